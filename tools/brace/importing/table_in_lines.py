"""Finds the tables among rows of cells: free text above, a line or two of names, units, readings, text below."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from brace.ground.errors import BadFileError
from brace.ground.units import meanings_of, unit_of
from brace.importing import names as names_of, numerals
from brace.importing.part import Part

ROWS_MOST = 2_000_000  # a test of half an hour at 1 kHz
COLUMNS_MOST = 16_384  # of Excel
CELLS_MOST = 20_000_000
HEADER_MOST = 3  # lines of names and units
_REMARK = re.compile(r"\s*([^:=\t;]{2,60}?)\s*(?::|=|\t|;)\s*(.{1,200})")
_NO_UNIT = frozenset(("", "-", "--", "[-]", "(-)", "1", "none", "[]", "n/a"))
# A row with one of these sums up the readings above it.
_SUMMARIES = frozenset(
    ("mean", "average", "avg", "max", "min", "maximum", "minimum", "std", "stdev", "sum", "median", "total", "range")
    + ("mittelwert", "mittel", "durchschnitt", "summe", "standardabweichung", "spannweite")
)
_TITLE_MOST = 200  # characters
_TITLES = frozenset(("run", "rep", "config", "axis", "test"))


def refuse_large(path: Path, rows: int, columns: int) -> None:
    """Refuses a file that is no record by its size, before it is read cell by cell."""
    for count, most, what in (
        (rows, ROWS_MOST, "rows"), (columns, COLUMNS_MOST, "columns"), (rows * columns, CELLS_MOST, "cells")
    ):  # fmt: skip
        if count > most:
            raise BadFileError(
                f"{count} {what} in this file",
                where=str(path),
                why=f"at most {most} are imported: a record of a limb has fewer",
                next_step="cut it to the rows and columns of the test, or take every tenth reading",
            )


@dataclass(frozen=True)
class Line:
    """One line of a file: its number, its text, its cells."""

    number: int
    text: str
    cells: list[str]

    @property
    def filled(self) -> int:
        return sum(1 for cell in self.cells if cell.strip())

    @property
    def readings(self) -> int:
        """Cells that are numbers, clock times or marks for 'nothing read'."""
        return sum(1 for cell in self.cells if _is_reading(cell))


def _is_reading(cell: str) -> bool:
    text = cell.strip()
    return bool(text) and (numerals.is_number(text) or numerals.clock_s(text) == numerals.clock_s(text))


def width_of(lines: Sequence[Line]) -> int:
    """The number of cells that most lines of readings have; 0 where there is none."""
    widths = Counter(len(line.cells) for line in lines if line.readings >= 2 and 2 * line.readings >= line.filled)
    return max(widths, key=lambda width: (widths[width], width)) if widths else 0


def _holds_readings(line: Line, width: int) -> bool:
    cells = _fitted(line, width)
    if cells is None or not line.filled or _sums_up(line):
        return False
    void = sum(1 for cell in cells if cell.strip() and numerals.is_missing(cell))
    return line.readings >= 1 and 2 * (line.readings + void) >= line.filled


def _is_row(line: Line, width: int) -> bool:
    """Whether a line among the readings is one of theirs: of an overload there may be the time alone, in front."""
    if _holds_readings(line, width):
        return True
    filled = [cell for cell in line.cells if cell.strip()]
    return _fitted(line, width) is not None and bool(filled) and _is_reading(filled[0]) and not _sums_up(line)


def _sums_up(line: Line) -> bool:
    return any(cell.strip().lower().rstrip(":") in _SUMMARIES for cell in line.cells)


def _fitted(line: Line, width: int) -> list[str] | None:
    """The line's cells, blank ones at its end added or taken off."""
    cells = line.cells
    if len(cells) > width and not any(cell.strip() for cell in cells[width:]):
        cells = cells[:width]
    return cells if len(cells) == width else None


