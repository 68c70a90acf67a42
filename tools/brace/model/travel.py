"""Where the joints of a limb may be commanded, as [motor.*] angle_min_rad and angle_max_rad say."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from brace.model.limb import LimbModel

ANGLES = {"femur": "theta1_rad", "tibia": "theta2_rad", "coxa": "theta0_rad"}
KNEE_MOST_RAD = 2.6  # where no travel is given: a knee that is bent further counts as folded into its femur


def travel_rad(model: LimbModel, joint: str) -> tuple[float, float]:
    """The least and the greatest commanded angle, the default where the file has none."""
    return model.number(f"motor.{joint}.angle_min_rad"), model.number(f"motor.{joint}.angle_max_rad")


def has_travel(model: LimbModel, joint: str) -> bool:
    """Whether limb.toml says how far the joint may be commanded."""
    return {f"motor.{joint}.angle_min_rad", f"motor.{joint}.angle_max_rad"} <= model.given


def within_travel(model: LimbModel, commanded_rad: Mapping[str, np.ndarray]) -> np.ndarray:
    """Of which postures every joint can be commanded there. Angles by their column (theta1_rad and so on)."""
    within = np.ones(len(next(iter(commanded_rad.values()))), bool)
    for joint, name in ANGLES.items():
        if name in commanded_rad:
            low, high = travel_rad(model, joint)
            within &= (commanded_rad[name] >= low - 1e-6) & (commanded_rad[name] <= high + 1e-6)
    return within
