"""Joints' springs as the firmware's estimators of K under a load want them: how far they yield, and their slope."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from brace.model import LimbModel
from brace.native.c_data import CData

_ROUNDS, _SETTLED = 20, 1e-5  # at most so many, and by what share a spring may still move


class Spring:
    """A joint's spring, torque = deflection / compliance + hardening deflection^3, as the firmware's C wants it."""

    def __init__(self, turn: str, joint: CData, model: LimbModel, part: str, base_rad_per_n_mm: float) -> None:
        self._turn, self._joint, self._base_rad_per_n_mm = turn, joint, base_rad_per_n_mm
        self._compliance_rad_per_n_mm = model.number(f"joint.{part}.compliance_rad_per_n_mm")
        self._hardening_n_mm_per_rad3 = model.number(f"joint.{part}.hardening_n_mm_per_rad3")
        self.carries(0.0)

    @property
    def hardens(self) -> bool:
        return self._hardening_n_mm_per_rad3 > 0.0 and self._compliance_rad_per_n_mm > 0.0

    def torque_n_mm(self, found: np.ndarray) -> float:
        """That turned the joint, and with it the base where base_rad_per_n_mm is not 0."""
        yields = self._joint.yields_by_rad_per_n_mm + self._base_rad_per_n_mm
        return float(found[self._turn][0]) / yields if yields > 0.0 else 0.0

    def carries(self, torque_n_mm: float) -> float:
        """Sets how the joint yields under a torque; by what share that differs from before."""
        slope = yields = self._compliance_rad_per_n_mm
        if self.hardens and torque_n_mm != 0.0 and np.isfinite(torque_n_mm):
            cubic = [self._hardening_n_mm_per_rad3, 0.0, 1.0 / self._compliance_rad_per_n_mm, -torque_n_mm]
            roots = np.roots(cubic)
            deflection_rad = float(roots[np.argmin(np.abs(roots.imag))].real)  # the only real one
            yields = deflection_rad / torque_n_mm
            stiffer_n_mm_per_rad = 3.0 * self._hardening_n_mm_per_rad3 * deflection_rad**2
            slope = 1.0 / (1.0 / self._compliance_rad_per_n_mm + stiffer_n_mm_per_rad)
        moved = abs(yields - self._joint.yields_by_rad_per_n_mm) / yields if yields > 0.0 else 0.0
        self._joint.yields_by_rad_per_n_mm, self._joint.slope_rad_per_n_mm = yields, slope
        return moved


def settle(springs: Sequence[Spring], find: Callable[[], np.ndarray]) -> np.ndarray:
    """`find` with springs that yield as what they then carry: how far a hardening spring yields depends on its torque,
    that a little on how far it yields. find: one case, in the struct of an estimator."""
    for spring in springs:
        spring.carries(0.0)
    found = find()
    for _ in range(_ROUNDS):
        moved = [spring.carries(spring.torque_n_mm(found)) for spring in springs]
        if not max(moved) > _SETTLED:
            break
        found = find()
    return found