def parts(path: Path, lines: Sequence[Line], *, decimal: str, how: str, sheet: str = "") -> list[Part]:
    """Every table of the file, in order. Refuses a file without one, and rows of another width than its table's."""
    width = width_of(lines)
    first = next((at for at, line in enumerate(lines) if width and _begins(lines, at, width)), None)
    if first is None:
        raise BadFileError(
            "no table of readings in this file",
            where=str(path),
            why="no two lines with two or more numbers each stand below one another",
            next_step="export the readings as a table: a line of column names, then a line for each reading",
        )
    last_blank = all(not line.cells[-1].strip() for line in lines[first : first + 50] if len(line.cells) == width)
    numbered = _is_counted([line.cells[0] for line in lines[first : first + 50] if len(line.cells) == width])
    short = "last" if last_blank else "first" if numbered else ""
    _refuse_unlike_header(path, lines, first, width, short)
    _refuse_turned(path, lines[first:], width)
    names, units, header_from = _header(lines, first, width, short)
    above = [line for line in lines[:header_from] if line.text.strip()]
    remarks = _remarks(above)
    header_texts = {line.text.strip() for line in lines[header_from:first]}
    found: list[Part] = []
    rows: list[list[str]] = []
    numbers: list[int] = []
    between: list[Line] = []
    skipped = 0
    readings = (cell for line in lines[first:] if len(line.cells) == width for cell in line.cells)
    sign = decimal or decimal_sign(path, readings)

    def close() -> None:
        if rows:
            how_read = f"{how}, decimal {'comma' if sign == ',' else 'point'}"
            cells, places = list(rows), list(numbers)
            found.append(Part(path, names, units, cells, places, sign, dict(remarks), sheet, how_read, skipped))
        rows.clear()
        numbers.clear()

    for line in lines[first:]:
        if not line.filled:
            continue
        if _is_row(line, width):
            heads = [other for other in between if _heads_block(other)]
            skipped += len(between) - len(heads)
            if heads:
                close()
                skipped = 0
                remarks = {**remarks, **_remarks(heads)}
            between = []
            cells = _fitted(line, width)
            assert cells is not None
            rows.append([cell.strip() for cell in cells])
            numbers.append(line.number)
        elif line.text.strip() in header_texts:
            skipped += sum(1 for other in between if not _heads_block(other))
            between = [other for other in between if _heads_block(other)]
            if rows:
                close()
                skipped = 0
        elif line.readings >= 2 and 2 * line.readings >= line.filled and len(line.cells) != width:
            raise _other_width(path, line, width)
        else:
            between.append(line)
    skipped += len(between)
    close()
    return [replace(part, block=number) for number, part in enumerate(found, start=1)] if len(found) > 1 else found


def _heads_block(line: Line) -> bool:
    """Whether a line among the readings begins another block: a remark with a key, or a title such as 'run 2'. Any
    other line (a row of overloads, a word) stands within one block: it must not cut a run in two."""
    if _sums_up(line):
        return False
    words = names_of.read(line.text[:_TITLE_MOST]).words
    if line.filled == 1 and words & _TITLES and re.search(r"\d", line.text):
        return True
    keys = [(key, value) for key, value in _remarks([line]).items() if any(c.isalpha() for c in key)]
    by_mark = re.search(r"[:=]", line.text) is not None
    return any((by_mark or line.filled <= 3) and not value.startswith(key) for key, value in keys)


def _other_width(path: Path, line: Line, width: int) -> BadFileError:
    return BadFileError(
        f"this row has {len(line.cells)} cells, the table {width}",
        where=f"{path}:{line.number}",
        why="a row was cut short, a second table begins here, or commas are both decimal signs and separators",
        next_step="complete or delete the row; export with ';' between columns where the decimal sign is a comma; one "
        "file for each table",
    )


def _is_counted(cells: Sequence[str]) -> bool:
    """Row numbers that a program wrote before each row, without a name above them."""
    texts = [cell.strip().strip('"') for cell in cells]
    return len(texts) > 2 and texts in ([str(n + start) for n in range(len(texts))] for start in (0, 1))


def _refuse_turned(path: Path, lines: Sequence[Line], width: int) -> None:
    """A table whose rows are what ours call columns."""
    rows = [line.cells for line in lines if len(line.cells) == width]
    words = {row[0].strip() for row in rows if row[0].strip() and not _is_reading(row[0])}
    if 3 <= len(words) == len(rows) < width and sum(1 for row in rows for c in row[1:] if _is_reading(c)) > len(
        rows
    ) * (width - 2):
        raise BadFileError(
            "rows and columns are exchanged",
            where=str(path),
            why=f"each row begins with a name ({', '.join(sorted(words)[:3])}) and goes on with readings",
            next_step="turn the table: a column for each quantity, a row for each reading",
        )


def _refuse_unlike_header(path: Path, lines: Sequence[Line], first: int, width: int, short: str) -> None:
    """A line of names right above the readings with another number of cells: commas that are decimal signs, say."""
    line = next((line for line in reversed(lines[:first]) if line.filled), None)
    if line is None or line.readings or line.filled < 2 or line.filled == width or 2 * line.filled < width:
        return
    if _header_cells(line, width, short) is None and line.filled == len(line.cells):
        raise _other_width(path, lines[first], len(line.cells))


