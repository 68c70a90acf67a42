"""The preload state machine on measured joints: gearboxes on the bench, their output locked.

The link stands still, so the motor's angle alone says where in its play a joint is: beyond half the gap from the middle a
flank touches. That is the truth here; torque, from the motor's current as the machine sees it, has no part in it, but for the
middle itself (half way between the angles at equal and opposite torques). Gap and friction are what `brace diagnose` finds in
the record. The machine is given them once as found, friction to 20 %, and once as docs/backlash.md says that a gear wants to
be set: the upper end of friction's interval, and nothing between rest and motion taken for sure (1). The gap is given right,
and 20 % off either way.

    BRACE_REAL_DATA=FOLDER PYTHONPATH=tools .venv/bin/python tests/property/backlash_measured.py

with records (docs/joint-tests.md) cycloidal_base, cycloidal_preloaded and cycloidal_polymer in FOLDER.
"""
from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import backlash_histories as histories

Floats = NDArray[np.float64]

RECORDS = ("cycloidal_base", "cycloidal_preloaded", "cycloidal_polymer")
FULL_LOAD_TEST = 100  # and the tests after it: ramps to 40 N m, the others to 4 N m
NOISE_N_MM = 300.0    # from sample to sample, all three
STEP_RAD = 1e-4
AS_FOUND, ALLOWING = "friction as found, to 20 %", "upper end of its interval, to 100 %"
GAP_OFF = (-0.2, 0.0, 0.2)


class Joint(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in (
        "tick_us", "gap_rad", "friction_n_mm", "friction_tolerance_ratio", "torque_range_n_mm", "torque_noise_n_mm",
        "torque_bias_n_mm", "angle_step_rad")]


@dataclass(frozen=True)
class Found:
    """What a diagnosis reports of a joint."""

    gap_rad: float
    friction_n_mm: float
    friction_high_n_mm: float


@dataclass
class Judged:
    """Ticks, all tests and believed gaps of a record together."""

    ticks: int = 0
    touching: int = 0
    decided: int = 0
    valid: int = 0
    wrong: int = 0        # the flank decided is not the one that touches
    valid_wrong: int = 0  # reported valid on the side on which the motor is not
    late_valid: int = 0   # valid with the gap open for longer than the time in which that has to be noticed
    direction_wrong: int = 0
    errors: tuple[Floats, ...] = ()       # |offset - truth| in gaps, every tick
    decided_errors: tuple[Floats, ...] = ()  # where a flank is decided

    def percentile(self, which: tuple[Floats, ...]) -> float:
        """The 95th [gaps]."""
        return float(np.quantile(np.concatenate(which), 0.95)) if which else float("nan")


def found_in(folder: Path) -> Found:
    """Gap and friction by `brace diagnose`."""
    from brace.dataset import load_dataset
    from brace.diagnose.options import Options
    from brace.diagnose.run import diagnose

    sizes = {key.rsplit(".", 1)[-1]: interval for effect in diagnose(load_dataset(folder), None, Options()).effects
            for key, interval in effect.parameters.items()}
    return Found(sizes["gap_rad"].value, sizes["coulomb_n_mm"].value, sizes["coulomb_n_mm"].high)


def middle_rad(angle_rad: Floats, torque_n_mm: Floats) -> float:
    """Half way between the angles at equal and opposite torques."""
    halves = []
    for torque in np.linspace(0.3, 0.6, 7) * np.abs(torque_n_mm).max():
        at = [np.median(angle_rad[np.abs(torque_n_mm - sign * torque) < 0.02 * torque]) for sign in (1.0, -1.0)]
        halves.append(0.5 * (at[0] + at[1]))
    return float(np.mean(halves))


def by_direction(angle_rad: Floats) -> NDArray[np.int64]:
    """The flank by the last direction of motion, with a hysteresis of two steps."""
    flank = np.zeros(len(angle_rad), dtype=np.int64)
    anchor, way = angle_rad[0], 0
    for i, angle in enumerate(angle_rad):
        if abs(angle - anchor) > 2.0 * STEP_RAD:
            way = 1 if angle > anchor else -1
            anchor = angle - way * 2.0 * STEP_RAD
        flank[i] = way
    return flank


