"""The core as two files, brace_core.h and brace_core.c, for builds that use no CMake.

    python3 tools/release/two_files.py --out FOLDER

brace_core.h is the public headers of firmware/core one after another, brace_core.c all of its sources. A name that two
sources keep to themselves (a static function, a type) gets the source's name behind it. The folder `batch`, many
postures at once on a host, is left out. The same sources give the same bytes. Needs nothing but Python.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
CORE = PROJECT / "firmware" / "core"
LEFT_OUT = "batch"
FIRST_TO_READ = "brace.h"
FIRST_OF_SOURCES = "base/exact.h"  # its #error and its pragma hold for all that follows

LICENCE = """ * SPDX-FileCopyrightText: 2026 The Brace authors
 * SPDX-License-Identifier: Apache-2.0
"""
HEADER_WORDS = """/* Brace {version}: the stiffness K at the tip of a robot's limb. The core's public headers.
 *
{licence} *
 * Written by tools/release/two_files.py; do not edit. brace_core.c has the functions. Both compile alone with any
 * C11 compiler: cc -std=c11 -O2 -c brace_core.c. A program that links them needs libm (-lm). brace_core.c refuses
 * -ffast-math: where a project has it, add -fno-fast-math for this file.
 */
"""
SOURCE_WORDS = """/* Brace {version}: the stiffness K at the tip of a robot's limb. The core's sources.
 *
{licence} *
 * Written by tools/release/two_files.py; do not edit. brace_core.h is the manual.
 */
"""
# The compiler flags of firmware/core/CMakeLists.txt, as far as a source can say them: products and sums are fused only
# where the source says fma, so that every processor gives the same bits; sqrtf sets no errno.
FLAGS = """
#ifdef __cplusplus
#error "brace_core.c is C: compile it with a C compiler. C++ programs include brace_core.h and link it."
#endif
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("fp-contract=off", "no-math-errno")
#else
#pragma STDC FP_CONTRACT OFF
#endif
"""

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_SYSTEM = re.compile(r"^#include <([^>]+)>\n", re.MULTILINE)
_PROJECT = re.compile(r'^#include "([^"]+)"[^\n]*\n', re.MULTILINE)
_GUARD = re.compile(r"^#ifndef (\w+_H)\n#define \1\n", re.MULTILINE)
_MACRO = re.compile(r"^#define (\w+)", re.MULTILINE)
_WORD = re.compile(r"[A-Za-z_]\w*")


class Unsuitable(Exception):
    """A source that cannot be put into one file with the others; the message says which and why."""


@dataclass
class Part:
    """A file of the core: its text without guard and includes, and the files that it sees, itself among them."""

    path: Path
    text: str
    sees: set[Path]


@dataclass
class Reader:
    """Takes files in, each header once and before its first user."""

    system: set[str] = field(default_factory=set)  # names of system headers
    parts: dict[Path, Part] = field(default_factory=dict)  # in the order in which they are written

    def take(self, path: Path) -> Part:
        """A file, after all headers that it includes."""
        if path in self.parts:
            return self.parts[path]
        text = path.read_text()
        if path.suffix == ".h":
            text = _without_guard(text, path)
        self.system.update(_SYSTEM.findall(text))
        seen = {path}.union(*(self.take(_find(name, path)).sees for name in _PROJECT.findall(text)))
        self.parts[path] = Part(path, _PROJECT.sub("", _SYSTEM.sub("", text)).strip("\n"), seen)
        return self.parts[path]


def _without_guard(text: str, path: Path) -> str:
    guard = _GUARD.search(text)
    if guard is None or not text.rstrip().endswith("#endif"):
        raise Unsuitable(f"{path}: no include guard of the usual form")
    return text[: guard.start()] + text[guard.end() :].rstrip().removesuffix("#endif")


def _find(name: str, user: Path) -> Path:
    for folder in (user.parent, CORE / "src", CORE / "include"):
        if (folder / name).is_file():
            return folder / name
    raise Unsuitable(f'{user}: #include "{name}" is no header of the core')


def declarations(text: str) -> Iterable[str]:
    """What stands at the outermost level of C text, bodies replaced by {}; enumerators keep theirs."""
    text = re.sub(r"^#[^\n]*(\\\n[^\n]*)*\n", "", _COMMENT.sub(" ", text), flags=re.MULTILINE)
    depth, start, kept = 0, 0, ""
    for at, letter in enumerate(text):
        if letter == "{":
            if depth == 0:
                kept += text[start:at] + "{"
                is_enum = re.search(r"\benum\b[^;(]*$", text[start:at]) is not None
                body = at
            depth += 1
        elif letter == "}":
            depth -= 1
            if depth == 0:
                kept += (text[body + 1 : at] if is_enum else "") + "}"
                start = at + 1
                if re.match(r"\s*(?:[\w*]+\s*)?[;,=\[]", text[start:]) is None:  # a function's end, not a type's
                    yield kept
                    kept = ""
        elif letter == ";" and depth == 0:
            yield kept + text[start:at]
            kept, start = "", at + 1


def own_names(text: str) -> set[str]:
    """What a source declares for itself at its outermost level: static objects and functions, types, enumerators."""
    names: set[str] = set()
    for line in declarations(text):
        if enumerators := re.search(r"\benum\b[^{]*\{(.*)\}", line, re.DOTALL):
            names.update(re.findall(r"(?:^|,)\s*(\w+)", enumerators[1]))
        head = re.sub(r"\{.*\}", " ", line, flags=re.DOTALL)
        if head.lstrip().startswith("typedef"):
            function_type = re.search(r"\(\s*\*\s*(\w+)\s*\)", head)
            names.add(function_type[1] if function_type else _WORD.findall(head)[-1])
        elif re.search(r"\b(static|INLINE)\b", head):
            before = re.split(r"[=(\[]", re.sub(r"__attribute__\s*\(\(.*?\)\)", "", head))[0]
            names.add(_WORD.findall(before)[-1])
    return names


def renamed(text: str, name: str, to: str) -> str:
    """The name of an object, a function or a type replaced, but not a member's."""
    return re.sub(rf"(?<![\w.])(?<!->){name}\b", to, text)


