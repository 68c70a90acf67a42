"""Limbs and postures for the property tests: drawn from a seed, within what a limb can be."""
from __future__ import annotations

from typing import Any

import numpy as np

from host_library import Model

PAPER = {
    "link.femur.axial_mm_per_n": 0.001, "link.femur.bending_mm_per_n": 0.06,
    "link.tibia.axial_mm_per_n": 0.002, "link.tibia.bending_mm_per_n": 0.25,
    "joint.femur.compliance_rad_per_n_mm": 1.0e-5, "joint.tibia.compliance_rad_per_n_mm": 1.6e-5,
}
"""The check values' limb."""


def limb(keys: dict[str, float]) -> Model:
    """A model with these keys of limb.toml, the rest without effect."""
    model = Model()
    for key, value in keys.items():
        model[key] = value
    return model


def random_limb(draw: np.random.Generator, *, planar: bool = True, base: bool = True) -> dict[str, float]:
    """Keys of a linear limb: every compliance over two decades, tilt, moment transfer."""
    keys = {"geometry.coxa_mm": draw.uniform(0, 100), "geometry.femur_mm": draw.uniform(80, 300),
            "geometry.tibia_mm": draw.uniform(80, 400)}
    for link in ("femur", "tibia") if planar else ("coxa", "femur", "tibia"):
        keys |= {f"link.{link}.axial_mm_per_n": 10 ** draw.uniform(-4, -2),
                 f"link.{link}.bending_mm_per_n": 10 ** draw.uniform(-2.5, -0.5),
                 f"link.{link}.tilt_rad": draw.uniform(-0.5, 0.5)}
        if not planar:
            keys |= {f"link.{link}.lateral_mm_per_n": 10 ** draw.uniform(-2.5, -0.5),
                     f"link.{link}.torsion_rad_per_n_mm": 10 ** draw.uniform(-7, -5)}
    for link in ("femur",) if planar else ("coxa", "femur"):
        keys[f"link.{link}.moment_transfer"] = draw.choice([0.0, 1.0, draw.uniform()])
    for joint in ("femur", "tibia") if planar else ("coxa", "femur", "tibia"):
        keys[f"joint.{joint}.compliance_rad_per_n_mm"] = 10 ** draw.uniform(-6, -4)
    if base:
        keys |= {"base.x_mm_per_n": 10 ** draw.uniform(-4, -2), "base.z_mm_per_n": 10 ** draw.uniform(-4, -2),
                 "base.rotation_rad_per_n_mm": 10 ** draw.uniform(-7, -5)}
    return keys


def geometry(model: Model, theta1_rad: float, theta2_rad: float) -> dict[str, Any]:
    """Vectors of physics.md at true angles: links a, w, unit vectors u1, u2, levers p1, p2 of the joints."""
    def unit(angle: float) -> Any:
        return np.array([np.cos(angle), np.sin(angle)])

    u1, u2 = unit(theta1_rad), unit(theta1_rad - theta2_rad)
    a, w = model["geometry.femur_mm"] * u1, model["geometry.tibia_mm"] * u2
    return {"u1": u1, "u2": u2, "a": a, "w": w, "p1": quarter_turn(a + w), "p2": quarter_turn(w)}


def quarter_turn(v: Any) -> Any:
    """v turned counter-clockwise by 90 degrees."""
    return np.array([-v[1], v[0]])


def symmetric(xx: Any, xz: Any, zz: Any) -> Any:
    """2x2 matrices from their three entries, shape (n, 2, 2)."""
    return np.stack([np.stack([xx, xz], -1), np.stack([xz, zz], -1)], -2)
