"""Excel workbooks (.xlsx), read with openpyxl."""

from __future__ import annotations

import datetime
import io
import math
import zipfile
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TypeAlias

from brace.ground.errors import BadFileError, UsageError
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.importing import numerals
from brace.importing.part import Part
from brace.importing.sheet_layout import Layout, layout_of
from brace.importing.table_in_lines import (
    CELLS_MOST, COLUMNS_MOST, ROWS_MOST, Line, decimal_sign, parts, refuse_large, width_of,
)  # fmt: skip

WHAT = "workbook"
UNPACKED_MOST_BYTES = 1 << 29
_BLOCK_BYTES = 1 << 20
Row: TypeAlias = tuple[object, ...]


def is_workbook(path: Path) -> bool:
    """Whether the file is a zipped one: a workbook, or something that is not read."""
    try:
        with path.open("rb") as file:
            return file.read(4) == b"PK\x03\x04"
    except OSError:
        return False


def read(path: Path, *, sheet: str = "", decimal: str = "") -> list[Part]:
    """The tables of one sheet: the one that is named, or the only one that has any."""
    data = read_bytes(path, DATA_LIMIT_BYTES, WHAT)
    if not _has_sheets(data):
        raise BadFileError(
            "a zipped file that is no Excel workbook, or a damaged one",
            where=str(path),
            why="brace import reads text (CSV and the like) and .xlsx",
            next_step="save it as .xlsx or CSV, or unpack it",
        )
    try:
        import openpyxl  # noqa: F401
    except ImportError:
        raise UsageError(
            "this is an Excel workbook, and openpyxl is not installed",
            where=str(path),
            why="openpyxl reads it",
            next_step="pip install openpyxl, or save the sheet as CSV",
        ) from None
    sheets = _sheets(path, data)
    if sheet and sheet not in sheets:
        raise UsageError(
            f"no sheet {sheet!r}", where=str(path), why=f"its sheets are {', '.join(sheets)}", next_step="--sheet NAME"
        )
    tables = {}
    for name in [sheet] if sheet else sheets:
        if width_of(_lines(sheets[name], ".")) >= 2:
            tables[name] = sheets[name]
    if not tables:
        raise BadFileError(
            "no table of readings in this workbook",
            where=str(path),
            why="no sheet has rows with two or more numbers (formulas that were never computed have none)",
            next_step="open it in a spreadsheet program, save it there, or export the sheet as CSV",
        )
    if len(tables) > 1:
        raise UsageError(
            f"{len(tables)} sheets have tables: {', '.join(tables)}",
            where=str(path),
            why="it is not said which is meant",
            next_step=f"--sheet {next(iter(tables))!r}",
        )
    name, rows = next(iter(tables.items()))
    rows = _with_formulas(data, name, rows)
    layout = layout_of(data, name)
    _refuse_hidden(path, rows, layout)
    rows, merged = _with_merged(rows, layout)
    texts = [cell for row in rows for cell in row if isinstance(cell, str)]
    sign = decimal or decimal_sign(path, texts)
    how = "Excel workbook" + (", decimal comma in its texts" if sign == "," else "")
    how += f", {merged} merged cells count for each of their rows" if merged else ""
    return parts(path, _lines(rows, sign), decimal=".", how=how, sheet=name)


def _refuse_hidden(path: Path, rows: Sequence[Row], layout: Layout) -> None:
    """Rows of readings that a filter or a person has hidden: whether they count is nobody's guess."""
    hidden = [number for number, row in enumerate(rows, start=1) if number in layout.hidden and _has_readings(row)]
    if hidden:
        raise UsageError(
            f"{len(hidden)} rows with readings are hidden, the first is row {hidden[0]}",
            where=str(path),
            why="a filter or a person has hidden them, and nothing says whether they belong to the test",
            next_step="delete them, or show them (clear the filter), and save the workbook",
        )


def _has_readings(row: Row) -> bool:
    return sum(1 for cell in row if isinstance(cell, (int, float)) and not isinstance(cell, bool)) >= 2


def _with_merged(rows: list[Row], layout: Layout) -> tuple[list[Row], int]:
    """A cell that is merged over three or more rows stands for each of them; of two, it may be a name. And how many."""
    out = [list(row) for row in rows]
    filled = 0
    for first, last, column in layout.merged:
        if last - first < 2 or last > len(out) or column >= len(out[first - 1]) or out[first - 1][column] is None:
            continue
        filled += 1
        for row in out[first:last]:
            row += [None] * (column + 1 - len(row))
            row[column] = out[first - 1][column] if row[column] is None else row[column]
    return [tuple(row) for row in out] if filled else rows, filled


