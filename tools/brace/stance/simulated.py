"""A stance as the simulated robot takes it: what is believed of it, what is true, what happens to it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from brace.ground.errors import UsageError, did_you_mean
from brace.model import LimbModel
from brace.sim.robot import Body, Foot, Robot, lifted_rad, tip_mm
from brace.sim.spec import LIFT_MM, Lift, Move, OneLimb, Payload
from brace.stance.stance_file import Limb, Stance

# A joint's compliance in limb.toml is that of a joint under power: its servo adds a hundredth of it
SERVO_N_MM_PER_RAD = 1e7
PAYLOADS = (Payload(1.0, 2.0, 0.0),)  # unless somebody says otherwise


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
