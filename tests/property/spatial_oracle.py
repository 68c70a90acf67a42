"""K of a limb in space, in double precision, summed from three-dimensional levers; shares nothing with the firmware.

Every source is a direction in which the tip moves: a joint spring or a link's torsion turns the tip about an axis, a
bending link moves it across and turns it about (link x bending direction). Frame: the limb's plane is x-z, then the
whole is turned by theta0 about z. Formulas: docs/physics.md.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planar_oracle import Limb, Link

Reals = NDArray[np.float64]
Y = np.array([0.0, 1.0, 0.0])
Z = np.array([0.0, 0.0, 1.0])


@dataclass
class Spatial:
    """K [N/mm] (n, 3, 3), eigenvalues ascending [N/mm] (n, 3)."""

    k: Reals
    eigenvalues: Reals


def _exact(value: float) -> float:
    return float(np.float32(value))


def _along(angle: Reals) -> Reals:
    """Unit vectors in the plane, (n, 3)."""
    return np.stack([np.cos(angle), np.zeros_like(angle), np.sin(angle)], -1)


def _dyad(a: Reals, b: Reals) -> Reals:
    product = a[..., :, None] * b[..., None, :]
    return (product + np.swapaxes(product, -1, -2)) / 2


def _turning(compliance: float, axis: Reals, arm: Reals) -> Reals:
    """A rotational compliance [rad/(N mm)] about an axis, arm [mm] from it to the tip."""
    lever = np.cross(axis, arm)
    return _exact(compliance) * _dyad(lever, lever)


def _bending(compliance: float, transfer: float, length_mm: float, link: Reals, across: Reals, arm: Reals) -> Reals:
    """A uniform beam's end, bending towards `across`, with the tip at `arm` beyond it."""
    b, k = _exact(compliance), _exact(transfer)
    total = b * _dyad(across, across)
    if k > 0:
        normal = np.cross(link, across)
        lever = np.cross(normal / np.linalg.norm(normal, axis=-1, keepdims=True), arm)
        total = total + 3 * b * k / length_mm * _dyad(across, lever) + 3 * b * k / length_mm**2 * _dyad(lever, lever)
    return total


def _link(link: Link, length_mm: float, angle: Reals, arm: Reals, transfer: float) -> Reals:
    tilted = angle + _exact(link.tilt)
    own = _along(angle)
    return (_exact(link.axial) * _dyad(_along(tilted), _along(tilted))
            + _bending(link.bending, transfer, length_mm, own, _along(tilted + np.pi / 2), arm)
            + _bending(link.lateral, transfer, length_mm, own, np.broadcast_to(Y, own.shape), arm)
            + _turning(link.torsion, own, arm))


def spatial(limb: Limb, theta0: Reals, theta1: Reals, theta2: Reals) -> Spatial:
    """The oracle at postures [rad], shape (n,)."""
    coxa, femur, tibia = (_exact(v) for v in (limb.coxa_mm, limb.femur_mm, limb.tibia_mm))
    shank = tibia * _along(theta1 - theta2)
    tip = femur * _along(theta1) + shank
    from_yaw = tip + np.array([coxa, 0.0, 0.0])
    level = np.zeros_like(theta1)
    joints = limb.joints
    c = (_turning(joints[0], Z, from_yaw) + _turning(joints[1], Y, tip) + _turning(joints[2], Y, shank)
         + _turning(limb.base_rotation, Y, tip)
         + _link(limb.coxa, coxa, level, tip, limb.coxa.moment_transfer if coxa > 0 else 0.0)
         + _link(limb.femur, femur, theta1, shank, limb.femur.moment_transfer)
         + _link(limb.tibia, tibia, theta1 - theta2, np.zeros_like(tip), 0.0)
         + np.diag([_exact(limb.base_x), 0.0, _exact(limb.base_z)]))
    turn = np.zeros_like(c)
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(theta0)
    turn[:, 1, 0] = np.sin(theta0)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    values, vectors = np.linalg.eigh(turn @ c @ np.swapaxes(turn, -1, -2))
    k = (vectors / values[:, None, :]) @ np.swapaxes(vectors, -1, -2)
    return Spatial(k, 1.0 / values[:, ::-1])
