"""Who calls whom, from the sources: no recursion, every call through a pointer known, and with the compiler's own
figures (-fstack-usage) how deep the stack can get.

A call through a structure's member can reach every function that is ever put there; one through an argument, every
function that is ever passed for it. Such calls go only through the members of brace_hal_t and the names in POINTERS.
"""
from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from pycparser import c_ast

from loops import walk, written
from sources import ROOT, Finding, Source

RECURSION = "recursion"
POINTER = "call through a pointer"
STACK = "stack without a bound"

# Beside the hardware door's members: what may be called through a pointer, and what it is.
POINTERS_FILE = Path(__file__).with_name("pointers.txt")


@dataclass
class Node:
    """One function."""

    key: str  # its name; of a static one, with its file
    path: Path
    line: int
    calls: set[str] = field(default_factory=set)
    through: set[tuple[str, int]] = field(default_factory=set)  # member or argument called through, and the line


@dataclass
class Graph:
    """All functions of the given sources."""

    nodes: dict[str, Node] = field(default_factory=dict)
    targets: dict[str, set[str]] = field(default_factory=dict)  # member or "function()argument" -> functions put there
    members: set[str] = field(default_factory=set)  # function pointers of brace_hal_t

    def below(self, key: str, there: Callable[[str], bool] = lambda _: True) -> set[str]:
        """What a function calls, also through pointers (those of which `there` says so)."""
        node = self.nodes.get(key)
        if node is None:
            return set()
        return node.calls | {t for name, _ in node.through for t in self.targets.get(name, ()) if there(t)}


def key_of(name: str, coord_file: str, is_static: bool) -> str:
    """Statics of different files are different functions."""
    return f"{Path(coord_file).resolve()}:{name}" if is_static else name


def short(key: str) -> str:
    """For people."""
    return key.rpartition(":")[2]


def listed_pointers(containing: str = "") -> set[str]:
    """Names that pointers.txt allows, of the lines that contain a word."""
    lines = POINTERS_FILE.read_text().splitlines()
    return {line.split()[0] for line in lines if line.strip() and not line.startswith("#") and containing in line}


def _function_keys(source: Source) -> dict[str, str]:
    """Name as written in this unit -> key; of functions defined or declared."""
    keys: dict[str, str] = {}
    for at in source.tree.ext:
        if isinstance(at, c_ast.Decl) and isinstance(at.type, c_ast.FuncDecl) and "static" not in at.storage:
            keys.setdefault(at.name, at.name)
        elif isinstance(at, c_ast.FuncDef):
            keys[at.decl.name] = key_of(at.decl.name, at.coord.file, "static" in at.decl.storage)
    return keys


def _arguments(function: c_ast.FuncDef) -> list[str]:
    args = function.decl.type.args
    return [p.name for p in args.params if isinstance(p, c_ast.Decl)] if args else []


def _plain(node: c_ast.Node) -> c_ast.Node:
    """Without address-of, dereference and casts."""
    while True:
        if isinstance(node, c_ast.UnaryOp) and node.op in ("&", "*"):
            node = node.expr
        elif isinstance(node, c_ast.Cast):
            node = node.expr
        else:
            return node


def _base_type(kind: c_ast.Node | None) -> str:
    """Name of the structure type below arrays, pointers and qualifiers; empty when there is none."""
    while isinstance(kind, (c_ast.ArrayDecl, c_ast.PtrDecl, c_ast.TypeDecl, c_ast.Typename)):
        kind = kind.type
    return kind.names[-1] if isinstance(kind, c_ast.IdentifierType) else ""


