"""Estimates what each way of each effect would gain if it joined a fitted hypothesis, and where its fit should start.
The plant plays the tries; all that the hypothesis turns already is refitted linearly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.loading.fit import PROBE, SEEN_IN_TURNING, Fit, residuals
from brace.identify.record import Record
from brace.diagnose.loading.space import Space, Trust, compatible, space_of
from brace.effects import Variant

MOST_TRIES = 120
MOST_SCALED = 4
THINNED = 3


@dataclass(frozen=True)
class Promise:
    """A variant added to a hypothesis: the space of both, a start, and the cost that its fit should come down to."""

    space: Space
    start: np.ndarray
    cost: float


class Nearby:
    """Residuals of limbs not far from a fitted one. They are played on limbs that do not turn; what turning changes is
    taken from the fitted limb."""

    def __init__(self, record: Record, fitted: Fit) -> None:
        self._record = record.unturned
        self._turning = fitted.residual - residuals(self._record, fitted.space, fitted.x[None])[0]

    def residuals(self, space: Space, points: np.ndarray) -> np.ndarray:
        """points x readings"""
        return np.asarray(residuals(self._record, space, points) + self._turning)


class Played:
    """Residuals of limbs that turn as they are displaced, for what shows only, or otherwise, in limbs that do."""

    def __init__(self, record: Record) -> None:
        self._record = record

    def residuals(self, space: Space, points: np.ndarray) -> np.ndarray:
        """points x readings"""
        return residuals(self._record, space, points)


class Remover:
    """Takes out of whitened residuals what the hypothesis' own parameters could still make up, under their priors."""

    def __init__(self, fitted: Fit, without: Sequence[str] = ()) -> None:
        keep = [i for i, key in enumerate(fitted.space.keys) if key not in without]
        sigma, scale = fitted.space.sigma[keep], fitted.scale[keep]
        weight = np.where(np.isinf(sigma), 1e-9, scale / sigma)
        self._pull = fitted.space.pull(fitted.x)[keep]
        stacked = np.vstack([fitted.jacobian[:, keep], np.diag(weight)])
        self.basis, _ = np.linalg.qr(stacked)
        """Readings and pulls x parameters, orthonormal: what they can make up."""

    def augmented(self, residual: np.ndarray) -> np.ndarray:
        """Residuals with the priors' pulls behind them, the removable part removed; points x (readings + pulls)."""
        whole = np.hstack([residual, np.broadcast_to(-self._pull, (len(residual), self._pull.size))])
        return np.asarray(whole - (whole @ self.basis) @ self.basis.T)

    def columns(self, columns: np.ndarray) -> np.ndarray:
        """The same for signatures, readings x columns."""
        whole = np.vstack([columns, np.zeros((self._pull.size, columns.shape[1]))])
        return np.asarray(whole - self.basis @ (self.basis.T @ whole))


def screen(record: Record, trust: Trust, fitted: Fit, variants: Sequence[Variant]) -> list[Promise]:
    """All compatible variants, the most promising first. Beside effects that are already there every third try is
    enough, because this step scales the sizes anyway."""
    held = fitted.space.variants
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    nearby, played = Nearby(record, fitted), Played(record)
    promises = []
    for variant in variants:
        if any(variant.label == other.label for other in held) or not compatible((*held, variant)):
            continue
        by = played if any(key.startswith(SEEN_IN_TURNING) for key in variant.keys) else nearby
        promises.append(_promise(by, fitted, space_of(trust, (*held, variant)), variant, remover, left))
    return sorted(promises, key=lambda promise: promise.cost)


