"""Which configurations of a record are locked away before anything is chosen."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset

LOCKED_SHARE = 0.25
LEAST_TO_LOCK = 4  # configurations from which one can be spared


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
