"""Bounded, prior-weighted least squares over a whole record, with the plant played for many points at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.identify.record import Record
from brace.diagnose.loading.space import Space
from brace.identify.parameters import TIBIA_BEAM

MAX_STEPS = 14
WHOLE_STEP, SHORTER_STEPS = np.array([1.0]), np.array([0.4, 0.1, 0.02])
KEPT_PROMISE = 0.5  # of what a step should gain: with less, shorter ones are tried as well
SCREENING_DECREASE = 0.05  # of chi squared: a step that gains less is the last of a screening fit
FINAL_DECREASE = 1e-4
PROBE = 0.2  # sigmas of the whole record that a finite difference moves by, about
STEPWISE_ROUNDS = 3
MOST_TIMES = 120
# Keys of which a limb that does not turn shows nothing, or only a part.
SEEN_IN_TURNING = (TIBIA_BEAM, "gravity.", "sensor.saturation_n")
BEAM_SHARES = np.array([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0])
BIG = 1e6  # whitened residual that stands for a model which no limb can have


@dataclass(frozen=True)
class Fit:
    """`x` in the keys' units; `residual` (measured - model) / sigma; `jacobian` of the model's whitened readings by
    x / scale; `cost` is chi squared with the priors' share."""

    space: Space
    x: np.ndarray
    residual: np.ndarray
    jacobian: np.ndarray
    scale: np.ndarray
    cost: float

    @property
    def chi2(self) -> float:
        return float(self.residual @ self.residual)

    @property
    def model(self) -> np.ndarray:
        """The limb's numbers."""
        return np.asarray(self.space.models(self.x[None])[0])

    def value(self, key: str) -> float:
        return float(self.x[self.space.keys.index(key)])


def cost_of(space: Space, x: np.ndarray, residual: np.ndarray) -> float:
    pull = space.pull(x)
    return float(residual @ residual + pull @ pull)


def residuals(record: Record, space: Space, points: np.ndarray) -> np.ndarray:
    """points x readings; models that cannot be played are far off."""
    found = space.residuals(record, points)
    return found if np.isfinite(found).all() else np.nan_to_num(found, nan=BIG, posinf=BIG, neginf=-BIG)


def scales(record: Record, space: Space, x: np.ndarray, residual: np.ndarray, final: bool) -> np.ndarray:
    """For each key, the change that moves the whole record by about one sigma; found by doubling and halving."""
    scale = np.where(np.isinf(space.sigma), np.maximum(np.abs(x), 1e-3) * 1e-2, 0.1 * space.sigma)
    scale = np.where(scale > 0.0, scale, 1e-6)
    for _ in range(2):
        moved = _changes(record, space, x, residual, _inward(space, x, scale), final)
        length = np.linalg.norm(moved, axis=1)
        scale = np.asarray(np.clip(scale / np.clip(length, 1e-4, 1e4), 1e-14, None))
    scale[list(space.stepwise)] = 1.0
    return np.asarray(scale)


