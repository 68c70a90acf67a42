"""One table as it was found in a file: names, units, cells as text, remarks above it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from brace.importing.signal import Log


@dataclass(frozen=True)
class Part:
    """A file has one or several. `lines` has the number of each row's line in the file; `units` is empty where there is
    no row of units; `names` are #1, #2 ... where the file names no columns."""

    path: Path
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: list[list[str]]
    lines: list[int]
    decimal: str
    remarks: Mapping[str, str] = field(default_factory=dict)
    sheet: str = ""
    how: str = ""  # read: encoding, separator, decimal sign, in words
    skipped: int = 0  # lines among and below the readings that are none
    log: Log | None = None  # what the rows were made from, where sources have clocks of their own
    block: int = 0  # from 1, of a file with several tables
    notes: tuple[str, ...] = ()  # what of the file is not in the rows, and how they were made

    @property
    def where(self) -> str:
        """The file, and its sheet."""
        return f"{self.path}[{self.sheet}]" if self.sheet else str(self.path)

    @property
    def places(self) -> tuple[str, ...]:
        """What a constant may name as its file: the block, FILE#2, before the whole file."""
        name = self.path.name
        return (f"{name}#{self.block}", name) if self.block else (name,)

    @property
    def has_names(self) -> bool:
        return not all(name.startswith("#") for name in self.names)

    def cells(self, index: int) -> list[str]:
        """One column."""
        return [row[index] for row in self.rows]


@dataclass(frozen=True)
class Table:
    """The columns of one part in our units, NaN where nothing was read; rows that say nothing are gone."""

    part: Part
    columns: dict[str, np.ndarray]
    texts: dict[str, list[str]]  # run, config, rep, axis as they stand there
