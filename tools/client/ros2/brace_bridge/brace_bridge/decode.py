"""From CAN frames to what a LimbStiffness message holds. Knows nothing of ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass

from brace.bus.frame import Frame
from brace.bus.snapshot import Joiner, Snapshot, heartbeat_of
from brace.errors import VersionMismatchError
from brace.wire.frames import DICTIONARY_HASH, MESSAGES

N_PER_M = 1000.0  # in a N/mm
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


class Decoder:
    """Frames of any number of controllers, in the order they came."""

    def __init__(self) -> None:
        self._joiner = Joiner()

    def add(self, frame: Frame) -> LimbStiffness | None:
        """What this frame completes: K alone, and where they are sent, K with eigenvalues and posture once more.
        VersionMismatchError when a heartbeat tells of another dictionary."""
        heartbeat = heartbeat_of(frame)
        if heartbeat is not None and heartbeat.dictionary_hash != DICTIONARY_HASH:
            raise VersionMismatchError(
                f"controller {heartbeat.node} speaks another dictionary",
                where=f"heartbeat of node {heartbeat.node}",
                why=f"its hash is 0x{heartbeat.dictionary_hash:08x}, this bridge's 0x{DICTIONARY_HASH:08x}",
                next_step="use the brace package of the firmware's version, or brace flash",
            )
        snapshot = self._joiner.add(frame)
        return None if snapshot is None else message_of(snapshot)


def message_of(snapshot: Snapshot) -> LimbStiffness:
    """A snapshot in SI units."""
    femur, tibia = snapshot.play or ("unknown", "unknown")
    has_posture = snapshot.has_posture
    return LimbStiffness(
        stamp_s=snapshot.time_s - (snapshot.age_ms or 0.0) * 1e-3,
        node=snapshot.node,
        sequence=snapshot.sequence,
        k_is_valid=snapshot.is_valid,
        flags=_bits("stiffness_a", "flags", snapshot.flags),
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
        mode=_code("posture", "mode", snapshot.mode) if has_posture else 0,
        faults=_bits("posture", "faults", snapshot.faults),
    )


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
