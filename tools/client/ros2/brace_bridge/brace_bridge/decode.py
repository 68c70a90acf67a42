"""This module decodes CAN frames into the values that the ROS bridge publishes. It does not import ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass

from brace.bus.frame import Frame
from brace.bus.drift import cause_text
from brace.bus.load import Load
from brace.bus.sigma import SIGMA_ENTRIES, SPACE_ENTRIES, Sigma
from brace.bus.snapshot import Heartbeat, Joiner, Snapshot, condition_of, emergency_of, heartbeat_of
from brace.bus.space import SpaceSnapshot
from brace.wire.codes import FAULT, PLAY
from brace.wire.frames import DICTIONARY_HASH, MESSAGES

N_PER_M = 1000.0  # in a N/mm
MM_PER_M = 1000.0
_NAN = math.nan


@dataclass(frozen=True)
class LimbStiffness:
    """The fields of msg/LimbStiffness.msg, in SI units; stamp_s takes the header's place."""

    stamp_s: float
    node: int
    sequence: int
    k_is_valid: bool
    flags: int
    k_xx: float
    k_xz: float
    k_zz: float
    play_femur: int
    play_tibia: int
    has_posture: bool
    lambda_min: float
    lambda_max: float
    stiff_axis: float
    theta1: float
    theta2: float
    mode: int
    faults: int


@dataclass(frozen=True)
class LimbStiffnessInSpace:
    """The fields of msg/LimbStiffnessInSpace.msg, in SI units; stamp_s takes the header's place."""

    stamp_s: float
    node: int
    sequence: int
    k_is_valid: bool
    flags: int
    k_xx: float
    k_xy: float
    k_xz: float
    k_yy: float
    k_yz: float
    k_zz: float
    lambda_1: float
    lambda_2: float
    lambda_3: float
    stiff_axis_x: float
    stiff_axis_y: float
    stiff_axis_z: float
    theta0: float
    k_across: float
    play_coxa: int


@dataclass(frozen=True)
class LimbLoad:
    """The fields of msg/LimbLoad.msg, in SI units; stamp_s takes the header's place."""

    stamp_s: float
    node: int
    sequence: int
    is_counted: bool
    force_x: float
    force_y: float
    force_z: float
    moved_x: float
    moved_y: float
    moved_z: float
    buckling_factor: float
    unloaded_k_xx: float
    unloaded_k_xz: float
    unloaded_k_zz: float
    unloaded_k_across: float
    gravity_direction: float
    gravity_lean: float


@dataclass(frozen=True)
class LimbUncertainty:
    """The fields of msg/LimbUncertainty.msg, in SI units; stamp_s takes the header's place."""

    stamp_s: float
    node: int
    sequence: int
    k_xx: float
    k_xz: float
    k_zz: float
    lambda_min: float
    lambda_max: float
    stiff_axis: float
    space_k_xx: float
    space_k_xy: float
    space_k_xz: float
    space_k_yy: float
    space_k_yz: float
    space_k_zz: float
    space_lambda_1: float
    space_lambda_2: float
    space_lambda_3: float
    k_across: float


@dataclass(frozen=True)
class LimbHealth:
    """What a diagnostic says of a limb."""

    stamp_s: float
    node: int
    level: int  # as diagnostic_msgs numbers them: 0 OK, 1 WARN, 2 ERROR
    text: str
    faults: tuple[str, ...]
    drift_cause: str  # none: no drift; empty: a drift whose cause was reported before this bridge listened


Message = LimbStiffness | LimbStiffnessInSpace | LimbLoad | LimbUncertainty | LimbHealth
OK, WARN, ERROR = range(3)
_NOT_HEARD = 0xFFFFFFFF
_NO_K = {"sensor_femur", "sensor_tibia", "encoder_stuck"}
_DRIFT = "model_drift"


