"""Flags of a posture that a controller there would report too: outside the travel, play that no load takes up."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from brace.model import LimbModel
from brace.model.travel import ANGLES, travel_rad, within_travel
from brace.stiffness.with_gap import gaps_rad
from brace.wire.codes import FLAG

_BIT = {code.name: 1 << code.number for code in FLAG.codes}


def flags_of_postures(model: LimbModel, commanded_rad: Mapping[str, np.ndarray], *, unloaded: bool) -> np.ndarray:
    """OUT_OF_RANGE beyond the travel, GAP_OPEN where there is play and no load; one word a posture."""
    angles = {name: np.asarray(commanded_rad[name], float) for name in ANGLES.values() if name in commanded_rad}
    flags = np.where(within_travel(model, angles), 0, _BIT["OUT_OF_RANGE"])
    return np.asarray(flags | (_BIT["GAP_OPEN"] if unloaded and gaps_rad(model) else 0), np.uint32)


def outside(model: LimbModel, commanded_rad: Mapping[str, float]) -> str:
    """Which angle is outside which travel; empty where none is."""
    lines = []
    for joint, name in ANGLES.items():
        low, high = travel_rad(model, joint)
        if name in commanded_rad and not low - 1e-6 <= commanded_rad[name] <= high + 1e-6:
            lines.append(
                f"{name} = {commanded_rad[name]:.4g} is outside the travel of [motor.{joint}], {low:g} to {high:g} rad"
            )
    return "; ".join(lines) + ": a controller tells no K there" if lines else ""