def _promise(
    nearby: Nearby | Played, fitted: Fit, space: Space, variant: Variant, remover: Remover, left: np.ndarray
) -> Promise:
    start = space.mean.copy()
    known = dict(zip(fitted.space.keys, fitted.x))
    for i, key in enumerate(space.keys):
        start[i] = min(max(known.get(key, start[i]), space.low[i]), space.high[i])
    tries = _tries(space, start, variant, THINNED if fitted.space.variants else 1)
    left_over = remover.augmented(nearby.residuals(space, tries))
    costs = np.einsum("ij,ij->i", left_over, left_over)
    if len(tries) > 1:
        scaled = _scaled_tries(space, variant, tries, left_over, left)
        left_scaled = remover.augmented(nearby.residuals(space, scaled))
        tries = np.vstack([tries, scaled])
        costs = np.concatenate([costs, np.einsum("ij,ij->i", left_scaled, left_scaled)])
    best = int(np.argmin(costs))
    estimate = float(costs[best])
    freed = [freedom.key for freedom in variant.freedoms]
    if freed:
        own = remover if not set(freed) & set(fitted.space.keys) else Remover(fitted, freed)
        here = own.augmented(nearby.residuals(space, tries[best][None]))[0]
        columns = own.columns(_signatures(nearby, space, tries[best], freed))
        lengths = np.linalg.norm(columns, axis=0)
        basis = columns[:, lengths > 1e-9] / lengths[lengths > 1e-9]
        if basis.shape[1] > 1:
            basis, _ = np.linalg.qr(basis)
        gain = float(np.sum((basis.T @ here) ** 2))
        estimate = min(estimate, float(here @ here) - gain)
    return Promise(space, tries[best], estimate)


def _tries(space: Space, start: np.ndarray, variant: Variant, every: int) -> np.ndarray:
    """Every combination of the tries of the variant's freedoms, and the start itself."""
    points = [start]
    grids = [freedom.tries or (None,) for freedom in variant.freedoms]
    places = [space.keys.index(freedom.key) for freedom in variant.freedoms]
    mesh: list[list[float | None]] = [[]]
    for grid in grids:
        mesh = [[*some, value] for some in mesh for value in grid]
    for values in mesh[every // 2 : MOST_TRIES : every]:
        point = start.copy()
        for place, value in zip(places, values):
            if value is not None:
                point[place] = min(max(value, space.low[place]), space.high[place])
        points.append(point)
    return np.array(points if len(points) == 1 or any(f.tries for f in variant.freedoms) else points[:1])


def _scaled_tries(
    space: Space, variant: Variant, tries: np.ndarray, left_over: np.ndarray, left: np.ndarray
) -> np.ndarray:
    """The most promising tries with their size (the variant's first key) scaled as if readings were linear in it."""
    change = left - left_over
    power = np.einsum("ij,ij->i", change, change)
    along = change @ left
    ratio = np.divide(along, power, out=np.zeros_like(along), where=power > 1e-12)
    gain = np.where(power > 1e-12, along * ratio, 0.0)
    best = np.argsort(-gain, kind="stable")[:MOST_SCALED]
    place = space.keys.index(variant.freedoms[0].key)
    scaled = tries[best].copy()
    believed = tries[0, place]
    scaled[:, place] = np.clip(
        believed + ratio[best] * (scaled[:, place] - believed), space.low[place], space.high[place]
    )
    return scaled


def _signatures(nearby: Nearby | Played, space: Space, point: np.ndarray, freed: Sequence[str]) -> np.ndarray:
    """Change of the whitened model readings along each freed key, scaled to about one sigma; readings x keys."""
    which = np.array([space.keys.index(key) for key in freed])
    step = np.maximum(np.abs(point[which]) * 1e-3, _small_steps(freed))
    points = point[np.newaxis].repeat(which.size, axis=0)
    for row, (place, size) in enumerate(zip(which, step)):
        size = -size if points[row, place] + size > space.high[place] else size
        points[row, place] += size
    base = nearby.residuals(space, point[None])[0]
    moved = base - nearby.residuals(space, points)
    lengths = np.linalg.norm(moved, axis=1)
    return np.asarray((moved * (PROBE / np.where(lengths > 0.0, lengths, np.inf))[:, None]).T)


def _small_steps(freed: Sequence[str]) -> np.ndarray:
    from brace.identify.parameters import natural_scale

    return np.array([1e-3 * natural_scale(key) for key in freed])
