"""The paper's cyclic test (Fig. 12) on a simulated limb whose gearboxes have the datasheet's play."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.native.plant import play_rig, zero_force_shift_mm

THETA1_RAD, THETA2_RAD = math.radians(70.0), math.radians(50.0)  # the paper's posture
STEP_MM, STEPS = 0.635, 8  # 0.025 inch; 0.2 inch to each side, the stroke that fits the paper's other figures
GAP_RAD = math.radians(20.0 / 60.0)  # 20 arcmin, MX-106 datasheet
GAP_KEYS = ("joint.femur.gap_rad", "joint.tibia.gap_rad")


@dataclass(frozen=True)
class CyclicTest:
    """Displacement [mm] and force [N] along z in the order of the test, with play and without; the zero-force shift,
    where the force crosses zero from either side, and what gap times lever lets expect [mm]."""

    displacement_mm: np.ndarray
    force_n: np.ndarray
    without_play_n: np.ndarray
    shift_mm: float
    crossings_mm: tuple[float, float]
    expected_mm: float


def cyclic_test(model: LimbModel) -> CyclicTest:
    """Plays the test on `model` with 20 arcmin of play in both joints, and without."""
    loose = model.with_values(dict.fromkeys(GAP_KEYS, GAP_RAD))
    tight = model.with_values(dict.fromkeys(GAP_KEYS, 0.0))
    design = {"theta1_rad": np.array([THETA1_RAD]), "theta2_rad": np.array([THETA2_RAD]), "axes": 2, "repeats": 1,
              "steps_per_side": STEPS, "step_mm": STEP_MM, "cyclic": 1, "transverse_free": 1, "noise_n": 0.05,
              "seed": 12}
    record, solid = play_rig(loose, design), play_rig(tight, {**design, "noise_n": 0.0, "resolution_n": 0.0})
    exact = play_rig(loose, {**design, "noise_n": 0.0, "resolution_n": 0.0})
    shift = zero_force_shift_mm(loose, THETA1_RAD, THETA2_RAD, "z", STEP_MM, STEPS)
    levers = _levers_mm(model)
    return CyclicTest(record["dz_mm"], record["fz_n"], solid["fz_n"], shift,
                      _crossings(exact["dz_mm"], exact["fz_n"]), GAP_RAD * float(np.abs(levers).sum()))


def _levers_mm(model: LimbModel) -> np.ndarray:
    """How far the tip moves along z per radian of either joint [mm]: the x parts of p and w."""
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    knee = femur * math.cos(THETA1_RAD)
    shank = tibia * math.cos(THETA1_RAD - THETA2_RAD)
    return np.array([knee + shank, shank])


def _crossings(displacement_mm: np.ndarray, force_n: np.ndarray) -> tuple[float, float]:
    """Displacement at which the loaded flanks, carried on in a straight line, meet zero force: the flank that pushes
    down and the flank that pushes up."""
    def meets_zero(flank: np.ndarray) -> float:
        slope, offset = np.polyfit(displacement_mm[flank], force_n[flank], 1)
        return float(-offset / slope)

    half = 0.5 * float(np.abs(force_n).max())
    return meets_zero(force_n < -half), meets_zero(force_n > half)
