"""One limb of a stance as a spring: where its tip is, how a force moves it, K there; all in the body's frame."""

from __future__ import annotations

from copy import copy
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
        self._limb, self._model, self._down = limb, model or limb.model, down
        true = limb.theta_rad + [self._model.number(f"joint.{joint}.zero_offset_rad") for joint in JOINTS]
        self.shape = shape_of(limb, self._model, true)
        self._from_plane, self._turns, self.tip_mm = self.shape.from_plane, self.shape.turns, self.shape.tip_mm
        gaps = np.array([self._model.number(f"joint.{joint}.gap_rad") for joint in JOINTS])
        self.half_rad = np.maximum(0.5 * gaps, 0.0)  # of each joint's play
        self.closing_n_mm = closes_at_n * np.abs(self._turns).sum(axis=1)  # loads that hold the joints on a side
        self.weight_n_mm = self._weight_torques_n_mm()  # what the limb's own weight asks of the joints
        self.has_play = bool(np.any(self.half_rad))
        # The search for joints' sides changes one joint of one limb at a time: the other springs are those of before.
        self._last: tuple[tuple[bytes, bytes], Spring] | None = None
        self._last_without_play: tuple[bytes, tuple[np.ndarray, np.ndarray]] | None = None
        self._loaded = LoadedLimbInSpace(self._model.with_values(_gravity(self._from_plane.T @ down)))

    def at(self, way_mm: np.ndarray) -> LimbLaw:
        """The same spring, its tip without load elsewhere by a short way: K changes by as little as the angles."""
        moved = copy(self)
        moved.tip_mm = self.tip_mm + way_mm
        return moved

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

    def play_covariance_mm2(self) -> np.ndarray:
        """3 x 3: of the tip's place in the body's frame, a joint being anywhere within its play."""
        turns = self.turns_in_body()
        return np.asarray((turns.T * (self.half_rad**2 / 3.0)) @ turns)

    def torques_n_mm(self, force_n: np.ndarray) -> np.ndarray:
        """What a force of the ground on the tip and the limb's own weight ask of coxa, femur and tibia, in the sense of
        their angles."""
        return np.asarray(self._turns @ (self._from_plane.T @ force_n) + self.weight_n_mm)

    def force_of_torques_n(self, torque_n_mm: np.ndarray) -> np.ndarray:
        """The force of the ground on the tip that goes with the joints' torques, in the body's frame."""
        return np.asarray(self._from_plane @ np.linalg.solve(self._turns, torque_n_mm - self.weight_n_mm))

    def force_by_torque(self) -> np.ndarray:
        """3 x 3: how the ground's force in the body's frame changes with the joints' torques [1/mm]."""
        return np.asarray(self._from_plane @ np.linalg.inv(self._turns))

    def _weight_torques_n_mm(self) -> np.ndarray:
        if not any(newton for newton, _ in self.weights()):
            return np.zeros(3)
        up, left = self._from_plane[:, 2], self._from_plane[:, 1]
        joints = ((up, self._limb.mount_mm, 0), (-left, self.shape.hip_mm, 0), (left, self.shape.knee_mm, 2))
        weights = self.weights()
        return np.array(
            [
                sum(float(axis @ cross(at - joint, newton * self._down)) for newton, at in weights[beyond:])
                for axis, joint, beyond in joints
            ]
        )

    def sides(self, force_n: np.ndarray) -> np.ndarray:
        """How surely a force of the ground on the tip holds each joint on a side of its play: beyond 1 on its positive
        side, below -1 on its negative one, between them in its play; infinite without play."""
        loads = self.torques_n_mm(force_n)
        return np.where(self.half_rad > 0.0, loads / self.closing_n_mm, np.inf)

    def spring(self, force_n: np.ndarray, held: np.ndarray | None = None) -> Spring:
        """At a force of the ground on the tip. held: the joints are taken to lie on these sides, -1, 0 or 1, whatever
        the force says; None: where it holds them. Raises GivesWayError where the limb has no rest under it."""
        if not self.has_play:
            return Spring(*self.without_play(force_n), ())
        sides = self.sides(force_n) if held is None or not np.all(held) else held
        held = side_of(sides) if held is None else held
        key = (force_n.tobytes(), held.tobytes())
        if self._last is None or self._last[0] != key:
            self._last = key, self._held_spring(force_n, sides, held)
        return self._last[1]

    def _held_spring(self, force_n: np.ndarray, sides: np.ndarray, held: np.ndarray) -> Spring:
        key = force_n.tobytes()
        if self._last_without_play is None or self._last_without_play[0] != key:
            self._last_without_play = key, self.without_play(force_n)
        k, moved = self._last_without_play[1]
        with_play = self.half_rad > 0.0
        is_open = with_play & (held == 0.0)
        at = np.where(is_open, sides, held) * self.half_rad
        in_body = self.turns_in_body()
        moved = moved + at @ in_body
        if not is_open.any():
            return Spring(k, moved, ())
        yields = self.half_rad[is_open] / self.closing_n_mm[is_open]
        k = np.linalg.inv(np.linalg.inv(k) + (in_body[is_open].T * yields) @ in_body[is_open])
        return Spring(k, moved, tuple(joint for joint, one in zip(JOINTS, is_open, strict=True) if one))

    def without_play(self, force_n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """K [N/mm] and the tip's displacement [mm] at a force of the ground on the tip, as if every joint were stiff in
        the middle of its play. Raises GivesWayError."""
        in_plane = self._from_plane.T @ force_n
        try:
            found = self._loaded.spring(self._limb.theta_rad, in_plane)
        except PostureError as error:
            raise GivesWayError(f"limb {self._limb.name!r}: {error.text}") from None
        if found is None:
            raise GivesWayError(f"limb {self._limb.name!r} gives way: a link buckles or a joint turns too far")
        entries, moved_in_plane = found
        return self._from_plane @ entries[MATRIX] @ self._from_plane.T, self._from_plane @ moved_in_plane


def side_of(sides: np.ndarray) -> np.ndarray:
    """-1, 0 or 1 of each joint: the side of its play, 0 within it."""
    return np.where(np.abs(sides) < 1.0, 0.0, np.sign(sides))


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """a x b along the last axis: numpy's own takes four times as long for so few."""
    one, two = [1, 2, 0], [2, 0, 1]
    return np.asarray(a[..., one] * b[..., two] - a[..., two] * b[..., one])


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
