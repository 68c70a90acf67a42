"""K over the whole workspace of the plane: a grid of postures, by the firmware's batch functions."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brace.ground.errors import UsageError
from brace.model import LimbModel
from brace.native import library
from brace.native.limb import firmware_limb, refused_limb
from brace.stiffness.at_rest import E_UNSUPPORTED
from brace.stiffness.names import PLANAR_K, PLANAR_REST
from brace.stiffness.under_load import LOADED_REST, LoadedLimb

COLUMNS = (*PLANAR_K, *PLANAR_REST)
LOADED_COLUMNS = (*PLANAR_K, *LOADED_REST)
BLOCK = 1 << 15  # postures at a time: inputs and outputs stay in the cache
MONOTONE_SLACK = 1e-5  # relative; below the accuracy of K


@dataclass(frozen=True)
class Workspace:
    """Grid of true angles, under a load the commanded ones: theta2 runs over rows, theta1 over columns. `values[name]`
    is rows x columns; NaN where no rest was found."""

    theta1_rad: np.ndarray
    theta2_rad: np.ndarray
    r_mm: np.ndarray  # one per row
    values: dict[str, np.ndarray]
    path: str  # "batch", "general" for a limb that only the compliance chain can serve, "loaded"

    @property
    def count(self) -> int:
        """Number of postures."""
        return int(self.theta1_rad.size * self.theta2_rad.size)

    @property
    def postures_rad(self) -> np.ndarray:
        """A row of theta1 and theta2 for each posture."""
        angles = np.tile(self.theta1_rad, self.theta2_rad.size), np.repeat(self.theta2_rad, self.theta1_rad.size)
        return np.column_stack(angles)

    def band(self, name: str) -> np.ndarray:
        """rows x (low, middle, high) of an eigenvalue over theta1: one line unless the base yields or a load acts. NaN
        where the limb has no K."""
        values = self.values[name]
        middle = values[:, values.shape[1] // 2]
        if not np.isnan(values).any():
            return np.column_stack([values.min(axis=1), middle, values.max(axis=1)])
        low, high = (extreme.reduce(values, axis=1) for extreme in (np.fmin, np.fmax))  # of those that are numbers
        return np.column_stack([low, middle, high])

    @property
    def folded(self) -> int:
        """At how many postures no rest was found."""
        return int(np.isnan(self.values["k_xx_n_per_mm"]).sum())


def compute(
    model: LimbModel,
    postures: int,
    theta1_limits_rad: tuple[float, float],
    theta2_limits_rad: tuple[float, float],
    advance: Callable[[int], None] = lambda _done: None,
    force_n: tuple[float, float] | None = None,
) -> Workspace:
    """K at about `postures` postures, evenly spread over both angles; with a force (x, z) of the ground on the tip, K
    under it and the limb's weight at the rest."""
    rows = max(2, round(math.sqrt(postures)))
    theta2 = np.linspace(*theta2_limits_rad, rows, dtype=np.float32)
    theta1 = np.linspace(*theta1_limits_rad, max(1, math.ceil(postures / rows)), dtype=np.float32)
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    r_mm = np.sqrt((femur - tibia) ** 2 + 4 * femur * tibia * np.cos(theta2.astype(float) / 2) ** 2)
    flat1 = np.tile(theta1, theta2.size)
    flat2 = np.repeat(theta2, theta1.size)
    if force_n is not None:
        values, path = _under_load(model, flat1, flat2, force_n, advance), "loaded"
    else:
        values, path = _evaluate(model, flat1, flat2, advance)
    if path != "loaded" and any(np.isnan(values[name]).any() for name in COLUMNS):
        raise UsageError(
            "some postures have no K",
            where=model.where(),
            why="C has no inverse there",
            next_step="a smaller range of --theta2, or a limb that yields in every direction",
        )
    shaped = {name: column.reshape(theta2.size, theta1.size) for name, column in values.items()}
    return Workspace(theta1, theta2, r_mm, shaped, path)


def turning_points(r_mm: np.ndarray, values: np.ndarray) -> list[float]:
    """The r [mm] at which a curve turns between falling and rising; one or none: quasi-convex or -concave."""
    order = np.argsort(r_mm)
    order = order[np.isfinite(values[order])]
    if not order.size:
        return []
    r, curve = r_mm[order], values[order]
    turns: list[float] = []
    direction, extreme, at = 0, curve[0], r[0]
    for radius, value in zip(r, curve):
        step = value - extreme
        if abs(step) <= MONOTONE_SLACK * abs(extreme):
            continue
        way = 1 if step > 0 else -1
        if direction and way != direction:
            turns.append(float(at))
        direction, extreme, at = way, value, radius
    return turns


def _under_load(
    model: LimbModel,
    theta1: np.ndarray,
    theta2: np.ndarray,
    force_n: tuple[float, float],
    advance: Callable[[int], None],
) -> dict[str, np.ndarray]:
    limb = LoadedLimb(model)
    out = {name: np.empty(theta1.size, np.float32) for name in LOADED_COLUMNS}
    for first in range(0, theta1.size, BLOCK):
        last = min(first + BLOCK, theta1.size)
        forces = (np.full(last - first, component, np.float32) for component in force_n)
        found = limb.stiffness(theta1[first:last], theta2[first:last], *forces)
        for name in LOADED_COLUMNS:
            out[name][first:last] = found[name]
        advance(last)
    folded = int(np.isnan(out["k_xx_n_per_mm"]).sum())
    if 2 * folded > theta1.size:
        raise UsageError(
            f"{folded} of {theta1.size} postures have no K under this load",
            where=model.where(),
            why=f"{force_n[0]:g} N along x and {force_n[1]:g} N along z: no rest was found there, the load may fold "
            "the limb; a map needs half of its postures",
            next_step="a smaller --fx and --fz, or leave both out for K without load",
        )
    return out


def _evaluate(
    model: LimbModel, theta1: np.ndarray, theta2: np.ndarray, advance: Callable[[int], None]
) -> tuple[dict[str, np.ndarray], str]:
    native = library()
    ffi, lib = native.ffi, native.lib
    limb = firmware_limb(native, model)
    planar, chain = ffi.new("brace_planar_t *"), ffi.new("brace_chain_t *")
    status = lib.brace_limb_check(limb) or lib.brace_planar_collapse(limb, planar)
    path = "general" if status == E_UNSUPPORTED else "batch"
    if path == "general":
        status = lib.brace_chain_build(limb, chain)
    if status:
        raise refused_limb(native, model, status)
    out = {name: np.empty(theta1.size, np.float32) for name in COLUMNS}
    soa = ffi.new("brace_stiffness_soa_t *")
    for first in range(0, theta1.size, BLOCK):
        last = min(first + BLOCK, theta1.size)
        pointers = [ffi.from_buffer("float[]", out[name][first:last]) for name in COLUMNS]
        for name, pointer in zip(COLUMNS, pointers):
            setattr(soa, name, pointer)
        angles = [ffi.from_buffer("float[]", angle[first:last]) for angle in (theta1, theta2)]
        if path == "batch":
            lib.brace_planar_batch(planar, last - first, *angles, soa)
        else:
            lib.brace_chain_batch(chain, last - first, *angles, soa, ffi.NULL, ffi.NULL)
        advance(last)
    return out, path
