"""K under load of the firmware's core against the reference, and against the physics engine itself, over random limbs,
postures, weights and loads."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from brace.native.c_data import CData
from brace.native.loader import library
from cases import Array, Case, off, random_cases, reference

LINKS = ("coxa", "femur", "tibia")


def core_limb(case: Case) -> tuple[CData, CData, CData]:
    """brace_loaded_t of the limb, and the load: ffi objects that have to be kept."""
    ffi, lib = library().ffi, library().lib
    limb, weights = ffi.new("brace_limb_t *"), ffi.new("brace_gravity_t *")
    limb.femur_mm, limb.tibia_mm = case.keys["geometry.femur_mm"], case.keys["geometry.tibia_mm"]
    for name in ("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm"):
        setattr(limb.base, name, case.keys[f"base.{name}"])
    for index, link in enumerate(LINKS[1:], start=1):
        for name in ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad"):
            setattr(limb.link[index], name, case.keys[f"link.{link}.{name}"])
        limb.link[index].moment_transfer = case.keys[f"link.{link}.moment_transfer"]
        limb.joint[index].compliance_rad_per_n_mm = case.keys[f"joint.{link}.compliance_rad_per_n_mm"]
    for name in ("femur_n", "knee_n", "tibia_n"):
        setattr(weights, name, case.keys.get(f"gravity.{name}", 0.0))
    loaded, load = ffi.new("brace_loaded_t *"), ffi.new("brace_load_t *")
    lib.brace_loaded_collapse(limb, weights, loaded)
    load.tip.x_n, load.tip.z_n = (float(part) for part in case.force_n)
    load.down.x, load.down.z = float(case.gravity[0]), float(case.gravity[2])
    for index, joint in ((1, load.hip), (2, load.knee)):
        joint.yields_by_rad_per_n_mm = joint.slope_rad_per_n_mm = limb.joint[index].compliance_rad_per_n_mm
    return loaded, load, limb


class CoreAnswer(NamedTuple):
    """What the core says of a limb at rest."""

    k_n_per_mm: Array  # (2, 2)
    buckling_factor: float
    displacement_mm: Array  # (2,)


def core_says(case: Case, path: str) -> CoreAnswer | None:
    """path: 'float' or 'fixed'. None: in fixed point a word does not hold a number of this limb."""
    native = library()
    loaded, load, _limb = core_limb(case)
    result = native.ffi.new("brace_loaded_stiffness_t *")
    if path == "fixed":
        fixed = native.ffi.new("brace_loaded_fixed_t *")
        native.lib.brace_loaded_fixed_collapse(loaded, fixed)
        status = native.lib.brace_loaded_fixed_stiffness(fixed, *case.theta_rad[1:], load, result)
    else:
        status = native.lib.brace_loaded_stiffness(loaded, *case.theta_rad[1:], load, result)
    if path == "fixed" and status == native.lib.BRACE_E_SINGULAR:
        return None
    assert status == native.lib.BRACE_OK, (status, case)
    k = result.stiffness
    return CoreAnswer(
        np.array([[k.k_xx_n_per_mm, k.k_xz_n_per_mm], [k.k_xz_n_per_mm, k.k_zz_n_per_mm]]),
        result.buckling_factor,
        np.array([result.displacement.x_mm, result.displacement.z_mm]),
    )


def errors(case: Case, path: str) -> tuple[float, float, float]:
    """Of K (Frobenius norm, relative), the buckling factor (relative; 0 where the reference says 10 and more) and the
    displacement [mm]; NaN where the core refuses the limb."""
    answer, found = core_says(case, path), reference(case)
    if answer is None:
        return np.nan, np.nan, np.nan
    factor = float(found["buckling_factor"][0])
    return (
        off(answer.k_n_per_mm, found.k_n_per_mm[0]),
        abs(answer.buckling_factor / factor - 1.0) if factor < 10.0 else 0.0,
        float(np.linalg.norm(answer.displacement_mm - found.displacement_mm[0])),
    )


def lighter(case: Case) -> Case:
    """A tenth of its force and of its weights."""
    keys = {key: value / 10.0 if key.startswith("gravity.") else value for key, value in case.keys.items()}
    return replace(case, keys=keys, force_n=case.force_n / 10.0)


@pytest.mark.parametrize(("path", "worst"), [("float", 6e-3), ("fixed", 1e-2)])
def test_k_buckling_and_displacement(limbs: int, seed: int, path: str, worst: float) -> None:
    """What brace/loaded.h and brace/loaded_fixed.h promise."""
    found = np.array([errors(case, path) for case in random_cases(seed, 10 * limbs, in_space=False)])
    refused = np.isnan(found[:, 0])
    k, buckling, moved_mm = found[~refused].T
    print(f"{path}, {len(found)} limbs, {np.sum(refused)} refused: K median {np.median(k):.1e}, worst {k.max():.1e}; "
          f"buckling factor worst {buckling.max():.1e}; displacement worst {moved_mm.max():.3f} mm")
    assert np.median(k) <= 5e-4 and k.max() <= worst
    assert buckling.max() <= 0.02
    assert moved_mm.max() <= 0.5
    assert np.mean(refused) <= 1e-3


@pytest.mark.parametrize("path", ["float", "fixed"])
def test_a_tenth_of_the_load(limbs: int, seed: int, path: str) -> None:
    """Force and weight both: near no load K is nearly exact."""
    k = np.array([errors(lighter(case), path)[0] for case in random_cases(seed, 10 * limbs, in_space=False)])
    print(f"{path}, a tenth of the load: K worst {np.nanmax(k):.1e}")
    assert np.nanmax(k) <= 5e-4
    assert np.mean(np.isnan(k)) <= 1e-3


@pytest.mark.parametrize("path", ["float", "fixed"])
@pytest.mark.parametrize(("load", "most"), [("the whole load", 6e-3), ("a tenth of the load", 1e-3)])
def test_k_of_the_engine(limbs: int, seed: int, path: str, load: str, most: float) -> None:
    """The engine's links have 24 segments, the core's are uniform beams. Under a moment 24 segments turn by
    1/(4 24^2) = 4e-4 too much, and a straight limb's K changes by as much again, whatever the load."""
    engine_says = pytest.importorskip("test_loaded_reference", reason="no physics engine").engine_says
    k = []
    for case in random_cases(seed, limbs, in_space=False):
        pressed = lighter(case) if load == "a tenth of the load" else case
        answer = core_says(pressed, path)
        k.append(np.nan if answer is None else off(answer.k_n_per_mm, engine_says(pressed, 24)[2]))
    print(f"{path} against the engine, {limbs} limbs, {load}: K worst {np.nanmax(k):.1e}")
    assert np.nanmax(k) <= most
    assert np.mean(np.isnan(k)) <= 2e-3
