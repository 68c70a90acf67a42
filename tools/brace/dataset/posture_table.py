"""A CSV file of postures: the angles as numbers, and every row's own bytes, so that columns can be appended to rows
that stay as they are, whatever else they hold and however it is encoded."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, did_you_mean
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.ground.slips import slip
from brace.ground.units import FORCE_MOST_N

WHAT = "table of postures"
_SLACK_RAD = 1e-5
LIMITS_RAD = {"theta1_rad": 2 * math.pi, "theta2_rad": math.pi, "theta0_rad": 2 * math.pi}
_MEANING = {"theta1_rad": "femur angle", "theta2_rad": "knee angle", "theta0_rad": "coxa yaw"}
_REQUIRED = ("theta1_rad", "theta2_rad")
FORCES = ("fx_n", "fz_n")  # both or neither
FORCE_ACROSS = "fy_n"  # beside them; 0 where it is not there


@dataclass(frozen=True)
class PostureTable:
    """`angles` maps theta1_rad, theta2_rad and, if present, theta0_rad to one entry per row; `forces` likewise fx_n,
    fz_n and, if present, fy_n, the force of the ground on the tip, and is empty where the file has none. `rows` are the
    file's bytes row by row without line ends; `lines` the line on which each begins."""

    path: Path
    names: Sequence[str]
    header: bytes
    rows: Sequence[bytes]
    lines: Sequence[int]
    line_end: bytes
    angles: dict[str, np.ndarray]
    forces: dict[str, np.ndarray]

    def place(self, row: int) -> str:
        """Where a row stands (0 is the first below the header), for messages."""
        return f"{self.path}:{self.lines[row]} (row {row + 1})"

    def with_columns(self, names: Sequence[str], texts: Sequence[Sequence[str]]) -> bytes:
        """The file with columns appended: `texts` holds one sequence per column."""
        added = [",".join(row).encode() for row in zip(*texts)]
        lines = [self.header + b"," + ",".join(names).encode()]
        lines += [row + b"," + extra for row, extra in zip(self.rows, added)]
        return self.line_end.join(lines) + self.line_end


def read_postures(path: Path) -> PostureTable:
    """Reads and checks the file; refuses with line, row, column, reason and suggestion."""
    data = read_bytes(path, DATA_LIMIT_BYTES, WHAT)
    records, lines = _records(data, path)
    if len(records) < 2:
        raise BadFileError(
            "no rows",
            where=f"{path}:1",
            why=f"a {WHAT} is a line of column names and rows below it",
            next_step="give it columns theta1_rad,theta2_rad and a row per posture",
        )
    header = records[0]
    quoted = b'"' in data
    names = [_readable(name.strip()) for name in _fields(header.removeprefix(b"\xef\xbb\xbf"), quoted)]
    _check_names(names, path)
    rows, lines = records[1:], lines[1:]
    line_end = next((end for end in (b"\r\n", b"\n", b"\r") if end in data), b"\n")
    table = PostureTable(path, names, header, rows, lines, line_end, {}, {})
    _fill(table, [_fields(row, quoted) for row in rows])
    return table


def _records(data: bytes, path: Path) -> tuple[list[bytes], list[int]]:
    """Rows without their line ends, and the line on which each begins; a quoted field may hold line ends."""
    if b"\0" in data:
        line = data.count(b"\n", 0, data.index(b"\0")) + 1
        raise BadFileError(
            "not text: it holds a zero byte",
            where=f"{path}:{line}",
            why=f"a {WHAT} is comma-separated text",
            next_step="export it as CSV",
        )
    raw = data.splitlines(keepends=True)
    while raw and not raw[-1].strip():
        raw.pop()
    if b'"' not in data:
        return [line.rstrip(b"\r\n") for line in raw], list(range(1, len(raw) + 1))
    records: list[bytes] = []
    lines: list[int] = []
    pending: list[bytes] = []
    quotes = 0
    for number, text in enumerate(raw, start=1):
        if not pending:
            lines.append(number)
        pending.append(text)
        quotes += text.count(b'"')
        if quotes % 2 == 0:
            records.append(b"".join(pending).rstrip(b"\r\n"))
            pending = []
    if pending:
        raise BadFileError(
            "a quoted field does not end",
            where=f"{path}:{lines[-1]}",
            why='a field that begins with " ends with "',
            next_step='close the quotes, or write "" for a quote inside',
        )
    return records, lines


def _fields(record: bytes, quoted: bool) -> list[str]:
    text = record.decode("latin-1")  # every byte is some character, and only numbers are looked at
    return next(csv.reader([text], skipinitialspace=True), [""]) if quoted and '"' in text else text.split(",")


