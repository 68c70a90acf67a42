"""The noise floor of a loading record: what repeats of the same step disagree by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset

FLOOR_N = 1e-3  # a record without noise (a simulated one) is still not known better than this


@dataclass(frozen=True)
class NoiseFloor:
    """One sigma of a force reading [N], and where it comes from: repeats, smoothness or resolution."""

    sigma_n: float
    source: str


def noise_floor(dataset: Dataset) -> NoiseFloor:
    """From repeats when there are any, else from the third differences along the runs."""
    force = np.column_stack([dataset["fx_n"], dataset["fz_n"]])
    resolution_n = dataset.meta.number("sensor.resolution_n") / np.sqrt(12.0)
    keys = np.column_stack([dataset["config"], dataset["axis"], dataset["step"]])
    _, group, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    repeated = counts > 1
    if repeated.any() and np.ptp(dataset["rep"]) > 0:
        sums = np.stack([np.bincount(group, weights=column) for column in force.T], axis=1)
        off = (force - sums[group] / counts[group, None])[repeated[group]]
        freedom = np.sum(counts[repeated] - 1)
        sigma, source = float(np.sqrt(np.sum(off**2) / (2 * freedom))), "repeats"
    else:
        sigma, source = along_runs(dataset, force), "smoothness along the runs"
    if sigma < max(FLOOR_N, 0.5 * resolution_n):
        return NoiseFloor(max(FLOOR_N, 0.5 * resolution_n), "the sensor's resolution")
    return NoiseFloor(sigma, source)


def along_runs(dataset: Dataset, readings: np.ndarray) -> float:
    """One sigma of readings (rows, or rows x channels) by their third differences along the runs, which hardly see what
    is smooth."""
    inside = dataset["run"][:-3] == dataset["run"][3:]
    third = np.diff(readings, n=3, axis=0)[inside]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0)) if third.size else 0.0
