"""Frames of one snapshot, put together: never a K of two ticks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import NamedTuple

from brace.bus.frame import NODE_MASK, Frame
from brace.bus.load import Load, load_of
from brace.bus.space import SpaceSnapshot, space_snapshot
from brace.wire.frames import FD_MESSAGES, MESSAGES, MULTIPLEXED
from brace.wire.layout import Layout, Value

# Halves with one number that lie further apart are of two rounds of the 8-bit counter: the shortest round is 256 ticks
# of 500 us, 0.128 s.
PAIR_S = 0.040
_STIFFNESS_A, _STIFFNESS_B = MESSAGES["stiffness_a"], MESSAGES["stiffness_b"]
_EIGENVALUES, _POSTURE = MESSAGES["eigenvalues"], MESSAGES["posture"]
_WHOLE = FD_MESSAGES["snapshot_fd"]
_SPACE_FD = FD_MESSAGES["space_fd"]
_LOAD_FD = FD_MESSAGES["load_fd"]


class Snapshot(NamedTuple):
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
    space: SpaceSnapshot | None = None  # of this snapshot; None: the limb has no coxa joint, or it has not come (yet)
    load: Load | None = None  # of this snapshot; None: it is not sent, or it has not come (yet)
    adds: str = "stiffness"  # what has come last of it: stiffness, space, posture, load

    @property
    def is_valid(self) -> bool:
        """K may be used, with its flags."""
        return None not in (self.k_xx, self.k_xz, self.k_zz)

    def as_json(self) -> dict[str, object]:
        """Names with units, as brace k and brace sim use them."""
        entry: dict[str, object] = {
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
        if self.space is not None:
            entry["space"] = self.space.as_json()
        if self.load is not None:
            entry["load"] = self.load.as_json()
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
    drift_cause: str  # none while there is no fault model_drift


@dataclass
class _Parts:
    """Frames of one message that carry one number. They are decoded where a snapshot wants them."""

    layouts: tuple[Layout, ...]
    time_s: float  # of the first
    sequence: int
    parts: dict[int, bytes] = field(default_factory=dict)

    @property
    def is_whole(self) -> bool:
        return len(self.parts) == len(self.layouts)

    def values(self) -> dict[str, Value]:
        found: dict[str, Value] = {}
        for part, data in self.parts.items():
            found |= self.layouts[part].decode(data)
        return found


class Joiner:
    """Snapshots from frames of any number of nodes."""

    def __init__(self) -> None:
        self._stiffness_a: dict[int, Frame] = {}
        self._eigenvalues: dict[int, Frame] = {}
        self._parts: dict[tuple[str, int], _Parts] = {}  # by message and node
        self._newest: dict[int, Snapshot] = {}
        self._seen: set[int] = set()
        self._sends_space: set[int] = set()
        self._sends_across: set[int] = set()  # the load across the plane, too
        self._whole_alone: dict[int, int] = {}  # of CAN FD: how many have come since K in space did
        self.unmatched = 0  # snapshots some of whose frames never came
        takers: list[tuple[Layout, Callable[[int, Frame], Snapshot | None]]] = [
            (_STIFFNESS_A, self._take_stiffness_a),
            (_STIFFNESS_B, self._join_stiffness),
            (_EIGENVALUES, self._take_eigenvalues),
            (_POSTURE, self._join_posture),
            *((MULTIPLEXED[name][0], partial(self._take_part, name)) for name in ("space", "load", "load_across")),
            (_WHOLE, self._take_whole),
            (_SPACE_FD, self._take_space_fd),
            (_LOAD_FD, self._take_load_fd),
        ]
        self._takers = {layout.identifier: (layout.size, take) for layout, take in takers}

    def add(self, frame: Frame) -> Snapshot | None:
        """The snapshot that this frame completes or adds to: first with K alone, then, where they are sent, with K in
        space, with its load, and with eigenvalues and posture. Over CAN FD one frame has all of it but K in space and
        the load."""
        message, node = frame.identifier & ~NODE_MASK, frame.identifier & NODE_MASK
        taker = self._takers.get(message)
        if taker is None or len(frame.data) != taker[0] or node == 0:
            return None
        return taker[1](node, frame)

    def is_complete(self, snapshot: Snapshot) -> bool:
        """Has all of it come that this node sends? Over CAN FD, K in space comes behind the rest."""
        if not snapshot.has_posture or snapshot.space is not None:
            return snapshot.has_posture
        may_follow = self._whole_alone.get(snapshot.node, 0) == 1
        return snapshot.node not in self._sends_space and not may_follow

    def _take_stiffness_a(self, node: int, frame: Frame) -> None:
        self._seen.add(node)
        self.unmatched += node in self._stiffness_a
        self._stiffness_a[node] = frame

    def _take_eigenvalues(self, node: int, frame: Frame) -> None:
        self._eigenvalues[node] = frame

    def _take_whole(self, node: int, frame: Frame) -> Snapshot:
        self._whole_alone[node] = self._whole_alone.get(node, 0) + 1
        self._newest[node] = _whole(frame)
        return self._newest[node]

    def _take_space_fd(self, node: int, frame: Frame) -> Snapshot | None:
        values = _SPACE_FD.decode(frame.data)
        self._sends_space.add(node)
        self._whole_alone[node] = 0
        return self._add_space(node, frame.time_s, int(values["sequence"] or 0) & 0xFF, values)

    def _take_load_fd(self, node: int, frame: Frame) -> Snapshot | None:
        values = _LOAD_FD.decode(frame.data)
        return self._add_load(node, frame.time_s, int(values["sequence"] or 0) & 0xFF, values, "load")

    def _join_stiffness(self, node: int, frame: Frame) -> Snapshot | None:
        first = self._stiffness_a.pop(node, None)
        if first is None or not _fit(first, frame):
            self.unmatched += node in self._seen  # we may have come between the two
            return None
        a, b = _STIFFNESS_A.decode(first.data), _STIFFNESS_B.decode(frame.data)
        self._newest[node] = Snapshot(
            node=node,
            time_s=frame.time_s,
            sequence=frame.data[0],
            k_xx=a["k_xx"],
            k_xz=a["k_xz"],
            k_zz=b["k_zz"],
            flags=bit_names(_STIFFNESS_A, "flags", a),
            age_ms=b["age"],
            play=(name_of(_STIFFNESS_B, "play_femur", b), name_of(_STIFFNESS_B, "play_tibia", b)),
            parameter_tag=b["parameter_tag"],
        )
        # they came before: their identifiers are the lower ones
        self._join_load(node, adds="stiffness")
        self._join_space(node)
        return self._newest[node]

    def _join_posture(self, node: int, frame: Frame) -> Snapshot | None:
        first = self._eigenvalues.pop(node, None)
        newest = self._of_newest(node, frame.time_s, frame.data[0])
        if newest is None or newest.has_posture or first is None or not _fit(first, frame):
            return None
        eigenvalues, posture = _EIGENVALUES.decode(first.data), _POSTURE.decode(frame.data)
        self._newest[node] = newest._replace(
            adds="posture",
            has_posture=True,
            lambda_min=eigenvalues["lambda_min"],
            lambda_max=eigenvalues["lambda_max"],
            stiff_axis=eigenvalues["stiff_axis"],
            theta1=posture["theta1"],
            theta2=posture["theta2"],
            mode=name_of(_POSTURE, "mode", posture),
            faults=bit_names(_POSTURE, "faults", posture),
        )
        return self._newest[node]

    def _take_part(self, message: str, node: int, frame: Frame) -> Snapshot | None:
        """One of the frames that carry K in space, the load, or the load across, together."""
        layouts = MULTIPLEXED[message]
        sequence, part = frame.data[0], frame.data[layouts[0].part_at // 8]
        if part >= len(layouts):
            return None
        if message == "space":
            self._sends_space.add(node)
        if message == "load_across":
            self._sends_across.add(node)
        begun = self._parts.get((message, node))
        if begun is None or begun.sequence != sequence or abs(frame.time_s - begun.time_s) > PAIR_S:
            if begun is not None and 0 in begun.parts and not begun.is_whole:
                self.unmatched += 1
            if message == "load" and begun is not None:
                self._forget_across(node, begun, sequence)
            begun = self._parts[message, node] = _Parts(layouts, frame.time_s, sequence)
        begun.parts[part] = frame.data
        if not begun.is_whole:
            return None
        if message == "space":
            return self._join_space(node)
        return self._join_load(node)

    def _forget_across(self, node: int, load: _Parts, next_sequence: int) -> None:
        """A node that has sent a load without what is across does not send that any more: its coxa joint is gone."""
        across = self._parts.get(("load_across", node))
        if load.is_whole and across is not None and across.sequence not in (load.sequence, next_sequence):
            self._sends_across.discard(node)

    def _join_load(self, node: int, adds: str = "load") -> Snapshot | None:
        """The load, and with it what is across the plane where the node sends that."""
        load = self._whole_of_newest("load", node)
        if load is None:
            return None
        across = self._parts.get(("load_across", node))
        values = load.values()
        if across is not None and across.is_whole and across.sequence == load.sequence:
            values = across.values() | values
        elif node in self._sends_across:
            return None
        return self._add_load(node, load.time_s, load.sequence, values, adds)

    def _join_space(self, node: int) -> Snapshot | None:
        space = self._whole_of_newest("space", node)
        return None if space is None else self._add_space(node, space.time_s, space.sequence, space.values())

    def _whole_of_newest(self, message: str, node: int) -> _Parts | None:
        """What has come of a message, if it is whole and of the newest snapshot."""
        parts = self._parts.get((message, node))
        if parts is None or not parts.is_whole or self._of_newest(node, parts.time_s, parts.sequence) is None:
            return None
        return parts

    def _add_load(
        self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value], adds: str
    ) -> Snapshot | None:
        newest = self._of_newest(node, time_s, sequence)
        if newest is None or newest.load is not None:
            return None
        self._newest[node] = newest._replace(adds=adds, load=load_of(values))
        return self._newest[node]

    def _add_space(self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value]) -> Snapshot | None:
        newest = self._of_newest(node, time_s, sequence)
        if newest is None or newest.space is not None:
            return None
        self._newest[node] = newest._replace(adds="space", space=space_snapshot(values))
        return self._newest[node]

    def _of_newest(self, node: int, time_s: float, sequence: Value) -> Snapshot | None:
        """The newest snapshot of a node, if a frame is of it."""
        newest = self._newest.get(node)
        is_of_it = newest is not None and newest.sequence == sequence and abs(time_s - newest.time_s) <= PAIR_S
        return newest if is_of_it else None


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
        adds="posture",
        has_posture=True,
        lambda_min=values["lambda_min"],
        lambda_max=values["lambda_max"],
        stiff_axis=values["stiff_axis"],
        theta1=values["theta1"],
        theta2=values["theta2"],
        mode=name_of(_WHOLE, "mode", values),
        faults=bit_names(_WHOLE, "faults", values),
    )


def _fit(first: Frame, second: Frame) -> bool:
    """Are they of one snapshot? Its number is their first byte."""
    return first.data[0] == second.data[0] and abs(second.time_s - first.time_s) <= PAIR_S


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
        name_of(layout, "drift_cause", values),
    )


def name_of(layout: Layout, field: str, values: Mapping[str, Value]) -> str:
    """A number's meaning."""
    return layout.codes_of(field).word_of(int(values[field] or 0))


def bit_names(layout: Layout, field: str, values: Mapping[str, Value]) -> tuple[str, ...]:
    """The set bits' meanings; those of faults in small letters, as brace sim prints them."""
    found = layout.codes_of(field).names_of_bits(int(values[field] or 0))
    return tuple(name.lower() for name in found) if field == "faults" else found