def _readable(field: str) -> str:
    """A field as UTF-8 if it is that."""
    try:
        return field.encode("latin-1").decode()
    except UnicodeDecodeError:
        return field


def _check_names(names: Sequence[str], path: Path) -> None:
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        raise BadFileError(
            "columns are not separated by commas",
            where=f"{path}:1",
            why="';' or tabs stand where commas are wanted",
            next_step="export with ',' between columns and '.' as decimal point",
        )
    for position, name in enumerate(names):
        if name and name in names[:position]:
            raise BadFileError(
                f"column {name!r} is there twice",
                where=f"{path}:1",
                why="it is not said which of the two counts",
                next_step="rename or drop one",
            )
    missing = [name for name in _REQUIRED if name not in names]
    if missing:
        near = did_you_mean(missing[0], [name for name in names if name not in LIMITS_RAD])
        near = near or next((name for name in names if name.startswith(missing[0][:6])), "")
        raise BadFileError(
            f"missing column{'s' if missing[1:] else ''} {', '.join(missing)}",
            where=f"{path}:1",
            why=f"the postures' angles in rad; the header has {', '.join(names)[:200]}",
            next_step=f"is it column {near!r}? convert to rad and rename it {missing[0]}"
            if near
            else f"add {missing[0]}",
        )


def _fill(table: PostureTable, fields: list[list[str]]) -> None:
    width = len(table.names)
    for row, entries in enumerate(fields):
        if len(entries) != width:
            empty = not table.rows[row].strip()
            raise BadFileError(
                f"row {row + 1} has {0 if empty else len(entries)} fields, the header {width}",
                where=table.place(row),
                why="the line is empty" if empty else "a row was cut short or holds a stray comma",
                next_step="complete or delete the row",
            )
    for name, limit in LIMITS_RAD.items():
        if name in table.names:
            position = table.names.index(name)
            table.angles[name] = _angles(table, [entries[position] for entries in fields], name, limit)
    present = [name for name in FORCES if name in table.names]
    across = [FORCE_ACROSS] if FORCE_ACROSS in table.names else []
    if len(present) == 1 or (across and not present):
        present = present or across
        other = next(name for name in FORCES if name not in present)
        raise BadFileError(
            f"column {present[0]} without {other}",
            where=f"{table.path}:1",
            why="a force on the tip has two components in the limb's plane",
            next_step=f"add {other} (0 where there is none), or rename {present[0]}",
        )
    for name in (*present, *across):
        position = table.names.index(name)
        table.forces[name] = _forces(table, [entries[position] for entries in fields], name)


def _forces(table: PostureTable, texts: list[str], name: str) -> np.ndarray:
    values = np.array([_number(text) for text in texts])
    bad = ~(np.abs(values) <= FORCE_MOST_N)
    if bad.any():
        row = int(np.argmax(bad))
        shown = _readable(texts[row]).strip()
        why, meant = slip(shown)
        raise BadFileError(
            f"{name} = {shown[:40]!r} is not allowed" if shown else "an entry is empty",
            where=f"{table.place(row)}, {name}",
            why=why or f"{name} is the force of the ground on the tip in N, within +-{FORCE_MOST_N:g}",
            next_step=f"write {meant}; so throughout" if meant else "write a number of N, 0 where there is no force",
        )
    return values


def _angles(table: PostureTable, texts: list[str], name: str, limit_rad: float) -> np.ndarray:
    try:
        values = np.array([float(text) for text in texts])
    except ValueError:
        values = np.array([_number(text) for text in texts])
    if any("_" in text for text in texts):
        values = np.array([_number(text) for text in texts])
    bad = ~(np.abs(values) <= limit_rad + _SLACK_RAD)
    if bad.any():
        row = int(np.argmax(bad))
        shown, finite = _readable(texts[row]).strip(), math.isfinite(values[row])
        why, meant = slip(shown)
        way = f"write {meant}; so throughout" if meant else "write a number with a decimal point, or delete the row"
        raise BadFileError(
            (f"{name} = {shown[:40]!r} is not allowed" if finite else f"{shown[:40]!r} is not a number")
            if shown
            else "an entry is empty",
            where=f"{table.place(row)}, {name}",
            why=why or f"{name} is the commanded {_MEANING[name]} in rad, within +-{limit_rad:.6g}",
            next_step=f"{math.radians(values[row]):.6g} if the column is in degrees" if finite else way,
        )
    return values


def _number(text: str) -> float:
    try:
        return math.nan if "_" in text else float(text)
    except ValueError:
        return math.nan
