"""Readings that stand twice in a loading record: noise never repeats itself bit by bit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.check_runs import ANGLE_SAME_RAD, MAX_LISTED, run_starts, span
from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
FORCES = ("fx_n", "fz_n")
WINDOW = 6  # readings of both forces that chance does not repeat
RICH = (400, 20)  # quanta that a run must move by, by the number of columns: within play all readings are alike
MOST = 0.6  # of a run's windows
FEW_REPEATS = 0.2  # share of a pose's repeats that may be copies; more, and the record has no noise
UNLIKELY = 1e-6


def row_keys(table: np.ndarray) -> np.ndarray:
    """A 64-bit key for each row; equal rows have equal keys."""
    words = (table + 0.0).view(np.uint64)
    keys = np.zeros(table.shape[0], dtype=np.uint64)
    for column in range(table.shape[1]):
        keys ^= words[:, column] + np.uint64(0x9E3779B97F4A7C15) + (keys << np.uint64(6)) + (keys >> np.uint64(2))
        keys *= np.uint64(0xBF58476D1CE4E5B9)
    return keys


def faults(columns: Columns) -> list[DataFault]:
    """Stretches of both forces, or of one, that another run has too."""
    found = [*_copies(columns, FORCES)]
    return found or [fault for name in FORCES for fault in _copies(columns, (name,))]


def _copies(columns: Columns, names: tuple[str, ...]) -> Iterator[DataFault]:
    run = columns["run"]
    width = WINDOW if len(names) == 2 else 2 * WINDOW
    if run.size < 2 * width:
        return
    count = run.size - width + 1
    rows = row_keys(np.column_stack([columns[name] for name in names]).astype(float))
    keys = np.zeros(count, dtype=np.uint64)
    for place in range(width):
        keys = keys * np.uint64(0x9E3779B97F4A7C15) + rows[place : place + count]
    starts = run_starts(run)
    moving = np.zeros(starts.size - 1, dtype=bool)
    for name in names:
        moving |= span(columns[name], starts) > RICH[len(names) - 1] * _quantum(columns[name])
    candidates = np.flatnonzero((run[:count] == run[width - 1 :]) & np.repeat(moving, np.diff(starts))[:count])
    keys = keys[candidates]
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    if not (counts > 1).any():
        return
    yield from _copied_runs(columns, names, candidates, inverse)


def _copied_runs(columns: Columns, names: tuple[str, ...], rows: np.ndarray, group: np.ndarray) -> Iterator[DataFault]:
    """One fault for each run that has most of an earlier run's readings."""
    order = np.argsort(group, kind="stable")
    same = np.flatnonzero(group[order][1:] == group[order][:-1])
    earlier, later = rows[order[same]], rows[order[same + 1]]
    number_of_row = np.repeat(
        np.arange(np.count_nonzero(np.diff(columns["run"])) + 1), np.diff(run_starts(columns["run"]))
    )
    pairs = np.column_stack([number_of_row[later], number_of_row[earlier]])
    pairs, counts = np.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0, return_counts=True)
    starts = run_starts(columns["run"])
    windows = np.diff(starts)[pairs[:, 0]] - (WINDOW if len(names) == 2 else 2 * WINDOW) + 1
    pairs = pairs[counts >= np.maximum(MOST * windows, 1)]
    first = starts[:-1]
    apart = columns["axis"][first[pairs[:, 0]]] != columns["axis"][first[pairs[:, 1]]]
    for name in ("theta1_rad", "theta2_rad"):
        apart |= np.abs(columns[name][first[pairs[:, 0]]] - columns[name][first[pairs[:, 1]]]) > ANGLE_SAME_RAD
    if not apart.all() and not _chance_is_out(columns, names, pairs[~apart], starts):
        pairs = pairs[apart]
    for copy, source in pairs[:MAX_LISTED]:
        row, other = int(first[copy]), int(first[source])
        for name in names:
            yield DataFault(
                row + 1,
                name,
                f"run {columns['run'][row]} (pose {columns['config'][row]}) has the readings of run "
                f"{columns['run'][other]} (pose {columns['config'][other]}) bit by bit, and noise never repeats "
                "itself: one of the two is a copy",
                f"readings of its own; compare row {other + 1}",
            )


def _chance_is_out(columns: Columns, names: tuple[str, ...], copies: np.ndarray, starts: np.ndarray) -> bool:
    """Whether repeats of one pose are so unlike elsewhere that these are no accident, nor the rule (a record without
    noise)."""
    copied = {(int(a), int(b)) for a, b in copies}
    seen: dict[tuple[object, ...], int] = {}
    equal = total = repeats = 0
    for run, (begin, end) in enumerate(zip(starts[:-1], starts[1:])):
        key = tuple(round(float(columns[name][begin]), 3) for name in ("theta1_rad", "theta2_rad", "axis"))
        before = seen.get((*key, end - begin))
        seen[(*key, end - begin)] = run
        if before is None:
            continue
        repeats += 1
        if (run, before) in copied:
            continue
        for name in names:
            here, there = columns[name][begin:end], columns[name][starts[before] : starts[before + 1]]
            equal, total = equal + int(np.count_nonzero(here == there)), total + end - begin
    if not total or len(copied) > FEW_REPEATS * repeats:
        return False
    readings = len(names) * (starts[1] - starts[0]) * MOST
    return bool(repeats * (equal / total) ** readings < UNLIKELY)


def _quantum(values: np.ndarray) -> float:
    """The smallest step between two readings."""
    steps = np.diff(np.unique(values[:20000]))
    return float(steps.min()) if steps.size else 0.0
