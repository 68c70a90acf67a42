"""Of a long record, the runs that are enough to choose by."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts

ENOUGH_ROWS = 3000  # a choice is no better with more


def enough_rows(dataset: Dataset, most: int = ENOUGH_ROWS) -> np.ndarray:
    """Whole runs, spread evenly over each configuration's and axis' share and over time, of about `most` rows."""
    if dataset.rows <= most:
        return np.ones(dataset.rows, dtype=bool)
    starts = run_starts(dataset["run"])
    lengths = np.diff(starts)
    place = dataset["config"][starts[:-1]] * 2 + dataset["axis"][starts[:-1]]
    share = most / dataset.rows
    keep = np.zeros(lengths.size, dtype=bool)
    for value in np.unique(place):
        runs = np.flatnonzero(place == value)
        count = min(runs.size, max(2, round(share * runs.size)))
        keep[runs[np.unique(np.linspace(0, runs.size - 1, count).round().astype(int))]] = True
    if lengths[keep].sum() > 2 * most:  # many places: thin them too
        kept = np.flatnonzero(keep)
        keep[:] = False
        keep[kept[:: int(np.ceil(lengths[kept].sum() / most))]] = True
    return np.repeat(keep, lengths)
