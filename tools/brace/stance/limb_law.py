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
UNSURE_N = 0.3  # one sigma of a sensor of a foot: below it nobody can tell on which side of its play a joint stands
MATRIX = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])  # K's entries xx xy xz yy yz zz as a matrix


@dataclass(frozen=True)
class Spring:
    """A limb's tip near a force, the body held: `k_n_per_mm` (3 x 3), `moved_mm` by that force and the limb's weight,
    `is_open`: the play of these joints is not surely closed."""

    k_n_per_mm: np.ndarray
    moved_mm: np.ndarray
    is_open: tuple[str, ...]


class GivesWayError(Exception):
    """A limb has no equilibrium under a force; the text says which."""


@dataclass(frozen=True)
class Shape:
    """A limb at its angles; places in the body's frame. from_plane: 3 x 3, from its plane's frame (x outwards, y to the
    left, z up) into the body's. turns: how the tip moves [mm/rad] in the plane's frame when coxa, femur or tibia turns
    by its own angle, a row a joint."""

    from_plane: np.ndarray
    hip_mm: np.ndarray
    knee_mm: np.ndarray
    tip_mm: np.ndarray
    turns: np.ndarray


def shape_of(limb: Limb, model: LimbModel, theta_rad: np.ndarray) -> Shape:
    """At true angles of coxa, femur and tibia, without load."""
    sine, cosine = np.sin(theta_rad[0]), np.cos(theta_rad[0])
    from_plane = limb.turn @ np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    coxa, femur, tibia = (model.number(f"geometry.{link}_mm") for link in JOINTS)
    raised, bent = theta_rad[1], theta_rad[1] - theta_rad[2]
    hip = np.array([coxa, 0.0, 0.0])
    thigh, shin = (size * np.array([np.cos(at), 0.0, np.sin(at)]) for size, at in ((femur, raised), (tibia, bent)))
    tip = hip + thigh + shin
    turns = np.array([[-tip[1], tip[0], 0.0], _turned(thigh + shin), -_turned(shin)])
    hip_mm, knee_mm, tip_mm = (limb.mount_mm + from_plane @ place for place in (hip, hip + thigh, tip))
    return Shape(from_plane, hip_mm, knee_mm, tip_mm, turns)


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
        self.shape = shape_of(limb, self._model, true)
        self._from_plane, self._turns, self.tip_mm = self.shape.from_plane, self.shape.turns, self.shape.tip_mm
        gaps = np.array([self._model.number(f"joint.{joint}.gap_rad") for joint in JOINTS])
        self._half_rad = np.maximum(0.5 * gaps, 0.0)
        self._weight_n_mm = self._weight_torques_n_mm()
        self.has_play = bool(np.any(self._half_rad))
        self._loaded = LoadedLimbInSpace(self._model.with_values(_gravity(self._from_plane.T @ down)))

    def points_mm(self) -> np.ndarray:
        """4 x 3: mount, hip, knee and tip, in the body's frame."""
        return np.array([self._limb.mount_mm, self.shape.hip_mm, self.shape.knee_mm, self.tip_mm])

    def weights(self) -> list[tuple[float, np.ndarray]]:
        """The limb's own weights [N] and where they act, in the body's frame."""
        femur, knee, tibia = (self._model.number(f"gravity.{part}") for part in ("femur_n", "knee_n", "tibia_n"))
        hip, bend = self.shape.hip_mm, self.shape.knee_mm
        return [(femur, 0.5 * (hip + bend)), (knee, bend), (tibia, 0.5 * (bend + self.tip_mm))]

    def turns_in_body(self) -> np.ndarray:
        """How the tip moves [mm/rad] in the body's frame when coxa, femur or tibia turn by their own angle: 3 x 3, a
        row a joint."""
        return np.asarray(self._turns @ self._from_plane.T)

    def torques_n_mm(self, force_n: np.ndarray) -> np.ndarray:
        """What a force of the ground on the tip and the limb's own weight ask of coxa, femur and tibia, in the sense of
        their angles."""
        return np.asarray(self._turns @ (self._from_plane.T @ force_n) + self._weight_n_mm)

    def force_of_torques_n(self, torque_n_mm: np.ndarray) -> np.ndarray:
        """The force of the ground on the tip that goes with the joints' torques, in the body's frame."""
        return np.asarray(self._from_plane @ np.linalg.solve(self._turns, torque_n_mm - self._weight_n_mm))

    def force_by_torque(self) -> np.ndarray:
        """3 x 3: how the ground's force in the body's frame changes with the joints' torques [1/mm]."""
        return np.asarray(self._from_plane @ np.linalg.inv(self._turns))

    def _weight_torques_n_mm(self) -> np.ndarray:
        up, left = self._from_plane[:, 2], self._from_plane[:, 1]
        joints = ((up, self._limb.mount_mm, 0), (-left, self.shape.hip_mm, 0), (left, self.shape.knee_mm, 2))
        weights = self.weights()
        return np.array(
            [
                sum(float(axis @ np.cross(at - joint, newton * self._down)) for newton, at in weights[beyond:])
                for axis, joint, beyond in joints
            ]
        )

    def sides(self, force_n: np.ndarray) -> np.ndarray:
        """How surely a force of the ground on the tip holds each joint on a side of its play: beyond 1 on its positive
        side, below -1 on its negative one, between them in its play; infinite without play."""
        loads = self.torques_n_mm(force_n)
        closing = self._closes_at_n * np.abs(self._turns).sum(axis=1)
        return np.where(self._half_rad > 0.0, loads / closing, np.inf)

    def spring(self, force_n: np.ndarray, held: np.ndarray | None = None) -> Spring:
        """At a force of the ground on the tip. held: the joints are taken to lie on these sides, -1, 0 or 1, whatever
        the force says; None: where it holds them. Raises GivesWayError where the limb has no rest under it."""
        in_plane = self._from_plane.T @ force_n
        try:
            found = self._loaded.spring(self._limb.theta_rad, in_plane)
        except PostureError as error:
            raise GivesWayError(f"limb {self._limb.name!r}: {error.text}") from None
        if found is None:
            raise GivesWayError(f"limb {self._limb.name!r} gives way: a link buckles or a joint turns too far")
        entries, moved_in_plane = found
        k = self._from_plane @ entries[MATRIX] @ self._from_plane.T
        moved = self._from_plane @ moved_in_plane
        if not self.has_play:
            return Spring(k, moved, ())
        sides = self.sides(force_n)
        held = side_of(sides) if held is None else held
        with_play = self._half_rad > 0.0
        is_open = with_play & (held == 0.0)
        at = np.where(is_open, np.where(with_play, sides, 0.0), held) * self._half_rad
        in_body = self.turns_in_body()
        moved = moved + at @ in_body
        if np.any(is_open):
            yields = self._half_rad[is_open] / (self._closes_at_n * np.abs(self._turns[is_open]).sum(axis=1))
            k = np.linalg.inv(np.linalg.inv(k) + (in_body[is_open].T * yields) @ in_body[is_open])
        return Spring(k, moved, tuple(joint for joint, one in zip(JOINTS, is_open, strict=True) if one))


def side_of(sides: np.ndarray) -> np.ndarray:
    """-1, 0 or 1 of each joint: the side of its play, 0 within it."""
    return np.where(np.abs(sides) < 1.0, 0.0, np.sign(sides))


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
