"""What others would say, who know as much as the command does: small displacements, the limb files' K, measured forces.

The convex law (MuJoCo's, Drake's; here by DAQP) lets a sliding foot lift off; the rigid body has no stiffness at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import daqp  # type: ignore[import-untyped, import-not-found, unused-ignore]
import numpy as np
from limbs import Array, compliance
from scipy.optimize import linprog
from truth import crossing, frames
from world import Stance

FACES = 24
MOST = 1000.0


@dataclass(frozen=True)
class Law:
    """change_n (n, 3) at the payload's factor 1, or None where no forces balance it; `factor` may be inf."""

    change_n: Array | None
    foot: int
    factor: float


def _cones(stance: Stance) -> tuple[Array, Array]:
    """Faces (24 n, 3 n) and limits: faces f <= limits. The faces stand within the cones' surface."""
    n, angle = len(stance.friction), 2 * np.pi * np.arange(FACES) / FACES
    along = frames(stance.world.normal)
    faces, limits = np.zeros((n, FACES, n, 3)), np.zeros((n, FACES))
    for i, mu in enumerate(stance.friction * np.cos(np.pi / FACES)):
        sideways = np.cos(angle)[:, None] * along[i, :, 1] + np.sin(angle)[:, None] * along[i, :, 2]
        faces[i, :, i] = sideways - mu * along[i, :, 0]
        limits[i] = mu * stance.world.grip_n[i]
    return faces.reshape(n * FACES, 3 * n), limits.ravel()


def _balance(stance: Stance) -> tuple[Array, Array, Array]:
    """Levers (6, 3 n), wrenches of weight and payload: levers f + weight + factor payload = 0; moments by 100 mm."""
    world, by = stance.world, np.array([1, 1, 1, 100, 100, 100.0])
    levers = np.concatenate([np.concatenate([np.eye(3), crossing(at)]) for at in world.commanded_mm], axis=1)
    wrench = [np.concatenate([force, np.cross(at, force)])
              for force, at in ((world.weight_n, world.com_mm), (world.payload_n, world.payload_at_mm))]
    return levers / by[:, None], wrench[0] / by, wrench[1] / by


class _Convex:
    """Least energy within the cones from forces `before_n` (n, 3), however they came about."""

    def __init__(self, stance: Stance, before_n: Array) -> None:
        n = len(stance.friction)
        faces, self._limits = _cones(stance)
        levers, self._weight, self._payload = _balance(stance)
        own = np.einsum("nab,nbc,ndc->nad", stance.world.turn, compliance(stance.nominal), stance.world.turn)
        self._energy = np.zeros((3 * n, 3 * n))
        for i, c in enumerate(own):
            self._energy[3 * i:3 * i + 3, 3 * i:3 * i + 3] = c
        self._start, self._rows = before_n.ravel(), np.concatenate([levers, faces])
        self._sense = np.array([5] * 6 + [0] * len(faces), dtype=np.int32)

    def at(self, factor: float, way_mm: Array | None = None, lifted: int = -1) -> tuple[Array, Array] | None:
        """Forces (3 n) and the cones' multipliers at the payload's factor. way_mm (n, 3): of the tips' set-points;
        lifted: a foot that bears nothing."""
        balance = -self._weight - factor * self._payload
        upper = np.concatenate([balance, self._limits])
        lower = np.concatenate([balance, np.full(len(self._limits), -1e30)])
        linear = -self._energy @ self._start + (0.0 if way_mm is None else way_mm.ravel())
        on = np.repeat(np.arange(len(linear) // 3) != lifted, 3)
        force = np.zeros(len(linear))
        energy, rows = np.ascontiguousarray(self._energy[np.ix_(on, on)]), np.ascontiguousarray(self._rows[:, on])
        force[on], _, flag, info = daqp.solve(energy, linear[on], rows, upper, lower, self._sense)
        return (force, np.abs(info["lam"][6:])) if flag == 1 else None

    def change(self, factor: float, way_mm: Array | None = None, lifted: int = -1) -> Array | None:
        """(n, 3). Between two of this law's answers: what the readings lack of balance is in both."""
        before, after = self.at(0.0), self.at(factor, way_mm, lifted)
        return None if before is None or after is None else (after[0] - before[0]).reshape(-1, 3)


def convex(stance: Stance, before_n: Array) -> Law:
    """From forces `before_n` (n, 3) before the payload."""
    law = _Convex(stance, before_n)
    low, high, foot = 0.0, 0.01, -1
    while low < MOST and high - low > 1e-4 * max(low, 0.01):
        factor = (low + high) / 2 if foot >= 0 else high
        solved = law.at(factor)
        if solved is not None and solved[1].max() < 1e-9:
            low, high = factor, high if foot >= 0 else 1.5 * high
        else:
            high = factor
            foot = int(solved[1].argmax()) // FACES if solved is not None else max(foot, 0)
    return Law(law.change(1.0), foot, high if foot >= 0 else np.inf)


def convex_change(stance: Stance, before_n: Array, way_mm: Array | None = None, lifted: int = -1) -> Array | None:
    """What moved set-points (n, 3), or a lifted foot, change without payload (n, 3); None: no forces balance."""
    return _Convex(stance, before_n).change(0.0, way_mm, lifted)


def may_stand(stance: Stance, lifted: int) -> bool:
    """Do any forces within the cones balance the weight without this foot?"""
    faces, limits = _cones(stance)
    levers, weight, _ = _balance(stance)
    on = np.repeat(np.arange(len(stance.friction)) != lifted, 3)
    solved = linprog(np.zeros(on.sum()), A_ub=faces[:, on], b_ub=limits, A_eq=levers[:, on], b_eq=-weight,
                     bounds=(None, None))
    return bool(solved.status == 0)


def rigid(stance: Stance) -> Law:
    """The most of the payload that any forces within the cones could bear, and the foot whose cone limits it most."""
    faces, limits = _cones(stance)
    levers, weight, payload = _balance(stance)
    cost = np.zeros(levers.shape[1] + 1)
    cost[-1] = -1
    bounds = [(None, None)] * levers.shape[1] + [(0, MOST)]
    solved = linprog(cost, A_ub=np.c_[faces, np.zeros(len(faces))], b_ub=limits, A_eq=np.c_[levers, payload],
                     b_eq=-weight, bounds=bounds)
    if solved.status != 0:
        return Law(None, -1, 0.0 if solved.status == 2 else np.inf)
    limiting = -solved.ineqlin.marginals.reshape(-1, FACES).sum(axis=1)
    return Law(None, int(limiting.argmax()), float(solved.x[-1]))
