"""Does what was fitted predict the readings that it never saw: large displacements from small ones, one direction from
the other, late readings from early ones, some postures from the others?

What the fit to the rest leaves of the held-out readings is compared with what noise, and the fit's own uncertainty
there, would leave. Only what the model's parameters could still make up is tested, by F: a model whose numbers differ
from part to part shows there first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.diagnosis import HeldOut
from brace.diagnose.loading.fit import Fit, cost_of, residuals
from brace.identify.noise import FORCES
from brace.identify.record import NOT_MEASURED, Record

LARGE = 0.6  # of the largest displacement: what lies above it is predicted from what lies below
LATE = 0.75  # of the runs: the later ones are predicted from the earlier
LEAST_ROWS = 8  # of both parts
ROUNDS = 4  # of Gauss-Newton steps with the slopes of the whole record's fit
FAILS_P = 1e-4  # below it a part is not predicted
FAILS_SHARE = 0.05  # of the held-out forces, that a prediction must be off by more than expected to be called a failure


@dataclass(frozen=True)
class Part:
    """`rows` are held out; `by` is one word, `words` say which they are."""

    by: str
    words: str
    rows: np.ndarray


def parts(record: Record, locked: np.ndarray) -> Iterator[Part]:
    """The ways to hold readings out that this record allows."""
    data = record.dataset
    x, z = data["dx_mm"], data["dz_mm"]
    size = np.hypot(x, z)
    largest = float(size.max())
    yield Part("amplitude", f"displacements above {LARGE * largest:.3g} mm", size > LARGE * largest)
    along = np.where(data["axis"] == 1, z, x)
    yield Part("direction", "displacements to the minus side", along < 0.0)
    starts = run_starts(data["run"])
    late = int(np.ceil(LATE * (starts.size - 1)))
    if late < starts.size - 1:
        since = float(data["t_s"][starts[late]])
        yield Part("time", f"runs from t = {since:.6g} s on", np.arange(record.rows) >= starts[late])
    if locked.any():
        count = np.unique(data["config"][locked]).size
        yield Part("posture", "1 configuration" if count == 1 else f"{count} configurations", locked)


def held_out(record: Record, fitted: Fit, locked: np.ndarray) -> tuple[HeldOut, ...]:
    """Every part, predicted by the model fitted to the rest of the record. Rows that are held out stay in the limb's
    history: they were driven, and were not read."""
    read = (record.sigma < NOT_MEASURED).any(axis=0)
    found = []
    for part in parts(record, locked):
        rows = part.rows & read
        if min(np.count_nonzero(rows), np.count_nonzero(read & ~rows)) >= LEAST_ROWS:
            found.append(_predicted(record, fitted, part, rows))
    return tuple(found)


def load_range(found: Sequence[HeldOut]) -> Iterator[str]:
    """Up to which load the model was seen to hold, in words."""
    for part in found:
        if part.by == "amplitude" and part.holds:
            yield f"the model holds for forces up to {part.largest:.3g} N, the largest that it predicted unseen"
        elif part.by == "amplitude":
            yield (
                f"the model fits its own amplitude only: fitted to smaller displacements it is off by {part.off:.3g} N "
                f"where forces reach {part.largest:.3g} N; do not use it for larger loads"
            )


def _predicted(record: Record, fitted: Fit, part: Part, rows: np.ndarray) -> HeldOut:
    held = np.broadcast_to(rows, record.measured.shape).ravel()
    x, residual = _without(record, fitted, held)
    p, expected = _chance(record, fitted, residual, held)
    off = (residual.reshape(record.measured.shape) * record.sigma)[: len(FORCES)][:, rows]
    read = record.forces_read[:, rows]
    force = record.measured[: len(FORCES)][:, rows][read]
    off_n = float(np.sqrt(np.mean(off[read] ** 2)))
    signal_n = float(np.sqrt(np.mean(force**2)))
    excess_n = float(np.sqrt(max(off_n**2 - expected**2, 0.0)))
    holds = p >= FAILS_P or excess_n < FAILS_SHARE * signal_n
    return HeldOut(part.by, part.words, off_n, expected, p, holds, float(np.max(np.abs(force), initial=0.0)))


def _without(record: Record, fitted: Fit, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The fit's parameters without the held-out readings, and what they leave of all readings."""
    space, x, residual = fitted.space, fitted.x, fitted.residual
    columns = fitted.jacobian[~held]
    weight = np.where(np.isinf(space.sigma), 0.0, fitted.scale / space.sigma)
    inside = (x > space.low) & (x < space.high)
    normal = columns.T @ columns + np.diag(weight**2 + 1e-9)
    free = np.flatnonzero(inside)
    cost = cost_of(space, x, residual[~held])
    for _ in range(ROUNDS if free.size else 0):
        downhill = columns.T @ residual[~held] - weight * space.pull(x)
        step = np.zeros(x.size)
        step[free] = np.linalg.solve(normal[np.ix_(free, free)], downhill[free]) * fitted.scale[free]
        points = np.clip(x + np.array([[1.0], [0.3]]) * step, space.low, space.high)
        tried = residuals(record, space, points)
        costs = [cost_of(space, point, left[~held]) for point, left in zip(points, tried)]
        best = int(np.argmin(costs))
        if costs[best] > cost - 1e-2:
            break
        x, residual, cost = points[best], tried[best], costs[best]
    return x, residual


def _chance(record: Record, fitted: Fit, residual: np.ndarray, held: np.ndarray) -> tuple[float, float]:
    """How often a model that holds would leave as much of the held-out readings in the directions that its parameters
    move them; and the rms [N] of the forces there that noise and the fit's uncertainty would leave."""
    from scipy.special import fdtrc

    space = fitted.space
    weight = np.where(np.isinf(space.sigma), 0.0, fitted.scale / space.sigma)
    free = np.flatnonzero((fitted.x > space.low) & (fitted.x < space.high))
    seen, unseen = fitted.jacobian[np.ix_(~held, free)], fitted.jacobian[np.ix_(held, free)]
    known = seen.T @ seen + np.diag(weight[free] ** 2 + 1e-9)
    spread = np.linalg.inv(known)
    of_reading = np.einsum("ij,jk,ik->i", unseen, spread, unseen)
    sigma = record.sigma.ravel()[held]
    forces = np.zeros(record.measured.shape, dtype=bool)
    forces[: len(FORCES)] = record.forces_read
    own = forces.ravel()[held]
    expected = float(np.sqrt(np.mean(sigma[own] ** 2 * (1.0 + of_reading[own])))) if own.any() else 0.0
    basis, sizes, turn = np.linalg.svd(unseen, full_matrices=False)
    kept = sizes > 1e-6 * max(float(sizes.max(initial=0.0)), 1e-12)
    if not kept.any():
        return 1.0, expected
    along = basis[:, kept].T @ residual[held]
    moved = sizes[kept, None] * turn[kept]
    inner = np.eye(int(kept.sum())) + moved @ spread @ moved.T
    statistic = float(along @ np.linalg.solve(inner, along)) / int(kept.sum())
    return float(fdtrc(int(kept.sum()), max(record.noise_freedom, 1.0), statistic)), expected
