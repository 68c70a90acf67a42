"""Is a fitted gap a gap? It is one only where the record reaches both of its sides, with hardly any rise of torque
between them.

A soft spring with a large gap and hardening fits many loops well. Such a gap is a shape, not a play. So is a gap that
the joint crosses while its friction still turns: it only mends the law by which friction turns."""

from __future__ import annotations

import numpy as np

from brace.diagnose.joint_test.fit import Fitted
from brace.diagnose.joint_test.record import JointRecord
from brace.effects.catalogue import FRICTION_TURN
from brace.identify.fit import columns_of

MIN_INSIDE = 6
FLAT = 0.4  # slope inside over slope outside, at most
FLANK = 0.02  # of the gap, that the record goes beyond each side
RISE = 1.0  # of what the fit leaves, by which the torque rises beyond each side


def refusal(record: JointRecord, fitted: Fitted) -> str:
    """Why no play may be claimed; empty when it may."""
    at = f"joint.{record.joint}."
    gap_rad = fitted.model.number(at + "gap_rad")
    deflection = record.deflection_rad(columns_of(fitted.nuisances), 1)[0]
    used = record.fitted
    if gap_rad > (1.0 - 1e-3) * record.size.swing_rad:
        return f"the joint reached both sides of its play within {record.size.swing_rad:.3g} rad"
    inside = used & (np.abs(deflection) < 0.5 * gap_rad)
    above, below = deflection[used].max() - 0.5 * gap_rad, -deflection[used].min() - 0.5 * gap_rad
    left_n_mm = float(np.sqrt(np.mean(fitted.off_n_mm[used] ** 2)))
    rises_n_mm = min(above, below) / max(fitted.model.number(at + "compliance_rad_per_n_mm"), 1e-30)
    if min(above, below) < FLANK * gap_rad or rises_n_mm < RISE * left_n_mm:
        return "the record does not reach both of its sides"
    if np.count_nonzero(inside) < MIN_INSIDE:
        return "hardly any reading lies inside it"
    without = fitted.model.with_values({at + "coulomb_n_mm": 0.0, at + "coulomb_per_load_ratio": 0.0})
    spring = record.torque(without, fitted.nuisances)
    friction = record.torque(fitted.model, fitted.nuisances) - spring
    carried = record.columns["torque_n_mm"] - friction
    slope_inside = _slope(deflection[inside], carried[inside])
    beyond = used & ~inside
    rise = np.ptp(carried[beyond]) / max(np.ptp(deflection[beyond]) - gap_rad, 1e-12)
    if slope_inside > FLAT * rise:
        return (
            f"the joint carries torque inside it: its slope there is {slope_inside / rise:.0%} of the one"
            " outside"
        )
    return ""


def is_friction_turning(record: JointRecord, plain: Fitted) -> str:
    """Why the gap of a fit without shapes and laws, in which all friction turns over one angle, is none; empty when it
    may be one. Friction that is smaller than the torque that the gap takes from the spring cannot stand for it."""
    at = f"joint.{record.joint}."
    gap_rad, spring = (plain.model.number(at + leaf) for leaf in ("gap_rad", "compliance_rad_per_n_mm"))
    turn_rad, rubs_n_mm = plain.values.get(FRICTION_TURN, 0.0), plain.model.number(at + "coulomb_n_mm")
    rubs_n_mm += plain.model.number(at + "coulomb_per_load_ratio") * 0.5 * record.size.torque_n_mm
    if gap_rad >= turn_rad or rubs_n_mm < 0.5 * gap_rad / max(spring, 1e-30):
        return ""
    return f"the joint crosses it while its friction still turns, which takes {turn_rad:.3g} rad"


def _slope(x: np.ndarray, y: np.ndarray) -> float:
    centred = x - x.mean()
    return float(centred @ y / max(float(centred @ centred), 1e-30))
