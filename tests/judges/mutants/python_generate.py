"""Mutants of a line of Python by universalmutator's rules, those of them that can be found, and the order of lines."""

from __future__ import annotations

import ast
import builtins
import contextlib
import io
import random
import re
import tokenize
import warnings
from collections.abc import Iterator
from functools import cache
from types import CodeType

import generate
from generate import ROOT, Mutant
from universalmutator import mutator  # type: ignore[import-not-found,import-untyped,unused-ignore]

RULES = ["universal.rules", "python.rules"]
REFUSED, SAME, TEXT, COUNTS = "refused by Python", "same bytecode", "another text only", "counts"
PROSE = re.compile(r"[A-Za-z]\S*[ \n]+\S*[A-Za-z]")  # two words: what people read, not a key
GIVEN = {*dir(builtins), "min", "max"}  # a mutant may name these where its file did not
# A mutant in a line that removes files or ends processes would do so on this machine.
DANGEROUS = re.compile(r"\b(unlink|rmtree|rmdir|kill|killpg|send_signal)\(")


def is_text(node: ast.AST) -> bool:
    """Is it a statement that is a string and no more: a docstring?"""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


class Bare(ast.NodeTransformer):
    """Takes away what no run shows: annotations and docstrings; is_plain: also the words of messages."""

    def __init__(self, is_plain: bool) -> None:
        self.is_plain = is_plain

    def visit(self, node: ast.AST) -> ast.AST:
        """Also without each `pass`, so that one in place of a docstring is the same."""
        body = getattr(node, "body", None)
        if isinstance(body, list):
            is_described = isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
            if is_described and body and is_text(body[0]):
                body = body[1:]
            at = getattr(node, "lineno", 1)
            nothing = ast.Pass(lineno=at, col_offset=0, end_lineno=at, end_col_offset=0)
            node.body = [one for one in body if not isinstance(one, ast.Pass)] or [nothing]  # type: ignore[attr-defined]
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            node.returns = None
        found: ast.AST = super().visit(node)
        return found

    def visit_arg(self, node: ast.arg) -> ast.AST:
        node.annotation = None
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        node.annotation = ast.copy_location(ast.Constant(""), node.annotation)
        return self.generic_visit(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> ast.AST:
        if self.is_plain:
            for part in node.values:
                if isinstance(part, ast.Constant) and re.search(r"\s", str(part.value)):
                    part.value = "text"
        return self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        if self.is_plain and isinstance(node.value, str) and PROSE.search(node.value):
            node.value = "text"
        return node


def bare_code(text: str, is_plain: bool) -> tuple[object, ...]:
    """What Python runs of a text, without the places in it."""
    bare = Bare(is_plain).visit(ast.parse(text))
    assert isinstance(bare, ast.Module)
    return key_of(compile(bare, "mutant", "exec", dont_inherit=True))


def key_of(code: CodeType) -> tuple[object, ...]:
    constants = tuple(key_of(c) if isinstance(c, CodeType) else (type(c).__name__, repr(c)) for c in code.co_consts)
    names = (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_flags, code.co_name)
    heads = (code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_exceptiontable)
    return (code.co_code, constants, names, heads)


def names_in(text: str) -> set[str]:
    """Every identifier that a text reads."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.Attribute):
            found.add(node.attr)
        elif isinstance(node, ast.keyword) and node.arg is not None:
            found.add(node.arg)
    return found


@cache
def text_of(file: str) -> str:
    return (ROOT / file).read_text()


@cache
def as_it_is(file: str, is_plain: bool) -> tuple[object, ...]:
    return bare_code(text_of(file), is_plain)


@cache
def own_names(file: str) -> set[str]:
    """Identifiers of a file as it is, also those that it only defines. Python 3.11 has no tokens within f-strings."""
    tokens = tokenize.generate_tokens(io.StringIO(text_of(file)).readline)
    return {token.string for token in tokens if token.type == tokenize.NAME} | names_in(text_of(file)) | GIVEN


def with_mutant(mutant: Mutant) -> str:
    """The text of its file with the mutant in."""
    lines = text_of(mutant.file).splitlines(keepends=True)
    lines[mutant.line - 1] = mutant.new + "\n"
    return "".join(lines)


def verdict(mutant: Mutant) -> str:
    """Can a run tell the mutant from the file as it is? A name that the file does not have is refused, and so is what
    Python warns of, a number that is called: such a mutant fails wherever it is run, and a compiler refuses it."""
    text = with_mutant(mutant)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            compile(text, "mutant", "exec", dont_inherit=True)
        if not names_in(text) <= own_names(mutant.file):
            return REFUSED
        if bare_code(text, True) != as_it_is(mutant.file, True):
            return COUNTS
        return SAME if bare_code(text, False) == as_it_is(mutant.file, False) else TEXT
    except (SyntaxError, ValueError, Warning):
        return REFUSED


def code_lines(text: str) -> set[int]:
    """Numbers of the lines that may be mutated: neither imports, nor what would remove files or end processes."""
    imports: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    lines = enumerate(text.splitlines(), 1)
    bare = {n for n, line in lines if line.strip() and not line.lstrip().startswith("#") and not DANGEROUS.search(line)}
    return bare - imports


def mutants_of(file: str, line: int) -> list[Mutant]:
    """All mutants of a line. It is given alone: universalmutator takes `{-` for the beginning of a comment."""
    old = text_of(file).splitlines()[line - 1]
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutator.mutants_regexp([old + "\n"], ruleFiles=RULES, ignorePatterns=[], ignoreStringOnly=False)
    news = [new for _, new, *_ in found if not generate.INSERTED.search(new)]
    return [Mutant(file, line, old, new.rstrip("\n")) for new in news]


@cache
def choose(file: str, line: int, seed: int) -> tuple[Mutant | None, tuple[str, ...]]:
    """One mutant of a line that counts, at random. returns it, and the verdicts of those that came before it"""
    chance = random.Random(f"{seed} {file} {line}")
    mutants = mutants_of(file, line)
    chance.shuffle(mutants)
    before: list[str] = []
    for mutant in mutants:
        found = verdict(mutant)
        if found == COUNTS:
            return mutant, tuple(before)
        before.append(found)
    return None, tuple(before)


def order(lines_of: dict[str, set[int]], seed: int) -> Iterator[tuple[str, int]]:
    """File and line in a random order: first the lines of each file until one has a mutant that counts, then the rest,
    where each line has the same chance. The files are in a random order, too: a sample may be smaller than they are."""
    chance = random.Random(seed)
    names = sorted(lines_of)
    chance.shuffle(names)
    shuffled = {}
    for name in names:
        shuffled[name] = sorted(lines_of[name])
        chance.shuffle(shuffled[name])
    rest = []
    for name, lines in shuffled.items():
        for index, line in enumerate(lines):
            yield name, line
            if choose(name, line, seed)[0] is not None:
                rest += [(name, other) for other in lines[index + 1 :]]
                break
    chance.shuffle(rest)
    yield from rest
