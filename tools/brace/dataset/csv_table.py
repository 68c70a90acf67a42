"""data.csv into numpy columns: fast when all is well, exact about row and column when not."""

from __future__ import annotations

import csv
import io
import math
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from brace.dataset.columns import Column
from brace.dataset.entries import QUOTED_COMMA, beyond_limit, entry_by_entry, entry_limit, entry_text
from brace.dataset.faults import DataFault
from brace.dataset.not_read import nothing_read, with_absent, without_blanks
from brace.ground.errors import BadFileError, did_you_mean
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.ground.slips import slip

WHAT = "dataset's data.csv"
MOST_REMARKS = 100  # lines above the column names that are looked through


def read_columns(
    path: Path, wanted: Sequence[Column], unreadable: list[DataFault] | None = None
) -> tuple[dict[str, np.ndarray], list[bytes]]:
    """The wanted columns as arrays of one entry per row (axis: 0 x, 1 z), and the file's lines without header.

    Refuses anything that is not a complete rectangular table of finite numbers, naming line, row, column. Where a list
    for `unreadable` entries is given, single entries that are none are put there, and read as 0. Optional columns may
    be empty for whole runs, and are NaN there."""
    data = read_bytes(path, DATA_LIMIT_BYTES, WHAT)
    lines = _lines(data, path)
    header = _header(lines[0], path)
    rows = lines[1:]
    while rows and not rows[-1].strip():
        rows.pop()
    if not rows:
        raise BadFileError(
            "no rows",
            where=f"{path}:1",
            why="there is a header and nothing below it",
            next_step="record some data",
        )
    if any(b'"' in line for line in (lines[0], rows[0])):
        rows = [b",".join(field.strip() for field in _unquoted(row)) for row in rows]
    elif any(b" " in row for row in rows):
        rows = [b",".join(field.strip() for field in row.split(b",")) for row in rows]
    _check_header(header, wanted, path, lines)
    _check_widths(rows, len(header), path)
    present = [column for column in wanted if column.name in header]
    positions = [header.index(column.name) for column in present]
    rows, not_read = without_blanks(rows, present, positions)
    refused: list[DataFault] = []
    try:
        columns = _parse(rows, present, positions, path)
        for column, position in zip(present, positions):
            _check_entries(columns[column.name], column, rows, position, path)
    except BadFileError:
        if unreadable is None:
            raise
        columns, refused = entry_by_entry(rows, present, positions)
        if not refused:
            raise
        unreadable += refused
    for name, blank in not_read.items():
        columns[name] = np.where(blank, np.nan, columns[name])
    typed = with_absent({column.name: _typed(columns[column.name], column) for column in present}, wanted)
    names, empty = nothing_read(typed, wanted)
    if empty.size:
        row = int(empty[0])
        raise BadFileError(
            f"{' and '.join(names)} are both empty",
            where=f"{path}:{row + 2} (row {row + 1})",
            why="a row without any force says nothing",
            next_step="give one of the two, or delete the row",
        )
    return typed, rows


def field_text(row: bytes, position: int) -> str:
    """One field of a raw line as text."""
    return entry_text(row.split(b",")[position])


def _lines(data: bytes, path: Path) -> list[bytes]:
    if data.startswith(b"\xef\xbb\xbf"):
        data = data[3:]
    if b"\0" in data:
        line = data.count(b"\n", 0, data.index(b"\0")) + 1
        raise BadFileError(
            "not text: it holds a zero byte",
            where=f"{path}:{line}",
            why="data.csv is comma-separated text",
            next_step="export it as CSV, UTF-8",
        )
    if not data.strip():
        raise BadFileError(
            "an empty file",
            where=str(path),
            why="data.csv starts with a line of column names",
            next_step="record some data",
        )
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data.split(b"\n")


