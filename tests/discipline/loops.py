"""Every loop has a bound that can be seen.

Accepted: a condition one of whose parts compares a counter with a bound, where every change of the counter in the loop
goes towards the bound, one of them at every turn, and the bound is bounded itself:
 - a constant, or made of such by arithmetic, min-like choice, masking or remainder;
 - a variable that only ever gets such values, or a static function's argument that only ever is one;
 - what a function of the same file answers, if all its answers are bounded;
 - a byte, or the counter of another bounded loop;
 - what a guard before the loop has let through: if (count > MOST) { return ...; };
 - a member or constant whose range is documented, "[0, 64]" or "at most", where it is declared; an argument, in its own
   function's comment;
or a number that is divided or shifted down to nothing; or the comment of the loop says "at most" and what.
A loop without end is for main, start-up and faults: under firmware/boards, with a comment that begins "for ever:".
Jumps backwards are no loops at all.
"""
from __future__ import annotations

import re
from collections.abc import Iterator

from pycparser import c_ast, c_generator

from sources import ROOT, Finding, Source

RULE = "loop without a bound"
FOR_EVER = "for ever:"
FLIPPED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "!=": "!="}
LOOPS = (c_ast.For, c_ast.While, c_ast.DoWhile)
_generator = c_generator.CGenerator()


def written(node: c_ast.Node) -> str:
    """The expression as text: two places of the same text are the same variable."""
    return str(_generator.visit(node))


def walk(node: c_ast.Node | None) -> Iterator[c_ast.Node]:
    """The node and everything below it."""
    stack = [node] if node is not None else []
    while stack:
        at = stack.pop()
        yield at
        stack.extend(child for _, child in at.children())


def constant(node: c_ast.Node | None) -> bool:
    """Made of literals, sizes and names in capitals (enumerators)."""
    match node:
        case c_ast.Constant():
            return True
        case c_ast.ID():
            return node.name.isupper()
        case c_ast.Cast():
            return constant(node.expr)
        case c_ast.UnaryOp():
            return node.op == "sizeof" or (node.op in "+-~!" and constant(node.expr))
        case c_ast.BinaryOp():
            return constant(node.left) and constant(node.right)
        case c_ast.TernaryOp():
            return constant(node.iftrue) and constant(node.iffalse)
    return False


def variables(node: c_ast.Node | None) -> Iterator[c_ast.Node]:
    """Names and members that an expression reads; a member's own name is none."""
    stack = [node] if node is not None else []
    while stack:
        at = stack.pop()
        if isinstance(at, (c_ast.ID, c_ast.StructRef)):
            yield at
        stack.extend([at.name] if isinstance(at, c_ast.StructRef) else [child for _, child in at.children()])


def changes(node: c_ast.Node | None, name: str) -> list[c_ast.Node]:
    """Where the variable of that text is changed, or its address given away."""
    out: list[c_ast.Node] = []
    for at in walk(node):
        if isinstance(at, c_ast.Assignment) and written(at.lvalue) == name:
            out.append(at)
        elif isinstance(at, c_ast.UnaryOp) and at.op in ("++", "--", "p++", "p--", "&") and written(at.expr) == name:
            out.append(at)
    return out


def step(node: c_ast.Node) -> int:
    """+1 up, -1 down by a constant, 0 anything else."""
    if isinstance(node, c_ast.UnaryOp):
        return {"++": 1, "p++": 1, "--": -1, "p--": -1}.get(node.op, 0)
    if isinstance(node, c_ast.Assignment) and constant(node.rvalue) and written(node.rvalue)[0] not in "-0":
        return {"+=": 1, "-=": -1}.get(node.op, 0)
    return 0


def shrinks(node: c_ast.Node) -> bool:
    """value /= constant, value >>= constant."""
    return isinstance(node, c_ast.Assignment) and node.op in ("/=", ">>=") and constant(node.rvalue)


def parts(cond: c_ast.Node | None) -> list[c_ast.Node]:
    """The conjuncts of a condition."""
    if isinstance(cond, c_ast.BinaryOp) and cond.op == "&&":
        return parts(cond.left) + parts(cond.right)
    return [cond] if cond is not None else []


