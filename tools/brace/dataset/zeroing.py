"""Played readings, made comparable with those of a force sensor that was zeroed before each run."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.dataset.intake import Dataset

FORCES = ("fx_n", "fz_n")


def zeroed(readings: Mapping[str, np.ndarray], dataset: Dataset) -> dict[str, np.ndarray]:
    """Takes the first force reading of each run off all of the run's, if the dataset's sensor was zeroed per run. Rows
    are the last axis."""
    if not dataset.meta.zeroed_per_run:
        return dict(readings)
    starts = run_starts(dataset["run"])
    counts = np.diff(starts)
    return {
        name: values - np.repeat(values[..., starts[:-1]], counts, axis=-1) if name in FORCES else values
        for name, values in readings.items()
    }
