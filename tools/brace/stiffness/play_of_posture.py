"""What the play of the joints means at one posture: how far the tip goes, and K until a load has taken it up."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from dataclasses import dataclass

from brace.model import LimbModel
from brace.stiffness.at_rest import PostureError
from brace.stiffness.names import PLANAR_K, PLANAR_REST
from brace.stiffness.with_gap import gaps_rad, stiffness_while_open


@dataclass(frozen=True)
class Play:
    """One joint's: K xx, xz, zz while it is open (None where it is not known), and the tip's free way."""

    joint: str
    gap_rad: float
    tip_mm: float
    open_k_n_per_mm: tuple[float, ...] | None


def levers_mm(model: LimbModel, theta1_rad: float, theta2_rad: float) -> dict[str, tuple[float, float]]:
    """From each joint to the tip: x, z [mm]; true angles."""
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    down = theta1_rad - theta2_rad
    shank = tibia * math.cos(down), tibia * math.sin(down)
    return {"femur": (femur * math.cos(theta1_rad) + shank[0], femur * math.sin(theta1_rad) + shank[1]), "tibia": shank}


def plays(model: LimbModel, theta1_rad: float, theta2_rad: float, carried: Mapping[str, float | str]) -> list[Play]:
    """A Play for each joint that has some; `carried` is K with every gap closed."""
    k = {name: float(carried[name]) for name in (*PLANAR_K, *PLANAR_REST)} | {"flags": float(carried.get("flags", 0.0))}
    found = []
    for joint, gap in gaps_rad(model).items():
        lever = math.hypot(*levers_mm(model, theta1_rad, theta2_rad)[joint])
        open_k = None
        with contextlib.suppress(PostureError):
            values = stiffness_while_open(model, theta1_rad, theta2_rad, k, joint)
            open_k = tuple(values[name] for name in PLANAR_K)
        found.append(Play(joint, gap, gap * lever, open_k))
    return found