def _begins(lines: Sequence[Line], at: int, width: int) -> bool:
    """Whether the table's readings begin here: this line holds some, and so does the next that is not empty."""
    line = lines[at]
    if not _holds_readings(line, width) or len(line.cells) < width or line.readings < min(2, width):
        return False
    after = next((other for other in lines[at + 1 :] if other.filled), None)
    return after is None or _holds_readings(after, width)


def _header(lines: Sequence[Line], first: int, width: int, short: str) -> tuple[tuple[str, ...], tuple[str, ...], int]:
    """Names, units and the index of the header's first line."""
    above: list[tuple[int, list[str]]] = []
    at = first - 1
    while at >= 0 and len(above) < HEADER_MOST:
        line = lines[at]
        if not line.text.strip():
            if above:
                break
            at -= 1
            continue
        cells = _header_cells(line, width, short)
        if cells is None:
            break
        above.append((at, cells))
        at -= 1
    if not above:
        return tuple(f"#{number}" for number in range(1, width + 1)), (), first
    units: tuple[str, ...] = ()
    if len(above) > 1 and _are_units(above[0][1]):
        units = tuple("" if cell.strip() in _NO_UNIT else cell.strip() for cell in above.pop(0)[1])
    header_from, names = above[0]
    names = [name.strip() for name in names]
    if len(above) > 1 and (len(set(names)) < len(names) or all(len(name) <= 2 for name in names)):
        header_from, groups = above[1]
        group, joined = "", []
        for over, name in zip(groups, names):
            group = over.strip() or group
            joined.append(f"{group} {name}".strip())
        names = joined
    if len(above) == 1 and not units and _are_units(names):
        return tuple(f"#{number}" for number in range(1, width + 1)), tuple(names), header_from
    named = tuple(name or f"#{number}" for number, name in enumerate(names, start=1))
    return named, units, header_from


# Behind the last name: nothing, or the column of remarks of which LabVIEW writes the name alone.
REMARKS = ("", "comment", "comments", "remark", "remarks", "note", "notes", "bemerkung", "kommentar", "commentaire")


def _header_cells(line: Line, width: int, short: str) -> list[str] | None:
    """The cells of a line that may name columns; None for one that cannot. short: which column may have no name."""
    marked = line.text.lstrip()
    cells = list(line.cells)
    if marked[:1] in "#%" or marked[:2] == "//":
        cells[0] = re.sub(r"^\s*(?:#+|%+|//+)\s*", "", cells[0])
        if not cells[0] and len(cells) == width + 1:
            cells = cells[1:]
    while len(cells) > width and cells[-1].strip().lower() in REMARKS:
        cells.pop()
    if len(cells) == width - 1 and short:
        cells = [*cells, ""] if short == "last" else ["", *cells]
    filled = sum(1 for cell in cells if cell.strip())
    if len(cells) != width or filled < 2 or 2 * line.readings > filled:
        return None
    if 3 * filled < width:
        return None
    return cells


def _are_units(cells: Sequence[str]) -> bool:
    """Every cell is a unit or says that there is none, and one at least is."""
    known = [unit_of(cell) is not None or bool(meanings_of(cell)) for cell in cells if cell.strip() not in _NO_UNIT]
    return bool(known) and all(known)


def _remarks(lines: Sequence[Line]) -> dict[str, str]:
    found: dict[str, str] = {}
    for line in lines:
        text = line.text.strip().lstrip("#%/").strip().rstrip(";,\t ")
        if match := _REMARK.fullmatch(text) or _REMARK.fullmatch(",".join(line.cells).replace(",", ":", 1)):
            found[match.group(1).strip(' "')] = match.group(2).strip(' ";,')
    return found


def decimal_sign(path: Path, cells: Iterable[str]) -> str:
    """The decimal sign of the readings. Refuses two at once, and what may be both."""
    sign, point, comma = numerals.decimal_sign(cells)
    if sign == "?":
        raise BadFileError(
            f"two decimal signs: {point} and {comma}",
            where=str(path),
            why="numbers of one file are written in one way",
            next_step="export it again, with a point or a comma throughout",
        )
    if not sign:
        raise BadFileError(
            f"{comma} may be a decimal number or one of thousands",
            where=str(path),
            why="every number with a comma has three digits behind it",
            next_step='say which: --decimal "," or --decimal "."',
        )
    return sign