def _sheets(path: Path, data: bytes) -> dict[str, list[Row]]:
    """The cells of every sheet of a table. A sheet states how many rows it has; some programs write that wrongly."""
    import openpyxl

    sheets = {}
    _refuse_large(path, data)
    try:
        book = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=True)
        for sheet in book.worksheets:
            sheet.reset_dimensions()
            sheets[sheet.title] = _rows(path, sheet.iter_rows(values_only=True))
    except BadFileError:
        raise
    except Exception as error:  # openpyxl lets through whatever its parsers raise
        raise BadFileError(
            "this workbook cannot be read",
            where=str(path),
            why=f"openpyxl: {type(error).__name__}: {str(error)[:200]}",
            next_step="open it in a spreadsheet program and save it as .xlsx, or export the sheet as CSV",
        ) from None
    return sheets


def _with_formulas(data: bytes, name: str, rows: list[Row]) -> list[Row]:
    """Empty cells that have a formula get its text: a program that computes nothing stores no result."""
    if not any(cell is None for row in rows for cell in row):
        return rows
    import openpyxl

    sheet = openpyxl.load_workbook(io.BytesIO(data), read_only=True, data_only=False)[name]
    sheet.reset_dimensions()
    return [
        tuple(
            written if cell is None and isinstance(written, str) and written.startswith("=") else cell
            for cell, written in zip_longest(row, formulas)
        )
        for row, formulas in zip(rows, sheet.iter_rows(values_only=True))
    ]


def _rows(path: Path, rows: Iterable[Row]) -> list[Row]:
    """Rows of a sheet. Gaps between the numbers of its rows and cells are filled by openpyxl, whatever they are."""
    found: list[Row] = []
    cells = 0
    for row in rows:
        found.append(row)
        cells += len(row)
        if cells > CELLS_MOST:
            refuse_large(path, len(found), -(-cells // len(found)))
        if len(found) > ROWS_MOST or len(row) > COLUMNS_MOST:
            refuse_large(path, len(found), len(row))
    return found


def _refuse_large(path: Path, data: bytes) -> None:
    """Counts rows and cells in the packed sheets, which may unpack to a thousand times their size."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for entry in archive.infolist():
            if entry.file_size > UNPACKED_MOST_BYTES:
                raise BadFileError(
                    f"this workbook unpacks to {entry.file_size} bytes ({entry.filename[:80]})",
                    where=str(path),
                    why=f"at most {UNPACKED_MOST_BYTES} are read: a record of a limb has fewer",
                    next_step="save the sheet of the readings alone, or export it as CSV",
                )
            if not entry.filename.startswith("xl/worksheets/"):
                continue
            rows = cells = 0
            try:
                with archive.open(entry) as sheet:
                    while block := sheet.read(_BLOCK_BYTES):
                        rows += block.count(b"<row") + block.count(b":row") // 2
                        cells += block.count(b"<c ") + block.count(b"<c>") + block.count(b":c ") // 2
                        refuse_large(path, rows, max(1, cells // max(1, rows)))
            except zipfile.BadZipFile:
                return  # openpyxl says what is damaged


def _has_sheets(data: bytes) -> bool:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return any(name.startswith("xl/") for name in archive.namelist())
    except zipfile.BadZipFile:
        return False


def _lines(rows: Sequence[Row], sign: str) -> list[Line]:
    """sign: the decimal one of numbers that are kept as text. All numbers get a point."""
    lines = []
    for number, row in enumerate(rows, start=1):
        texts = [_with_point(cell, sign) if isinstance(cell, str) else _text(cell) for cell in row]
        lines.append(Line(number, ";".join(texts), texts))
    widest = max((index + 1 for line in lines for index, cell in enumerate(line.cells) if cell.strip()), default=0)
    return [Line(line.number, line.text, (line.cells + [""] * widest)[:widest]) for line in lines]


def _with_point(text: str, sign: str) -> str:
    value = numerals.number(text, sign)
    return repr(value) if sign == "," and math.isfinite(value) else text.strip()


def _text(cell: object) -> str:
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return str(cell)
    if isinstance(cell, float):
        return repr(cell)
    if isinstance(cell, datetime.datetime):
        return cell.replace(tzinfo=None).isoformat(sep=" ")
    if isinstance(cell, datetime.time):
        return cell.isoformat()
    if isinstance(cell, datetime.timedelta):
        return repr(cell.total_seconds())
    return str(cell).strip()
