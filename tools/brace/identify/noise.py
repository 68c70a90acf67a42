"""The noise floor of a loading record: what repeats of the same step disagree by, after what their runs as a whole
disagree by (which time, drift and temperature make, and not noise)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts
from brace.dataset.grid import step_of

LEAST_FORCE_SIGMA_N = 1e-3  # a simulated record without noise is still not known better
LEAST_SHARE = 1e-4  # of what a channel moves by
FORCES: tuple[str, ...] = ("fx_n", "fz_n")
REPEATS, GROWING = "repeats", ", growing with load"
ROUNDING = "rounding to the sensor's resolution"
ON_GRID = 1e-3  # of a step: how near to whole steps the readings of a sensor that rounds stand in the file
FAR_SIGMAS = 4.5  # from which a difference is no noise; of white noise it cuts 7 in a million, 0.02 % of the variance
MEDIAN_OF_SQUARES = 0.4549  # of a normal variable with variance 1
THIRD_DIFFERENCES_SHARE = 2.31  # how many third differences of white noise show as much as one independent reading
ASSUMED_SHARE = 0.02  # of the largest reading: what scales and dial gauges read to by hand, where nothing shows it
ASSUMED_FREEDOM = 2.0  # readings that this is worth
ASSUMED = "not enough readings; 2 % of the largest is assumed"
GROWTH_GAIN = 12.0  # twice the log-likelihood that a noise growing with load must gain to be believed
GROWTH_HINT = 6.0  # the same, where what a search leaves must agree before it is believed


@dataclass(frozen=True)
class ChannelNoise:
    """sigma^2 = floor^2 + (growth * |reading|)^2, in the channel's unit; `freedom` is the number of independent
    differences that it was taken from. Where rounding hides the noise, a limb whose force is within `rounds_n` of a
    reading gives this very reading; 0: it is noise that decides."""

    floor: float
    growth_ratio: float
    source: str
    freedom: float = 0.0
    rounds_n: float = 0.0

    def sigma(self, reading: np.ndarray) -> np.ndarray:
        """One sigma of each reading."""
        return np.asarray(np.hypot(self.floor, self.growth_ratio * np.abs(reading)))


@dataclass(frozen=True)
class _Differences:
    """What one channel's readings disagree by, scaled to one reading's noise, and the readings' sizes."""

    off: np.ndarray
    size: np.ndarray
    source: str
    freedom: float
    least: float

    @property
    def spread(self) -> float:
        return robust_sigma(self.off)


def noise_of(dataset: Dataset, channels: Sequence[str]) -> dict[str, ChannelNoise]:
    """Of each channel: from repeats where there are any, else from the smoothness along the runs. Whether it grows with
    the load is asked of the force's channels together, which are one sensor's."""
    noise: dict[str, ChannelNoise] = {}
    growing: dict[str, _Differences] = {}
    for name in channels:
        if np.isnan(dataset[name]).all():
            noise[name] = ChannelNoise(np.inf, 0.0, "not read")
            continue
        found = _differences(dataset, name)
        rounding = rounding_of(dataset, name)
        if found.off.size >= 4 and found.spread < rounding:
            noise[name] = _rounded(dataset, found, rounding)
        elif found.off.size < 4:
            floor = max(found.least, ASSUMED_SHARE * float(np.nanmax(np.abs(dataset[name]))))
            noise[name] = ChannelNoise(floor, 0.0, ASSUMED, ASSUMED_FREEDOM)
        elif found.spread < found.least:
            noise[name] = ChannelNoise(found.least, 0.0, "the sensor's resolution")
        else:
            noise[name] = ChannelNoise(found.spread, 0.0, found.source, found.freedom)
            if found.source == REPEATS and name in FORCES:
                growing[name] = found
    for name, growth in zip(growing, growth_of([(found.off, found.size) for found in growing.values()])):
        if growth is not None:
            found = growing[name]
            noise[name] = ChannelNoise(max(growth[0], found.least), growth[1], found.source + GROWING, found.freedom)
    return noise