class _Unit:
    """Takes one source into the graph."""

    def __init__(self, graph: Graph, source: Source) -> None:
        self.graph, self.source, self.keys = graph, source, _function_keys(source)
        self.structures = {at.name: {d.name: d.type for d in at.type.type.decls or []} for at in source.tree.ext
                           if isinstance(at, c_ast.Typedef) and isinstance(at.type, c_ast.TypeDecl) and
                           isinstance(at.type.type, c_ast.Struct)}
        self.globals = {at.name: at.type for at in source.tree.ext if isinstance(at, c_ast.Decl)}
        self.locals: dict[str, c_ast.Node] = {}

    def take_in(self) -> None:
        for at in self.source.tree.ext:
            if isinstance(at, c_ast.FuncDef):
                self._function(at)
            elif isinstance(at, c_ast.Decl) and at.init is not None:
                self.locals = {}
                self._puts(at, "")
            if isinstance(at, c_ast.Typedef) and at.name == "brace_hal_t":
                self.graph.members |= {f"brace_hal_t.{d.name}" for d in at.type.type.decls or []
                                       if isinstance(d.type, c_ast.PtrDecl) and isinstance(d.type.type, c_ast.FuncDecl)}

    def _function(self, at: c_ast.FuncDef) -> None:
        node = Node(self.keys[at.decl.name], Path(at.coord.file), at.coord.line)
        self.locals = {d.name: d.type for d in walk(at) if isinstance(d, c_ast.Decl)}
        self.graph.nodes[node.key] = node
        own, arguments = node.key, _arguments(at)
        self._puts(at.body, own, arguments)
        for call in walk(at.body):
            if not isinstance(call, c_ast.FuncCall):
                continue
            name = _plain(call.name)
            if isinstance(name, c_ast.ID) and name.name in self.keys:
                node.calls.add(self.keys[name.name])
                self._passes(self.keys[name.name], call, own, arguments)
            elif isinstance(name, c_ast.ID) and name.name in arguments:
                node.through.add((f"{own}()#{arguments.index(name.name)}", call.coord.line))
            elif isinstance(name, c_ast.ID) and (name.name.startswith("__builtin_") or self._is_library(name.name, at)):
                node.calls.add(name.name)
            else:
                node.through.add((self._place(name), call.coord.line))

    def _is_library(self, name: str, function: c_ast.FuncDef) -> bool:
        local = any(isinstance(d, c_ast.Decl) and d.name == name for d in walk(function.body))
        return not local and not any(isinstance(d, c_ast.Decl) and d.name == name for d in self.source.tree.ext)

    def _structure(self, node: c_ast.Node) -> str:
        """Structure type of an expression; empty when it is not known."""
        node = _plain(node)
        match node:
            case c_ast.ID():
                return _base_type(self.locals.get(node.name, self.globals.get(node.name)))
            case c_ast.ArrayRef():
                return self._structure(node.name)
            case c_ast.StructRef():
                return _base_type(self.structures.get(self._structure(node.name), {}).get(node.field.name))
        return ""

    def _place(self, node: c_ast.Node) -> str:
        """What a pointer is kept in: a structure's member, a table, a variable."""
        if isinstance(node, c_ast.StructRef):
            return f"{self._structure(node.name)}.{node.field.name}"
        if isinstance(node, c_ast.ArrayRef):
            return self._place(node.name)
        return written(node)

    def _passes(self, callee: str, call: c_ast.FuncCall, own: str, arguments: list[str]) -> None:
        for i, arg in enumerate(call.args.exprs if call.args else []):
            self._put(f"{callee}()#{i}", arg, own, arguments)

    def _put(self, place: str, value: c_ast.Node, own: str, arguments: list[str]) -> None:
        value = _plain(value)
        if isinstance(value, c_ast.TernaryOp):
            self._put(place, value.iftrue, own, arguments)
            self._put(place, value.iffalse, own, arguments)
        elif isinstance(value, c_ast.ID):
            if value.name in arguments:
                self.graph.targets.setdefault(place, set()).add(f"{own}()#{arguments.index(value.name)}")
            elif value.name in self.keys:
                self.graph.targets.setdefault(place, set()).add(self.keys[value.name])

    def _puts(self, node: c_ast.Node | None, own: str, arguments: list[str] | None = None) -> None:
        """Functions that become the value of a member or a variable."""
        arguments = arguments or []
        for at in walk(node):
            if isinstance(at, c_ast.Assignment):
                self._put(self._place(at.lvalue), at.rvalue, own, arguments)
            elif isinstance(at, c_ast.CompoundLiteral):
                self._list(_base_type(at.type), at.init, "", own, arguments)
            elif isinstance(at, c_ast.Decl) and at.init is not None and not isinstance(at.type, c_ast.FuncDecl):
                if isinstance(at.init, c_ast.InitList):
                    self._list(_base_type(at.type), at.init, at.name, own, arguments)
                else:
                    self._put(at.name, at.init, own, arguments)

    def _list(self, kind: str, rows: c_ast.InitList, table: str, own: str, arguments: list[str]) -> None:
        """{.member = function}, {"name", function}: of a structure, or of a table of such, or of functions."""
        members = list(self.structures.get(kind, {}))
        for i, row in enumerate(rows.exprs):
            named = isinstance(row, c_ast.NamedInitializer)
            value = row.expr if named else row
            last = row.name[-1] if named else None
            member = last.name if isinstance(last, c_ast.ID) and last.name in members else None
            if member is None and not named and not isinstance(value, c_ast.InitList) and i < len(members):
                member = members[i]
            if isinstance(value, c_ast.InitList):
                inner = _base_type(self.structures.get(kind, {}).get(member)) if member else kind
                self._list(inner, value, table, own, arguments)
            elif member is not None:
                self._put(f"{kind}.{member}", value, own, arguments)
            else:
                self._put(table, value, own, arguments)


