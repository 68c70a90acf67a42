"""Which play a load takes up, by the function that a controller uses (brace/play.h), and K with the other gaps open."""

from __future__ import annotations

import math
from dataclasses import dataclass

from brace.model import LimbModel
from brace.native import library
from brace.native.limb import firmware_limb, status_text
from brace.params.values import words_of
from brace.stiffness.at_rest import PLANAR_C, PLANAR_K, PLANAR_REST, PostureError
from brace.stiffness.under_load import LoadedLimb

JOINTS = ("femur", "tibia")
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


class PlayUnderLoad:
    """Which play of a limb in its plane a load takes up, as its controller settles at."""

    def __init__(self, model: LimbModel, arithmetic: str = "f32") -> None:
        native = library()
        ffi, lib = native.ffi, native.lib
        words, _ = words_of(model)
        parameters = ffi.new("brace_parameters_t *")
        ffi.memmove(parameters, words.tobytes(), words.nbytes)
        self._native, self._limb = native, LoadedLimb(model, arithmetic)
        self._firmware_limb = firmware_limb(native, model)
        self._joints = ffi.new("brace_play_joint_t[2]")
        self._kept = [ffi.new("brace_backlash_t *") for _ in JOINTS]
        self._machines = ffi.new("brace_backlash_t *[2]")
        self.gaps_rad = {}
        for index, (joint, machine) in enumerate(zip(JOINTS, self._kept, strict=True)):
            number = lib.BRACE_FEMUR + index
            watched = ffi.new("brace_backlash_params_t *", lib.brace_play_watched(parameters, number))
            self._joints[index] = lib.brace_play_joint(parameters, number)
            is_watched = lib.brace_backlash_init(machine, watched) == 0
            self._machines[index] = machine if is_watched else ffi.NULL
            self.gaps_rad[joint] = model.number(f"joint.{joint}.gap_rad")

    def at(self, theta1_rad: float, theta2_rad: float, fx_n: float, fz_n: float) -> Play | None:
        """At commanded true angles. A joint that stands on a side stands half its gap off. None: no joint of the plane
        has play. Raises PostureError where there is no rest."""
        if not any(self.gaps_rad.values()):
            return None
        sides = {joint: 0 for joint in JOINTS}
        for _ in range(_ROUNDS):
            stands = [
                angle - 0.5 * sides[joint] * self.gaps_rad[joint]
                for joint, angle in zip(JOINTS, (theta1_rad, theta2_rad), strict=True)
            ]
            before = sides
            play = self._once((stands[0], stands[1]), (fx_n, fz_n))
            sides = play.stands
            if sides == before:
                break
        return play

    def _once(self, theta_rad: tuple[float, float], force_n: tuple[float, float]) -> Play:
        """What holds at angles that count them already."""
        ffi, lib = self._native.ffi, self._native.lib
        rest, load, weights = self._limb.rest_at(theta_rad, force_n)
        engaged, found = ffi.new("brace_engagement_t[2]"), ffi.new("brace_gap_stiffness_t *")
        status = lib.brace_loaded_play(
            self._firmware_limb, weights, *theta_rad, load, rest, self._joints, self._machines, engaged, found
        )
        if status:
            raise PostureError(0, status, status_text(self._native, status))
        by_joint = dict(zip(JOINTS, engaged, strict=True))
        names = (*PLANAR_K, *PLANAR_REST)
        lines = [{name: float(getattr(k, name)) + 0.0 for name in names} for k in (found.now, found.engaged)]
        stands = {name: int(joint.flank) for name, joint in by_joint.items()}
        play = Play(
            stands,
            {name: int(joint.flank) for name, joint in by_joint.items() if joint.is_engaged and joint.flank},
            tuple(name for name, joint in by_joint.items() if joint.is_assumed),
            tuple(name for name, joint in by_joint.items() if not joint.is_engaged),
            {**lines[0], "flags": int(found.now.flags)},
            lines[1],
        )
        return play


def put_into(values: dict[str, float], play: Play) -> None:
    """K of now and its flags in place of K with every gap closed; C is its inverse, NaN where a gap is open."""
    values |= {**play.now, "flags": int(values["flags"]) | int(play.now["flags"])}
    xx, xz, zz = (values[name] for name in PLANAR_K)
    det = xx * zz - xz * xz
    for name, entry in zip(PLANAR_C, (zz, -xz, xx), strict=True):
        values[name] = math.nan if play.open else entry / det
