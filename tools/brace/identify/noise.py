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
    resolution_n = dataset.meta.number("sensor.resolution_n") / np.sqrt(12.0)
    keys = np.column_stack([dataset["config"], dataset["axis"], dataset["step"]])
    repeated = np.ptp(dataset["rep"]) > 0
    square, freedom = 0.0, 0
    bends: list[np.ndarray] = []
    for name in ("fx_n", "fz_n"):
        read = ~np.isnan(dataset[name])
        if not read.any():
            continue
        force = dataset[name][read]
        _, group, counts = np.unique(keys[read], axis=0, return_inverse=True, return_counts=True)
        group = group.ravel()
        off = force - (np.bincount(group, weights=force) / counts)[group]
        square += float(off @ off)
        freedom += int(np.sum(counts - 1))
        bends.append(_bends(dataset.select(read), force))
    if repeated and freedom:
        sigma, source = float(np.sqrt(square / freedom)), "repeats"
    else:
        sigma, source = _sigma_of(np.concatenate(bends)), "smoothness along the runs"
    if sigma < max(FLOOR_N, 0.5 * resolution_n):
        return NoiseFloor(max(FLOOR_N, 0.5 * resolution_n), "the sensor's resolution")
    return NoiseFloor(sigma, source)


def along_runs(dataset: Dataset, readings: np.ndarray) -> float:
    """One sigma of readings, one for each row, by their third differences along the runs, which hardly see what is
    smooth."""
    return _sigma_of(_bends(dataset, readings))


def _bends(dataset: Dataset, readings: np.ndarray) -> np.ndarray:
    """Third differences within the runs."""
    inside = dataset["run"][:-3] == dataset["run"][3:]
    return np.asarray(np.diff(readings, n=3)[inside])


def _sigma_of(bends: np.ndarray) -> float:
    return float(1.4826 * np.median(np.abs(bends)) / np.sqrt(20.0)) if bends.size else 0.0