def graph_of(sources: Iterable[Source]) -> Graph:
    """The whole program's calls."""
    graph = Graph()
    for source in sources:
        _Unit(graph, source).take_in()
    for place in [p for p in graph.targets if p.startswith(".")]:  # of a structure that is not known: of any
        for other in [p for p in graph.targets if p.endswith(place)] + [m for m in graph.members if m.endswith(place)]:
            graph.targets.setdefault(other, set()).update(graph.targets[place])
    changed = True
    while changed:  # an argument that is passed on reaches what was passed for it
        changed = False
        for place, put in graph.targets.items():
            more = {t for p in put if "()#" in p for t in graph.targets.get(p, ())} - put
            if more:
                graph.targets[place] = put | more
                changed = True
    for place in graph.targets:
        graph.targets[place] = {t for t in graph.targets[place] if "()#" not in t}
    return graph


def pointer_findings(graph: Graph) -> list[Finding]:
    """Calls through pointers that are not listed, or reach nothing that is known."""
    listed, found = listed_pointers() | graph.members, []
    elsewhere = listed_pointers("elsewhere")
    for node in graph.nodes.values():
        for place, line in sorted(node.through):
            name = short(place)
            if name not in listed:
                found.append(Finding(node.path, line, POINTER, f"in {short(node.key)}: through {name}; list it in "
                                     "tests/discipline/pointers.txt and say what it is"))
            elif not graph.targets.get(place) and name not in graph.members | elsewhere:
                found.append(Finding(node.path, line, POINTER,
                                     f"in {short(node.key)}: nothing is ever put into {name}"))
    return found


def recursion_findings(graph: Graph) -> list[Finding]:
    """Every function that can come back to itself."""
    found = []
    for key, node in graph.nodes.items():
        seen: dict[str, str] = {}
        pending = [(key, below) for below in graph.below(key)]
        while pending:
            above, at = pending.pop()
            if at in seen:
                continue
            seen[at] = above
            if at == key:
                chain, step = [short(key)], above
                while step != key:
                    chain.append(short(step))
                    step = seen[step]
                found.append(Finding(node.path, node.line, RECURSION, " <- ".join([*chain, short(key)])))
                break
            pending += [(at, below) for below in graph.below(at)]
    return found


# ---- stack

FOLDERS_WITH_FIGURES = (ROOT / "firmware", ROOT / "hal")
SU_LINE = re.compile(r"^(.*):(\d+):\d+:(\S+)\t(\d+)\t(\S+)$", re.M)


def frames(build: Path) -> tuple[dict[str, int], list[Finding]]:
    """Stack of each function by the compiler [B] under its key and its bare name, and functions without a bound."""
    sizes: dict[str, int] = {}
    found = []
    for path in build.rglob("*.su"):
        for source, line, name, size, kind in SU_LINE.findall(path.read_text()):
            file = (build / source).resolve()  # ccache has the compiler name its source from the build folder
            if not any(file.is_relative_to(folder) for folder in FOLDERS_WITH_FIGURES):
                continue
            if kind == "dynamic":
                found.append(Finding(file, int(line), STACK, f"{name}: {kind}"))
            bare = name.split(".")[0]
            for key in (bare, f"{file}:{bare}"):
                sizes[key] = max(sizes.get(key, 0), int(size))
    return sizes, found


def deepest(graph: Graph, sizes: dict[str, int], root: str, there: Callable[[str], bool],
            outside: Callable[[str], int]) -> tuple[int, list[str]]:
    """Deepest stack from `root` down [B] and the chain; `outside` gives it for functions that are not ours."""
    known: dict[str, tuple[int, list[str]]] = {}

    def go(key: str, above: tuple[str, ...]) -> tuple[int, list[str]]:
        if key in above:
            return 0, ["recursion"]
        if key not in known:
            if key not in graph.nodes:
                known[key] = (outside(key), [short(key)])
            else:
                size, chain = max((go(b, (*above, key)) for b in sorted(graph.below(key, there))), default=(0, []))
                known[key] = (size + sizes.get(key, 0), [short(key), *chain])  # inlined: no figure, none of its own
        return known[key]

    return go(root, ())
