"""Which play a load takes up, by the function that a controller uses (brace/play.h), and K with the other gaps open."""

from __future__ import annotations

import math
from dataclasses import dataclass

from brace.model import LimbModel
from brace.native import library
from brace.native.limb import firmware_limb, status_text
from brace.stiffness import PLANAR_C, PLANAR_K, PLANAR_REST, PostureError
from brace.stiffness_under_load import LoadedLimb

JOINTS = ("femur", "tibia")


@dataclass(frozen=True)
class Play:
    """The joints that the load holds, each with its side, +1 or -1; those whose gap is open; K of now, with its flags;
    K once all is taken up."""

    held: dict[str, int]
    open: tuple[str, ...]
    now: dict[str, float]
    engaged: dict[str, float]


def play_under_load(
    model: LimbModel, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float, arithmetic: str = "f32"
) -> Play | None:
    """At commanded true angles. A joint that is held stands half its gap off. None: no joint of the plane has play.
    Raises PostureError where there is no rest."""
    gaps_rad = {joint: model.number(f"joint.{joint}.gap_rad") for joint in JOINTS}
    if not any(gaps_rad.values()):
        return None
    limb = LoadedLimb(model, arithmetic)
    held = _once(model, limb, (theta1_rad, theta2_rad), gaps_rad, (fx_n, fz_n)).held
    stands = [
        angle - 0.5 * held.get(joint, 0) * gaps_rad[joint]
        for joint, angle in zip(JOINTS, (theta1_rad, theta2_rad), strict=True)
    ]
    return _once(model, limb, (stands[0], stands[1]), gaps_rad, (fx_n, fz_n))


def put_into(values: dict[str, float], play: Play) -> None:
    """K of now and its flags in place of K with every gap closed; C is its inverse, NaN where a gap is open."""
    values |= {**play.now, "flags": int(values["flags"]) | int(play.now["flags"])}
    xx, xz, zz = (values[name] for name in PLANAR_K)
    det = xx * zz - xz * xz
    for name, entry in zip(PLANAR_C, (zz, -xz, xx), strict=True):
        values[name] = math.nan if play.open else entry / det


def _once(
    model: LimbModel,
    limb: LoadedLimb,
    theta_rad: tuple[float, float],
    gaps_rad: dict[str, float],
    force_n: tuple[float, float],
) -> Play:
    native = library()
    ffi, lib = native.ffi, native.lib
    rest, load, weights = limb.rest_at(theta_rad, force_n)
    joints, flank = ffi.new("brace_play_joint_t[2]"), ffi.new("int[2]")
    for joint, name in zip(joints, JOINTS, strict=True):
        joint.coulomb_n_mm = model.number(f"joint.{name}.coulomb_n_mm")
        joint.coulomb_per_load_ratio = model.number(f"joint.{name}.coulomb_per_load_ratio")
        joint.noise_n, joint.gain_rel = model.number("sensor.noise_n"), model.number("uncertainty.gain_rel")
    bits = dict(zip(JOINTS, (lib.BRACE_GAP_FEMUR, lib.BRACE_GAP_TIBIA), strict=True))
    gaps = sum(bits[name] for name in JOINTS if gaps_rad[name] > 0.0)
    found = ffi.new("brace_gap_stiffness_t *")
    status = lib.brace_loaded_play(
        firmware_limb(native, model), weights, *theta_rad, load, rest, joints, gaps, flank, found
    )
    if status:
        raise PostureError(0, status, status_text(native, status))
    held = {name: int(side) for name, side in zip(JOINTS, flank, strict=True) if side}
    names = (*PLANAR_K, *PLANAR_REST)
    told = [{name: float(getattr(k, name)) + 0.0 for name in names} for k in (found.now, found.engaged)]
    assumed = lib.BRACE_FLAG_PLAY_ASSUMED if held else 0
    now = {**told[0], "flags": int(found.now.flags) | assumed}
    return Play(held, tuple(n for n in JOINTS if gaps_rad[n] > 0.0 and n not in held), now, told[1])
