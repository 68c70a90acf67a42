"""Files of any known kind to tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from brace.errors import UsageError
from brace.importing import textfile, workbook
from brace.importing.part import Part


def read_all(paths: Sequence[Path], *, sheet: str = "", decimal: str = "", separator: str = "") -> list[Part]:
    """The tables of all files, in order."""
    names = [path.name for path in paths]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise UsageError(
            f"two files are called {twice}",
            why="a mapping tells files apart by their names",
            next_step="give each file once, or rename one",
        )
    parts: list[Part] = []
    for path in paths:
        if path.is_file() and workbook.is_workbook(path):
            parts += workbook.read(path, sheet=sheet, decimal=decimal)
        else:
            parts += textfile.read(path, decimal=decimal, separator=separator)
    return parts
