"""`brace sim --stance`: the limbs of a stance under one body. The file's stance as the simulated robot has it; what
happens to it; what is then true."""

from __future__ import annotations

import argparse
import csv
import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, TextIO

import numpy as np

from brace.cli import common
from brace.cli.sim_stance_options import LIFT_MM
from brace.ground.errors import BadFileError, UsageError, did_you_mean
from brace.sim.robot import LIMBS_MOST, Body, Fall, Foot, Robot, RobotTruth, lifted_rad, tip_mm
from brace.sim.spec import JOINTS, Lift, Move, OneLimb, Payload

if TYPE_CHECKING:
    from brace.model import LimbModel
    from brace.stance.stance_file import Limb, Stance

SERVO_N_MM_PER_RAD = 1e7  # a joint's compliance in limb.toml is that of a joint under power: its servo adds little
PAYLOADS = (Payload(1.0, 2.0, 0.0),)  # unless the command says otherwise
_COLUMNS = (
    "t_s,limb,fx_n,fy_n,fz_n,state,foot_x_mm,foot_y_mm,foot_z_mm,tau0_n_mm,tau1_n_mm,tau2_n_mm,payload_factor,"
    "body_x_mm,body_y_mm,body_z_mm,body_rx_rad,body_ry_rad,body_rz_rad"
).split(",")


class SimulatedStance:
    """A stance that is believed, and the one that is true."""

    def __init__(self, believed: Stance, true: Stance) -> None:
        self.believed, self.true = believed, true
        self.names = [limb.name for limb in believed.limbs]

    @property
    def body(self) -> Body:
        """As the simulated robot takes it."""
        true = self.true
        feet = (_foot(limb, own) for limb, own in zip(self.believed.limbs, true.limbs))
        return Body(true.weight_n, true.com_mm, true.down, true.payload_n, true.payload_at_mm, tuple(feet))

    @property
    def limbs(self) -> list[OneLimb]:
        """In the file's order."""
        return [
            OneLimb(
                _leaning(limb, self.believed.down),
                _leaning(replace(own, theta_rad=limb.theta_rad), self.true.down),
                limb.node,
                (float(limb.theta_rad[0]), float(limb.theta_rad[1]), float(limb.theta_rad[2])),
            )
            for limb, own in zip(self.believed.limbs, self.true.limbs)
        ]

    def happen(self, robot: Robot, payloads: Sequence[Payload], moves: Sequence[Move], lifts: Sequence[Lift]) -> None:
        """Gives the robot what the command line says will happen. Raises UsageError."""
        for payload in payloads or PAYLOADS:
            robot.set_payload(payload.at_s, payload.factor, payload.ramp_s)
        changes: list[tuple[float, int, np.ndarray]] = []  # of the set-points: when, whose, by how much
        for move in moves:
            changes.append((move.at_s, self._index(move.limb, "--move"), np.array(move.by_rad)))
        for lift in lifts:
            index = self._index(lift.limb, "--lift")
            up = self._up_rad(index)
            robot.release(index, lift.at_s, lift.for_s)
            changes.append((lift.at_s, index, up))
            if math.isfinite(lift.for_s):
                changes.append((lift.at_s + lift.for_s, index, -up))
        theta = [np.array(limb.theta_rad, dtype=float) for limb in self.believed.limbs]
        for at_s, index, by_rad in sorted(changes, key=lambda change: change[0]):
            theta[index] = theta[index] + by_rad
            robot.set_points(index, at_s, theta[index].tolist())

    def _index(self, limb: str, option: str) -> int:
        if limb in self.names:
            return self.names.index(limb)
        if limb.isdigit() and 1 <= int(limb) <= len(self.names):
            return int(limb) - 1
        near = did_you_mean(limb, self.names)
        raise UsageError(
            f"{option}: this stance has no limb {limb!r}",
            where="sim",
            why=f"its limbs are {', '.join(self.names)}; or 1 to {len(self.names)}",
            next_step=f"{option} '{near or self.names[0]}...'",
        )

    def _up_rad(self, index: int) -> np.ndarray:
        limb = self.believed.limbs[index]
        up = lifted_rad(limb.model, limb.theta_rad, limb.mount_mm, limb.turn, LIFT_MM * limb.normal)
        if up is None:
            raise UsageError(
                f"--lift: limb {limb.name!r} does not reach {LIFT_MM:.0f} mm off its ground",
                where="sim",
                why="its joints turn it no further that way",
                next_step=f"--move '{limb.name}:0,0.1,0@3' moves it as you say",
            )
        return np.asarray(up - limb.theta_rad)


def read(arguments: argparse.Namespace) -> SimulatedStance:
    """The two files. Raises BadFileError."""
    from brace.stance.stance_file import load_stance

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


def _foot(believed: Limb, true: Limb) -> Foot:
    """The ground is where the tip is believed, but for the true offset: zeros and lengths that are wrong act as
    footholds that are."""
    tip = tip_mm(believed.model, believed.theta_rad, believed.mount_mm, believed.turn)
    return Foot(
        true.name,
        true.mount_mm,
        true.turn,
        tip + true.offset_mm,
        true.normal,
        true.friction_ratio,
        true.grip_n,
    )


def _leaning(limb: Limb, down: np.ndarray) -> LimbModel:
    """The limb's model with weights that pull where they do in this stance."""
    yaw = limb.theta_rad[0]
    x, y, z = limb.turn.T @ down
    out, left = np.cos(yaw) * x + np.sin(yaw) * y, np.cos(yaw) * y - np.sin(yaw) * x
    lean = float(np.arctan2(left, np.hypot(out, z)))
    return limb.model.with_values(
        {"gravity.direction_rad": float(np.arctan2(z, out)), "gravity.lean_rad": lean}
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
                common.emit(json.dumps(common.json_ready({"event": "truth", "truth": truth})))
        if self._file is not None:
            self._file.flush()
        fall = None if self._has_fallen else self._robot.fall()
        if fall is not None:
            self._has_fallen = True
            words = _fall_words(fall)
            common.say(words)
            if self._as_json:
                event = {"event": "fall", "time_s": fall.time_s, "states": fall.states, "message": words}
                common.emit(json.dumps(common.json_ready(event)))


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