def _header(line: bytes, path: Path) -> list[str]:
    try:
        text = line.decode("utf-8")
    except UnicodeDecodeError:
        raise BadFileError(
            "the header is not text",
            where=f"{path}:1",
            why="data.csv is UTF-8 text",
            next_step="export it as CSV, UTF-8",
        ) from None
    if "," not in text and (";" in text or "\t" in text):
        raise BadFileError(
            "columns are not separated by commas",
            where=f"{path}:1",
            why="';' or tabs stand where commas are wanted",
            next_step="export with ',' between columns and '.' as decimal point",
        )
    names = [name.strip().strip('"') for name in text.split(",")]
    if all(_is_entry(name) for name in names):
        raise BadFileError(
            "no column names",
            where=f"{path}:1",
            why="data.csv starts with a line of column names, and this one begins with readings",
            next_step="put the names above: docs/datasets.md has them",
        )
    return names


def _is_entry(text: str) -> bool:
    """A number, or the name of an axis: what stands below a header."""
    try:
        return text in ("x", "z") or math.isfinite(float(text))
    except ValueError:
        return False


def _unquoted(row: bytes) -> list[bytes]:
    fields = next(csv.reader(io.StringIO(row.decode("utf-8", "replace"))), [])
    return [field.encode().replace(b",", QUOTED_COMMA) for field in fields]


def _check_header(header: list[str], wanted: Sequence[Column], path: Path, lines: Sequence[bytes]) -> None:
    for position, name in enumerate(header):
        if name in header[:position] and any(column.name == name for column in wanted):
            raise BadFileError(
                f"column {name!r} is there twice",
                where=f"{path}:1",
                why="it is not said which of the two counts",
                next_step="rename or drop one",
            )
    missing = [column for column in wanted if _needed(column, wanted, header) and column.name not in header]
    if not missing:
        return
    if not {column.name for column in wanted} & set(header):
        _refuse_preamble(lines, missing, path)
    column = missing[0]
    spare = [name for name in header if name not in {item.name for item in wanted}]
    near = did_you_mean(column.name, spare)
    stem = column.name.partition("_")[0]
    near = near or next((name for name in spare if name.partition("_")[0] == stem or _alike(stem, name)), "")
    names = ", ".join(item.name for item in missing)
    unit = f" in {column.unit}" if column.unit else ""
    raise BadFileError(
        f"missing column{'s' if len(missing) > 1 else ''} {names}",
        where=f"{path}:1",
        why=f"{column.name} is the {column.meaning}{unit}; the header has {', '.join(header)[:200]}",
        next_step=(
            f"is it column {near!r}? convert{unit or ' it'} and rename it {column.name}"
            if near
            else f"add {column.name}"
        ),
    )


def _needed(column: Column, wanted: Sequence[Column], header: Sequence[str]) -> bool:
    """Whether a column has to be there: of several of which one is enough, those that seem to be there by another name,
    and all where none is."""
    if not column.one_of:
        return column.required
    others = [other.name for other in wanted if other.one_of == column.one_of]
    spare = [name for name in header if name not in {item.name for item in wanted}]
    stem = column.name.removesuffix(f"_{column.unit.lower()}")
    return not set(others) & set(header) or any(_alike(stem, name) for name in spare)


def _alike(stem: str, name: str) -> bool:
    """Whether a column's name is another way to say this one: force_x, Fx [N]."""
    letters = "".join(char for char in name.lower() if char.isalpha() or char == "_")
    return letters.startswith((stem, f"{stem[0]}_{stem[1:]}", f"force_{stem[1:]}", f"force{stem[1:]}"))


def _refuse_preamble(lines: Sequence[bytes], required: Sequence[Column], path: Path) -> None:
    """Remarks above the column names."""
    for number, line in enumerate(lines[1:MOST_REMARKS], start=2):
        if {column.name.encode() for column in required} <= {name.strip().strip(b'"') for name in line.split(b",")}:
            raise BadFileError(
                f"the column names stand in line {number}",
                where=f"{path}:1",
                why="data.csv starts with the line of column names; remarks go into meta.toml, which keeps them",
                next_step=f"take the {number - 1} line{'s' if number > 2 else ''} above away",
            )


