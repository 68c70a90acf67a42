"""The firmware's C sources, found by looking, parsed with pycparser after the compiler's own preprocessor.

System headers are replaced by empty ones and a few typedefs: what is checked is our code. Assembly is taken out.
"""
from __future__ import annotations

import json
import re
import shlex
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

from pycparser import c_ast, c_parser

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("firmware", "hal")
CROSS = "arm-none-eabi-"

TYPES = "".join(f"typedef {'unsigned ' if u else ''}{base} {'u' if u else ''}{name}_t;\n"
                for u in (False, True) for name, base in (("int8", "char"), ("int16", "short"), ("int32", "int"),
                                                          ("int64", "long long"), ("intptr", "long"))) + """
typedef _Bool bool; typedef unsigned long size_t; typedef long ssize_t; typedef long ptrdiff_t; typedef long time_t;
typedef unsigned socklen_t; typedef unsigned long nfds_t; typedef unsigned speed_t; typedef unsigned tcflag_t;
typedef int FILE; typedef unsigned mode_t; typedef unsigned short in_port_t; typedef long off_t;
typedef unsigned sa_family_t; typedef int va_list;
typedef int uint_fast8_t; typedef unsigned long uintmax_t; typedef long intmax_t;
"""
ASSEMBLY = re.compile(r"\b(?:__asm__|__asm|asm)\b\s*(?:volatile|__volatile__)?\s*(?=\()")
RANGE_INITIALISER = re.compile(r"\[(\s*\w+\s*)\.\.\.[^\]]*\]")
LINE_MARKER = re.compile(r'^(?=# \d+ ")', re.M)
QUOTED = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'')
WORD = re.compile(r"[A-Za-z_]\w*")
SYSTEM_INCLUDE = re.compile(r"#\s*include\s*<([^>]+)>")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
PROJECT_INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


class Unreadable(Exception):
    """A source that cannot be preprocessed or parsed; the message names it."""


@dataclass(frozen=True)
class Finding:
    """One breach of a rule."""

    path: Path
    line: int
    rule: str
    why: str

    def __str__(self) -> str:
        name = self.path.relative_to(ROOT) if self.path.is_relative_to(ROOT) else self.path
        return f"{name}:{self.line}: {self.rule}: {self.why}"


@dataclass
class Source:
    """One translation unit."""

    path: Path
    flags: list[str] = field(default_factory=list)  # -I, -D and -m of its build
    compiler: str = "gcc"

    @cached_property
    def text(self) -> str:
        """As written."""
        return self.path.read_text()

    @cached_property
    def tree(self) -> c_ast.FileAST:
        """The whole translation unit."""
        return parse(self)

    @property
    def functions(self) -> list[c_ast.FuncDef]:
        """Those defined in this file or in the project's headers it includes."""
        return [node for node in self.tree.ext if isinstance(node, c_ast.FuncDef)]

    @cached_property
    def comments(self) -> dict[int, str]:
        """Comment text by each line it touches."""
        return comments_of(self.text)

    @cached_property
    def documents(self) -> str:
        """This file and the project's headers it includes, for what they say of a name."""
        return "\n".join([self.text, *(path.read_text() for path in self._headers())])

    def _headers(self) -> list[Path]:
        folders = [self.path.parent, *(Path(flag[2:]) for flag in self.flags if flag.startswith("-I"))]
        seen: dict[Path, None] = {}
        queue = [self.text]
        while queue:
            for name in PROJECT_INCLUDE.findall(queue.pop()):
                path = next((f / name for f in folders if (f / name).is_file()), None)
                if path is not None and path not in seen:
                    seen[path] = None
                    queue.append(path.read_text())
        return list(seen)


def comments_of(text: str) -> dict[int, str]:
    """Comment text by each line it touches."""
    found: dict[int, str] = {}
    for match in COMMENT.finditer(text):
        first = text.count("\n", 0, match.start()) + 1
        for line in range(first, first + match[0].count("\n") + 1):
            found[line] = found.get(line, "") + " " + match[0]
    return found


