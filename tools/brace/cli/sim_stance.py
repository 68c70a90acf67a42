"""`brace sim --stance`: reads the stance that is believed and the true one, and says what is true of the robot."""

from __future__ import annotations

import argparse
import csv
import json
import sys
from pathlib import Path
from types import TracebackType
from typing import TextIO

from brace.cli import common
from brace.ground.errors import BadFileError, UsageError
from brace.sim.robot import LIMBS_MOST, Fall, Robot, RobotTruth
from brace.sim.spec import JOINTS
from brace.stance.simulated import SimulatedStance
from brace.stance.stance_file import Limb, load_stance

_FRICTIONS = ("coulomb_n_mm", "coulomb_per_load_ratio")
_LEAST_MM_PER_N = 0.01
_COLUMNS = (
    "t_s,limb,fx_n,fy_n,fz_n,state,foot_x_mm,foot_y_mm,foot_z_mm,tau0_n_mm,tau1_n_mm,tau2_n_mm,payload_factor,"
    "body_x_mm,body_y_mm,body_z_mm,body_rx_rad,body_ry_rad,body_rz_rad"
).split(",")


def read(arguments: argparse.Namespace) -> SimulatedStance:
    """The two files. Raises BadFileError."""
    believed = load_stance(arguments.stance)
    true = load_stance(arguments.stance_plant) if arguments.stance_plant else believed
    if [limb.name for limb in believed.limbs] != [limb.name for limb in true.limbs]:
        raise BadFileError(
            "the true stance has other limbs",
            where=str(arguments.stance_plant),
            why=f"{arguments.stance.name} has {', '.join(limb.name for limb in believed.limbs)}",
            next_step="give both files the same limbs, in the same order",
        )
    assert len(believed.limbs) <= LIMBS_MOST  # load_stance refuses more
    for path, stance in ((arguments.stance, believed), (arguments.stance_plant, true)):
        for limb in stance.limbs:
            _refuse_rigid_across(limb, path)
            _refuse_rigid_links(limb, path)
    return SimulatedStance(believed, true)


def _refuse_rigid_across(limb: Limb, path: Path | None) -> None:
    yields = ["joint.coxa.compliance_rad_per_n_mm", *(f"link.{link}.lateral_mm_per_n" for link in JOINTS)]
    yields += [f"link.{link}.torsion_rad_per_n_mm" for link in ("coxa", "femur")]
    if not any(limb.model.number(key) > 0.0 for key in yields):
        raise BadFileError(
            f"limb {limb.name!r} does not yield across its plane",
            where=f"{limb.model.where()}, of {path}",
            why="a limb under a body needs a coxa joint that gives way, or links that do",
            next_step="give joint.coxa.compliance_rad_per_n_mm or link.femur.lateral_mm_per_n",
        )


def _refuse_rigid_links(limb: Limb, path: Path | None) -> None:
    """host_sim/README.md says why."""
    number = limb.model.number
    rubs = any(number(f"joint.{joint}.{key}") > 0.0 for joint in JOINTS for key in _FRICTIONS)
    if rubs and any(
        sum(number(f"link.{link}.{way}_mm_per_n") for link in ("femur", "tibia")) < _LEAST_MM_PER_N
        for way in ("bending", "lateral")
    ):
        raise BadFileError(
            f"limb {limb.name!r} has joints that rub and links that hardly yield",
            where=f"{limb.model.where()}, of {path}",
            why=f"the robot's body needs links of at least {_LEAST_MM_PER_N:g} mm/N where friction may hold the joints",
            next_step="give link.tibia.bending_mm_per_n and lateral_mm_per_n, or the friction to motor.*",
        )


# ---------------------------------------------------------------------------------------------- what is true


class Watch:
    """Says what is true of a running robot: rows of a file, one object a second, the fall once. Use it in a `with`."""

    def __init__(self, robot: Robot, truth: Path | None, as_json: bool) -> None:
        self._robot, self._path, self._as_json = robot, truth, as_json
        self._file: TextIO | None = None
        self._has_fallen = False

    def __enter__(self) -> Watch:
        if self._path is not None:
            try:
                self._file = self._path.open("w", newline="")
            except OSError as error:
                raise UsageError(
                    "the truth cannot be written",
                    where=str(self._path),
                    why=error.strerror or str(error),
                    next_step="choose another --truth",
                ) from None
            csv.writer(self._file, lineterminator="\n").writerow(_COLUMNS)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._file is not None:
            self._file.close()

    def look(self) -> None:
        """At all that has happened since the last look."""
        for truth in self._robot.log():
            if self._file is not None:
                csv.writer(self._file, lineterminator="\n").writerows(_rows(truth))
            if self._as_json and abs(truth["time_s"] - round(truth["time_s"])) < 1e-6:
                _emit_now({"event": "truth", "truth": truth})
        if self._file is not None:
            self._file.flush()
        fall = None if self._has_fallen else self._robot.fall()
        if fall is not None:
            self._has_fallen = True
            words = _fall_words(fall)
            common.say(words)
            if self._as_json:
                _emit_now({"event": "fall", "time_s": fall.time_s, "states": fall.states, "message": words})


def _emit_now(event: dict[str, object]) -> None:
    """A line that whoever waits for it gets at once."""
    common.emit(json.dumps(common.json_ready(event)))
    if sys.stdout is not None:
        sys.stdout.flush()


def _rows(truth: RobotTruth) -> list[list[object]]:
    body = [truth["payload_factor"], *truth["displacement_mm"], *truth["rotation_rad"]]
    rows: list[list[object]] = []
    for limb in truth["limbs"]:
        numbers = [*limb["foot_mm"], *limb["torque_n_mm"], *body]
        forces = [f"{force:.9g}" for force in limb["force_n"]]
        row = [f"{truth['time_s']:.3f}", limb["name"], *forces, limb["state"], *(f"{value:.9g}" for value in numbers)]
        rows.append(list(row))
    return rows


def _fall_words(fall: Fall) -> str:
    groups = [
        f"{' and '.join(names)} {'slide' if len(names) > 1 else 'slides'}"
        if state == "slides"
        else f"{' and '.join(names)} {'are' if len(names) > 1 else 'is'} off the ground"
        for state in ("slides", "open")
        if (names := [name for name, own in fall.states.items() if own == state])
    ]
    feet = f": {', '.join(groups)}" if groups else ": the limbs give way"
    return f"the body falls at {fall.time_s:.3f} s, there is no equilibrium{feet}"


def end_lines(truth: RobotTruth) -> list[str]:
    """What is true at the end, a line a foot."""
    wide = max(len(limb["name"]) for limb in truth["limbs"])
    lines = [
        f"{limb['name']:{wide}}  x {x:8.3f}  y {y:8.3f}  z {z:8.3f} N, {limb['state']}"
        for limb in truth["limbs"]
        for x, y, z in [limb["force_n"]]
    ]
    x, y, z = truth["displacement_mm"]
    return [*lines, f"the body has moved x {x:.3f} y {y:.3f} z {z:.3f} mm, payload factor {truth['payload_factor']:g}"]
