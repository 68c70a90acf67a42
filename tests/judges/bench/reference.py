"""K in double precision by the plain sum C = sum T' S T of docs/physics.md; shares nothing with the core.

Written for the bench alone: every source of compliance is a 6-vector wrench map in space, and the planar limb is
the same sum restricted to x and z. Arrays are (n, ...) over postures.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from postures import Limb, Link

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Planar:
    """K [N/mm] (n, 2, 2), eigenvalues ascending [N/mm] (n, 2), stiff axis [rad] (n,)."""

    k: Array
    eigenvalues: Array
    axis_rad: Array


@dataclass(frozen=True)
class Spatial:
    """K [N/mm] (n, 3, 3), eigenvalues ascending (n, 3), unit stiff axis (n, 3)."""

    k: Array
    eigenvalues: Array
    axis: Array


def _f(value: float) -> float:
    """The parameter as the float32 the images are given."""
    return float(np.float32(value))


def _rotation(angle: Array) -> Array:
    """Rotation in the plane from a link's frame to the limb's, (n, 2, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)


def _link_in_plane(link: Link, length: float, angle: Array, arm: Array) -> Array:
    """Compliance (n, 2, 2) a link adds at the tip; arm: far end of the link to the tip [mm] (n, 2)."""
    turn = _rotation(angle + _f(link.tilt_rad))
    axial, bending = _f(link.axial_mm_per_n), _f(link.bending_mm_per_n)
    force = np.swapaxes(turn, -1, -2)
    total = np.swapaxes(force, -1, -2) @ np.diag([axial, bending]) @ force
    kappa = _f(link.moment_transfer)
    if kappa > 0.0:
        moment = np.stack([-arm[:, 1], arm[:, 0]], -1)
        across = turn[:, :, 1]
        coupling = across[:, :, None] * moment[:, None, :]
        total = total + 1.5 * bending * kappa / length * (coupling + np.swapaxes(coupling, -1, -2))
        total = total + 3.0 * bending * kappa / length**2 * moment[:, :, None] * moment[:, None, :]
    return total


def _spring(compliance: float, arm: Array) -> Array:
    lever = np.stack([-arm[:, 1], arm[:, 0]], -1)
    return _f(compliance) * lever[:, :, None] * lever[:, None, :]


def _plane(limb: Limb, theta1: Array, theta2: Array, with_coxa: bool) -> tuple[Array, Array]:
    """C in the limb's plane (n, 2, 2) and the tip from the femur axis (n, 2) [mm]."""
    knee_to_tip = _f(limb.tibia_mm) * np.stack([np.cos(theta1 - theta2), np.sin(theta1 - theta2)], -1)
    tip = _f(limb.femur_mm) * np.stack([np.cos(theta1), np.sin(theta1)], -1) + knee_to_tip
    c = _link_in_plane(limb.femur, _f(limb.femur_mm), theta1, knee_to_tip)
    c = c + _link_in_plane(limb.tibia, _f(limb.tibia_mm), theta1 - theta2, np.zeros_like(tip))
    c = c + _spring(limb.joint_rad_per_n_mm[1], tip) + _spring(limb.joint_rad_per_n_mm[2], knee_to_tip)
    c = c + np.diag([_f(limb.base_mm_per_n[0]), _f(limb.base_mm_per_n[1])])
    if with_coxa:
        c = c + _link_in_plane(limb.coxa, _f(limb.coxa_mm), np.zeros_like(theta1), tip)
    return c, tip


def planar(limb: Limb, theta1: Array, theta2: Array) -> Planar:
    """K of the limb in its plane."""
    c, _ = _plane(limb, theta1, theta2, with_coxa=False)
    k = np.linalg.inv(c)
    values, vectors = np.linalg.eigh(k)
    stiff = vectors[:, :, 1]
    axis_rad = np.arctan(stiff[:, 1] / stiff[:, 0])
    return Planar(k, values, axis_rad)


def _out_of_plane(limb: Limb, theta2: Array, theta1: Array, tip: Array) -> Array:
    """The compliance across the limb's plane [mm/N] (n,), limb frame."""
    def beam(link: Link, length: float, reach: Array) -> Array:
        lateral, kappa = _f(link.lateral_mm_per_n), _f(link.moment_transfer)
        return lateral * (1.0 + 3.0 * kappa / length * reach + 3.0 * kappa / length**2 * reach**2)

    tibia = _f(limb.tibia_mm)
    across, along = tibia * np.sin(theta2), tibia * np.cos(theta2)
    coxa, femur = _f(limb.coxa_mm), _f(limb.femur_mm)
    return (_f(limb.joint_rad_per_n_mm[0]) * (coxa + tip[:, 0]) ** 2
            + beam(limb.coxa, coxa, tip[:, 0]) + _f(limb.coxa.torsion_rad_per_n_mm) * tip[:, 1] ** 2
            + beam(limb.femur, femur, along) + _f(limb.femur.torsion_rad_per_n_mm) * across**2
            + _f(limb.tibia.lateral_mm_per_n))


def spatial(limb: Limb, theta0: Array, theta1: Array, theta2: Array) -> Spatial:
    """K of the limb in space; x, y, z of the robot's base."""
    plane, tip = _plane(limb, theta1, theta2, with_coxa=True)
    c = np.zeros((len(theta1), 3, 3))
    c[:, 0, 0], c[:, 0, 2], c[:, 2, 0], c[:, 2, 2] = plane[:, 0, 0], plane[:, 0, 1], plane[:, 1, 0], plane[:, 1, 1]
    c[:, 1, 1] = _out_of_plane(limb, theta2, theta1, tip)
    turn = np.zeros_like(c)
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(theta0)
    turn[:, 1, 0], turn[:, 0, 1] = np.sin(theta0), -np.sin(theta0)
    turn[:, 2, 2] = 1.0
    k = turn @ np.linalg.inv(c) @ np.swapaxes(turn, -1, -2)
    values, vectors = np.linalg.eigh(k)
    return Spatial(k, values, vectors[:, :, 2])
