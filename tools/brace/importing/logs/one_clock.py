"""Signals of many clocks to one table. Its rows are the readings of one source: the slowest of those that hold the
displacements and the forces. A faster signal is interpolated between its neighbours in time; a posture, a temperature
or a number of a run stands from its reading to the next. Over a gap nothing is interpolated. All of it is said."""

from __future__ import annotations

import datetime
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.importing import names
from brace.importing.mapping import MappingTable
from brace.importing.meaning import OPEN, quantity_of
from brace.importing.part import Part
from brace.importing.signal import Log, Signal

TIME = "time of the log"
GAP_PERIODS = 3.0  # two readings further apart than so many usual periods have a gap between them
MOVING = {
    "loading": frozenset(
        ("dx_mm", "dz_mm", "d_mm", "fx_n", "fz_n", "f_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
    ),
    "joint_test": frozenset(("angle_rad", "torque_n_mm", "command_n_mm")),
}
HELD, MOVED, UNUSED = "held", "moved", "unused"


def drafted(path: Path, log: Log) -> Part:
    """The table by which a mapping is guessed: every signal, with roles by the names."""
    read = {s.name: names.read(s.name, s.unit) for s in log.signals}
    quantities = {name: "" if "command" in each.words else quantity_of(each) for name, each in read.items()}
    kinds = set(quantities.values())
    moving = ("force", "length") if kinds & {"force", "length"} else ("torque", "angle")
    roles = {name: MOVED if quantity in moving else HELD for name, quantity in quantities.items()}
    if MOVED not in roles.values():
        roles = dict.fromkeys(roles, MOVED)
    part = _table(path, log, roles)
    return replace(part, notes=(*log.notes, *_rates(log)))


def settled(part: Part, mapping: MappingTable) -> Part:
    """The table of the signals that the mapping uses; the others' columns are blank."""
    log = part.log
    if log is None:
        return part
    if mapping.kind not in MOVING:
        raise BadFileError(
            "a log cannot be imported as a table of K",
            where=part.where,
            why="it holds readings by time",
            next_step='kind = "loading" or "joint_test"',
        )
    clock = mapping.constant(part.places, "clock")
    if clock is not None and clock.value in log.by_clock:
        log = _at(log, clock.value)
    elif why := doubt(part, mapping):
        raise UsageError(
            "the log has messages by two clocks", where=part.where, why=why, next_step="--set clock=stamp, or clock=log"
        )
    roles = {}
    for at, signal in enumerate(log.signals, start=2):
        use = mapping.column(part.path.name, signal.name, at)
        targets = set(use.targets) if use is not None and use.used else set()
        roles[signal.name] = MOVED if targets & MOVING[mapping.kind] else HELD if targets else UNUSED
    if MOVED not in roles.values():
        raise BadFileError(
            "no signal of this log is a displacement or a force",
            where=part.where,
            why="the mapping uses none of them as such",
            next_step="say in the mapping which signals they are, or join the log and the instrument's file into one",
        )
    made = _table(part.path, log, roles)
    return replace(made, notes=(*log.notes, *made.notes))


def _at(log: Log, clock: str) -> Log:
    """The same with its topics placed by the clock that was said."""
    choice = log.choice
    assert choice is not None
    told = [f"all topics are at the times of the log, as was said (clock = {clock})"]
    if clock == "stamp":
        told = [f"{', '.join([*choice.by_stamp, *choice.partly])}: the stamps are used, as was said (clock = stamp)"]
        for topic, (left, count) in choice.partly.items():
            told.append(f"{topic}: {left} of {count} messages have no stamp: left out")
        others = {s.source for s in log.signals} - {*choice.by_stamp, *choice.partly}
        told += [f"without usable stamps, at the times of the log: {', '.join(sorted(others))}"] if others else []
    kept = [note for note in log.notes if note not in choice.told]
    return replace(log, signals=log.by_clock[clock], notes=(*kept, *told))


def doubt(part: Part, mapping: MappingTable) -> str:
    """Why a log's clock must be said: the topics that move, or may, would be joined by clocks that disagree."""
    log = part.log
    if log is None or log.choice is None or not log.by_clock:
        return ""
    moved: list[str] = []
    for at, signal in enumerate(log.signals, start=2):
        use = mapping.column(part.path.name, signal.name, at)
        if use is not None and set(use.targets) & {OPEN, *MOVING.get(mapping.kind, ())}:
            moved.append(signal.source)
    return log.choice.doubt(list(dict.fromkeys(moved)))


def _table(path: Path, log: Log, roles: Mapping[str, str]) -> Part:
    clock = _clock(log, roles)
    rows = clock.times_s
    start = min(float(signal.times_s[0]) for signal in log.signals)
    if len(rows) > 1 and rows[0] == rows[-1]:
        raise BadFileError(
            f"all {len(rows)} readings of {clock.source} have one time",
            where=str(path),
            why="the log does not say when they were taken",
            next_step="record anew with a clock that runs (candump -l, header.stamp, rosbag2's own time)",
        )
    apart = {id(signal): _apart(signal.times_s) for signal in log.signals if roles[signal.name] != UNUSED}
    moments = apart[id(clock)]
    notes = [f"its rows are the readings of {clock.source} ({_rate(clock)})", *_shared(log, roles)]
    if (begin := _day(start)) is not None:
        notes.append(f"t_s counts from {begin}")
    columns = [[repr(round(float(t - start), 9)) for t in rows]]
    for signal in log.signals:
        role = roles[signal.name]
        if role == UNUSED:
            columns.append([""] * len(rows))
            continue
        own = replace(signal, times_s=apart[id(signal)])
        joined = _interpolated(own, moments) if role == MOVED else _held(own, moments)
        notes += _said(signal, clock, joined, role)
        columns.append([_cell(value) for value in joined.values.tolist()])
    return Part(
        path=path,
        names=(TIME, *(signal.name for signal in log.signals)),
        units=("s", *(signal.unit for signal in log.signals)),
        rows=[list(row) for row in zip(*columns)],
        lines=list(range(1, len(rows) + 1)),
        decimal=".",
        how=log.how,
        log=log,
        notes=tuple(notes),
    )


def _cell(value: float) -> str:
    if math.isnan(value):
        return ""
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def _clock(log: Log, roles: Mapping[str, str]) -> Signal:
    """One signal of the source that has the fewest readings among those that move."""
    moved = [signal for signal in log.signals if roles[signal.name] == MOVED]
    return min(moved, key=lambda signal: len(signal.times_s))


def _apart(times_s: np.ndarray) -> np.ndarray:
    """Times at which readings that share a stamp stand evenly up to the next stamp, in the log's order: a clock of few
    steps (10 ms, 1 s) stamps several with one time. They order the readings; the rows keep the stamps."""
    first = np.searchsorted(times_s, times_s, "left")
    count = np.searchsorted(times_s, times_s, "right") - first
    if count.size == 0 or count.max() < 2:
        return times_s
    stamps = np.unique(times_s)
    steps = np.diff(stamps)
    width = np.append(steps, np.median(steps) if steps.size else 0.0)
    usual = float(np.median(steps)) if steps.size else 0.0
    within = np.minimum(width, GAP_PERIODS * usual)[np.searchsorted(stamps, times_s)]
    return np.asarray(times_s + (np.arange(times_s.size) - first) / count * within)


def _shared(log: Log, roles: Mapping[str, str]) -> list[str]:
    """A line for each source of which several readings share a stamp."""
    told = []
    for source in dict.fromkeys(s.source for s in log.signals if roles[s.name] != UNUSED):
        times = max((s.times_s for s in log.signals if s.source == source), key=len)
        stamps, counts = np.unique(times, return_counts=True)
        if counts.max() > 1 and stamps.size > 1:
            told.append(
                f"{source}: up to {counts.max()} readings share a stamp ({len(times)} readings, {stamps.size} stamps): "
                "each keeps its value, and within a stamp they are taken as evenly apart"
            )
    return told


@dataclass(frozen=True)
class _Joined:
    """A signal at the rows' times, and how many rows have none of it."""

    values: np.ndarray
    before: int = 0  # rows before its first reading
    after: int = 0
    in_gaps: int = 0
    oldest_s: float = 0.0  # of a held one


def _interpolated(signal: Signal, rows: np.ndarray) -> _Joined:
    t, v = signal.times_s, signal.values
    right = np.searchsorted(t, rows, "left")
    exact = (right < len(t)) & (t[np.minimum(right, len(t) - 1)] == rows)
    values = np.where(exact, v[np.minimum(right, len(t) - 1)], np.interp(rows, t, v))
    before, after = rows < t[0], rows > t[-1]
    inside = ~before & ~after & ~exact
    left = np.clip(right - 1, 0, len(t) - 1)
    width = t[np.minimum(right, len(t) - 1)] - t[left]
    gap = inside & (width > GAP_PERIODS * _period(signal))
    values = np.where(before | after | gap, math.nan, values)
    return _Joined(values, int(before.sum()), int(after.sum()), int(gap.sum()))


def _held(signal: Signal, rows: np.ndarray) -> _Joined:
    t = signal.times_s
    at = np.searchsorted(t, rows, "right") - 1
    before = at < 0
    age = rows - t[np.maximum(at, 0)]
    values = np.where(before, math.nan, signal.values[np.maximum(at, 0)])
    return _Joined(values, int(before.sum()), oldest_s=float(age[~before].max()) if (~before).any() else 0.0)


def _said(signal: Signal, clock: Signal, joined: _Joined, role: str) -> list[str]:
    if signal.source == clock.source and np.array_equal(signal.times_s, clock.times_s):
        return []
    notes = []
    if role == HELD:
        longest = f"{joined.oldest_s:.3g} s at most"
        notes.append(f"{signal.name} ({_rate(signal)}): each reading stands until the next, {longest}")
    else:
        notes.append(f"{signal.name} ({_rate(signal)}) is interpolated between its neighbours in time")
    lost = {
        "before its first reading": joined.before,
        "after its last": joined.after,
        "in its gaps": joined.in_gaps,
    }
    for where, count in lost.items():
        if count:
            notes.append(f"{signal.name}: {count} rows have none of it, {where}")
    return notes


def _period(signal: Signal) -> float:
    steps = np.diff(_apart(signal.times_s))
    steps = steps[steps > 0.0]
    return float(np.median(steps)) if steps.size else 0.0


def _rate(signal: Signal) -> str:
    count, period = len(signal.times_s), _period(signal)
    if count < 2 or period <= 0.0:
        return f"{count} reading{'s' if count != 1 else ''}"
    return f"{count} readings, " + (f"{period:.3g} s apart" if period >= 1.0 else f"{period * 1e3:.3g} ms apart")


def _rates(log: Log) -> list[str]:
    """A line for each source: how many readings, how far apart, the gaps."""
    notes = []
    for source in dict.fromkeys(signal.source for signal in log.signals):
        signal = max((s for s in log.signals if s.source == source), key=lambda s: len(s.times_s))
        steps = np.diff(_apart(signal.times_s))
        gaps = steps[steps > GAP_PERIODS * _period(signal)] if len(steps) > 2 else steps[:0]
        text = f", {len(gaps)} gap{'s' if len(gaps) > 1 else ''}, the longest {gaps.max():.3g} s" if gaps.size else ""
        notes.append(f"{source}: {_rate(signal)}{text}")
    return notes


def _day(start_s: float) -> str | None:
    """The moment of a clock that counts from 1970; None for one that counts from a start."""
    if start_s < 1e8:
        return None
    return datetime.datetime.fromtimestamp(start_s, datetime.timezone.utc).strftime("%Y-%m-%d %H:%M:%S UTC")
