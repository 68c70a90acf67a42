"""Random limbs, postures and loads from a seed, within what the reference and the firmware promise figures for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from brace.model import LIMB_KEYS, LimbModel
from brace.native import loaded
from brace.native.loaded import LoadedLimbs

Array = NDArray[np.float64]
LEAST_BUCKLING_FACTOR = 2.0
MOST_OF_REACH = 0.2  # displacement of the tip


@dataclass(frozen=True)
class Case:
    """A limb, its commanded angles, and the loads on it."""

    keys: dict[str, float]
    theta_rad: tuple[float, float, float]  # coxa, femur, tibia; in the plane the first is not used
    force_n: Array  # x, z; in space x, y, z
    gravity: Array  # unit vector: x, y, z


def limb_model(keys: dict[str, float]) -> LimbModel:
    """The same limb for the reference."""
    defaults = {key.name: key.default for key in LIMB_KEYS if key.default is not None}
    return LimbModel(defaults).with_values(dict(keys))


def reference(case: Case, parts: int = 0) -> LoadedLimbs:
    """What the reference says; `parts` as in brace_host.h."""
    model, (theta0, theta1, theta2) = limb_model(case.keys), case.theta_rad
    if len(case.force_n) == 3:
        return loaded.space_under_force(model, (theta0, theta1, theta2), case.force_n, case.gravity, parts)
    direction_rad = np.arctan2(case.gravity[2], case.gravity[0])
    return loaded.under_force(model, theta1, theta2, case.force_n, direction_rad, parts)


def off(k: Array, wanted: Array) -> float:
    """Frobenius, relative."""
    return float(np.linalg.norm(k - wanted) / np.linalg.norm(wanted))


def _limb(draw: np.random.Generator, links: tuple[str, ...]) -> dict[str, float]:
    keys = {
        "geometry.coxa_mm": draw.uniform(20, 100),
        "geometry.femur_mm": draw.uniform(80, 300),
        "geometry.tibia_mm": draw.uniform(80, 400),
        "base.x_mm_per_n": 10 ** draw.uniform(-4, -2),
        "base.z_mm_per_n": 10 ** draw.uniform(-4, -2),
        "base.rotation_rad_per_n_mm": 10 ** draw.uniform(-7, -5),
    }
    for link in links:
        keys |= {
            f"link.{link}.axial_mm_per_n": 10 ** draw.uniform(-4, -2),
            f"link.{link}.bending_mm_per_n": 10 ** draw.uniform(-2.5, -0.5),
            f"link.{link}.tilt_rad": draw.choice([0.0, draw.uniform(-0.4, 0.4)]),
            f"link.{link}.moment_transfer": draw.choice([0.0, 1.0, draw.uniform()]),
            f"joint.{link}.compliance_rad_per_n_mm": 10 ** draw.uniform(-6, -4.5),
        }
        if len(links) == 3:
            keys |= {
                f"link.{link}.lateral_mm_per_n": 10 ** draw.uniform(-2.5, -0.5),
                f"link.{link}.torsion_rad_per_n_mm": 10 ** draw.uniform(-7, -5.5),
            }
    if draw.uniform() < 0.5:
        keys |= {f"gravity.{part}_n": draw.uniform(0, 4) for part in ("femur", "tibia", "knee")}
    return {key: float(value) for key, value in keys.items()}


def _draw(draw: np.random.Generator, in_space: bool) -> Case:
    links = ("coxa", "femur", "tibia") if in_space else ("femur", "tibia")
    force_n = draw.normal(size=3 if in_space else 2)
    force_n *= draw.uniform(1.0, 25.0) / np.linalg.norm(force_n)
    gravity = draw.normal(size=3) * (1.0, float(in_space), 1.0)
    theta_rad = (draw.uniform(-3, 3) if in_space else 0.0, draw.uniform(-3, 3), draw.uniform(-2.8, 2.8))
    return Case(_limb(draw, links), theta_rad, force_n, gravity / np.linalg.norm(gravity))


def within_promise(case: Case, found: LoadedLimbs) -> bool:
    """Whether figures are promised for this load."""
    reach_mm = case.keys["geometry.femur_mm"] + case.keys["geometry.tibia_mm"]
    return bool(
        found.status[0] == 0
        and found["buckling_factor"][0] >= LEAST_BUCKLING_FACTOR
        and np.linalg.norm(found.displacement_mm[0]) <= MOST_OF_REACH * reach_mm
    )


def random_cases(
    seed: int, count: int, *, in_space: bool, answer: Callable[[Case], LoadedLimbs] = reference
) -> Iterator[Case]:
    """So many cases within the promise. The reference chooses; what it chooses is judged by the engine."""
    draw = np.random.default_rng(seed)
    while count:
        case = _draw(draw, in_space)
        if within_promise(case, answer(case)):
            count -= 1
            yield case


def pressed_cases(seed: int, count: int, *, in_space: bool) -> Iterator[tuple[Case, LoadedLimbs]]:
    """So many limbs pressed inward with a buckling factor of at least 2, and what the reference says of them. The force
    points from the tip to the base, up to 60 degrees aside, with 1 to 200 N. How far the tip moves does not choose."""
    draw = np.random.default_rng(seed)
    while count:
        case = _draw(draw, in_space)
        femur_mm, tibia_mm = case.keys["geometry.femur_mm"], case.keys["geometry.tibia_mm"]
        theta0, theta1, theta2 = case.theta_rad
        tip = femur_mm * np.exp(1j * theta1) + tibia_mm * np.exp(1j * (theta1 - theta2))
        inward = -tip / abs(tip) * np.exp(1j * draw.uniform(-1.05, 1.05)) * 10 ** draw.uniform(0.0, 2.3)
        aside = draw.uniform(-1.05, 1.05) if in_space else 0.0
        along, across, up = inward.real * np.cos(aside), abs(inward) * np.sin(aside), inward.imag * np.cos(aside)
        yawed = (along + 1j * across) * np.exp(1j * theta0)
        force_n = np.array([yawed.real, yawed.imag, up] if in_space else [along, up])
        pressed = Case(case.keys, case.theta_rad, force_n, case.gravity)
        found = reference(pressed)
        if found.status[0] == 0 and found["buckling_factor"][0] >= LEAST_BUCKLING_FACTOR:
            count -= 1
            yield pressed, found


def moved_of_reach(case: Case, found: LoadedLimbs) -> float:
    """How far the tip moves, over the lengths of femur and tibia."""
    reach_mm = case.keys["geometry.femur_mm"] + case.keys["geometry.tibia_mm"]
    return float(np.linalg.norm(found.displacement_mm[0])) / reach_mm
