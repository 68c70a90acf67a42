"""LabVIEW's measurement files (.lvm): two headers of keys, the second once for each segment, then names and readings."""

from __future__ import annotations

from collections.abc import Sequence

from brace.ground.errors import BadFileError
from brace.importing.table_in_lines import REMARKS, Line

FIRST = "LabVIEW Measurement"
_END = "***End_of_Header***"
_NAMES = "x_value"
_SECONDS = ("time", "s", "sec", "seconds")


def without_headers(where: str, lines: Sequence[Line]) -> list[Line]:
    """The lines with the headers' as free text, which names no columns and holds no readings. The units of a segment's
    header stand as a row of their own below the names. Refuses an X that is no time."""
    out: list[Line] = []
    header: list[Line] = []
    is_header = True
    for line in lines:
        key = line.cells[0].strip() if line.cells else ""
        if is_header:
            header.append(line)
            out.append(Line(line.number, line.text, [line.text]))
            is_header = key != _END or not any(each.cells[0].strip() == "Channels" for each in header if each.cells)
            if key == _END and is_header and not _has_keys(lines, line.number):
                is_header = False  # a writer that leaves the second header out
        elif key == "Channels":
            is_header, header = True, [line]
            out.append(Line(line.number, line.text, [line.text]))
        else:
            out.append(line)
            if key.lower() == _NAMES:
                _refuse_other_x(where, header)
                if units := _units(header, line):
                    out.append(Line(line.number, " | ".join(units), units))
    return out


def _has_keys(lines: Sequence[Line], after: int) -> bool:
    """Whether a second header follows."""
    return any(line.number > after and line.cells and line.cells[0].strip() == _END for line in lines)


def _entries(header: Sequence[Line], key: str) -> list[str]:
    return next(
        ([cell.strip() for cell in line.cells[1:]] for line in header if line.cells and line.cells[0].strip() == key), []
    )


def _units(header: Sequence[Line], names: Line) -> list[str]:
    """A cell for each name: the time's, the channels', none for remarks. LabVIEW's time is in seconds."""
    if not _entries(header, "X_Dimension"):
        return []
    given = iter(_entries(header, "Y_Unit_Label"))
    cells = ["s" if name.strip().lower() == _NAMES else next(given, "") or "-" for name in names.cells]
    return cells[:-1] + [""] if names.cells[-1].strip().lower() in REMARKS else cells


def _refuse_other_x(where: str, header: Sequence[Line]) -> None:
    other = [each for each in _entries(header, "X_Dimension") if each and each.lower() not in _SECONDS]
    if other:
        raise BadFileError(
            f"X_Value of this .lvm is no time: its X_Dimension is {other[0]!r}",
            where=where,
            why="a record is a row for each moment",
            next_step="export the signals over time from LabVIEW",
        )