def ways_out(loop: c_ast.Node) -> list[c_ast.Node]:
    """Conditions under which the body's own statements leave the loop: if (i == MOST) { break; }"""
    body = loop.stmt.block_items or [] if isinstance(loop.stmt, c_ast.Compound) else [loop.stmt]
    out: list[c_ast.Node] = []
    for at in body:
        if isinstance(at, c_ast.If) and leaves(at.iftrue):
            pending = [at.cond]
            while pending:
                cond = pending.pop()
                if isinstance(cond, c_ast.BinaryOp) and cond.op == "||":
                    pending += [cond.left, cond.right]
                else:
                    out.append(cond)
    return out


def leaves(node: c_ast.Node | None) -> bool:
    """Ends in break or return."""
    if isinstance(node, c_ast.Compound):
        return bool(node.block_items) and leaves(node.block_items[-1])
    return isinstance(node, (c_ast.Break, c_ast.Return))


def returns(node: c_ast.Node | None) -> bool:
    """Ends in return."""
    if isinstance(node, c_ast.Compound):
        return bool(node.block_items) and returns(node.block_items[-1])
    return isinstance(node, c_ast.Return)


def alternatives(cond: c_ast.Node) -> list[c_ast.Node]:
    """The disjuncts of a condition."""
    if isinstance(cond, c_ast.BinaryOp) and cond.op == "||":
        return alternatives(cond.left) + alternatives(cond.right)
    return [cond]


def endless(loop: c_ast.Node) -> bool:
    """for (;;), while (1), while (true)."""
    return loop.cond is None or written(loop.cond) in ("1", "true", "1u")


