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


def convex(stance: Stance, before_n: Array) -> Law:
    """Least energy within the cones from forces `before_n` (n, 3) before the payload, however they came about."""
    faces, limits = _cones(stance)
    levers, weight, payload = _balance(stance)
    n = len(stance.friction)
    own = np.einsum("nab,nbc,ndc->nad", stance.world.turn, compliance(stance.nominal), stance.world.turn)
    energy = np.zeros((3 * n, 3 * n))
    for i, c in enumerate(own):
        energy[3 * i:3 * i + 3, 3 * i:3 * i + 3] = c
    start, rows = before_n.ravel(), np.concatenate([levers, faces])
    sense = np.array([5] * 6 + [0] * len(faces), dtype=np.int32)

    def at(factor: float) -> tuple[Array, Array] | None:
        upper = np.concatenate([-weight - factor * payload, limits])
        lower = np.concatenate([-weight - factor * payload, np.full(len(faces), -1e30)])
        force, _, flag, info = daqp.solve(energy, -energy @ start, rows, upper, lower, sense)
        return (force, np.abs(info["lam"][6:])) if flag == 1 else None

    low, high, foot = 0.0, 0.01, -1
    while low < MOST and high - low > 1e-4 * max(low, 0.01):
        factor = (low + high) / 2 if foot >= 0 else high
        solved = at(factor)
        if solved is not None and solved[1].max() < 1e-9:
            low, high = factor, high if foot >= 0 else 1.5 * high
        else:
            high = factor
            foot = int(solved[1].argmax()) // FACES if solved is not None else max(foot, 0)
    one = at(1.0)
    change = None if one is None else one[0].reshape(n, 3) - before_n
    return Law(change, foot, high if foot >= 0 else np.inf)


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
