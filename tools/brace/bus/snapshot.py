"""Frames of one snapshot, put together: never a K of two ticks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from brace.bus.frame import NODE_MASK, Frame
from brace.wire.frames import FD_MESSAGES, MESSAGES
from brace.wire.layout import Layout, Value

# Halves with one number that lie further apart are of two rounds of the 8-bit counter: the shortest round is 256 ticks
# of 250 us, 0.064 s.
PAIR_S = 0.040
_LAYOUT_OF = {layout.identifier: layout for layout in MESSAGES.values()}
_WHOLE = FD_MESSAGES["snapshot_fd"]
_PARTS = ("stiffness_a", "stiffness_b", "eigenvalues", "posture")


@dataclass(frozen=True)
class Snapshot:
    """K of one tick; None: not known. Eigenvalues and posture come with every few snapshots only."""

    node: int
    time_s: float
    sequence: int
    k_xx: Value  # N/mm
    k_xz: Value
    k_zz: Value
    flags: tuple[str, ...]
    age_ms: Value = None
    play: tuple[str, ...] = ()
    parameter_tag: Value = None
    has_posture: bool = False  # the six below are of this snapshot
    lambda_min: Value = None  # N/mm
    lambda_max: Value = None
    stiff_axis: Value = None  # rad
    theta1: Value = None
    theta2: Value = None
    mode: str = ""
    faults: tuple[str, ...] = ()

    @property
    def is_valid(self) -> bool:
        """K may be used, with its flags."""
        return None not in (self.k_xx, self.k_xz, self.k_zz)

    def as_json(self) -> dict[str, Any]:
        """Names with units, as brace k and brace sim use them."""
        entry: dict[str, Any] = {
            "node": self.node,
            "time_s": round(self.time_s, 6),
            "sequence": self.sequence,
            "k_is_valid": self.is_valid,
            "k_xx_n_per_mm": self.k_xx,
            "k_xz_n_per_mm": self.k_xz,
            "k_zz_n_per_mm": self.k_zz,
            "flag_names": list(self.flags),
            "age_ms": self.age_ms,
            "play": list(self.play),
        }
        if self.parameter_tag is not None:
            entry["parameter_tag"] = f"{self.parameter_tag:04x}"
        if self.has_posture:
            entry |= {
                "lambda_min_n_per_mm": self.lambda_min,
                "lambda_max_n_per_mm": self.lambda_max,
                "stiff_axis_rad": self.stiff_axis,
                "theta1_rad": self.theta1,
                "theta2_rad": self.theta2,
                "mode": self.mode,
                "faults": list(self.faults),
            }
        return entry


@dataclass(frozen=True)
class Heartbeat:
    """A controller lives."""

    node: int
    time_s: float
    state: str
    mode: str
    faults: tuple[str, ...]
    dictionary_hash: int


@dataclass(frozen=True)
class Emergency:
    """A fault has come or gone."""

    node: int
    time_s: float
    error_code: int
    mode: str
    faults: tuple[str, ...]


@dataclass
class _Half:
    time_s: float
    values: Mapping[str, Value]


class Joiner:
    """Snapshots from frames of any number of nodes."""

    def __init__(self) -> None:
        self._stiffness_a: dict[int, _Half] = {}
        self._eigenvalues: dict[int, _Half] = {}
        self._whole: dict[int, Snapshot] = {}
        self._seen: set[int] = set()
        self.unmatched = 0  # halves whose other half never came

    def add(self, frame: Frame) -> Snapshot | None:
        """The snapshot that this frame completes: first with K alone, then, where they are sent, with eigenvalues and
        posture too (has_posture). Over CAN FD one frame has all of it."""
        if frame.identifier & ~NODE_MASK == _WHOLE.identifier and len(frame.data) == _WHOLE.size and frame.node != 0:
            return _whole(frame)
        layout = _LAYOUT_OF.get(frame.identifier & ~NODE_MASK)
        if layout is None or layout.name not in _PARTS or len(frame.data) != 8 or frame.node == 0:
            return None
        values = layout.decode(frame.data)
        if layout.name == "stiffness_a":
            self._seen.add(frame.node)
            if frame.node in self._stiffness_a:
                self.unmatched += 1
            self._stiffness_a[frame.node] = _Half(frame.time_s, values)
        elif layout.name == "eigenvalues":
            self._eigenvalues[frame.node] = _Half(frame.time_s, values)
        elif layout.name == "stiffness_b":
            return self._join_stiffness(frame, layout, values)
        else:
            return self._join_posture(frame, layout, values)
        return None

    def _join_stiffness(self, frame: Frame, layout: Layout, b: Mapping[str, Value]) -> Snapshot | None:
        a = self._stiffness_a.pop(frame.node, None)
        if not _fit(a, frame, b) or a is None:
            self.unmatched += frame.node in self._seen  # we may have come between the two
            return None
        snapshot = Snapshot(
            node=frame.node,
            time_s=frame.time_s,
            sequence=int(b["sequence"] or 0),
            k_xx=a.values["k_xx"],
            k_xz=a.values["k_xz"],
            k_zz=b["k_zz"],
            flags=bit_names(MESSAGES["stiffness_a"], "flags", a.values),
            age_ms=b["age"],
            play=(name_of(layout, "play_femur", b), name_of(layout, "play_tibia", b)),
            parameter_tag=b["parameter_tag"],
        )
        self._whole[frame.node] = snapshot
        return snapshot

    def _join_posture(self, frame: Frame, layout: Layout, posture: Mapping[str, Value]) -> Snapshot | None:
        eigenvalues = self._eigenvalues.pop(frame.node, None)
        whole = self._whole.get(frame.node)
        if whole is None or eigenvalues is None or not _fit(eigenvalues, frame, posture):
            return None
        if whole.sequence != posture["sequence"] or abs(frame.time_s - whole.time_s) > PAIR_S:
            return None
        del self._whole[frame.node]
        return replace(
            whole,
            has_posture=True,
            lambda_min=eigenvalues.values["lambda_min"],
            lambda_max=eigenvalues.values["lambda_max"],
            stiff_axis=eigenvalues.values["stiff_axis"],
            theta1=posture["theta1"],
            theta2=posture["theta2"],
            mode=name_of(layout, "mode", posture),
            faults=bit_names(layout, "faults", posture),
        )


def _whole(frame: Frame) -> Snapshot:
    values = _WHOLE.decode(frame.data)
    return Snapshot(
        node=frame.node,
        time_s=frame.time_s,
        sequence=int(values["sequence"] or 0) & 0xFF,
        k_xx=values["k_xx"],
        k_xz=values["k_xz"],
        k_zz=values["k_zz"],
        flags=bit_names(_WHOLE, "flags", values),
        age_ms=values["age"],
        play=(name_of(_WHOLE, "play_femur", values), name_of(_WHOLE, "play_tibia", values)),
        parameter_tag=int(values["parameter_crc"] or 0) & 0xFFFF,
        has_posture=True,
        lambda_min=values["lambda_min"],
        lambda_max=values["lambda_max"],
        stiff_axis=values["stiff_axis"],
        theta1=values["theta1"],
        theta2=values["theta2"],
        mode=name_of(_WHOLE, "mode", values),
        faults=bit_names(_WHOLE, "faults", values),
    )


def _fit(half: _Half | None, frame: Frame, values: Mapping[str, Value]) -> bool:
    return (
        half is not None
        and half.values["sequence"] == values["sequence"]
        and abs(frame.time_s - half.time_s) <= PAIR_S
    )


def heartbeat_of(frame: Frame) -> Heartbeat | None:
    """A heartbeat, or None."""
    layout = MESSAGES["heartbeat"]
    if frame.identifier & ~NODE_MASK != layout.identifier or len(frame.data) != 8 or frame.node == 0:
        return None
    values = layout.decode(frame.data)
    return Heartbeat(
        frame.node,
        frame.time_s,
        name_of(layout, "state", values),
        name_of(layout, "mode", values),
        bit_names(layout, "faults", values),
        int(values["dictionary_hash"] or 0),
    )


def emergency_of(frame: Frame) -> Emergency | None:
    """An emergency, or None."""
    layout = MESSAGES["emergency"]
    if frame.identifier & ~NODE_MASK != layout.identifier or len(frame.data) != 8 or frame.node == 0:
        return None
    values = layout.decode(frame.data)
    return Emergency(
        frame.node,
        frame.time_s,
        int(values["error_code"] or 0),
        name_of(layout, "mode", values),
        bit_names(layout, "faults", values),
    )


def name_of(layout: Layout, field: str, values: Mapping[str, Value]) -> str:
    """A number's meaning."""
    code = int(values[field] or 0)
    return next(item.names for item in layout.fields if item.name == field).get(code, str(code)).lower()


def bit_names(layout: Layout, field: str, values: Mapping[str, Value]) -> tuple[str, ...]:
    """The set bits' meanings; those of faults in small letters, as brace sim prints them."""
    names = next(item.bit_names for item in layout.fields if item.name == field)
    found = names_of_bits(names, int(values[field] or 0))
    return tuple(name.lower() for name in found) if field == "faults" else found


def names_of_bits(names: tuple[str, ...], bits: int) -> tuple[str, ...]:
    """Bits without a name by their number."""
    return tuple(
        names[bit] if bit < len(names) else f"BIT_{bit}"
        for bit in range(bits.bit_length())
        if bits >> bit & 1
    )
