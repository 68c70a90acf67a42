"""The robot of brace_robot.h: limbs and their controllers under one body, on one bus."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypedDict

import numpy as np

from brace.model import LimbModel
from brace.native.c_data import CData
from brace.sim.node import LimbSetup, Node

LIMBS_MOST = 8  # BRACE_ROBOT_LIMBS
_CONTACTS = ("sticks", "slides", "open", "open")  # brace_robot_contact_t; who let go is off the ground, too
_LOG_ROWS = 400
_LIFT_STEPS = 40


@dataclass(frozen=True)
class Foot:
    """Where a limb is fixed to the body and the ground under its foot; in the body's frame without load."""

    name: str
    mount_mm: np.ndarray
    turn: np.ndarray  # 3 x 3: the limb's frame into the body's
    foothold_mm: np.ndarray
    normal: np.ndarray
    friction_ratio: float
    grip_n: float


@dataclass(frozen=True)
class Body:
    """What the limbs carry; payload_n acts at the factor 1."""

    weight_n: float
    com_mm: np.ndarray
    down: np.ndarray
    payload_n: np.ndarray
    payload_at_mm: np.ndarray
    feet: tuple[Foot, ...]


class FootTruth(TypedDict):
    """Forces in the frame of the body as it stands; foot_mm in the world: the body's frame where it has no load."""

    name: str
    force_n: list[float]
    state: str  # sticks, grips, slides, open
    foot_mm: list[float]
    torque_n_mm: list[float]  # coxa, femur, tibia, as their motors' currents show it, in the sense of the angles


class RobotTruth(TypedDict):
    """What no controller sees."""

    time_s: float
    payload_factor: float
    displacement_mm: list[float]
    rotation_rad: list[float]
    unbalanced_ratio: float
    limbs: list[FootTruth]


@dataclass(frozen=True)
class Fall:
    """When the body fell, and where its feet were then."""

    time_s: float
    states: dict[str, str]


class Robot(Node):
    """Limbs under one body. A Node, but that `press` and `add_posture` are not for it."""

    def __init__(self, body: Body, limbs: Sequence[LimbSetup], can: str | None = "none", seed: int = 0) -> None:
        self.body = body
        super().__init__(limbs, can, seed)
        self.names = tuple(foot.name for foot in body.feet)
        ffi = self.native.ffi
        self._truth, self._rows = ffi.new("brace_robot_truth_t *"), ffi.new("brace_robot_truth_t[]", _LOG_ROWS)

    def _create(self, structs: CData, can: CData, seed: int, failure: CData) -> CData:
        ffi = self.native.ffi
        robot = ffi.new("brace_robot_t *")
        robot.weight_n = self.body.weight_n
        robot.com_mm, robot.down = self.body.com_mm.tolist(), self.body.down.tolist()
        robot.payload_n, robot.payload_at_mm = self.body.payload_n.tolist(), self.body.payload_at_mm.tolist()
        for struct, foot in zip(robot.foot, self.body.feet):
            struct.mount_mm, struct.mount_turn = foot.mount_mm.tolist(), foot.turn.ravel().tolist()
            struct.foothold_mm, struct.normal = foot.foothold_mm.tolist(), foot.normal.tolist()
            struct.friction_ratio, struct.grip_n = foot.friction_ratio, foot.grip_n
        return self.native.lib.brace_robot_create(structs, len(structs), robot, can, seed, failure)

    # ------------------------------------------------------------------------------------------ commanding

    def set_payload(self, at_s: float, factor: float, ramp_s: float = 0.0) -> None:
        """From a time on, the payload's factor goes to this one within a time."""
        self.native.lib.brace_robot_payload(self._node, at_s, factor, ramp_s)

    def set_points(self, limb: int, at_s: float, theta_rad: Sequence[float]) -> None:
        """From a time on, a limb's set-points move to these at the drives' rate."""
        self.native.lib.brace_robot_set_points(self._node, limb, at_s, list(theta_rad))

    def release(self, limb: int, at_s: float, for_s: float) -> None:
        """For a while, a foot only presses, so that it can be lifted."""
        self.native.lib.brace_robot_release(self._node, limb, at_s, for_s)

    # ------------------------------------------------------------------------------------------ reading

    def robot_truth(self) -> RobotTruth:
        """As it is now."""
        self.native.lib.brace_robot_truth(self._node, self._truth)
        return self._as_truth(self._truth)

    def fall(self) -> Fall | None:
        """None: the body stands."""
        self.native.lib.brace_robot_truth(self._node, self._truth)
        truth = self._truth
        if truth.fallen_s < 0.0:
            return None
        states = (_CONTACTS[foot.contact_before_fall] for foot in truth.foot)
        return Fall(truth.fallen_s, dict(zip(self.names, states)))

    def log(self) -> list[RobotTruth]:
        """The truth each 10 ms since the last call, the last 20 s at most."""
        rows: list[RobotTruth] = []
        while read := self.native.lib.brace_robot_log(self._node, self._rows, _LOG_ROWS):
            rows += [self._as_truth(self._rows[i]) for i in range(read)]
        return rows

    def _as_truth(self, truth: CData) -> RobotTruth:
        return {
            "time_s": truth.time_s,
            "payload_factor": truth.payload_factor,
            "displacement_mm": list(truth.displacement_mm),
            "rotation_rad": list(truth.rotation_rad),
            "unbalanced_ratio": truth.unbalanced_ratio,
            "limbs": [
                {
                    "name": foot.name,
                    "force_n": list(found.force_n),
                    "state": _state(found, foot),
                    "foot_mm": list(found.foot_mm),
                    "torque_n_mm": list(found.torque_n_mm),
                }
                for foot, found in zip(self.body.feet, truth.foot)
            ],
        }


def _state(found: CData, foot: Foot) -> str:
    state = _CONTACTS[found.contact]
    pulled = sum(a * b for a, b in zip(found.force_n, foot.normal)) < 0.0
    return "grips" if state == "sticks" and pulled else state


def tip_mm(model: LimbModel, theta_rad: np.ndarray, mount_mm: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Where a limb that nothing loads has its tip: angles are commanded, the model's zero offsets are added."""
    coxa, femur, tibia = (model.number(f"geometry.{link}_mm") for link in ("coxa", "femur", "tibia"))
    zeros = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("coxa", "femur", "tibia")]
    yaw, pitch, knee = np.asarray(theta_rad) + zeros
    out = coxa + femur * np.cos(pitch) + tibia * np.cos(pitch - knee)
    up = femur * np.sin(pitch) + tibia * np.sin(pitch - knee)
    return np.asarray(mount_mm + turn @ np.array([out * np.cos(yaw), out * np.sin(yaw), up]))


def lifted_rad(
    model: LimbModel, theta_rad: np.ndarray, mount_mm: np.ndarray, turn: np.ndarray, way_mm: np.ndarray
) -> np.ndarray | None:
    """The set-points that move the unloaded tip by a way; None where the limb does not reach there."""
    target = tip_mm(model, theta_rad, mount_mm, turn) + way_mm
    theta = np.array(theta_rad, dtype=float)
    for _ in range(_LIFT_STEPS):
        lacks = target - tip_mm(model, theta, mount_mm, turn)
        if np.abs(lacks).max() < 1e-6:
            return theta
        step = 1e-6
        slopes = [(tip_mm(model, theta + step * axis, mount_mm, turn) - target + lacks) / step for axis in np.eye(3)]
        try:
            change = np.linalg.solve(np.array(slopes).T, lacks)
        except np.linalg.LinAlgError:
            return None
        theta += change * min(1.0, 0.2 / max(np.abs(change).max(), 1e-12))
    return None
