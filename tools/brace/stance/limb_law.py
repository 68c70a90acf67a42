"""One limb of a stance as a spring: where its tip is, how a force moves it, K there; all in the body's frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.model import LimbModel
from brace.stance.stance_file import Limb
from brace.stiffness.at_rest import PostureError
from brace.stiffness.in_space_under_load import LoadedLimbInSpace

JOINTS = ("coxa", "femur", "tibia")
CLOSES_AT_N = 0.05  # a force at the tip that closes a joint's play from its middle to its end
UNSURE_N = 0.6  # two sigma of a sensor of 0.3 N: below it nobody can tell on which side of its play a joint stands
_PLACES = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])  # K's entries xx xy xz yy yz zz as a matrix


@dataclass(frozen=True)
class Spring:
    """A limb's tip near a force, the body held: `k_n_per_mm` (3 x 3), `moved_mm` by that force and the limb's weight,
    `is_open`: the play of these joints is not surely closed."""

    k_n_per_mm: np.ndarray
    moved_mm: np.ndarray
    is_open: tuple[str, ...]


class GivesWayError(Exception):
    """A limb has no equilibrium under a force; the text says which."""


class LimbLaw:
    """A limb at its commanded angles, with a model that may differ from the stance's own. closes_at_n: CLOSES_AT_N
    for a draw. UNSURE_N for the believed limb: its stiffness is then a mean over the joints' possible places in their
    play."""

    def __init__(
        self, limb: Limb, down: np.ndarray, model: LimbModel | None = None, closes_at_n: float = CLOSES_AT_N
    ) -> None:
        self._closes_at_n = closes_at_n
        self._limb, self._model, self._down = limb, model or limb.model, down
        true = limb.theta_rad + [self._model.number(f"joint.{joint}.zero_offset_rad") for joint in JOINTS]
        yaw = np.array([[np.cos(true[0]), -np.sin(true[0]), 0.0], [np.sin(true[0]), np.cos(true[0]), 0.0], [0, 0, 1]])
        self._from_plane = limb.turn @ yaw  # x outwards in the limb's plane, y to the left of it, z up
        coxa, femur, tibia = (self._model.number(f"geometry.{link}_mm") for link in JOINTS)
        thigh = femur * np.array([np.cos(true[1]), 0.0, np.sin(true[1])])
        shin = tibia * np.array([np.cos(true[1] - true[2]), 0.0, np.sin(true[1] - true[2])])
        tip = np.array([coxa, 0.0, 0.0]) + thigh + shin
        self._knee_mm = self._in_body(tip - shin)
        self._hip_mm = self._in_body(np.array([coxa, 0.0, 0.0]))
        self.tip_mm = self._in_body(tip)
        # how the tip moves when a joint turns by its own angle, in the plane's frame
        self._turns = np.array([[-tip[1], tip[0], 0.0], _turned(thigh + shin), -_turned(shin)])
        self._loaded = LoadedLimbInSpace(self._model.with_values(_gravity(self._from_plane.T @ down)))

    def _in_body(self, in_plane_mm: np.ndarray) -> np.ndarray:
        return np.asarray(self._limb.mount_mm + self._from_plane @ in_plane_mm)

    def points_mm(self) -> np.ndarray:
        """4 x 3: mount, hip, knee and tip, in the body's frame."""
        return np.array([self._limb.mount_mm, self._hip_mm, self._knee_mm, self.tip_mm])

    def weights(self) -> list[tuple[float, np.ndarray]]:
        """The limb's own weights [N] and where they act, in the body's frame."""
        femur, knee, tibia = (self._model.number(f"gravity.{part}") for part in ("femur_n", "knee_n", "tibia_n"))
        middle = 0.5 * (self._hip_mm + self._knee_mm)
        return [(femur, middle), (knee, self._knee_mm), (tibia, 0.5 * (self._knee_mm + self.tip_mm))]

    def turns_in_body(self) -> np.ndarray:
        """How the tip moves [mm/rad] in the body's frame when coxa, femur or tibia turn by their own angle: 3 x 3, a
        row a joint."""
        return np.asarray(self._turns @ self._from_plane.T)

    def torques_n_mm(self, force_n: np.ndarray) -> np.ndarray:
        """What a force of the ground on the tip and the limb's own weight ask of coxa, femur and tibia, in the sense of
        their angles."""
        return np.asarray(self._turns @ (self._from_plane.T @ force_n) + self._weight_torques_n_mm())

    def force_of_torques_n(self, torque_n_mm: np.ndarray) -> np.ndarray:
        """The force of the ground on the tip that goes with the joints' torques, in the body's frame."""
        return np.asarray(self._from_plane @ np.linalg.solve(self._turns, torque_n_mm - self._weight_torques_n_mm()))

    def force_by_torque(self) -> np.ndarray:
        """3 x 3: how the ground's force in the body's frame changes with the joints' torques [1/mm]."""
        return np.asarray(self._from_plane @ np.linalg.inv(self._turns))

    def _weight_torques_n_mm(self) -> np.ndarray:
        up, left = self._from_plane[:, 2], self._from_plane[:, 1]
        joints = ((up, self._limb.mount_mm, 0), (-left, self._hip_mm, 0), (left, self._knee_mm, 2))
        weights = self.weights()
        return np.array(
            [
                sum(float(axis @ np.cross(at - joint, newton * self._down)) for newton, at in weights[beyond:])
                for axis, joint, beyond in joints
            ]
        )

    def spring(self, force_n: np.ndarray) -> Spring:
        """At a force of the ground on the tip. Raises GivesWayError where the limb has no rest under it."""
        in_plane = self._from_plane.T @ force_n
        try:
            found = self._loaded.spring(self._limb.theta_rad, in_plane)
        except PostureError as error:
            raise GivesWayError(f"limb {self._limb.name!r}: {error.text}") from None
        if found is None:
            raise GivesWayError(f"limb {self._limb.name!r} gives way: a link buckles or a joint turns too far")
        entries, moved_in_plane = found
        k = self._from_plane @ entries[_PLACES] @ self._from_plane.T
        moved = self._from_plane @ moved_in_plane
        return self._with_play(k, moved, in_plane)

    def _with_play(self, k: np.ndarray, moved: np.ndarray, in_plane_n: np.ndarray) -> Spring:
        """Each joint's play lies to the side that its load holds; within a small load it gives way like a soft
        spring."""
        compliance, is_open = np.linalg.inv(k), []
        for joint, turn in zip(JOINTS, self._turns, strict=True):
            half_rad = 0.5 * self._model.number(f"joint.{joint}.gap_rad")
            if half_rad <= 0.0:
                continue
            load, closing = float(turn @ in_plane_n), self._closes_at_n * float(np.abs(turn).sum())
            side = float(np.clip(load / closing, -1.0, 1.0))
            in_body = self._from_plane @ turn
            moved = moved + half_rad * side * in_body
            if abs(side) < 1.0:
                compliance = compliance + half_rad / closing * np.outer(in_body, in_body)
                is_open.append(joint)
        return Spring(np.linalg.inv(compliance) if is_open else k, moved, tuple(is_open))


def _turned(lever: np.ndarray) -> np.ndarray:
    """A lever in the plane, by +90 degrees from x towards z."""
    return np.array([-lever[2], 0.0, lever[0]])


def _gravity(down_in_plane: np.ndarray) -> dict[str, float]:
    """Where down is for the limb, from the stance."""
    x, y, z = (float(part) for part in down_in_plane)
    return {
        "gravity.direction_rad": float(np.arctan2(z, x)),
        "gravity.lean_rad": float(np.arctan2(y, np.hypot(x, z))),
    }