def hinted_growth(dataset: Dataset, names: Sequence[str]) -> dict[str, tuple[float, float]]:
    """(floor, growth) of those of the force's channels of which repeats say that their noise grows with the load, but
    not clearly enough to be believed alone."""
    found = {name: _differences(dataset, name) for name in names}
    repeated = {name: one for name, one in found.items() if one.source == REPEATS}
    growth = growth_of([(one.off, one.size) for one in repeated.values()], GROWTH_HINT)
    return {name: (max(one[0], repeated[name].least), one[1]) for name, one in zip(repeated, growth) if one is not None}


def rounding_of(dataset: Dataset, channel: str) -> float:
    """One sigma of a channel's rounding, where every reading is a whole number of its steps from the first; else 0."""
    taken = dataset[channel][~np.isnan(dataset[channel])]
    step = dataset.meta.number("sensor.resolution_n") if channel in FORCES else 0.0
    steps = (taken - taken[0]) / (step or np.inf)
    if step <= 0.0 or np.abs(steps - np.rint(steps)).max() >= ON_GRID:
        step = step_of(taken)
    return float(step / np.sqrt(12.0))


def _rounded(dataset: Dataset, found: _Differences, rounding: float) -> ChannelNoise:
    """Rounding that noise does not blur comes again in every repeat: all repeats together show as much of it as one."""
    repeats = len(list(_runs(dataset))) / len({key for key, _, _ in _runs(dataset)})
    floor = float(np.sqrt(found.spread**2 + repeats * (rounding**2 - found.spread**2)))
    half_step = (1.0 if dataset.meta.zeroed_per_run else 0.5) * np.sqrt(12.0) * rounding
    return ChannelNoise(floor, 0.0, ROUNDING, found.freedom, float(half_step + FAR_SIGMAS * found.spread))


def _differences(dataset: Dataset, channel: str) -> _Differences:
    values = dataset[channel]
    if np.isnan(values).any():  # a reading that only a part of the record has
        dataset = dataset.select(~np.isnan(values))
        values = dataset[channel]
    least = LEAST_SHARE * float(np.ptp(values)) + 1e-12
    if channel in FORCES:
        resolution = dataset.meta.number("sensor.resolution_n") / np.sqrt(12.0)
        least = max(least, LEAST_FORCE_SIGMA_N, 0.1 * resolution)
    off, size, sigmas = _repeat_differences(dataset, values)
    source, freedom = REPEATS, 0.75 * off.size
    if off.size < 30:
        off, size, sigmas = _third_differences(dataset, values)
        source, freedom = "smoothness along the runs", off.size / THIRD_DIFFERENCES_SHARE
    if off.size < 4:
        off, size, sigmas = _off_curves(dataset, values)
        source, freedom = "smooth curves through the runs", 0.5 * off.size
    if off.size < 4:
        off, size, sigmas = _off_curves(dataset, values, straight=True)
        source, freedom = "straight lines through the runs", 0.5 * off.size
    return _Differences(off / sigmas, size, source, freedom, least)


def robust_sigma(off: np.ndarray) -> float:
    """Standard deviation of what lies within `FAR_SIGMAS` of it: the rest, up to nearly a half, belongs to slips, to
    glitches, or to the corners of readings that are cut off."""
    square = off**2
    sigma2 = float(np.median(square)) / MEDIAN_OF_SQUARES
    if sigma2 <= 0.0:  # most differences are of less than the resolution
        kept = np.sort(square)[: max(1, int(np.ceil(0.99 * square.size)))]
        return float(np.sqrt(np.mean(kept)))
    for _ in range(20):
        inside = square[square <= FAR_SIGMAS**2 * sigma2]
        fresh = float(np.mean(inside))
        if abs(fresh - sigma2) <= 1e-9 * sigma2:
            break
        sigma2 = fresh
    return float(np.sqrt(sigma2))