class Decoder:
    """Frames of any number of controllers, in the order they came."""

    def __init__(self) -> None:
        self._joiner = Joiner()
        self._reported: dict[int, tuple[int, float]] = {}  # by node: the snapshot whose K in the plane has been given
        self._load_reported: dict[int, tuple[int, float]] = {}  # the same of its load
        self._sigma_reported: dict[int, tuple[tuple[int, float], Sigma]] = {}  # and of its uncertainty
        self._cause: dict[int, str] = {}
        self._strangers: set[int] = set()  # nodes with another dictionary: their frames mean something else

    def add(self, frame: Frame) -> list[Message]:
        """What this frame completes: K alone; K in space; its load; its uncertainty; K with eigenvalues and posture once more; with a
        condition or an emergency the limb's health. Of a controller whose heartbeat reports another dictionary: that
        it does, and nothing else."""
        heartbeat = heartbeat_of(frame)
        if heartbeat is not None:
            if heartbeat.dictionary_hash != DICTIONARY_HASH:
                self._strangers.add(heartbeat.node)
                return [_stranger(heartbeat)]
            self._strangers.discard(heartbeat.node)
            return []
        if frame.node in self._strangers:
            return []
        snapshot = self._joiner.add(frame)
        if snapshot is not None:
            return self._messages_of(snapshot)
        condition = condition_of(frame)
        if condition is not None:
            return [self._health(condition.time_s, condition.node, condition.faults)]
        emergency = emergency_of(frame)
        if emergency is not None:
            self._cause[emergency.node] = emergency.drift_cause
            return [self._health(emergency.time_s, emergency.node, emergency.faults)]
        return []

    def _messages_of(self, snapshot: Snapshot) -> list[Message]:
        messages: list[Message] = []
        this = (snapshot.sequence, snapshot.time_s)
        if snapshot.adds not in ("space", "load", "sigma") or self._reported.get(snapshot.node) != this:
            messages.append(message_of(snapshot))
        self._reported[snapshot.node] = this
        if snapshot.adds == "space" and snapshot.space is not None:
            messages.append(space_message_of(snapshot, snapshot.space))
        if snapshot.load is not None and self._load_reported.get(snapshot.node) != this:
            self._load_reported[snapshot.node] = this
            messages.append(load_message_of(snapshot, snapshot.load))
        if snapshot.sigma is not None and self._sigma_reported.get(snapshot.node) != (this, snapshot.sigma):
            self._sigma_reported[snapshot.node] = (this, snapshot.sigma)
            messages.append(uncertainty_message_of(snapshot, snapshot.sigma))
        return messages

    def _health(self, time_s: float, node: int, faults: tuple[str, ...]) -> LimbHealth:
        cause = self._cause.get(node, "") if _DRIFT in faults else "none"
        texts = {code.name.lower(): code.text for code in FAULT.codes}
        lines = [texts.get(name, name) for name in faults]
        if cause not in ("", "none"):
            lines.append(f"The drift's likeliest cause is {cause_text(cause)}")
        level = ERROR if _NO_K & set(faults) else WARN if faults else OK
        return LimbHealth(time_s, node, level, " ".join(lines) or "No fault is there.", faults, cause)


def _stranger(heartbeat: Heartbeat) -> LimbHealth:
    text = (
        f"The controller speaks another dictionary: its hash is 0x{heartbeat.dictionary_hash:08x}, this bridge's "
        f"0x{DICTIONARY_HASH:08x}. Use the brace package of the firmware's version, or brace flash."
    )
    return LimbHealth(heartbeat.time_s, heartbeat.node, ERROR, text, ("another_dictionary",), "none")


def message_of(snapshot: Snapshot) -> LimbStiffness:
    """A snapshot in SI units."""
    femur, tibia = snapshot.play or ("unknown", "unknown")
    has_posture = snapshot.has_posture
    return LimbStiffness(
        stamp_s=_sampled_s(snapshot),
        node=snapshot.node,
        sequence=snapshot.sequence,
        k_is_valid=snapshot.is_valid,
        flags=_bits("stiffness_b", "flags", snapshot.flags),
        k_xx=_per_m(snapshot.k_xx),
        k_xz=_per_m(snapshot.k_xz),
        k_zz=_per_m(snapshot.k_zz),
        play_femur=_code("stiffness_b", "play_femur", femur),
        play_tibia=_code("stiffness_b", "play_tibia", tibia),
        has_posture=has_posture,
        lambda_min=_per_m(snapshot.lambda_min),
        lambda_max=_per_m(snapshot.lambda_max),
        stiff_axis=_or_nan(snapshot.stiff_axis),
        theta1=_or_nan(snapshot.theta1),
        theta2=_or_nan(snapshot.theta2),
        mode=_code("stiffness_b", "mode", snapshot.mode),
        faults=_NOT_HEARD if snapshot.faults is None else _bits("emergency", "faults", snapshot.faults),
    )


