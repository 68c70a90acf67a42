"""A limb of limb.toml as the engine's chain, from docs/physics.md: joints and base are springs, a beam is rigid
segments with hinges between them.

Keys that begin with `outside.` are of limbs that limb.toml does not describe: a bowed tibia, a knee axis beside the
femur's line, a point for a cable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from engine_chain import Array, Chain

_Y = np.array([0.0, 1.0, 0.0])
_TURN_UP = np.array([0.0, -1.0, 0.0])  # from x towards z


@dataclass(frozen=True)
class EngineLimb:
    """A compiled limb: in the plane frame of its commanded posture, origin on the femur axis."""

    model: mujoco.MjModel
    weights: tuple[tuple[int, float], ...]  # body, N
    tip_body: int


@dataclass(frozen=True)
class Hinges:
    """Where along a beam (0 to 1) its hinges are, and which share of the beam's turn under a moment each takes."""

    at: Array
    share: Array


def equal_segments(count: int) -> Hinges:
    """Hinges in the middle of equal segments. They bend as the beam does when each is a little softer: the sum of
    (1 - x)^2 is 1/3."""
    share = 1.0 / count / (1.0 - 0.25 / count**2)
    return Hinges((np.arange(count) + 0.5) / count, np.full(count, share))


def engine_limb(
    keys: Mapping[str, float], theta1_rad: float, theta2_rad: float, segments: int | Hinges, *, in_space: bool = False
) -> EngineLimb:
    """Keys of limb.toml; those that are missing have no effect. In space the limb has its coxa, and yields across.
    segments: hinges along each beam, or how many equal segments it has."""
    limb = _Builder(keys, equal_segments(segments) if isinstance(segments, int) else segments, in_space)
    tip = limb.build(theta1_rad, theta2_rad)
    model = limb.chain.compiled(tip)
    weights = tuple((int(model.body(name).id), weight) for name, weight in limb.chain.weights)
    return EngineLimb(model, weights, int(model.body("tip").id))


def _towards(angle_rad: float) -> Array:
    return np.array([np.cos(angle_rad), 0.0, np.sin(angle_rad)])


class _Builder:
    def __init__(self, keys: Mapping[str, float], hinges: Hinges, in_space: bool) -> None:
        self.chain = Chain()
        self._keys = keys
        self._hinges = hinges
        self._in_space = in_space

    def _value(self, key: str) -> float:
        return float(self._keys.get(key, 0.0))

    def build(self, theta1_rad: float, theta2_rad: float) -> Array:
        """Fills the chain; the tip's place at no deflection."""
        chain, value, origin = self.chain, self._value, np.zeros(3)
        chain.slide(np.array([1.0, 0.0, 0.0]), value("base.x_mm_per_n"))
        chain.slide(np.array([0.0, 0.0, 1.0]), value("base.z_mm_per_n"))
        chain.hinge(origin, _TURN_UP, value("base.rotation_rad_per_n_mm"))
        if self._in_space:
            yaw_axis = np.array([-value("geometry.coxa_mm"), 0.0, 0.0])
            chain.hinge(yaw_axis, np.array([0.0, 0.0, 1.0]), value("joint.coxa.compliance_rad_per_n_mm"), "coxa")
            self._link("coxa", yaw_axis, 0.0)
        chain.hinge(origin, _TURN_UP, value("joint.femur.compliance_rad_per_n_mm"), "femur")
        knee = self._link("femur", origin, theta1_rad)
        knee = knee + value("outside.knee_offset_mm") * np.cross(_towards(theta1_rad), _Y)
        chain.weight(knee, value("gravity.knee_n"))
        chain.hinge(knee, _TURN_UP, value("joint.tibia.compliance_rad_per_n_mm"), "tibia")
        return self._link("tibia", knee, theta1_rad - theta2_rad)

    def _link(self, name: str, start: Array, angle_rad: float) -> Array:
        """Adds a link; the place of its end."""
        chain = self.chain
        length_mm = self._value(f"geometry.{name}_mm")
        axial, bending, tilt_rad, lateral, torsion, strength = (
            self._value(f"link.{name}.{key}")
            for key in (
                "axial_mm_per_n", "bending_mm_per_n", "tilt_rad", "lateral_mm_per_n", "torsion_rad_per_n_mm",
                "moment_transfer",
            )
        )  # fmt: skip
        if not self._in_space:
            lateral = torsion = 0.0
        line, elastic = _towards(angle_rad), _towards(angle_rad + tilt_rad)
        sideways = np.cross(line, _Y)
        end = start + length_mm * line
        weight_n = self._value(f"gravity.{name}_n")
        middle = start + 0.5 * length_mm * line

        chain.slide(elastic, strength * axial)
        shares = strength * self._hinges.share
        bow_mm = self._value(f"outside.{name}_bow_mm")
        for number, (at, share) in enumerate(zip(self._hinges.at, shares, strict=True) if strength > 0.0 else ()):
            to_end, side = length_mm * (1.0 - at), 4.0 * bow_mm * at * (1.0 - at) * sideways
            turns = [
                (end - to_end * elastic + side, _TURN_UP, 3.0 * share * bending / length_mm**2),
                (end - to_end * line, sideways, 3.0 * share * lateral / length_mm**2),
                (end, line, strength * torsion / len(shares)),
            ]
            for turn in turns if number % 2 == 0 else reversed(turns):  # they do not commute: no order leads
                chain.hinge(*turn)
            chain.weight(end - to_end * line, strength * weight_n / len(shares))
            if 2 * (number + 1) in (len(shares), len(shares) + 1):
                chain.weight(middle, (1.0 - strength) * weight_n)
        if strength == 0.0:
            chain.weight(middle, weight_n)
        if self._value(f"outside.{name}_cable_at") > 0.0:
            chain.point(start + self._value(f"outside.{name}_cable_at") * length_mm * line, "cable")
        chain.slide(elastic, (1.0 - strength) * axial)
        chain.slide(np.cross(elastic, _Y), (1.0 - strength) * bending)
        chain.slide(_Y, (1.0 - strength) * lateral)
        chain.hinge(end, line, (1.0 - strength) * torsion)
        return end
