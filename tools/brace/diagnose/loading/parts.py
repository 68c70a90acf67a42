"""Which rows of a record serve what: configurations locked away before anything is chosen, and, of a long record, the
runs that are enough to choose by."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts

LOCKED_SHARE = 0.25
LEAST_TO_LOCK = 4  # configurations from which one can be spared
ENOUGH_ROWS = 3000  # a choice is no better with more


def locked_rows(dataset: Dataset) -> np.ndarray:
    """Rows of the configurations that take no part in choosing or fitting: every fourth by knee angle, none at the
    ends of the range, so that the rest surrounds them. All False when too few configurations were visited."""
    configs, first = np.unique(dataset["config"], return_index=True)
    if configs.size < LEAST_TO_LOCK:
        return np.zeros(dataset.rows, dtype=bool)
    order = configs[np.argsort(dataset["theta2_rad"][first], kind="stable")]
    count = max(1, round(LOCKED_SHARE * configs.size))
    places = np.unique(np.linspace(1, configs.size - 2, count).round().astype(int))
    return np.isin(dataset["config"], order[places])


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
