"""Files of any known kind to tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from brace.ground.errors import UsageError
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.importing import textfile, workbook
from brace.importing.logs import candump, mcap_file, one_clock
from brace.importing.logs.wanted import Wanted
from brace.importing.part import Part


def read_all(
    paths: Sequence[Path],
    *,
    sheet: str = "",
    decimal: str = "",
    separator: str = "",
    databases: Sequence[Path] = (),
    signals: Sequence[str] = (),
) -> list[Part]:
    """The tables of all files, in order.
    databases: DBC files for the CAN frames of logs. signals: names or patterns of those of a log that are taken;
    none: all."""
    names = [path.name for path in paths]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise UsageError(
            f"two files are called {twice}",
            why="a mapping distinguishes files by their names",
            next_step="give each file once, or rename one",
        )
    parts: list[Part] = []
    for path in paths:
        if not path.is_file():
            read_bytes(path, DATA_LIMIT_BYTES, "file of readings")  # refuses; a pipe would be waited for
        if mcap_file.is_mcap(path):
            parts.append(one_clock.drafted(path, mcap_file.read(path, databases, Wanted(path, signals))))
        elif candump.is_candump(path):
            parts.append(one_clock.drafted(path, candump.read(path, databases, Wanted(path, signals))))
        elif workbook.is_workbook(path):
            parts += workbook.read(path, sheet=sheet, decimal=decimal)
        else:
            parts += textfile.read(path, decimal=decimal, separator=separator)
    if databases and all(part.log is None for part in parts):
        raise UsageError(
            "--dbc, and no file is a log of CAN frames",
            where=", ".join(names),
            why="a database decodes frames of candump's logs, of .asc, .blf and .trc, and of brace record's MCAP",
            next_step="leave --dbc out, or give the log",
        )
    if signals and all(part.log is None for part in parts):
        raise UsageError(
            "--signals, and no file is a log",
            where=", ".join(names),
            why="a table's columns are left out by the mapping",
            next_step='leave --signals out; is = "ignore" in the mapping leaves a column out',
        )
    return parts
