"""K under load of the firmware's core against the reference, over random limbs, postures, weights and loads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from brace.native.c_data import CData
from brace.native.loader import library
from cases import Case, random_cases, reference

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
        limb.link[index].moment_transfer_ratio = case.keys[f"link.{link}.moment_transfer"]
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


def errors(case: Case, path: str = "float") -> tuple[float, float, float]:
    """Of K (Frobenius norm, relative), the buckling factor (relative; 0 where the reference says 10 and more) and the
    displacement [mm]."""
    native = library()
    loaded, load, _limb = core_limb(case)
    result = native.ffi.new("brace_loaded_stiffness_t *")
    if path == "fixed":
        fixed = native.ffi.new("brace_loaded_fixed_t *")
        native.lib.brace_loaded_fixed_collapse(loaded, fixed)
        status = native.lib.brace_loaded_fixed_stiffness(fixed, *case.theta_rad[1:], load, result)
    else:
        status = native.lib.brace_loaded_stiffness(loaded, *case.theta_rad[1:], load, result)
    assert status == 0, (status, case)
    found, k = reference(case), result.stiffness
    got = np.array([[k.k_xx_n_per_mm, k.k_xz_n_per_mm], [k.k_xz_n_per_mm, k.k_zz_n_per_mm]])
    true_k, factor = found.k_n_per_mm[0], float(found["buckling_factor"][0])
    moved = np.array([result.displacement.x_mm, result.displacement.z_mm]) - found.displacement_mm[0]
    return (
        float(np.linalg.norm(got - true_k) / np.linalg.norm(true_k)),
        abs(result.buckling_factor / factor - 1.0) if factor < 10.0 else 0.0,
        float(np.linalg.norm(moved)),
    )


@pytest.mark.parametrize(("path", "worst"), [("float", 6e-3), ("fixed", 1e-2)])
def test_k_buckling_and_displacement(limbs: int, seed: int, path: str, worst: float) -> None:
    """What brace/loaded.h and brace/loaded_fixed.h promise."""
    found = np.array([errors(case, path) for case in random_cases(seed, 10 * limbs, in_space=False)])
    k, buckling, moved_mm = found.T
    print(f"{path}, {len(k)} limbs: K median {np.median(k):.1e}, worst {k.max():.1e}; buckling factor worst "
          f"{buckling.max():.1e}; displacement worst {moved_mm.max():.3f} mm")
    assert np.median(k) <= 5e-4 and k.max() <= worst
    assert buckling.max() <= 0.02
    assert moved_mm.max() <= 0.5


@pytest.mark.parametrize("path", ["float", "fixed"])
def test_a_tenth_of_the_load(limbs: int, seed: int, path: str) -> None:
    """Force and weight both: near no load K is nearly exact."""
    worst = 0.0
    for case in random_cases(seed, 10 * limbs, in_space=False):
        lighter = {key: value / 10.0 if key.startswith("gravity.") else value for key, value in case.keys.items()}
        worst = max(worst, errors(replace(case, keys=lighter, force_n=case.force_n / 10.0), path)[0])
    print(f"{path}, a tenth of the load: K worst {worst:.1e}")
    assert worst <= 5e-4
