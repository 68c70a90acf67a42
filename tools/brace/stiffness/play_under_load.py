"""Which play a load takes up, by the function that a controller uses (brace/play.h), and K with the other gaps open."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.native import library
from brace.native.c_data import CData
from brace.native.limb import firmware_limb, status_text
from brace.params.values import words_of
from brace.stiffness.at_rest import PostureError, spatial_compliance
from brace.stiffness.names import PLANAR_C, PLANAR_K, PLANAR_REST, SPATIAL_C, SPATIAL_K, SPATIAL_REST
from brace.stiffness.in_space_under_load import LoadedLimbInSpace
from brace.stiffness.under_load import LoadedLimb

JOINTS = ("femur", "tibia")
JOINTS_IN_SPACE = ("coxa", *JOINTS)
_NUMBER = {joint: number for number, joint in enumerate(JOINTS_IN_SPACE)}  # BRACE_COXA to BRACE_TIBIA
_ROUNDS = 4  # the sides where joints stand move the limb by less than a degree: the second round nearly always agrees


@dataclass(frozen=True)
class Play:
    """On which side joints stand, +1 or -1, and which of them the load holds there; those held ones that only the load
    says so, which a motor's torque does not prove; those whose gap is open; K of now, with its flags; K once all is
    taken up."""

    stands: dict[str, int]
    held: dict[str, int]
    assumed: tuple[str, ...]
    open: tuple[str, ...]
    now: dict[str, float]
    engaged: dict[str, float]


class _Watched:
    """Joints with what a controller knows of their play and what watches it, as brace_loaded_play wants them."""

    def __init__(self, model: LimbModel, joints: tuple[str, ...]) -> None:
        self.native = library()
        ffi, lib = self.native.ffi, self.native.lib
        words, _ = words_of(model)
        parameters = ffi.new("brace_parameters_t *")
        ffi.memmove(parameters, words, words.itemsize * len(words))
        self.joints = joints
        self.play = ffi.new("brace_play_joint_t[]", len(joints))
        self._kept = [ffi.new("brace_backlash_t *") for _ in joints]
        self.machines = ffi.new("brace_backlash_t *[]", len(joints))
        self.gaps_rad = {joint: model.number(f"joint.{joint}.gap_rad") for joint in joints}
        for index, (joint, machine) in enumerate(zip(joints, self._kept, strict=True)):
            number = _NUMBER[joint]
            watched = ffi.new("brace_backlash_params_t *", lib.brace_play_watched(parameters, number))
            self.play[index] = lib.brace_play_joint(parameters, number)
            is_watched = lib.brace_backlash_init(machine, watched) == 0
            self.machines[index] = machine if is_watched else ffi.NULL

    def settle(self, once: Callable[[tuple[float, ...]], Play]) -> Play:
        """`once` at how far joints stand off their commanded angles, half the gap of each that stands on a side, until
        the sides agree."""
        sides = dict.fromkeys(self.joints, 0)
        for _ in range(_ROUNDS):
            before = sides
            play = once(tuple(-0.5 * sides[joint] * self.gaps_rad[joint] for joint in self.joints))
            sides = play.stands
            if sides == before:
                break
        return play

    def found(self, engaged: CData, now: dict[str, float], whole: dict[str, float]) -> Play:
        """engaged: brace_engagement_t of each joint; whole: K with every gap closed."""
        by_joint = dict(zip(self.joints, engaged, strict=True))
        return Play(
            {name: int(joint.flank) for name, joint in by_joint.items()},
            {name: int(joint.flank) for name, joint in by_joint.items() if joint.is_engaged and joint.flank},
            tuple(name for name, joint in by_joint.items() if joint.is_assumed),
            tuple(name for name, joint in by_joint.items() if not joint.is_engaged),
            now,
            whole,
        )


class PlayUnderLoad:
    """Which play of a limb in its plane a load takes up, as its controller settles at."""

    def __init__(self, model: LimbModel, arithmetic: str = "f32") -> None:
        self._limb, self._watched = LoadedLimb(model, arithmetic), _Watched(model, JOINTS)
        self._firmware_limb = firmware_limb(self._watched.native, model)
        self.gaps_rad = self._watched.gaps_rad

    def at(self, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float) -> Play | None:
        """At commanded true angles. A joint that stands on a side stands half its gap off. None: no joint of the plane
        has play. Raises PostureError where there is no rest."""
        if not any(self.gaps_rad.values()):
            return None
        return self._watched.settle(lambda off: self._once((theta1_rad + off[0], theta2_rad + off[1]), (fx_n, fz_n)))

    def _once(self, theta_rad: tuple[float, float], force_n: tuple[float, float]) -> Play:
        """What holds at angles that count the gaps already."""
        native, watched = self._watched.native, self._watched
        rest, load, weights = self._limb.rest_at(theta_rad, force_n)
        engaged, found = native.ffi.new("brace_engagement_t[2]"), native.ffi.new("brace_gap_stiffness_t *")
        status = native.lib.brace_loaded_play(
            self._firmware_limb, weights, *theta_rad, load, rest, watched.play, watched.machines, engaged, found
        )
        if status:
            raise PostureError(0, status, status_text(native, status))
        names = (*PLANAR_K, *PLANAR_REST)
        lines = [{name: float(getattr(k, name)) + 0.0 for name in names} for k in (found.now, found.engaged)]
        return watched.found(engaged, {**lines[0], "flags": int(found.now.flags)}, lines[1])


def held_ratio(
    model: LimbModel, theta_rad: np.ndarray, force_n: tuple[float, float], most: int = 1000
) -> dict[str, float]:
    """For each joint of the plane with play: at what share of the postures (rows: true theta1, theta2) a force holds it.
    At most so many postures count, evenly taken; those without a rest do not."""
    limb = PlayUnderLoad(model)
    joints = [joint for joint, gap_rad in limb.gaps_rad.items() if gap_rad > 0.0]
    every = max(1, -(-len(theta_rad) // most))
    open_of: list[tuple[str, ...]] = []
    for theta1_rad, theta2_rad in theta_rad[::every].tolist() if joints else ():
        with contextlib.suppress(PostureError):
            if play := limb.at(theta1_rad, theta2_rad, *force_n):
                open_of.append(play.open)
    return {joint: sum(joint not in gaps for gaps in open_of) / len(open_of) for joint in joints if open_of}


class PlayInSpaceUnderLoad:
    """The same of a limb in space, its coxa joint too."""

    def __init__(self, model: LimbModel) -> None:
        self._limb, self._watched = LoadedLimbInSpace(model), _Watched(model, JOINTS_IN_SPACE)
        self.gaps_rad = self._watched.gaps_rad

    def at(self, theta_rad: Sequence[float], force_n: Sequence[float]) -> Play | None:
        """theta_rad: commanded, of coxa, femur, tibia joint; zero offsets are added. force_n: of the ground on the tip,
        outwards in the limb's plane, to the left of it, up. None: no joint has play. Raises PostureError where there is
        no rest."""
        if not any(self.gaps_rad.values()):
            return None
        return self._watched.settle(lambda off: self._once(np.add(theta_rad, off), np.array(force_n, float)))

    def _once(self, theta_rad: np.ndarray, force_n: np.ndarray) -> Play:
        native, watched = self._watched.native, self._watched
        ffi, lib = native.ffi, native.lib
        true_rad, limb, weights, load, rest = self._limb.rest_at(theta_rad[None, :], force_n[None, :])
        engaged, now = ffi.new("brace_engagement_t[3]"), ffi.new("brace_stiffness_spatial_t *")
        whole = ffi.new("brace_stiffness_spatial_t *")

        status = lib.brace_loaded_space_play(
            limb, weights, true_rad, load, rest, watched.play, watched.machines, engaged, now
        )
        status = status or lib.brace_loaded_space_turn(true_rad[0], ffi.addressof(rest.k), whole)
        if status:
            raise PostureError(0, status, status_text(native, status))
        return watched.found(engaged, {**spatial_values(now), "flags": int(now.flags)}, spatial_values(whole))


def spatial_values(k: CData) -> dict[str, float]:
    """The numbers of a brace_stiffness_spatial_t by the names that `brace k` has for them."""
    values = {name: float(getattr(k, name)) + 0.0 for name in SPATIAL_K}
    parts = [*k.lambda_n_per_mm, *k.stiff_axis]
    return values | {name: float(part) + 0.0 for name, part in zip(SPATIAL_REST, parts, strict=True)}


def put_into(values: dict[str, float], play: Play) -> None:
    """K of now and its flags in place of K with every gap closed; C is its inverse, NaN where a gap is open."""
    values |= {**play.now, "flags": int(values["flags"]) | int(play.now["flags"])}
    is_in_space = SPATIAL_K[1] in play.now
    if play.open:
        values |= dict.fromkeys(SPATIAL_C if is_in_space else PLANAR_C, math.nan)
    elif is_in_space:
        k = np.array([tuple(values[name] for name in SPATIAL_K)], [(name, "f8") for name in SPATIAL_K])
        c = spatial_compliance(k)[0]
        values |= {name: float(c[name]) for name in SPATIAL_C}
    else:
        xx, xz, zz = (values[name] for name in PLANAR_K)
        det = xx * zz - xz * xz
        values |= {name: entry / det for name, entry in zip(PLANAR_C, (zz, -xz, xx), strict=True)}
