"""Limbs of coxa, femur and tibia for the judge of a body on its limbs: places, levers and compliance of all at once.

Written for this judge alone, from docs/physics.md; it shares no code with tools/ or firmware/. Arrays have the limb as
their first axis. A limb's frame: x outwards at yaw 0, y left, z up; origin on the yaw's axis at the femur's height.
Lengths mm, forces N, angles rad, torques N mm.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
HINGES = [0, 1, 5]  # yaw, femur, knee among the coordinates; the rest slide: end of the femur 2-4, of the tibia 6-8
# The torque that closes a play. A play without any friction of its own has no rest under a leg that presses: it snaps
# from one flank to the other. 30 N mm are 0.2 N at a tip 150 mm away: less than the sensors' noise or a gear's friction
CLOSING_N_MM = 30.0


@dataclass(frozen=True)
class Limbs:
    """n limbs. Angles are coxa, femur, tibia; a link's compliances are along it, across its plane, within its plane."""

    length_mm: Array  # (n, 3)
    theta_rad: Array  # (n, 3): where the joints' springs rest
    joint_rad_per_n_mm: Array  # (n, 3)
    link_mm_per_n: Array  # (n, 2, 3): femur, tibia
    gap_rad: Array  # (n, 3): full play

    def take(self, which: list[int]) -> Limbs:
        return replace(self, **{name: value[which] for name, value in vars(self).items()})


def cross(a: Array, b: Array) -> Array:
    """a x b along the last axis; numpy's own takes four times as long for so few."""
    i, j = [1, 2, 0], [2, 0, 1]
    return a[..., i] * b[..., j] - a[..., j] * b[..., i]


def _chain(limbs: Limbs, moved: Array) -> tuple[Array, Array, Array, Array]:
    """Tips (n, 3); for each of 9 coordinates its direction, its hinge's place and the tip's lever (n, 9, 3)."""
    n = len(limbs.length_mm)
    coxa, femur, tibia = limbs.length_mm.T[:, :, None]
    yaw, pitch, knee = (limbs.theta_rad + moved[:, HINGES]).T[:, :, None]
    out = np.concatenate([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=1)
    left = np.concatenate([-np.sin(yaw), np.cos(yaw), 0 * yaw], axis=1)
    frames = []
    for angle in (pitch, pitch - knee):
        along, bends = np.cos(angle) * out + np.sin(angle) * UP, np.cos(angle) * UP - np.sin(angle) * out
        frames.append(np.stack([along, left, bends], axis=1))
    hip = coxa * out
    knee_mm = hip + femur * frames[0][:, 0] + np.einsum("ni,nik->nk", moved[:, 2:5], frames[0])
    tip = knee_mm + tibia * frames[1][:, 0] + np.einsum("ni,nik->nk", moved[:, 6:9], frames[1])
    up = np.broadcast_to(UP, (n, 3))
    direction = np.stack([up, -left, *frames[0].transpose(1, 0, 2), left, *frames[1].transpose(1, 0, 2)], axis=1)
    place = np.zeros((n, 9, 3))
    place[:, 1], place[:, 5] = hip, knee_mm
    lever = direction.copy()
    lever[:, HINGES] = cross(direction[:, HINGES], tip[:, None] - place[:, HINGES])
    return tip, direction, place, lever


def levers(limbs: Limbs, moved: Array) -> Array:
    """(n, 3, 3): how yaw, femur and knee move the tips, at coordinates `moved` (n, 9)."""
    return _chain(limbs, moved)[3][:, HINGES]


def _springs(limbs: Limbs, load: Array) -> tuple[Array, Array, Array]:
    """How far each coordinate's spring gives way under its load, its compliance there, and the ratio (its secant).

    A play gives way at CLOSING_N_MM.
    """
    compliance = np.empty_like(load)
    compliance[:, HINGES] = limbs.joint_rad_per_n_mm
    compliance[:, 2:5], compliance[:, 6:9] = limbs.link_mm_per_n[:, 0], limbs.link_mm_per_n[:, 1]
    half = np.zeros_like(load)
    half[:, HINGES] = limbs.gap_rad / 2
    size = np.maximum(np.abs(load), CLOSING_N_MM)
    is_open = np.abs(load) < CLOSING_N_MM
    secant = compliance + half / size
    return secant * load, np.where(is_open, secant, compliance), secant


def small(limbs: Limbs, force_n: Array, secant: bool = False) -> tuple[Array, Array]:
    """The small-displacement limb under its foot's force (n, 3), levers as at rest: tips (n, 3) [mm], C (n, 3, 3)
    [mm/N].

    With `secant` C is that of springs through their rest, which overstates how a play gives way and never understates
    it.
"""
    tip, _, _, lever = _chain(limbs, np.zeros((len(limbs.length_mm), 9)))
    gives, *compliances = _springs(limbs, np.einsum("nic,nc->ni", lever, force_n))
    compliance = compliances[secant]
    return tip + np.einsum("nic,ni->nc", lever, gives), np.einsum("nic,ni,nid->ncd", lever, compliance, lever)


def compliance(limbs: Limbs) -> Array:
    """C (n, 3, 3) [mm/N] at the springs' rest, every play closed."""
    return small(replace(limbs, gap_rad=0 * limbs.gap_rad), np.zeros_like(limbs.length_mm))[1]


def _geometric(direction: Array, place: Array, tip: Array, force: Array) -> Array:
    """Second derivative of force times tip in the coordinates (n, 9, 9)."""
    second = direction.copy()
    second[:, HINGES] = cross(direction[:, HINGES], tip[:, None] - place[:, HINGES])
    turns = np.zeros_like(direction)
    turns[:, HINGES] = cross(force[:, None], direction[:, HINGES])
    upper = np.triu(np.einsum("nik,njk->nij", turns, second))
    whole: Array = upper + np.triu(upper, 1).transpose(0, 2, 1)
    return whole


def loaded(limbs: Limbs, force_n: Array, start: Array, secant: bool = False) -> tuple[Array, Array, Array]:
    """Equilibrium of springs and force at any deflection: tips (n, 3), C there (n, 3, 3), and the coordinates (n, 9).

    force_n (n, 3) is the ground's force on each tip, in the limb's frame. Newton's steps begin at `start`.
    ArithmeticError where they do not come to rest.
    """
    moved = start.copy()
    for _ in range(80):
        tip, direction, place, lever = _chain(limbs, moved)
        gives, compliance, overstated = _springs(limbs, np.einsum("nic,nc->ni", lever, force_n))
        # Solved for deflections, not loads: an open play's spring is too soft to carry a Newton step of loads.
        slope = np.eye(9) - compliance[:, :, None] * _geometric(direction, place, tip, force_n)
        step = np.linalg.solve(slope, (gives - moved)[..., None])[..., 0]
        if np.abs(step).max() < 1e-11:
            if secant:
                compliance = overstated
                slope = np.eye(9) - compliance[:, :, None] * _geometric(direction, place, tip, force_n)
            springs = np.linalg.solve(slope, compliance[:, :, None] * np.eye(9))
            return tip, np.einsum("nic,nij,njd->ncd", lever, springs, lever), moved
        moved = moved + step * np.minimum(1.0, 0.3 / np.abs(step[:, HINGES]).max(axis=1, initial=1e-30))[:, None]
    raise ArithmeticError("a limb found no rest under its foot's force; its load may be beyond what its springs bear")