def without_assembly(text: str) -> str:
    """Every asm statement and register name removed, line structure kept."""
    out, at = [], 0
    while match := ASSEMBLY.search(text, at):
        end, depth, quoted = match.end(), 0, False
        while end < len(text):
            letter = text[end]
            if letter == "\\" and quoted:
                end += 1
            elif letter == '"':
                quoted = not quoted
            elif not quoted:
                depth += (letter == "(") - (letter == ")")
            end += 1
            if depth == 0 and not quoted:
                break
        out += [text[at:match.start()], "\n" * text.count("\n", match.start(), end)]
        at = end
    return "".join([*out, text[at:]])


def parse(source: Source) -> c_ast.FileAST:
    """Preprocess and parse. Raises Unreadable."""
    with tempfile.TemporaryDirectory(prefix="brace-discipline-") as folder:
        fake = Path(folder)
        (fake / "types_of_the_checker.h").write_text(TYPES)
        for name in SYSTEM_INCLUDE.findall(source.documents):
            (fake / name).parent.mkdir(parents=True, exist_ok=True)
            (fake / name).write_text("")
        command = [source.compiler, "-E", "-nostdinc", f"-I{fake}", *source.flags, "-D__attribute__(x)=",
                   "-D__extension__=",
                   "-D__restrict=", "-D__inline=inline", "-include", "types_of_the_checker.h", str(source.path)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = done.stderr.strip().splitlines()
        raise Unreadable(next((line for line in said if "error" in line), said[-1]))
    try:
        return c_ast.FileAST(_declarations(done.stdout))
    except Exception as error:  # pycparser's ParseError has moved between its versions
        raise Unreadable(f"{source.path}: {error}") from error


def _declarations(preprocessed: str) -> list[c_ast.Node]:
    """Of a translation unit, piece by piece: what the headers say is the same in most units, and parsed once."""
    found: list[c_ast.Node] = []
    types: set[str] = set()
    piece = ""
    for part in LINE_MARKER.split(preprocessed):
        piece += part
        if _is_whole(piece):
            for node in _parsed(piece, tuple(sorted(types.intersection(WORD.findall(piece))))):
                found.append(node)
                if isinstance(node, c_ast.Typedef):
                    types.add(node.name)
            piece = ""
    return found + _parsed(piece, tuple(sorted(types)))


@cache
def _is_whole(piece: str) -> bool:
    """It ends where a declaration ends."""
    code = QUOTED.sub("", re.sub(r"^#.*", "", piece, flags=re.M)).rstrip()
    return code.count("{") == code.count("}") and code.count("(") == code.count(")") and code[-1:] in ("", ";", "}")


@cache
def _parsed(piece: str, types: tuple[str, ...]) -> list[c_ast.Node]:
    """The declarations of a piece in which these names are types."""
    text = RANGE_INITIALISER.sub(r"[\1]", without_assembly(piece))
    known = "".join(f"typedef int {name};\n" for name in types)
    return list(c_parser.CParser().parse(known + text).ext[len(types):])


words_of = cache(shlex.split)


def build_commands(build: Path) -> dict[Path, list[str]]:
    """Source -> compiler flags that matter, from CMake's compile_commands.json."""
    listed = json.loads((build / "compile_commands.json").read_text())
    return {Path(entry["file"]): [flag for flag in words_of(entry["command"]) if flag[:2] in ("-I", "-D", "-m")]
            for entry in listed}


def build_objects(build: Path) -> list[tuple[Path, Path]]:
    """Every (source under firmware/ or hal/, object) that the build has made."""
    pairs = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = words_of(entry["command"])
        source, compiled = Path(entry["file"]), build / words[words.index("-o") + 1]
        if any(source.is_relative_to(ROOT / folder) for folder in FOLDERS) and compiled.is_file():
            pairs.append((source, compiled))
    return pairs


def firmware_sources(build: Path) -> Iterator[Source]:
    """Every .c under firmware/ and hal/: as its build compiles it, or, if that does not, with the host's compiler."""
    commands = build_commands(build)
    everywhere = sorted(f"-I{path}" for f in FOLDERS for name in ("include", "src", "generated")
                        for path in (ROOT / f).rglob(name) if path.is_dir())
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.c")):
            if path in commands:
                yield Source(path, commands[path], CROSS + "gcc")
            else:
                yield Source(path, everywhere, "gcc")