def _check_widths(rows: list[bytes], width: int, path: Path) -> None:
    if b"\n".join(rows).count(b",") == len(rows) * (width - 1) and all(rows[:1]):
        counts_ok = True
    else:
        counts_ok = False
    if counts_ok and len(rows) > 200_000:
        body = np.frombuffer(b"\n".join(rows) + b"\n", dtype=np.uint8)
        ends = np.flatnonzero(body == 10)
        commas = np.flatnonzero(body == 44)
        per_row = np.diff(np.searchsorted(commas, ends), prepend=0)
        bad = np.flatnonzero(per_row != width - 1)
    else:
        bad = np.flatnonzero(np.fromiter((row.count(b",") for row in rows), np.int64, len(rows)) != width - 1)
    if bad.size:
        row = int(bad[0])
        fields = rows[row].count(b",") + 1 if rows[row].strip() else 0
        raise BadFileError(
            f"row {row + 1} has {fields} field{'s' if fields != 1 else ''}, the header {width}",
            where=f"{path}:{row + 2}",
            why=(
                "a row was cut short or holds a stray comma (a decimal comma?)"
                if fields
                else "the line is empty"
            ),
            next_step="complete or delete the row",
        )


def _parse(
    rows: list[bytes], present: list[Column], positions: list[int], path: Path
) -> dict[str, np.ndarray]:
    kinds = np.dtype([(column.name, "S4" if column.kind == "axis" else "f8") for column in present])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = np.loadtxt(
                io.BytesIO(b"\n".join(rows)),
                dtype=kinds,
                delimiter=",",
                comments=None,
                usecols=positions,
                ndmin=1,
                encoding="latin-1",
            )
    except (ValueError, UserWarning, OverflowError):
        raise _first_bad_number(rows, present, positions, path) from None
    return {column.name: np.ascontiguousarray(table[column.name]) for column in present}


def _first_bad_number(
    rows: list[bytes], present: list[Column], positions: list[int], path: Path
) -> BadFileError:
    for number, row in enumerate(rows, start=1):
        for column, position in zip(present, positions):
            text = field_text(row, position)
            if column.kind == "axis":
                continue
            try:
                float(text)
                if "_" not in text:
                    continue
            except ValueError:
                pass
            shown = text if len(text) <= 40 else text[:37] + "..."
            why, meant = slip(text)
            return BadFileError(
                f"{shown!r} is not a number" if text else "an entry is empty",
                where=f"{path}:{number + 1} (row {number}), {column.name}",
                why=why or f"{column.name} is the {column.meaning}" + (f" in {column.unit}" if column.unit else ""),
                next_step=f"write {meant}; so throughout the file"
                if meant
                else "write a number with a decimal point, or delete the row",
            )
    return BadFileError(
        "not a table of numbers",
        where=str(path),
        why="it could not be read",
        next_step="export it as plain CSV",
    )


def _check_entries(values: np.ndarray, column: Column, rows: list[bytes], position: int, path: Path) -> None:
    if column.kind == "axis":
        bad = ~((values == b"x") | (values == b"z"))
        why, way = "axis is x or z", "write x or z"
    else:
        bad = ~np.isfinite(values)
        why, way = "a reading that is not finite says nothing", "delete the row or record it again"
        if not bad.any():
            bad = np.abs(values) > entry_limit(column)
            why, way = beyond_limit(column), "correct the entry"
        if not bad.any() and column.positive:
            bad = values <= 0.0
            why, way = f"{column.name}, the {column.meaning}, is positive", "correct the entry"
        if not bad.any() and column.kind == "int":
            bad = values != np.rint(values)
            why, way = f"{column.name}, the {column.meaning}, is a whole number", "correct the entry"
    if bad.any():
        row = int(np.argmax(bad))
        is_nan = values.dtype.kind == "f" and bool(np.isnan(values[row]))
        raise BadFileError(
            f"{column.name} = {field_text(rows[row], position)[:40]!r} is not {'a number' if is_nan else 'allowed'}",
            where=f"{path}:{row + 2} (row {row + 1}), {column.name}",
            why=why,
            next_step=way,
        )


def _typed(values: np.ndarray, column: Column) -> np.ndarray:
    if column.kind == "axis":
        return np.asarray(values == b"z", dtype=np.int32)
    return np.asarray(values.astype(np.int32) if column.kind == "int" else values)