def _repeat_differences(dataset: Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Differences between runs that repeat each other, step by step, less each pair's own mean and trend; what one
    reading's sigma makes of them."""
    seen: dict[tuple[object, ...], int] = {}
    off, size = [], []
    for key, begin, end in _runs(dataset):
        before = seen.get(key)
        seen[key] = begin
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


def _runs(dataset: Dataset) -> Iterator[tuple[tuple[object, ...], int, int]]:
    """(what repeats of a run have in common, its first row, the next run's first row) of every run."""
    starts = run_starts(dataset["run"]).tolist()
    for begin, end in zip(starts[:-1], starts[1:]):
        key = (
            int(dataset["config"][begin]),
            int(dataset["axis"][begin]),
            dataset["dx_mm"][begin:end].round(6).tobytes(),
            dataset["dz_mm"][begin:end].round(6).tobytes(),
        )
        yield key, begin, end


def _third_differences(dataset: Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Third differences within the legs of the runs, where the imposed displacement goes on in equal steps."""
    d = dataset["dx_mm"] + dataset["dz_mm"]
    bend = np.abs(np.diff(d, n=2))
    straight = bend <= 1e-6 * max(float(np.ptp(d)), 1e-9)
    inside = (dataset["run"][:-3] == dataset["run"][3:]) & straight[:-1] & straight[1:]
    third = np.diff(values, n=3)[inside]
    return third, np.abs(values[:-3][inside]), float(np.sqrt(20.0))


def _off_curves(
    dataset: Dataset, values: np.ndarray, *, straight: bool = False
) -> tuple[np.ndarray, np.ndarray, float]:
    """What smooth curves over the displacement leave of each run whose steps are uneven and are never repeated; what
    the curves cannot follow counts as noise, so this is an upper bound. `straight`: lines, for runs of a few readings
    only."""
    least = 2 if straight else 4
    starts = run_starts(dataset["run"])
    off, size = [], []
    for begin, end in zip(starts[:-1], starts[1:]):
        rows = slice(begin + 1, end)  # the first may be zero by definition
        x, z = dataset["dx_mm"][rows], dataset["dz_mm"][rows]
        along = z if dataset["axis"][begin] else x
        lines = [np.ones(len(x)), x, z]
        curves = np.column_stack(lines if straight else [*lines, np.abs(along), along**2, along**3])
        basis, triangle = np.linalg.qr(curves)
        basis = basis[:, np.abs(np.diag(triangle)) > 1e-9]
        freedom = len(x) - basis.shape[1]
        if freedom < least:
            continue
        left = values[rows] - basis @ (basis.T @ values[rows])
        off.append(left * np.sqrt(len(x) / freedom))
        size.append(np.abs(values[rows]))
    if not off:
        return np.empty(0), np.empty(0), 1.0
    return np.concatenate(off), np.concatenate(size), 1.0


def growth_of(
    channels: Sequence[tuple[np.ndarray, np.ndarray]], must_gain: float = GROWTH_GAIN
) -> list[tuple[float, float] | None]:
    """(floor, growth) of each channel (differences, sizes of the readings) whose noise grows with the reading, far more
    likely than that it does not: all of them in one ratio to their floors, or one or the other by itself. They are one
    sensor's, so that one of them by itself must be far more likely still."""
    scales = [float(np.sqrt(np.mean(size**2))) if size.size else 0.0 for _, size in channels]
    if not scales or max(scales) <= 0.0:
        return [None] * len(channels)
    ratios = np.linspace(0.0, 3.0, 31)[:, None] / max(scales)  # of growth to floor
    floors2, costs = [], []
    for off, size in channels:
        shape = 1.0 + (ratios * size) ** 2
        floor2 = np.mean(off**2 / shape, axis=1)
        floors2.append(floor2)
        costs.append(off.size * np.log(floor2) + np.sum(np.log(shape), axis=1))
    together = np.sum(costs, axis=0)
    shared = int(np.argmin(together))
    own = [int(np.argmin(cost)) for cost in costs]
    pays = [max(0.0, float(cost[0] - cost[best]) - must_gain) for cost, best in zip(costs, own)]
    if float(together[0] - together[shared]) > max(must_gain, sum(pays)):
        own, pays = [shared] * len(own), [1.0] * len(own)
    return [
        (float(np.sqrt(floor2[best])), float(ratios[best, 0] * np.sqrt(floor2[best]))) if pay > 0.0 else None
        for floor2, best, pay in zip(floors2, own, pays)
    ]
