"""This module decodes CAN frames of a stance's limbs for the ROS bridge. It does not import ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from brace.bus.frame import Frame
from brace.stance.limb_law import UNSURE_N
from brace.stance.stance_file import load_stance
from brace.stance.watching import Shown, Watching

MM_PER_M = 1000.0
_PERIOD_S = 0.01  # frames that came within it are taken together
_EVERY_S = 0.05  # between two messages
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class StanceFoot:
    """The fields of msg/StanceFoot.msg, in SI units."""

    name: str
    node: int
    force: Vector
    force_covariance: list[float]
    is_down: bool
    margin: float
    margin_sigma: float
    is_alarm: bool
    age: float
    why: str


@dataclass(frozen=True)
class Stance:
    """The fields of msg/Stance.msg, in SI units; stamp_s takes the header's place. carried: force and moment."""

    stamp_s: float
    feet: list[StanceFoot]
    carried: tuple[Vector, Vector]
    carried_sigma: Vector
    displacement: Vector
    rotation: Vector
    next_to_let_go: str
    further_payload_factor: float


class StanceDecoder:
    """Frames of all controllers of a stance, in the order they came."""

    def __init__(self, path: str, where: str) -> None:
        """path: of stance.toml. Raises BraceError."""
        self._watching = Watching(load_stance(Path(path)), where, UNSURE_N, None)
        self._held: list[Frame] = []
        self._next_s = -math.inf

    def add(self, frame: Frame) -> Stance | None:
        """A message, twenty times a second once all limbs are heard. Raises LooseError where the limbs do not hold the
        body."""
        self._held.append(frame)
        if frame.time_s - self._held[0].time_s < _PERIOD_S:
            return None
        frames, self._held = self._held, []
        is_heard = self._watching.take(frames, frame.time_s)
        if not is_heard or frame.time_s < self._next_s:
            return None
        self._next_s = frame.time_s + _EVERY_S
        return stance_of(self._watching.shown())


def stance_of(shown: Shown) -> Stance:
    """A stance in SI units."""
    estimate, slip = shown.estimate, shown.next_slip
    is_named = slip is not None and slip.limb >= 0
    feet = [
        StanceFoot(
            name=limb.name,
            node=limb.node,
            force=_vector(estimate.force_n[i]),
            force_covariance=[float(one) for one in estimate.force_covariance_n2[i].ravel()],
            is_down=estimate.is_down[i],
            margin=float(estimate.margin_n[i]),
            margin_sigma=float(estimate.margin_sigma_n[i]),
            is_alarm=limb.name in shown.alarms,
            age=math.nan if (age_s := shown.news[i].age_s) is None else age_s,
            why=",".join(shown.why(i)),
        )
        for i, limb in enumerate(shown.stance.limbs)
    ]
    return Stance(
        stamp_s=estimate.time_s,
        feet=feet,
        carried=(_vector(estimate.carried_n[:3]), _vector(estimate.carried_n[3:] / MM_PER_M)),
        carried_sigma=_vector(estimate.carried_sigma_n[:3]),
        displacement=_vector(estimate.displacement_mm / MM_PER_M),
        rotation=_vector(estimate.rotation_rad),
        next_to_let_go=shown.stance.limbs[slip.limb].name if slip is not None and is_named else "",
        further_payload_factor=slip.factor if slip is not None and is_named else math.nan,
    )


def _vector(values: np.ndarray) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
