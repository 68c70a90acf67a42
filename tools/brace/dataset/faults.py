"""A doubt about an entry: which one, why, and what it should probably read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from brace.ground.errors import BadFileError


@dataclass(frozen=True)
class DataFault:
    """`row` is 1-based without the header, None for a whole column or file. `repair` says whether `suggestion`
    follows from the rest of the record alone, so that it may stand in for the entry once it is said aloud.
    `blocking` says that no result may be drawn from the record while the fault stands. `doubtful`: something about the
    limb may look the same, so whoever has a model of it asks that before."""

    row: int | None
    field: str
    why: str
    suggestion: float | str | None = None
    repair: bool = False
    blocking: bool = True
    doubtful: bool = False

    def as_json(self) -> dict[str, object]:
        """The entry of `data_faults` in every --json report."""
        return {"row": self.row, "field": self.field, "why": self.why, "suggestion": self.suggestion}

    def place(self, path: Path) -> str:
        """`data.csv:line, row N, column F` (the header is line 1)."""
        if self.row is None:
            return f"{path}, {self.field}"
        return f"{path}:{self.row + 1} (row {self.row}), {self.field}"

    def sentence(self, path: Path) -> str:
        """One line for people."""
        hint = "" if self.suggestion is None else f"; probably {self.suggestion}"
        return f"{self.place(path)}: {self.why}{hint}"

    def error(self, path: Path, more: int = 0) -> BadFileError:
        """The refusal for this fault; `more` counts the others behind it."""
        behind = f" (and {more} more fault{'s' if more > 1 else ''})" if more else ""
        return BadFileError(
            f"faulty data{behind}",
            where=self.place(path),
            why=self.why,
            next_step=(
                "correct it"
                if self.suggestion is None
                else f"it should probably be {self.suggestion}; correct the file"
            ),
        )


_UNIT = re.compile(r"(\w[\w ]*): (?:multiply|subtract|divide)")


def what_is_wrong(faults: Sequence[DataFault], path: Path) -> str:
    """Blocking faults in a sentence without its full stop: columns that are all in one other unit by that unit, else
    the first fault, and how many more there are."""
    units = [_UNIT.match(str(fault.suggestion)) if fault.row is None else None for fault in faults]
    named = {unit.group(1) for unit in units if unit}
    fields = list(dict.fromkeys(fault.field for fault in faults))
    if all(units) and len(named) == 1:
        columns = " and ".join([", ".join(fields[:-1]), fields[-1]] if fields[1:] else fields)
        return f"{columns} {'are' if fields[1:] else 'is'} in {named.pop()}"
    more = len(faults) - 1
    behind = f" ({more} more fault{'s are' if more > 1 else ' is'} listed below)" if more else ""
    return faults[0].sentence(path) + behind
