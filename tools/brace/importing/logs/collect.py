"""Readings as they come, gathered signal by signal."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError
from brace.importing import stamps
from brace.importing.logs.wanted import Wanted
from brace.importing.signal import Signal

JUMP_BACK_S = 1.0  # within it, entries of several senders may be written out of order


class Collector:
    """Adds readings, gives signals."""

    def __init__(self, path: Path, wanted: Wanted) -> None:
        self._path, self.wanted = path, wanted
        self._readings: dict[str, tuple[str, str, list[float], list[float], list[float]]] = {}
        self._entries: dict[str, tuple[list[float], list[float]]] = {}  # of each stamped source
        self._latest_s = -float("inf")
        self._late = 0

    def clock(self, time_s: float) -> None:
        """The time of the next entry of the log. Refuses a clock that was set back: rows would be mixed up."""
        if time_s < self._latest_s - JUMP_BACK_S:
            raise BadFileError(
                f"the log's clock goes back by {self._latest_s - time_s:.1f} s",
                where=str(self._path),
                why="the clock was set while it was written, or two logs stand in one file",
                next_step="cut the file there, and import the two parts one by one",
            )
        self._late += time_s < self._latest_s
        self._latest_s = max(self._latest_s, time_s)

    def stamped(self, source: str, time_s: float, stamp_s: float) -> None:
        """One message of a source, and when its sample was taken by its own word (NaN: it does not say)."""
        logged, stamp = self._entries.setdefault(source, ([], []))
        logged.append(time_s)
        stamp.append(stamp_s)

    def add(
        self, source: str, name: str, unit: str, time_s: float, value: float, stamp_s: float = math.nan
    ) -> None:
        """One reading of a signal."""
        entry = self._readings.get(name)
        if entry is None:
            if not self.wanted.takes(source, name):
                return
            entry = self._readings[name] = (source, unit, [], [], [])
        entry[2].append(time_s)
        entry[3].append(value)
        entry[4].append(stamp_s)

    def choice(self) -> stamps.Choice:
        """Of the clocks."""
        used = {source for source, *_ in self._readings.values()}
        entries = {source: entry for source, entry in self._entries.items() if source in used}
        return stamps.chosen({source: (np.array(t), np.array(s)) for source, (t, s) in entries.items()})

    def signals(self, clock: str = "") -> tuple[Signal, ...]:
        """All, in the order in which they first came, each by rising time. clock: log or stamp, where one was said;
        readings without a stamp are then left out, in topics that have some."""
        found = []
        choice = self.choice()
        by_stamp = {"log": frozenset[str](), "stamp": choice.by_stamp | set(choice.partly)}.get(clock, choice.by_stamp)
        for name, (source, unit, times, values, own) in self._readings.items():
            t, v = np.array(own if source in by_stamp else times), np.array(values)
            order = np.argsort(t, kind="stable")
            order = order[~np.isnan(t[order])]
            if order.size:
                found.append(Signal(source, name, unit, t[order], v[order]))
        return tuple(found)

    def notes(self) -> list[str]:
        """What was mended."""
        late = [f"{self._late} entries stand out of order in the log: sorted by time"] if self._late else []
        return [*self.choice().told, *late]
