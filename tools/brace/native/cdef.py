"""C declarations for cffi, taken from the real headers so that structs can not drift.

A small preprocessor for headers written the way ours are: declarations, enums, include guards, plain constant
macros. Function-like macros, conditionals other than guards and `__cplusplus`, and inline functions are dropped.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
_DEFINE = re.compile(r"^\s*#\s*define\s+([A-Za-z_]\w*)\s+(.+?)\s*$")
_NUMBER = re.compile(r"\(?\s*(-?(?:0[xX][0-9a-fA-F]+|\d+))[uUlL]*\s*\)?")
_INLINE = re.compile(r"(?:static\s+inline|inline\s+static)\b[^;{]*\{")
_STATIC_ASSERT = re.compile(r"_Static_assert\s*\([^;]*;")
_ATTRIBUTE = re.compile(r"__attribute__\s*\(\(.*?\)\)")


def declarations(roots: Sequence[Path], folders: Sequence[Path]) -> str:
    """The declarations of the headers `roots` and of all that they include from `folders`, each header once."""
    seen: set[Path] = set()
    constants: dict[str, str] = {}
    text = "\n".join(part for root in roots for part in _unfold(root, folders, seen, constants))
    text = _without_bodies(_STATIC_ASSERT.sub("", _ATTRIBUTE.sub("", text)))
    if constants:
        names = re.compile(r"\b(" + "|".join(map(re.escape, constants)) + r")\b")
        for _ in range(3):  # constants may be written in terms of others
            text = names.sub(lambda match: constants[match.group(1)], text)
    return re.sub(r"\n\s*\n+", "\n", text)


def _unfold(
    header: Path, folders: Sequence[Path], seen: set[Path], constants: dict[str, str]
) -> Iterable[str]:
    header = header.resolve()
    if header in seen:
        return
    seen.add(header)
    depth_cplusplus = 0
    kept: list[str] = []
    source = _COMMENT.sub(" ", header.read_text()).replace("\\\n", " ")
    for line in source.split("\n"):
        directive = line.lstrip().startswith("#")
        if depth_cplusplus:
            if directive and re.match(r"\s*#\s*if", line):
                depth_cplusplus += 1
            elif directive and re.match(r"\s*#\s*endif", line):
                depth_cplusplus -= 1
            continue
        if not directive:
            kept.append(line)
        elif re.match(r"\s*#\s*if(def\s+|\s+defined\s*\(?\s*)__cplusplus", line):
            depth_cplusplus = 1
        elif include := _INCLUDE.match(line):
            for folder in (header.parent, *folders):
                if (folder / include.group(1)).is_file():
                    yield from _unfold(folder / include.group(1), folders, seen, constants)
                    break
        elif define := _DEFINE.match(line):
            if number := _NUMBER.fullmatch(define.group(2)):
                constants[define.group(1)] = number.group(1)
            elif re.fullmatch(r"[\w\s()+*/<-]+", define.group(2)) and not re.search(
                r"\d\.|\bf\b", define.group(2)
            ):
                constants[define.group(1)] = f"({define.group(2)})"
    yield "\n".join(kept)


def _without_bodies(text: str) -> str:
    """Inline functions removed, braces matched."""
    while match := _INLINE.search(text):
        depth, end = 1, match.end()
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        text = text[: match.start()] + text[end:]
    return text