class Function:
    """One function's loops."""

    def __init__(self, source: Source, node: c_ast.FuncDef) -> None:
        self.source, self.node = source, node
        arguments = node.decl.type.args
        self.arguments = [p.name for p in arguments.params if isinstance(p, c_ast.Decl)] if arguments else []
        self.is_static = "static" in node.decl.storage
        self.before_line = 0  # guards count when they come before this line

    # ---- bounds

    def bounded(self, node: c_ast.Node | None, depth: int = 0) -> bool:
        """Cannot exceed something that the source shows."""
        if node is None or depth > 8:
            return False
        if constant(node):
            return True
        match node:
            case c_ast.Cast():
                return "int8_t" in written(node.to_type) or self.bounded(node.expr, depth + 1)
            case c_ast.TernaryOp():
                both = self.bounded(node.iftrue, depth + 1) and self.bounded(node.iffalse, depth + 1)
                return both or self._smaller_of_two(node, depth)
            case c_ast.BinaryOp():
                left, right = self.bounded(node.left, depth + 1), self.bounded(node.right, depth + 1)
                if node.op in ("%", "&"):
                    return left or right
                return left and (right or node.op in ("-", "/", ">>"))
            case c_ast.UnaryOp():
                return node.op == "&" or (node.op == "*" and self._documented(written(node.expr)))
            case c_ast.ID():
                return self._name_bounded(node.name, depth)
            case c_ast.StructRef():
                return self._documented(node.field.name, is_member=True) or self._guarded(written(node), depth)
            case c_ast.ArrayRef():
                return self.bounded(node.name, depth + 1)
            case c_ast.FuncCall():
                return self._answers_bounded(written(node.name), depth)
        return False

    def _answers_bounded(self, name: str, depth: int) -> bool:
        """Of a function of this unit: everything it returns."""
        node = next((f for f in self.source.functions if f.decl.name == name), None)
        if node is None:
            return False
        answers = [at.expr for at in walk(node.body) if isinstance(at, c_ast.Return)]
        return bool(answers) and all(Function(self.source, node).bounded(at, depth + 1) for at in answers)

    def _smaller_of_two(self, node: c_ast.TernaryOp, depth: int) -> bool:
        """a < b ? a : b with one of them bounded."""
        cond = node.cond
        if not isinstance(cond, c_ast.BinaryOp) or cond.op not in FLIPPED:
            return False
        low, high = (cond.left, cond.right) if cond.op in ("<", "<=") else (cond.right, cond.left)
        return (written(node.iftrue) == written(low) and written(node.iffalse) == written(high) and
                (self.bounded(low, depth + 1) or self.bounded(high, depth + 1)))

    def _name_bounded(self, name: str, depth: int) -> bool:
        if self._documented(name) or self._guarded(name, depth) or self._counter(name, depth):
            return True
        if name in self.arguments:
            return self.is_static and not changes(self.node.body, name) and self._arguments_bounded(name, depth)
        values = [at.init for at in walk(self.node.body)
                  if isinstance(at, c_ast.Decl) and at.name == name and at.init is not None]
        for at in changes(self.node.body, name):
            if not isinstance(at, c_ast.Assignment) or at.op != "=":
                return False
            values.append(at.rvalue)
        if not values and self._is_array(name):
            return True
        return bool(values) and all(self.bounded(value, depth + 1) for value in values)

    def _guarded(self, text: str, depth: int) -> bool:
        """Refused when larger: a top-level if of the function that returns."""
        for at in self.node.body.block_items or []:
            if isinstance(at, c_ast.If) and returns(at.iftrue) and at.coord.line < self.before_line:
                for cond in alternatives(at.cond):
                    if isinstance(cond, c_ast.BinaryOp) and (
                            (cond.op in (">", ">=") and written(cond.left) == text
                             and self.bounded(cond.right, depth + 1)) or
                            (cond.op in ("<", "<=") and written(cond.right) == text
                             and self.bounded(cond.left, depth + 1))):
                        return True
                    if self._asked(cond, text, depth):
                        return True
        return False

    def _asked(self, cond: c_ast.Node, text: str, depth: int) -> bool:
        """A function of this file was asked whether it is too large:
        it compares that argument with something bounded."""
        for call in walk(cond):
            if isinstance(call, c_ast.FuncCall) and call.args is not None:
                place = next((i for i, at in enumerate(call.args.exprs) if written(at) == text), None)
                node = next((f for f in self.source.functions if f.decl.name == written(call.name)), None)
                if place is not None and node is not None:
                    inner = Function(self.source, node)
                    own = inner.arguments[place]
                    for at in walk(node.body):
                        if isinstance(at, c_ast.BinaryOp) and at.op in ("<", "<=", ">", ">="):
                            if ((written(at.left) == own and inner.bounded(at.right, depth + 1)) or
                                    (written(at.right) == own and inner.bounded(at.left, depth + 1))):
                                return True
        return False

    def _counter(self, name: str, depth: int) -> bool:
        """Counts another loop of this function, up to something bounded; starting at nothing larger."""
        for loop in walk(self.node.body):
            if isinstance(loop, c_ast.For):
                for part in parts(loop.cond):
                    if (isinstance(part, c_ast.BinaryOp) and part.op in ("<", "<=") and written(part.left) == name and
                            all(step(at) == 1 for at in self._inside(loop, name)) and
                            self._end_bounded(loop, part.left, part.right, depth + 1)):
                        return True
        return False

    def _end_bounded(self, loop: c_ast.Node, var: c_ast.Node, end: c_ast.Node, depth: int = 0) -> bool:
        """The bound itself; of a pointer: so many places after the start."""
        if self.bounded(end, depth):
            return True
        start = {written(at.init) for at in walk(getattr(loop, "init", None))
                 if isinstance(at, c_ast.Decl) and at.name == written(var) and at.init is not None}
        ends = [end]
        if isinstance(end, c_ast.ID):
            ends = [at.init for at in walk(self.node.body) if isinstance(at, c_ast.Decl) and at.name == end.name]
        return bool(ends) and all(isinstance(at, c_ast.BinaryOp) and at.op == "+" and written(at.left) in start and
                                  self.bounded(at.right, depth + 1) for at in ends)

    def _is_array(self, name: str) -> bool:
        return any(isinstance(at, c_ast.Decl) and at.name == name and isinstance(at.type, c_ast.ArrayDecl)
                   for at in [*walk(self.node.body), *self.source.tree.ext])

    def _arguments_bounded(self, name: str, depth: int) -> bool:
        """Of a static function: at all its calls."""
        place, own = self.arguments.index(name), self.node.decl.name
        calls = 0
        for node in self.source.functions:
            for at in walk(node.body):
                if isinstance(at, c_ast.FuncCall) and written(at.name) == own and at.args is not None:
                    calls += 1
                    caller = Function(self.source, node)
                    caller.before_line = at.coord.line
                    if not caller.bounded(at.args.exprs[place], depth + 1):
                        return False
        return calls > 0

    def _own_comments(self) -> str:
        """What stands before this function, wherever it is declared; and its own line's arguments."""
        own = re.escape(self.node.decl.name)
        # begun only where a declaration begins: from every letter of a line it would take half a second a file
        shown = rf"(?:/\*(?:(?!\*/).)*?\*/\s*\n)?(?<![^\n;{{}}])[^\n;{{}}]*\b{own}\((?:(?!\)[;\s]).)*\)"
        return "\n".join(match[0] for match in re.finditer(shown, self.source.documents, re.S))

    def _documented(self, name: str, is_member: bool = False) -> bool:
        """Its range stands where it is declared, or it is a byte."""
        n = re.escape(name)
        documents = self._own_comments() if name in self.arguments and not is_member else self.source.documents
        ranged = r"(?:\[[^\]\n]*[\w)]\]|\bat most\b|\b\d+ to \w+)"
        return re.search(rf"\bu?int8_t\s+(?:\w+,\s*)*\b{n}\b(?!\s*\()"
                         rf"|/\*(?:(?!\*/).)*?\b{n}\b[^.\n;]*{ranged}"
                         rf"|^\s*\*[^\n]*\b{n}\b[^.\n;]*{ranged}"
                         rf"|\b{n}\b(?:\[\w+\])?(?:, \w+)*;\s*/\*(?:(?!\*/).)*?{ranged}",
                         documents, re.M | re.S) is not None

    # ---- loops

    def findings(self) -> Iterator[Finding]:
        """Of this function."""
        for at in walk(self.node.body):
            if isinstance(at, LOOPS) and not self._accepted(at):
                yield self._finding(at, "no counter is seen that reaches a bound; give it one, document the bound's "
                                        "range, or say in the loop's comment 'at most ...'")
        yield from self._jumps()

    def _finding(self, node: c_ast.Node, why: str) -> Finding:
        return Finding(self.source.path, node.coord.line, RULE, f"in {self.node.decl.name}: {why}")

    def _jumps(self) -> Iterator[Finding]:
        labels = {at.name: at.coord.line for at in walk(self.node.body) if isinstance(at, c_ast.Label)}
        for at in walk(self.node.body):
            if isinstance(at, c_ast.Goto) and labels.get(at.name, 0) <= at.coord.line:
                yield self._finding(at, f"it jumps back to {at.name}")

    def _comment(self, loop: c_ast.Node) -> str:
        line = loop.coord.line
        return self.source.comments.get(line, "") + self.source.comments.get(line - 1, "")

    def _accepted(self, loop: c_ast.Node) -> bool:
        self.before_line = loop.coord.line
        counted = any(self._counts(loop, part) for part in [*parts(loop.cond), *self._kept_by_ways_out(loop)])
        if endless(loop) and not counted:
            boards = ROOT / "firmware" / "boards"
            body_line = self.source.comments.get(loop.coord.line + 1, "")
            return FOR_EVER in self._comment(loop) + body_line and (
                self.source.path.is_relative_to(boards) or not self.source.path.is_relative_to(ROOT))
        return counted or "at most" in self._comment(loop)

    @staticmethod
    def _kept_by_ways_out(loop: c_ast.Node) -> list[c_ast.Node]:
        """What holds while none of them is taken."""
        inverse = {">": "<=", ">=": "<", "<": ">=", "<=": ">", "==": "!="}
        return [c_ast.BinaryOp(inverse[at.op], at.left, at.right) for at in ways_out(loop)
                if isinstance(at, c_ast.BinaryOp) and at.op in inverse]

    def _counts(self, loop: c_ast.Node, part: c_ast.Node) -> bool:
        if isinstance(part, c_ast.UnaryOp) and part.op in ("p--", "--"):  # while (n--)
            return self._name_bounded(written(part.expr), 0) or self.bounded(part.expr)
        if not isinstance(part, c_ast.BinaryOp) or part.op not in FLIPPED:
            return isinstance(part, c_ast.ID) and self._falls(loop, part)
        return (self._reaches(loop, part.left, part.op, part.right) or
                self._reaches(loop, part.right, FLIPPED[part.op], part.left))

    def _falls(self, loop: c_ast.Node, var: c_ast.Node) -> bool:
        inside = self._inside(loop, written(var))
        return bool(inside) and all(shrinks(at) for at in inside) and self._every_turn(loop, inside)

    def _inside(self, loop: c_ast.Node, name: str) -> list[c_ast.Node]:
        return [*changes(loop.stmt, name), *changes(loop.cond, name),
                *(changes(loop.next, name) if isinstance(loop, c_ast.For) else [])]

    def _reaches(self, loop: c_ast.Node, left: c_ast.Node, op: str, right: c_ast.Node) -> bool:
        """left, a variable, goes towards right, which stands still."""
        var = left.expr if isinstance(left, c_ast.UnaryOp) and left.op in ("p++", "p--", "++", "--") else left
        if isinstance(var, c_ast.BinaryOp) and var.op in "+-" and constant(var.right):  # i + 1 < n
            var = var.left
        if not isinstance(var, (c_ast.ID, c_ast.StructRef)):
            return False
        inside = self._inside(loop, written(var))
        if not inside or not self._every_turn(loop, inside):
            return False
        if op in (">", "!=") and all(shrinks(at) for at in inside):
            return constant(right)
        ways = {step(at) for at in inside}
        towards = {"<": {1}, "<=": {1}, ">": {-1}, ">=": {-1}}.get(op)
        if towards is None:  # '!=': by ones, from either side
            if len(ways) != 1 or 0 in ways or not all(isinstance(at, c_ast.UnaryOp) for at in inside):
                return False
        elif ways != towards:
            return False
        moved = any(self._inside(loop, written(at)) for at in variables(right))
        if -1 in ways:  # downwards: what it starts from has to be bounded
            stands = constant(right) or (isinstance(right, c_ast.ID) and self._counter(right.name, 0))
            return stands and not moved and self._start_bounded(loop, var)
        return not moved and self._end_bounded(loop, var, right)

    def _start_bounded(self, loop: c_ast.Node, var: c_ast.Node) -> bool:
        name = written(var)
        if self._documented(name) or (isinstance(var, c_ast.StructRef) and self.bounded(var)):
            return True
        if name in self.arguments:
            return self.is_static and self._arguments_bounded(name, 0)
        values = [at.init for at in walk(self.node.body)
                  if isinstance(at, c_ast.Decl) and at.name == name and at.init is not None]
        values += [at.rvalue for at in changes(self.node.body, name) if isinstance(at, c_ast.Assignment)
                   and at.op == "="]
        return bool(values) and all(self.bounded(value) for value in values)

    @staticmethod
    def _every_turn(loop: c_ast.Node, inside: list[c_ast.Node]) -> bool:
        """One of the changes happens at each turn, whatever the loop's body decides."""
        def unconditional(node: c_ast.Node | None) -> list[c_ast.Node]:
            if node is None or isinstance(node, (c_ast.If, c_ast.Switch, c_ast.TernaryOp, *LOOPS)):
                return []
            if isinstance(node, c_ast.BinaryOp) and node.op in ("&&", "||"):
                return unconditional(node.left)
            return [node, *(n for _, child in node.children() for n in unconditional(child))]

        always = unconditional(loop.cond)
        if isinstance(loop, c_ast.For):
            always += unconditional(loop.next)
        if not any(isinstance(at, c_ast.Continue) for at in walk(loop.stmt)):
            always += unconditional(loop.stmt)
        return any(at is change for at in always for change in inside)


def check(source: Source) -> list[Finding]:
    """All loops of a file (and of the headers' functions it includes)."""
    found: list[Finding] = []
    for node in source.functions:
        if node.coord.file == str(source.path):
            found += Function(source, node).findings()
    return sorted(found, key=lambda finding: finding.line)