def space_message_of(snapshot: Snapshot, space: SpaceSnapshot) -> LimbStiffnessInSpace:
    """K in space in SI units."""
    names = [code.name.lower() for code in PLAY.codes]
    return LimbStiffnessInSpace(
        _sampled_s(snapshot),
        snapshot.node,
        snapshot.sequence,
        space.is_valid,
        _bits("stiffness_b", "flags", space.flags),
        *map(_per_m, space.k),
        *map(_per_m, space.eigenvalues),
        *map(_or_nan, space.stiff_axis),
        theta0=_or_nan(space.theta0),
        k_across=_per_m(space.k_across),
        play_coxa=names.index(space.play_coxa) if space.play_coxa in names else int(space.play_coxa),
    )


def load_message_of(snapshot: Snapshot, load: Load) -> LimbLoad:
    """The load in SI units."""
    v = load.values
    return LimbLoad(
        stamp_s=_sampled_s(snapshot),
        node=snapshot.node,
        sequence=snapshot.sequence,
        is_counted=load.is_counted,
        force_x=_or_nan(v["counted_force_x"]),
        force_y=_or_nan(v.get("counted_force_y")),
        force_z=_or_nan(v["counted_force_z"]),
        moved_x=_or_nan(v["moved_x"]) / MM_PER_M,
        moved_y=_or_nan(v.get("moved_y")) / MM_PER_M,
        moved_z=_or_nan(v["moved_z"]) / MM_PER_M,
        buckling_factor=_or_nan(v["buckling_factor"]),
        unloaded_k_xx=_per_m(v["unloaded_k_xx"]),
        unloaded_k_xz=_per_m(v["unloaded_k_xz"]),
        unloaded_k_zz=_per_m(v["unloaded_k_zz"]),
        unloaded_k_across=_per_m(v.get("unloaded_k_across")),
        gravity_direction=_or_nan(v["gravity_direction"]),
        gravity_lean=_or_nan(v["gravity_lean"]),
    )


def uncertainty_message_of(snapshot: Snapshot, sigma: Sigma) -> LimbUncertainty:
    """How sure K is, in SI units."""
    plane, space = sigma.values, sigma.space or {}
    return LimbUncertainty(
        _sampled_s(snapshot),
        snapshot.node,
        snapshot.sequence,
        *(_per_m(plane[name]) for name in SIGMA_ENTRIES[:-1]),
        stiff_axis=_or_nan(plane["stiff_axis"]),
        **{name: _per_m(space.get(name)) for name in SPACE_ENTRIES},
    )


def _sampled_s(snapshot: Snapshot) -> float:
    return snapshot.time_s - (snapshot.age_ms or 0.0) * 1e-3


def _or_nan(value: float | None) -> float:
    return _NAN if value is None else float(value)


def _per_m(value: float | None) -> float:
    return _or_nan(value) * N_PER_M


def _code(message: str, field: str, name: str) -> int:
    names = next(entry.names for entry in MESSAGES[message].fields if entry.name == field)
    return next((code for code, known in names.items() if known.lower() == name), int(name) if name.isdigit() else 0)


def _bits(message: str, field: str, names: tuple[str, ...]) -> int:
    known = next(entry.bit_names for entry in MESSAGES[message].fields if entry.name == field)
    bits = 0
    for name in names:
        if name.upper().startswith("BIT_"):
            bits |= 1 << int(name[4:])
        else:
            bits |= 1 << known.index(name.upper())
    return bits
