"""What `brace stance range` says: the forces that each foot may bear, whatever has slipped or been pulled before.

With every history of slips possible, forces are any that balance the loads and that each foot's ground can give: a
linear program for each end (Bretl and Lall, IEEE Trans. Robotics 24, 2008), with cones of FACES faces around the round
ones: a range is too wide by 0.5 % of the sideways force at most, never too narrow. Feet lie where they do without load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from brace.stance.stance_file import Stance
from brace.stance.world import NoStanceError, World, believed

FACES = 32
_LEVER_MM = 100.0  # moments become forces of about the same size
_INFEASIBLE, _UNBOUNDED = 2, 3  # of linprog's status


@dataclass(frozen=True)
class Ranges:
    """A row a limb, in the body's frame; infinite where the feet can squeeze the body against each other without end.
    payload_factor: the most of the payload that any forces bear; None: no payload, or no end."""

    stance: Stance
    low_n: np.ndarray  # n x 3
    high_n: np.ndarray
    pressing_low_n: np.ndarray  # n, along the ground's normal
    pressing_high_n: np.ndarray
    payload_factor: float | None

    def as_json(self) -> dict[str, object]:
        """Null: no end."""
        return {
            "limbs": [
                {
                    "name": limb.name,
                    "force_low_n": _ends(self.low_n[i]),
                    "force_high_n": _ends(self.high_n[i]),
                    "pressing_n": _ends(np.array([self.pressing_low_n[i], self.pressing_high_n[i]])),
                }
                for i, limb in enumerate(self.stance.limbs)
            ],
            "payload_factor": self.payload_factor,
        }


def _ends(values: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]


def ranges(stance: Stance) -> Ranges:
    """Under weight and payload. Raises NoStanceError where no forces bear them; `share`: what they bear at most."""
    program = _Program(stance, believed(stance))
    n = len(stance.limbs)
    if not program.is_borne(1.0, 1.0):
        is_payload = program.is_borne(1.0, 0.0)
        share = program.most_payload() if is_payload else 0.0
        raise NoStanceError("no forces that the ground can give balance the load", share or 0.0, is_payload)
    low, high, pressing = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 2))
    for i, limb in enumerate(stance.limbs):
        for axis, direction in enumerate(np.eye(3)):
            low[i, axis], high[i, axis] = program.least(i, direction), -program.least(i, -direction)
        pressing[i] = program.least(i, limb.normal), -program.least(i, -limb.normal)
    factor = program.most_payload() if np.any(stance.payload_n) else None
    return Ranges(stance, low, high, pressing[:, 0], pressing[:, 1], factor)


class _Program:
    """The forces on the feet are its unknowns, 3 n; balance is six equations, each foot's cone FACES inequalities."""

    def __init__(self, stance: Stance, world: World) -> None:
        n = len(stance.limbs)
        self._balance, self._cones, self._bounds = np.zeros((6, 3 * n)), [], []
        for i, (law, offset, contact) in enumerate(zip(world.laws, world.offset_mm, world.contacts, strict=True)):
            foot = slice(3 * i, 3 * i + 3)
            self._balance[:, foot] = _wrench_of(np.eye(3), law.tip_mm + offset)
            along = np.linalg.svd(contact.normal[None])[2][1:]
            for angle in 2 * np.pi * np.arange(FACES) / FACES:
                face = np.zeros(3 * n)
                face[foot] = np.cos(angle) * along[0] + np.sin(angle) * along[1]
                ratio = contact.friction_ratio / np.cos(np.pi / FACES)
                face[foot] -= ratio * contact.normal
                self._cones.append(face)
                self._bounds.append(ratio * contact.grip_n)
            face = np.zeros(3 * n)
            face[foot] = -contact.normal
            self._cones.append(face)
            self._bounds.append(contact.grip_n)
        self._weight = np.sum([_wrench_of(force, at) for force, at in world.weight], axis=0)
        self._payload = _wrench_of(*world.payload)

    def _solve(self, cost: np.ndarray, balance: np.ndarray, borne: np.ndarray, cones: np.ndarray) -> tuple[int, float]:
        found = linprog(cost, cones, self._bounds, balance, borne, (None, None))
        return int(found.status), float(found.fun if found.status == 0 else -np.inf)

    def _forces(self, cost: np.ndarray, weight: float, payload: float) -> tuple[int, float]:
        borne = -(weight * self._weight + payload * self._payload)
        return self._solve(cost, self._balance, borne, np.array(self._cones))

    def is_borne(self, weight: float, payload: float) -> bool:
        return self._forces(np.zeros(self._balance.shape[1]), weight, payload)[0] != _INFEASIBLE

    def least(self, limb: int, direction: np.ndarray) -> float:
        """Of the limb's force along a direction, under weight and payload; -inf: no end."""
        cost = np.zeros(self._balance.shape[1])
        cost[3 * limb : 3 * limb + 3] = direction
        return self._forces(cost, 1.0, 1.0)[1]

    def most_payload(self) -> float | None:
        """The largest factor of the payload that some forces bear; None: no end."""
        count = self._balance.shape[1]
        cost = np.zeros(count + 1)
        cost[count] = -1.0
        cones = np.array(self._cones)
        status, least = self._solve(cost, np.hstack([self._balance, self._payload[:, None]]), -self._weight,
                                    np.hstack([cones, np.zeros((len(cones), 1))]))  # fmt: skip
        return None if status == _UNBOUNDED else max(-least, 0.0)


def _wrench_of(force: np.ndarray, at_mm: np.ndarray) -> np.ndarray:
    """Force [N] and moment about the body's origin by _LEVER_MM; of several forces, one a column."""
    x, y, z = at_mm
    return np.concatenate([force, np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]) @ force / _LEVER_MM])
