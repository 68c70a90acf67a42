"""The identified limb along the paper's test: tip moved outwards at one height; curves and three drawn postures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.plots.limb_plot import PosedLimb
from brace.stiffness.at_rest import PlanarLimb, planar_limb


@dataclass(frozen=True)
class Curve:
    """Eigenvalues of K [N/mm] by the firmware over r [mm]."""

    r_mm: np.ndarray
    largest: np.ndarray
    smallest: np.ndarray


def curve(model: LimbModel, height_mm: float, r_mm: np.ndarray) -> Curve:
    """The limb with its tip at one height and at distances r [mm]."""
    limb = planar_limb(model)
    angles = np.array([limb.posture(float(r), float(np.arcsin(height_mm / r)), "up") for r in r_mm])
    k = limb.stiffness(angles[:, 0], angles[:, 1])
    return Curve(r_mm, k["lambda_max_n_per_mm"].astype(float), k["lambda_min_n_per_mm"].astype(float))


def reach(model: LimbModel, height_mm: float, count: int) -> np.ndarray:
    """r [mm] from nearly folded to nearly straight, never below the tip's height."""
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    return np.linspace(max(abs(femur - tibia), abs(height_mm)) + 4.0, femur + tibia - 1.0, count)


def points_mm(model: LimbModel, theta1_rad: float, theta2_rad: float) -> np.ndarray:
    """3 x 2: femur axis, knee, tip [mm]."""
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    knee = femur * np.array([np.cos(theta1_rad), np.sin(theta1_rad)])
    shank = theta1_rad - theta2_rad
    return np.array([[0.0, 0.0], knee, knee + tibia * np.array([np.cos(shank), np.sin(shank)])])


def posed_limb(model: LimbModel, limb: PlanarLimb, r_mm: float, height_mm: float) -> PosedLimb:
    """The limb with its tip at (r, height), and the ellipses of its links and of the whole."""
    theta1, theta2 = limb.posture(r_mm, float(np.arcsin(height_mm / r_mm)), "up")
    entry = limb.stiffness(np.array([theta1]), np.array([theta2]))[0]
    whole = np.array([[entry["c_xx_mm_per_n"], entry["c_xz_mm_per_n"]],
                      [entry["c_xz_mm_per_n"], entry["c_zz_mm_per_n"]]], dtype=float)
    title = (f"r = {r_mm:.0f} mm, knee {np.degrees(theta2):.0f} deg\n"
             f"K: {entry['lambda_min_n_per_mm']:.2f} and {entry['lambda_max_n_per_mm']:.1f} N/mm")
    return PosedLimb(title, points_mm(model, theta1, theta2), _link_ellipse(model, "femur", theta1),
                     _link_ellipse(model, "tibia", theta1 - theta2), whole)


def _link_ellipse(model: LimbModel, link: str, direction_rad: float) -> np.ndarray:
    """The link's compliance ellipsoid in the limb's plane, 2 x 2 [mm/N]."""
    angle = direction_rad + model.number(f"link.{link}.tilt_rad")
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    principal = [model.number(f"link.{link}.axial_mm_per_n"), model.number(f"link.{link}.bending_mm_per_n")]
    ellipse: np.ndarray = turn @ np.diag(principal) @ turn.T
    return ellipse