def sources() -> list[Path]:
    """The core's sources in their order."""
    return sorted(path for path in (CORE / "src").glob("*/*.c") if path.parent.name != LEFT_OUT)


def public_headers() -> list[Path]:
    """The public headers in their order, without those of the folder that is left out."""
    paths = (CORE / "include" / "brace").glob("*.h")
    return sorted(path for path in paths if not path.stem.endswith("_" + LEFT_OUT))


def two_files(version: str) -> dict[str, str]:
    """Names and texts of the two files."""
    reader = Reader()
    for path in public_headers():
        reader.take(path)
    manual, manual_includes = list(reader.parts.values()), sorted(reader.system)
    first = reader.parts[CORE / "include" / "brace" / FIRST_TO_READ]  # only words are left of it, and includes of all
    manual = [first, *(part for part in manual if part is not first)]
    reader.system = set()
    for path in (CORE / "src" / FIRST_OF_SOURCES, *sources()):
        reader.take(path)
    private = list(reader.parts.values())[len(manual) :]
    header = (
        HEADER_WORDS.format(version=version, licence=LICENCE)
        + "#ifndef BRACE_CORE_H\n#define BRACE_CORE_H\n\n"
        + _includes(manual_includes)
        + '\n#ifdef __cplusplus\nextern "C" {\n#endif\n'
        + "".join(_titled(part.path, part.text) for part in manual)
        + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
    )
    source = (
        SOURCE_WORDS.format(version=version, licence=LICENCE)
        + FLAGS
        + '\n#include "brace_core.h"\n\n'
        + _includes(sorted(reader.system))
        + "".join(_titled(path, text) for path, text in _kept_apart(private))
    )
    return {"brace_core.h": header, "brace_core.c": source}


def _includes(names: Iterable[str]) -> str:
    return "".join(f"#include <{name}>\n" for name in names)


def _titled(path: Path, text: str) -> str:
    return f"\n/* ---- {path.relative_to(CORE)} ---- */\n\n{text}\n"


def _kept_apart(parts: list[Part]) -> Iterable[tuple[Path, str]]:
    """Texts in which no two files declare the same name, and no source's macro outlives it."""
    names = {part.path: own_names(part.text) | set(_MACRO.findall(part.text)) for part in parts}
    count = Counter(name for own in names.values() for name in own)
    for part in parts:
        text = part.text
        for seen in sorted(part.sees & names.keys()):
            for name in sorted(name for name in names[seen] if count[name] > 1):
                text = renamed(text, name, f"{name}_in_{seen.stem}")
        if part.path.suffix == ".c":
            text += "".join(f"\n#undef {macro}" for macro in dict.fromkeys(_MACRO.findall(text)))
        yield part.path, text


def main(arguments: list[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="the core as brace_core.h and brace_core.c")
    parser.add_argument("--out", type=Path, required=True, metavar="FOLDER", help="where the two files go")
    out = parser.parse_args(arguments).out
    version = re.search(r"^set\(BRACE_VERSION (\S+)\)", (CORE / "cmake" / "version.cmake").read_text(), re.MULTILINE)
    out.mkdir(parents=True, exist_ok=True)
    for name, text in two_files(version[1] if version else "").items():
        (out / name).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
