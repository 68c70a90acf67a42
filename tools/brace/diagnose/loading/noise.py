"""The noise floor of a loading record: what repeats of the same step disagree by, after what their runs as a whole
disagree by (which time, drift and temperature make, and not noise)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts

LEAST_FORCE_SIGMA_N = 1e-3  # a simulated record without noise is still not known better
LEAST_SHARE = 1e-4  # of what a channel moves by
REPEATS = "repeats"
THIRD_DIFFERENCES_SHARE = 2.31  # how many third differences of white noise tell as much as one independent reading
GROWTH_GAIN = 12.0  # twice the log-likelihood that a noise growing with load must gain to be believed


@dataclass(frozen=True)
class ChannelNoise:
    """sigma^2 = floor^2 + (growth * |reading|)^2, in the channel's unit; `freedom` is the number of independent
    differences that it was taken from."""

    floor: float
    growth_ratio: float
    source: str
    freedom: float = 0.0

    def sigma(self, reading: np.ndarray) -> np.ndarray:
        """One sigma of each reading."""
        return np.asarray(np.hypot(self.floor, self.growth_ratio * np.abs(reading)))


def channel_noise(dataset: Dataset, channel: str) -> ChannelNoise:
    """From repeats where there are any, else from the smoothness along the runs."""
    values = dataset[channel]
    if np.isnan(values).any():  # a reading that only a part of the record has
        dataset = dataset.select(~np.isnan(values))
        values = dataset[channel]
    least = LEAST_SHARE * float(np.ptp(values)) + 1e-12
    if channel in ("fx_n", "fz_n"):
        resolution = dataset.meta.number("sensor.resolution_n") / np.sqrt(12.0)
        least = max(least, LEAST_FORCE_SIGMA_N, 0.1 * resolution)
    off, size, freedom_ratio = _repeat_differences(dataset, values)
    source, freedom = REPEATS, 0.75 * off.size
    if off.size < 30:
        off, size, freedom_ratio = _third_differences(dataset, values)
        source, freedom = "smoothness along the runs", off.size / THIRD_DIFFERENCES_SHARE
    if off.size < 4:
        off, size, freedom_ratio = _off_curves(dataset, values)
        source, freedom = "smooth curves through the runs", 0.5 * off.size
    if off.size < 4:
        return ChannelNoise(least, 0.0, "not enough readings; the least that can be told")
    spread = robust_sigma(off) / freedom_ratio
    if spread < least:
        return ChannelNoise(least, 0.0, "the sensor's resolution")
    growth = growth_of(off / freedom_ratio, size, spread) if source == REPEATS and channel in ("fx_n", "fz_n") else None
    if growth is None:
        return ChannelNoise(spread, 0.0, source, freedom)
    return ChannelNoise(max(growth[0], least), growth[1], source + ", growing with load", freedom)


def robust_sigma(off: np.ndarray) -> float:
    """Standard deviation with the largest per cent left out, which a slip or a glitch may own."""
    square = np.sort(off**2)
    kept = square[: max(1, int(np.ceil(0.99 * square.size)))]
    return float(np.sqrt(np.mean(kept) / (0.9238 if kept.size < square.size else 1.0)))


def _repeat_differences(dataset: Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Differences between runs that repeat each other, step by step, less each pair's own mean and trend; what one
    reading's sigma makes of them."""
    starts = run_starts(dataset["run"])
    seen: dict[tuple[object, ...], int] = {}
    off, size = [], []
    for begin, end in zip(starts[:-1], starts[1:]):
        key = (
            int(dataset["config"][begin]),
            int(dataset["axis"][begin]),
            dataset["dx_mm"][begin:end].round(6).tobytes(),
            dataset["dz_mm"][begin:end].round(6).tobytes(),
        )
        before = seen.get(key)
        seen[key] = int(begin)
        if before is None or end - begin < 6:
            continue
        change = values[begin:end] - values[before : before + end - begin]
        displacement = dataset["dx_mm"][begin:end] + dataset["dz_mm"][begin:end]
        trend = np.column_stack(
            [np.ones(end - begin), np.arange(end - begin), displacement, np.abs(displacement)]
        )
        basis, triangle = np.linalg.qr(trend)
        basis = basis[:, np.abs(np.diag(triangle)) > 1e-9]
        left = change - basis @ (basis.T @ change)
        off.append(left * np.sqrt((end - begin) / (end - begin - basis.shape[1])))
        size.append(np.abs(values[begin:end]))
    if not off:
        return np.empty(0), np.empty(0), 1.0
    return np.concatenate(off), np.concatenate(size), float(np.sqrt(2.0))


def _third_differences(dataset: Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Third differences within the legs of the runs, where the imposed displacement goes on in equal steps."""
    d = dataset["dx_mm"] + dataset["dz_mm"]
    bend = np.abs(np.diff(d, n=2))
    straight = bend <= 1e-6 * max(float(np.ptp(d)), 1e-9)
    inside = (dataset["run"][:-3] == dataset["run"][3:]) & straight[:-1] & straight[1:]
    third = np.diff(values, n=3)[inside]
    return third, np.abs(values[:-3][inside]), float(np.sqrt(20.0))


def _off_curves(dataset: Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """What smooth curves over the displacement leave of each run whose steps are uneven and are never repeated; what
    the curves cannot follow counts as noise, so this is an upper bound."""
    starts = run_starts(dataset["run"])
    off, size = [], []
    for begin, end in zip(starts[:-1], starts[1:]):
        rows = slice(begin + 1, end)  # the first may be zero by definition
        x, z = dataset["dx_mm"][rows], dataset["dz_mm"][rows]
        along = z if dataset["axis"][begin] else x
        curves = np.column_stack([np.ones(len(x)), x, z, np.abs(along), along**2, along**3])
        basis, triangle = np.linalg.qr(curves)
        basis = basis[:, np.abs(np.diag(triangle)) > 1e-9]
        freedom = len(x) - basis.shape[1]
        if freedom < 4:
            continue
        left = values[rows] - basis @ (basis.T @ values[rows])
        off.append(left * np.sqrt(len(x) / freedom))
        size.append(np.abs(values[rows]))
    if not off:
        return np.empty(0), np.empty(0), 1.0
    return np.concatenate(off), np.concatenate(size), 1.0


def growth_of(off: np.ndarray, size: np.ndarray, spread: float) -> tuple[float, float] | None:
    """(floor, growth) when a noise that grows with the reading is far more likely than a constant one."""
    scale = float(np.sqrt(np.mean(size**2)))
    if scale <= 0.0:
        return None
    ratios = np.linspace(0.0, 3.0, 31)[:, None]  # of growth * scale to floor
    shape = 1.0 + (ratios * size / scale) ** 2
    floor2 = np.mean(off**2 / shape, axis=1)
    cost = off.size * np.log(floor2) + np.sum(np.log(shape), axis=1)
    best = int(np.argmin(cost))
    if best == 0 or cost[0] - cost[best] < GROWTH_GAIN:
        return None
    floor = float(np.sqrt(floor2[best]))
    return floor, float(ratios[best, 0]) * floor / scale
