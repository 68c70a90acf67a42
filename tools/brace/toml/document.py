"""A parsed TOML file with the line on which each key stands."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from brace.ground.errors import BadFileError, place
from brace.ground.files import TOML_LIMIT_BYTES, read_text
from brace.ground.slips import slip
from brace.toml.parser import tomllib

_BARE_OR_QUOTED = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
_KEY = rf"{_BARE_OR_QUOTED}(?:\s*\.\s*{_BARE_OR_QUOTED})*"
_TABLE_LINE = re.compile(rf"^\s*\[(\[)?\s*({_KEY})\s*\]")
_KEY_LINE = re.compile(rf"^\s*({_KEY})\s*=")
_NUMBER_WITH_UNIT = re.compile(r"([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)\s*[A-Za-z\u00b0/]+[\w/ ]*")
MAX_DEPTH = 8
_ERROR_LINE = re.compile(r"\(at line (\d+), column \d+\)|\(at end of document\)")


@dataclass(frozen=True)
class Document:
    """`content` as tomllib gives it; `lines` maps dotted keys ("link.femur.tilt_rad", "configuration.0.r_mm")
    to 1-based line numbers."""

    path: Path
    content: dict[str, object]
    lines: dict[str, int] = field(default_factory=dict)

    def where(self, key: str = "") -> str:
        """`file:line` of a dotted key, or of the first key below it, or of the nearest table above it, or of
        the file's first line."""
        parts = key.split(".") if key else []
        while parts:
            dotted = ".".join(parts)
            below = (at for key, at in self.lines.items() if key.startswith(dotted + "."))
            line = self.lines.get(dotted) or min(below, default=None)
            if line is not None:
                return place(self.path, line)
            parts.pop()
        return place(self.path, 1)


def read(path: Path, what: str) -> Document:
    """Reads and parses a TOML file; `what` names it in refusals ("limb model")."""
    return parse(read_text(path, TOML_LIMIT_BYTES, what), path, what)


def parse(text: str, path: Path, what: str) -> Document:
    """Parses TOML text; a syntax error or a duplicate key is refused with its line."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise _syntax_error(str(error), text, path, what) from None
    except RecursionError:
        raise BadFileError(
            f"not a {what}: nested too deeply",
            where=place(path, _deepest_line(text)),
            why=f"a {what} has tables of plain values, at most {MAX_DEPTH} levels",
            next_step="write plain tables of plain values",
        ) from None
    except ValueError as error:  # Python refuses integers of thousands of digits
        raise BadFileError(
            f"not a {what}: a number of thousands of digits",
            where=place(path, _longest_number_line(text)),
            why=str(error).partition(";")[0],
            next_step="write the number with a decimal point or an exponent, e.g. 1.6e-5",
        ) from None
    lines = _locate(text)
    _refuse_depth(content, lines, path, what, text)
    return Document(path, content, lines)


def _refuse_depth(content: dict[str, object], lines: dict[str, int], path: Path, what: str, text: str) -> None:
    """Walks the document level by level (never recursively) and refuses what is deeper than any format here."""
    level: list[object] = [content]
    for _ in range(MAX_DEPTH):
        level = [
            item
            for value in level
            for item in (value.values() if isinstance(value, dict) else value if isinstance(value, list) else ())
            if isinstance(item, (dict, list))
        ]
        if not level:
            return
    raise BadFileError(
        f"not a {what}: nested too deeply",
        where=place(path, _deepest_line(text)),
        why=f"a {what} has tables of plain values, at most {MAX_DEPTH} levels",
        next_step="write plain tables of plain values",
    )


def _deepest_line(text: str) -> int:
    """The line with the most brackets and dots, where the depth comes from."""
    lines = text.splitlines() or [""]
    return 1 + max(range(len(lines)), key=lambda i: sum(lines[i].count(mark) for mark in "[{."))


def _longest_number_line(text: str) -> int:
    lengths = [max(map(len, re.findall(r"[\d_]+", line)), default=0) for line in text.splitlines()]
    return 1 + lengths.index(max(lengths))


def _syntax_error(message: str, text: str, path: Path, what: str) -> BadFileError:
    found = _ERROR_LINE.search(message)
    line = int(found.group(1)) if found and found.group(1) else text.count("\n") + 1
    reason = _ERROR_LINE.sub("", message).strip()
    lines = text.splitlines()
    shown = lines[line - 1].strip()[:80] if 0 < line <= len(lines) else ""
    if "overwrite a value" in reason.lower() or "declare" in reason.lower():
        next_step = "keep one of the two entries"
        reason = f"a key or table is given twice ({reason})"
    else:
        next_step = _way_on(lines[line - 1] if shown else "")
    return BadFileError(
        f"not valid TOML: {shown!r}",
        where=place(path, line),
        why=f"a {what} is a TOML file: {reason}",
        next_step=next_step,
    )


def _way_on(line: str) -> str:
    """For a line that is no TOML."""
    key, equals, value = (part.strip() for part in line.partition("#")[0].partition("="))
    why, meant = slip(value)
    if meant:
        return f"{key} = {meant}: {why}"
    if equals and (with_unit := _NUMBER_WITH_UNIT.fullmatch(value)):
        return f"{key} = {with_unit.group(1)}: the unit is in the key's name"
    return "text needs quotes, numbers a point, tables [brackets]; docs/limb-keys.md has the keys of a limb model"


def _locate(text: str) -> dict[str, int]:
    """Line of every key in a well-formed document (inline tables count as their key's line)."""
    lines: dict[str, int] = {}
    table = ""
    counts: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _TABLE_LINE.match(line):
            table = _plain(header.group(2))
            if header.group(1):
                counts[table] = counts.get(table, -1) + 1
                table = f"{table}.{counts[table]}"
            lines.setdefault(table, number)
        elif key := _KEY_LINE.match(line):
            dotted = _plain(key.group(1))
            lines.setdefault(f"{table}.{dotted}" if table else dotted, number)
    return lines


def _plain(key: str) -> str:
    return ".".join(part.strip().strip("\"'") for part in re.findall(_BARE_OR_QUOTED, key))