def _inward(space: Space, x: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Steps turned round where they would leave the bounds."""
    step = np.where(x + step > space.high, -step, step)
    return np.asarray(np.clip(x + step, space.low, space.high) - x)


def _changes(
    record: Record, space: Space, x: np.ndarray, residual: np.ndarray, step: np.ndarray, final: bool
) -> np.ndarray:
    """How the model's whitened readings change with each key by its step, keys x readings. While a fit only screens, a
    limb that does not turn gives most of them: nearly the same, and ten times as fast."""
    points = x + np.diag(step)
    moved = np.empty((space.size, residual.size))
    played = np.array([final or key.startswith(SEEN_IN_TURNING) for key in space.keys], dtype=bool)
    moved[played] = residual - residuals(record, space, points[played])
    if not played.all():
        flat = record.unturned
        left = residuals(flat, space, np.vstack([x, points[~played]]))
        moved[~played] = left[0] - left[1:]
    return moved


def jacobian(
    record: Record, space: Space, x: np.ndarray, residual: np.ndarray, scale: np.ndarray, final: bool
) -> np.ndarray:
    """Columns of the model's whitened readings by x / scale."""
    step = _inward(space, x, PROBE * scale)
    moved = _changes(record, space, x, residual, step, final)
    safe = np.where((step == 0.0) | np.isin(np.arange(space.size), space.stepwise), np.inf, step)
    return np.asarray(moved * (scale / safe)[:, None]).T


def fit(record: Record, space: Space, start: np.ndarray, *, final: bool = True) -> Fit:
    """Gauss-Newton with bounds; times at which readings jump are searched reading by reading in between."""
    x = np.clip(start, space.low, space.high)
    residual = residuals(record, space, x[None])[0]
    scale = scales(record, space, x, residual, final)
    found = _descend(record, space, x, residual, scale, final)
    for _ in range(STEPWISE_ROUNDS if space.stepwise else 0):
        moved, left, cost = _step_times(record, space, found.x, found.residual, found.cost)
        if cost > found.cost - SCREENING_DECREASE:
            break
        found = _descend(record, space, moved, left, scale, False)
    return _other_beam(record, space, found, scale, final)


def _other_beam(record: Record, space: Space, found: Fit, scale: np.ndarray, final: bool) -> Fit:
    """How much of a tibia is a beam may have two best answers, one near each end: descends again where another share
    does better with all else held."""
    if TIBIA_BEAM not in space.keys:
        return found
    points = found.x[np.newaxis].repeat(BEAM_SHARES.size, axis=0)
    points[:, space.keys.index(TIBIA_BEAM)] = BEAM_SHARES
    tried = residuals(record, space, points)
    costs = np.array([cost_of(space, point, left) for point, left in zip(points, tried)])
    best = int(np.argmin(costs))
    if costs[best] > found.cost - SCREENING_DECREASE:
        return found
    return _descend(record, space, points[best], tried[best], scale, final)


def _descend(
    record: Record, space: Space, x: np.ndarray, residual: np.ndarray, scale: np.ndarray, final: bool
) -> Fit:
    """Steps until one gains too little."""
    cost = cost_of(space, x, residual)
    columns = jacobian(record, space, x, residual, scale, final)
    for _ in range(MAX_STEPS):
        # far from the record a step must gain more to turn the evidence as much (evidence.py)
        stop = FINAL_DECREASE if final else SCREENING_DECREASE * max(1.0, cost / max(record.readings, 1))
        step, promised = _newton_step(space, x, residual, columns, scale)
        if promised < stop:
            break
        there, left, here = x, residual, cost
        for lengths in (WHOLE_STEP, SHORTER_STEPS):
            points = np.clip(x + lengths[:, None] * step, space.low, space.high)
            tried = residuals(record, space, points)
            costs = np.array([cost_of(space, point, left) for point, left in zip(points, tried)])
            best = int(np.argmin(costs))
            if costs[best] < cost:
                there, left, cost = points[best], tried[best], float(costs[best])
            if here - cost > KEPT_PROMISE * promised:
                break
        gained = here - cost
        if gained <= 0.0:
            break
        x, residual = there, left
        if gained < stop:
            break
        columns = jacobian(record, space, x, residual, scale, final)
    return Fit(space, x, residual, columns, scale, cost)


def times_near(record: Record, time_s: float, runs: float = 2.0) -> np.ndarray:
    """Middles between neighbouring readings, within about so many runs of a time."""
    clock = record.dataset["t_s"]
    between = 0.5 * (clock[1:] + clock[:-1])
    length = float(np.ptp(clock)) / max(int(np.unique(record.dataset["run"]).size), 1)
    near = between[np.abs(between - time_s) <= runs * length]
    return np.asarray(near[:: max(1, near.size // MOST_TIMES)])


def _step_times(
    record: Record, space: Space, x: np.ndarray, residual: np.ndarray, cost: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """The best time between readings near each stepwise key, the rest held."""
    for place in space.stepwise:
        times = times_near(record, float(x[place]))
        times = times[(times >= space.low[place]) & (times <= space.high[place])]
        if not times.size:
            continue
        points = x[np.newaxis].repeat(times.size, axis=0)
        points[:, place] = times
        tried = residuals(record, space, points)
        costs = np.array([cost_of(space, point, left) for point, left in zip(points, tried)])
        best = int(np.argmin(costs))
        if costs[best] < cost:
            x, residual, cost = points[best], tried[best], float(costs[best])
    return x, residual, cost


def _newton_step(
    space: Space, x: np.ndarray, residual: np.ndarray, columns: np.ndarray, scale: np.ndarray
) -> tuple[np.ndarray, float]:
    """Gauss-Newton's step with the priors in it, and what it should gain; keys that push against a bound stay."""
    weight = np.where(np.isinf(space.sigma), 0.0, scale / space.sigma)
    normal = columns.T @ columns + np.diag(weight**2)
    downhill = columns.T @ residual - weight * space.pull(x)
    held = np.zeros(x.size, dtype=bool)
    for _ in range(3):
        free = np.flatnonzero(~held)
        if not free.size:
            return np.zeros_like(x), 0.0
        part = normal[np.ix_(free, free)]
        diagonal = np.diag(part)
        damped = part + np.diag(1e-9 * diagonal + 1e-12)
        step = np.zeros_like(x)
        step[free] = np.linalg.solve(damped, downhill[free]) * scale[free]
        outward = ((x <= space.low) & (step < 0.0)) | ((x >= space.high) & (step > 0.0))
        if not np.any(outward & ~held):
            break
        held |= outward
    turned = step / scale
    return step, float(2.0 * turned @ downhill - turned @ normal @ turned)
