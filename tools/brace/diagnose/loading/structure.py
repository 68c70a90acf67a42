"""Is there structure in what a hypothesis leaves, or only noise? Families of shapes, each tested on its own with what
the hypothesis could still make up taken out; one family-wise p over all of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import robust_sigma
from brace.identify.record import NOT_MEASURED, Record
from brace.diagnose.loading.rounding import blurred, rounds_to_record
from brace.diagnose.loading.screen import Remover

STRUCTURED_P = 1e-6  # family-wise; structure that matters is far below, and noise is never quite white
MOST_DIMENSIONS = 160  # of one family
LEAST_BESIDE = 6.0  # readings' worth of freedom that a family must leave: fewer do not show the noise
ALIKE = 60  # readings of about the same size: enough to estimate their own noise within a tenth


@dataclass(frozen=True)
class FamilyTest:
    """`words` say what kind of disagreement; `p` is for this family alone; `gain` is what its shapes take off chi
    squared, with `dimensions` shapes; `rms_share` of the left-over's square that they hold."""

    words: str
    p: float
    gain: float
    dimensions: int


@dataclass(frozen=True)
class Structure:
    """`p` over all families together (Bonferroni)."""

    p: float
    families: tuple[FamilyTest, ...]

    @property
    def structured(self) -> bool:
        return self.p < STRUCTURED_P

    @property
    def strongest(self) -> FamilyTest:
        return min(self.families, key=lambda item: (item.p, -item.gain))


def structure_of(record: Record, fitted: Fit) -> Structure:
    """Tests the residuals of a fit. What rounding leaves has shape, too, and says nothing."""
    if rounds_to_record(record, fitted):
        return Structure(1.0, ())
    record, fitted = blurred(record, fitted)
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    tests = []
    taken = float(np.sum(remover.basis[: record.measured.size] ** 2))  # freedoms that the fit took from the readings
    for words, shapes in _families(record, fitted):
        tests.append(_test(words, shapes, remover, left, record.readings - taken))
    tests.append(_lack_of_fit(record, fitted))
    tests.append(_neighbours(record, fitted))
    tests.append(_outliers(record, fitted))
    least = min(test.p for test in tests)
    return Structure(min(1.0, least * len(tests)), tuple(sorted(tests, key=lambda item: item.p)))


def _test(words: str, shapes: np.ndarray, remover: Remover, left: np.ndarray, freedom: float) -> FamilyTest:
    """By F: what the shapes take off, over what is left beside them, so that the noise need not be known well."""
    from scipy.special import fdtrc

    columns = remover.columns(shapes)
    whole = np.linalg.norm(shapes, axis=0)
    columns = columns[:, np.linalg.norm(columns, axis=0) > 1e-3 * np.maximum(whole, 1e-300)]
    if not columns.shape[1]:
        return FamilyTest(words, 1.0, 0.0, 0)
    columns = columns / np.linalg.norm(columns, axis=0)
    basis, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    basis = basis[:, sizes > 1e-4 * sizes[0]][:, :MOST_DIMENSIONS]
    gain = float(np.sum((basis.T @ left) ** 2))
    dimensions = basis.shape[1]
    beside = freedom - dimensions
    if beside < LEAST_BESIDE:
        return FamilyTest(words, 1.0, gain, dimensions)
    ratio = (gain / dimensions) / max((float(left @ left) - gain) / beside, 1e-300)
    return FamilyTest(words, float(fdtrc(dimensions, beside, ratio)), gain, dimensions)


def _lack_of_fit(record: Record, fitted: Fit) -> FamilyTest:
    """Do repeats agree with each other better than with the model? The means of repeats against their spread."""
    from scipy.special import fdtrc

    words = "alike in every repeat"
    data = record.dataset
    along = np.round(np.stack([data["dx_mm"], data["dz_mm"]], axis=1), 6)
    keys = np.column_stack([data["config"], data["axis"], data["step"], along])
    _, group, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    if counts.max() < 2 or data.meta.moved_by_motors:  # there repeats share what their angles are rounded by
        return FamilyTest(words, 1.0, 0.0, 0)
    left = fitted.residual.reshape(len(record.channels), -1)
    between = within = 0.0
    freedom, beside = -fitted.space.size, 0
    for channel, sigma in zip(left, record.sigma):
        taken = sigma < NOT_MEASURED
        count = np.bincount(group[taken], minlength=counts.size)
        mean = np.bincount(group[taken], weights=channel[taken], minlength=counts.size) / np.maximum(count, 1)
        between += float(np.sum(mean**2 * count))
        within += float(np.sum((channel - mean[group])[taken] ** 2))
        freedom += int(np.count_nonzero(count))
        beside += int(np.sum(np.maximum(count - 1, 0)))
    freedom = max(freedom, 1)
    ratio = (between / freedom) / max(within / beside, 1e-300)
    return FamilyTest(words, float(fdtrc(freedom, beside, ratio)), between, freedom)


def _neighbours(record: Record, fitted: Fit) -> FamilyTest:
    """Do readings that follow each other in a run agree in what is left of them?"""
    from scipy.special import ndtr

    left = fitted.residual.reshape(len(record.channels), -1)
    same = np.diff(record.dataset["run"]) == 0
    product = (left[:, 1:] * left[:, :-1])[:, same]
    pairs = int(np.count_nonzero(product))
    size = float(np.sum(left**2)) / max(record.readings, 1)
    z = float(product.sum() / np.sqrt(max(pairs, 1)) / max(size, 1e-12))
    return FamilyTest("from one reading to the next", float(2.0 * ndtr(-abs(z))), z**2, 1)


