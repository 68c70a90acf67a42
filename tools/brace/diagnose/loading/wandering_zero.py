"""How well a force sensor's zero is known: to a step of its resolution.

Many readings resolve a change of force far below the step that each of them is rounded to, because noise dithers them.
They resolve the zero as well, but no maker promises that it stands still within a step. So each zero is taken to differ
from the record's by one sigma of rounding: by a constant, slowly, and from one part of the record to the next (a
Gaussian process in time). That spread is part of the readings' covariance. What a zero must do to be named has to be more."""

from __future__ import annotations

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import FORCES, ON_GRID
from brace.identify.record import Record

ALL_ALONG = np.inf
TIMES = (ALL_ALONG, 0.5, 0.1)  # of the record's duration, over which a zero keeps its place; each has an equal share
LEAST_SHARE = 1e-3  # of the largest direction's spread: what moves less is left out
CERTAIN_SIGMAS = 5.0  # beyond what noise alone makes of those shapes
MOST_PLACES = 400  # runs, or stretches of runs, that have a zero of their own


def zero_sigma_n(record: Record) -> float:
    """One sigma of the forces' zero [N]: that of rounding to `resolution_n`. 0 where meta.toml gives none, where runs
    are zeroed, and where readings are finer than it: averages of many readings, by an instrument that resolves more."""
    step_n = float(record.dataset.meta.number("sensor.resolution_n"))
    if step_n <= 0.0 or record.dataset.meta.zeroed_per_run:
        return 0.0
    for place in range(len(FORCES)):
        steps = record.measured[place][record.forces_read[place]] / step_n
        if steps.size and np.abs((steps - steps[0]) - np.rint(steps - steps[0])).max() >= ON_GRID:
            return 0.0
    return step_n / float(np.sqrt(12.0))


def also_seen(record: Record, fitted: Fit) -> str:
    """One line about a zero that certainly wanders, by less than the sensor resolves; "" where noise would do so."""
    sigma_n = zero_sigma_n(record)
    if sigma_n == 0.0:
        return ""
    off_n = record.measured - record.player.play_numbers(fitted.model[None])[0]
    shapes = sigma_n * _shapes(record)
    wandered_n = np.zeros((len(FORCES), record.rows))
    seen = expected = spread = 0.0
    for place in range(len(FORCES)):
        sigma = record.sigma[place][:, None]
        directions, lengths, sizes = np.linalg.svd(shapes / sigma, full_matrices=False)
        share = lengths**2 / (1.0 + lengths**2)
        along = directions.T @ (off_n[place] / sigma[:, 0])
        wandered_n[place] = shapes @ (sizes.T @ (along * lengths / (1.0 + lengths**2)))
        seen += float(share @ along**2)
        expected, spread = expected + float(share.sum()), spread + float(2.0 * (share**2).sum())
    if seen <= expected + CERTAIN_SIGMAS * np.sqrt(spread):
        return ""
    rms_n, step_n = float(np.sqrt(np.mean(wandered_n**2))), sigma_n * float(np.sqrt(12.0))
    return (
        f"also seen: the force's zero wanders by about {rms_n:.2g} N, which is less than the sensor resolves "
        f"(resolution_n = {step_n:g}); it is real, and too small to be named"
    )


def with_wandering_zero(record: Record) -> Record:
    """The record with that spread of its zeros in the covariance of its readings."""
    sigma_n = zero_sigma_n(record)
    if sigma_n == 0.0:
        return record
    shapes = sigma_n * _shapes(record)
    columns = np.zeros((len(record.channels), record.rows, len(FORCES) * shapes.shape[1]))
    for place, own in enumerate(np.split(np.arange(columns.shape[2]), len(FORCES))):
        columns[place][:, own] = shapes
    return record.beside(columns)


def _shapes(record: Record) -> np.ndarray:
    """Rows x shapes: what a zero does with one sigma of each. A zero stands still within a run."""
    starts = run_starts(record.dataset["run"])
    stretch = max(1, -(-(starts.size - 1) // MOST_PLACES))
    starts = np.append(starts[:-1][::stretch], starts[-1])
    clock = record.dataset["t_s"]
    middle = 0.5 * (clock[starts[:-1]] + clock[starts[1:] - 1])
    apart = np.abs(middle[:, None] - middle[None]) / max(float(np.ptp(clock)), 1e-9)
    covariance = np.mean([np.exp(-0.5 * (apart / time) ** 2) for time in TIMES], axis=0)
    spread, shapes = np.linalg.eigh(covariance)
    kept = spread > LEAST_SHARE * spread[-1]
    return np.asarray(np.repeat(shapes[:, kept] * np.sqrt(spread[kept]), np.diff(starts), axis=0))