def ticks_open(touching: NDArray[np.bool_]) -> NDArray[np.int64]:
    """For how many ticks the gap has been open."""
    count = np.zeros(len(touching), dtype=np.int64)
    for i, touches in enumerate(touching):
        count[i] = 0 if touches else (count[i - 1] if i else 0) + 1
    return count


def play_test(lib: ctypes.CDLL, joint: Joint, angle_rad: Floats, torque_n_mm: Floats, middle: float, gap_rad: float,
              judged: Judged) -> None:
    """One test through the machine, and what it says beside the truth."""
    said = np.zeros((len(angle_rad), 3))
    angle, torque = np.ascontiguousarray(angle_rad), np.ascontiguousarray(torque_n_mm)
    detection_us = lib.backlash_measured(ctypes.byref(joint), len(angle), ctypes.c_void_p(angle.ctypes.data),
                                         ctypes.c_void_p(torque.ctypes.data), ctypes.c_void_p(said.ctypes.data))
    assert detection_us > 0, f"status {detection_us}"
    flank, valid, offset_rad = said[:, 0], said[:, 1] > 0.0, said[:, 2]
    off_middle = angle - middle
    touching = np.abs(off_middle) >= 0.5 * gap_rad
    side = np.sign(off_middle)
    errors = np.abs(offset_rad + np.clip(off_middle, -0.5 * gap_rad, 0.5 * gap_rad)) / gap_rad
    judged.ticks += len(angle)
    judged.touching += int(touching.sum())
    judged.decided += int((flank != 0.0).sum())
    judged.valid += int(valid.sum())
    judged.wrong += int((touching & (flank == -side)).sum())
    judged.valid_wrong += int((valid & (flank == -side)).sum())
    judged.late_valid += int((valid & (ticks_open(touching) * joint.tick_us > detection_us)).sum())
    judged.direction_wrong += int((touching & (by_direction(angle) == -side)).sum())
    judged.errors += (errors,)
    judged.decided_errors += (errors[flank != 0.0],)


def judge(lib: ctypes.CDLL, folder: Path) -> Iterator[tuple[str, bool, Judged]]:
    """Setting, up to full load?, and how the machine does on a record."""
    found = found_in(folder)
    rows = np.genfromtxt(folder / "data.csv", delimiter=",", names=True)
    full = rows["test"] >= FULL_LOAD_TEST
    middle = middle_rad(rows["angle_rad"][full], rows["torque_n_mm"][full])
    settings = {AS_FOUND: (found.friction_n_mm, 0.2), ALLOWING: (found.friction_high_n_mm, 1.0)}
    for name, (friction_n_mm, tolerance_ratio) in settings.items():
        for to_full_load in (False, True):
            judged = Judged()
            for test in np.unique(rows["test"][full == to_full_load]):
                record = rows[rows["test"] == test]
                tick_us = 1e6 * np.ptp(record["t_s"]) / (len(record) - 1)
                for off in GAP_OFF:
                    joint = Joint(round(tick_us), found.gap_rad * (1.0 + off), friction_n_mm, tolerance_ratio, 4e4,
                                  NOISE_N_MM, 400.0, STEP_RAD)
                    play_test(lib, joint, record["angle_rad"], record["torque_n_mm"], middle, found.gap_rad, judged)
            yield name, to_full_load, judged


def share(part: int, whole: int) -> str:
    return f"{part / whole:7.3%}" if whole else "      -"


def report(record: str, setting: str, to_full_load: bool, j: Judged) -> str:
    """One row."""
    return (f"{record:20} {'40 N m' if to_full_load else ' 4 N m'}  {setting:35} gap open {share(j.ticks - j.touching, j.ticks)}  "
            f"decided {share(j.decided, j.ticks)}  valid {share(j.valid, j.ticks)}  wrong {share(j.wrong, j.touching)}  "
            f"valid and wrong {share(j.valid_wrong, j.ticks)}, past detection {share(j.late_valid, j.ticks)}  "
            f"by direction wrong {share(j.direction_wrong, j.touching)}  "
            f"95 % within {j.percentile(j.decided_errors):.3f} gaps decided, {j.percentile(j.errors):.3f} at all ticks")


def main() -> None:
    lib = histories.library()
    for record in RECORDS:
        for setting, to_full_load, judged in judge(lib, Path(os.environ["BRACE_REAL_DATA"]) / record):
            print(report(record, setting, to_full_load, judged))


if __name__ == "__main__":
    main()