def _outliers(record: Record, fitted: Fit) -> FamilyTest:
    """Single readings that no noise makes, neither the record's nor that of its readings under like load."""
    from scipy.special import ndtr

    worst = float(far_among_alike(record, fitted).max(initial=0.0))
    p = float(min(1.0, 2.0 * ndtr(-worst) * record.readings))
    return FamilyTest("in single readings", p, worst**2, 1)


def far_among_alike(record: Record, fitted: Fit) -> np.ndarray:
    """How many sigmas each reading is off: the record's own, or those of the readings of its channel under like load,
    whichever are larger. 0 where nothing was read."""
    size = max(1.0, float(np.sqrt(fitted.chi2 / max(record.readings, 1))))
    far: np.ndarray = np.zeros(record.measured.shape)
    for place, (left, sigma) in enumerate(zip(fitted.residual.reshape(record.measured.shape), record.sigma)):
        taken = np.flatnonzero(sigma < NOT_MEASURED)
        alike = taken[np.argsort(np.abs(record.measured[place, taken]), kind="stable")]
        for begin in range(0, alike.size, ALIKE):
            rows = alike[max(0, min(begin, alike.size - ALIKE)) : begin + ALIKE]
            far[place, rows] = np.abs(left[rows]) / max(size, robust_sigma(left[rows]))
    return far.ravel()


def _families(record: Record, fitted: Fit) -> Iterator[tuple[str, np.ndarray]]:
    """(words, readings x shapes). Shapes are of a force (the same for each channel apart) or of a displacement (what a
    displacement of the tip along the run would do to all channels at once)."""
    data, channels, rows = record.dataset, len(record.channels), record.rows
    along = np.where(data["axis"] == 1, data["dz_mm"], data["dx_mm"])
    reach = max(float(np.abs(along).max()), 1e-9)
    s = along / reach
    pushing = _pushing(along, data["run"])
    time = (data["t_s"] - data["t_s"][0]) / max(float(np.ptp(data["t_s"])), 1e-9)
    slope = slopes(record, fitted, along)
    one = np.ones(rows)
    config, axis = _levels(data["config"]), _levels(data["axis"])
    places = _levels(data["config"] * 2 + data["axis"])
    level = _levels(np.round(s * 64).astype(int) * 2 + data["axis"])
    step = _levels(data["step"] * 2 + data["axis"])
    run = _levels(data["run"])

    def apart(columns: np.ndarray) -> np.ndarray:
        """Rows x shapes to readings x (shapes of each channel apart)."""
        out = np.zeros((channels, rows, channels, columns.shape[1]))
        for channel in range(channels):
            out[channel, :, channel] = columns / record.sigma[channel][:, None]
        return out.reshape(channels * rows, -1)

    def together(columns: np.ndarray) -> np.ndarray:
        """Rows x shapes of displacement to readings x shapes."""
        out = slope[:, :, None] * columns[None] / record.sigma[:, :, None]
        return np.asarray(out.reshape(channels * rows, -1))

    yield "at some configurations whatever the load", apart(config)
    yield "at some configurations in proportion to the load", apart(places * s[:, None])
    yield "in proportion to the load's size, whichever its sign", together(
        np.hstack([places * np.abs(s)[:, None], places * (s**2)[:, None]])
    )
    yield "at some levels of the load", together(level)
    yield "at some levels of the load, axis by axis of the sensor", apart(level)
    yield "between loading and unloading", np.hstack(
        [together(places * pushing[:, None]), together(axis * (pushing * np.abs(s))[:, None])]
    )
    yield "at some step of every run", together(step)
    yield "from run to run whatever the load", apart(run) if run.shape[1] <= 40 else together(run)
    yield "from run to run in proportion to the load", together(run * s[:, None])
    waves = np.column_stack([one] + [np.cos(np.pi * k * time) for k in range(1, 7)])
    yield "slowly with time", apart(waves)
    yield "slowly with time, in proportion to the load", together(np.hstack([waves * s[:, None], axis * 0.0]))
    pitches = reach / np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
    periodic = [wave(2 * np.pi * along / pitch) for pitch in pitches for wave in (np.sin, np.cos)]
    yield "periodic in the displacement", together(np.column_stack(periodic))


def _levels(values: np.ndarray) -> np.ndarray:
    """One column of zeros and ones for each distinct value; the first 120 of them."""
    distinct, place = np.unique(values, return_inverse=True)
    shown = min(distinct.size, 120)
    out = np.zeros((values.size, shown))
    kept = place.ravel() < shown
    out[np.flatnonzero(kept), place.ravel()[kept]] = 1.0
    return out


def _pushing(along: np.ndarray, run: np.ndarray) -> np.ndarray:
    """+1 while the displacement goes away from the start of the run, -1 on the way back; signed by its side."""
    out = np.zeros(along.size)
    starts = run_starts(run)
    for begin, end in zip(starts[:-1], starts[1:]):
        way = np.diff(along[begin:end], prepend=along[begin])
        out[begin:end] = np.sign(way)
    return out


def slopes(record: Record, fitted: Fit, along: np.ndarray) -> np.ndarray:
    """Channels x rows: what the channel reads per mm along the run, by the fitted model at that place."""
    played = (record.measured - fitted.residual.reshape(record.measured.shape) * record.sigma)
    out: np.ndarray = np.zeros_like(played)
    places = record.dataset["config"] * 2 + record.dataset["axis"]
    for place in np.unique(places):
        rows = places == place
        d = along[rows] - along[rows].mean()
        size = float(d @ d)
        if size > 0.0:
            out[:, rows] = (played[:, rows] @ d / size)[:, None]
    return out
