"""Frames of one snapshot, put together: never a K of two ticks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from brace.bus.frame import NODE_MASK, Frame
from brace.bus.interval import Interval, interval_of
from brace.bus.load import Load, load_of
from brace.bus.sigma import Sigma, sigma_of
from brace.bus.space import SpaceSnapshot, space_snapshot
from brace.wire.frames import FD_GROUPS, FD_MESSAGES, GROUPS, MESSAGES
from brace.wire.layout import Layout, Value

# Halves with one number that lie further apart are of two rounds of the 8-bit counter: the shortest round is 256 ticks
# of 500 us, 0.128 s.
PAIR_S = 0.040
_STIFFNESS_A, _STIFFNESS_B = MESSAGES["stiffness_a"], MESSAGES["stiffness_b"]
_EIGENVALUES, _POSTURE = MESSAGES["eigenvalues"], MESSAGES["posture"]
_WHOLE = FD_MESSAGES["snapshot_fd"]
(_CONDITION,) = GROUPS["condition"]
_EMERGENCY, _HEARTBEAT = MESSAGES["emergency"], MESSAGES["heartbeat"]
_DETAILS = _CONDITION.identifier
_PART_BYTE = _CONDITION.part_at // 8
# Number of a part -> its group, and its place there.
_PARTS = {layout.part: (name, place) for name, group in GROUPS.items() for place, layout in enumerate(group)}
_OF_SNAPSHOTS = frozenset(
    ("space", "load", "load_across", "sigma", "sigma_space", "interval", "interval_across")
)
_PARTS_FD = {layout.part: (name, layout) for name, group in FD_GROUPS.items() for layout in group}


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
    mode: str = ""
    has_posture: bool = False  # the six below are of this snapshot
    lambda_min: Value = None  # N/mm
    lambda_max: Value = None
    stiff_axis: Value = None  # rad
    theta1: Value = None
    theta2: Value = None
    parameter_tag: Value = None
    faults: tuple[str, ...] | None = None  # as last heard: at a change, with each heartbeat; None: not yet
    sigma: Sigma | None = None  # of this snapshot; None: it is not sent, or it has not come (yet)
    space: SpaceSnapshot | None = None  # of this snapshot; None: the limb has no coxa joint, or it has not come (yet)
    load: Load | None = None  # of this snapshot; None: it is not sent, or it has not come (yet)
    interval: Interval | None = None  # of this snapshot; None: it is not sent, or it has not come (yet)
    adds: str = "stiffness"  # what has come last of it: stiffness, space, posture, load, sigma, interval

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
            "mode": self.mode,
            "faults": None if self.faults is None else list(self.faults),
        }
        if self.sigma is not None:
            entry |= self.sigma.as_json()
        if self.parameter_tag is not None:
            entry["parameter_tag"] = f"{self.parameter_tag:04x}"
        if self.has_posture:
            entry |= {
                "lambda_min_n_per_mm": self.lambda_min,
                "lambda_max_n_per_mm": self.lambda_max,
                "stiff_axis_rad": self.stiff_axis,
                "theta1_rad": self.theta1,
                "theta2_rad": self.theta2,
            }
        if self.space is not None:
            entry["space"] = self.space.as_json()
        if self.load is not None:
            entry["load"] = self.load.as_json()
        if self.interval is not None:
            entry["interval"] = self.interval.as_json()
        return entry


@dataclass(frozen=True)
class Heartbeat:
    """A controller lives."""

    node: int
    time_s: float
    state: str
    mode: str
    setting: str
    protocol: int
    dictionary_hash: int


@dataclass(frozen=True)
class Condition:
    """What is wrong, behind each heartbeat."""

    node: int
    time_s: float
    mode: str
    setting: str
    faults: tuple[str, ...]


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
        self._faults: dict[int, tuple[str, ...]] = {}  # by node, as last heard
        self._seen: set[int] = set()
        self._sends_space: set[int] = set()
        self._sends_across: set[int] = set()  # the load across the plane, too
        self._whole_alone: dict[int, int] = {}  # of CAN FD: how many have come since K in space did
        self.unmatched = 0  # snapshots some of whose frames never came
        takers: list[tuple[Layout, Callable[[int, Frame], Snapshot | None]]] = [
            (_EMERGENCY, self._take_emergency),
            (_STIFFNESS_A, self._take_stiffness_a),
            (_STIFFNESS_B, self._join_stiffness),
            (_EIGENVALUES, self._take_eigenvalues),
            (_POSTURE, self._join_posture),
            (_CONDITION, self._take_details),
            (_WHOLE, self._take_whole),
            (FD_GROUPS["space_fd"][0], self._take_details_fd),
        ]
        self._takers = {layout.identifier: (layout.size, take) for layout, take in takers}

    def add(self, frame: Frame) -> Snapshot | None:
        """The snapshot that this frame completes or adds to: first with K alone, then, where they are sent, with K in
        space, with its load, with its uncertainty, and with eigenvalues and posture. Over CAN FD one frame has all of
        it but K in space, the load and the uncertainty."""
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

    def hear_faults(self, node: int, faults: tuple[str, ...]) -> None:
        """What a controller has answered about its faults."""
        self._faults[node] = faults

    def faults_of(self, node: int) -> tuple[str, ...] | None:
        """As last heard."""
        return self._faults.get(node)

    def _take_emergency(self, node: int, frame: Frame) -> None:
        self._faults[node] = bit_names(_EMERGENCY, "faults", _EMERGENCY.decode(frame.data))

    def _take_stiffness_a(self, node: int, frame: Frame) -> None:
        self._seen.add(node)
        self.unmatched += node in self._stiffness_a
        self._stiffness_a[node] = frame

    def _take_eigenvalues(self, node: int, frame: Frame) -> None:
        self._eigenvalues[node] = frame

    def _take_whole(self, node: int, frame: Frame) -> Snapshot:
        self._whole_alone[node] = self._whole_alone.get(node, 0) + 1
        self._newest[node] = newest = _whole(frame)
        self._faults[node] = newest.faults or ()
        return newest

    def _take_details_fd(self, node: int, frame: Frame) -> Snapshot | None:
        name, layout = _PARTS_FD.get(frame.data[_PART_BYTE], ("", _WHOLE))
        values = layout.decode(frame.data) if name else {}
        if name == "space_fd":
            self._sends_space.add(node)
            self._whole_alone[node] = 0
            return self._add_space(node, frame.time_s, values["sequence"], values)
        if name == "load_fd":
            return self._add_load(node, frame.time_s, values["sequence"], values, "load")
        if name == "sigma_fd":
            return self._add_sigma(node, frame.time_s, values["sequence"], values)
        if name == "interval_fd":
            return self._add_interval(node, frame.time_s, values["sequence"], values)
        return None

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
            flags=bit_names(_STIFFNESS_B, "flags", b),
            age_ms=a["age"],
            play=(name_of(_STIFFNESS_B, "play_femur", b), name_of(_STIFFNESS_B, "play_tibia", b)),
            mode=name_of(_STIFFNESS_B, "mode", b),
            faults=self._faults.get(node),
        )
        # they may have come before: their identifier is lower than that of stiffness_b
        self._join_load(node, adds="stiffness")
        self._join_space(node)
        self._join_sigma(node, adds="stiffness")
        self._join_interval(node, adds="stiffness")
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
            parameter_tag=posture["parameter_tag"],
            faults=self._faults.get(node),
        )
        return self._newest[node]

    def _take_details(self, node: int, frame: Frame) -> Snapshot | None:
        """One of the frames that carry K in space, the load, or the uncertainty together; or the controller's
        condition. A part that we do not know is another version's."""
        message, part = _PARTS.get(frame.data[_PART_BYTE], ("", 0))
        if message == "condition":
            self._faults[node] = bit_names(_CONDITION, "faults", _CONDITION.decode(frame.data))
        if message not in _OF_SNAPSHOTS:
            return None
        layouts, sequence = GROUPS[message], frame.data[0]
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
        if message in ("interval", "interval_across"):
            return self._join_interval(node)
        return self._join_sigma(node) if message in ("sigma", "sigma_space") else self._join_load(node)

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

    def _join_sigma(self, node: int, adds: str = "sigma") -> Snapshot | None:
        """How sure K is, first in the plane, then in space too where the node sends that."""
        sigma, space = self._whole_of_newest("sigma", node), self._whole_of_newest("sigma_space", node)
        if sigma is None:
            return None
        values = sigma.values()
        if space is not None and space.sequence == sigma.sequence:
            values |= {name if name == "k_across" else f"space_{name}": v for name, v in space.values().items()}
        return self._add_sigma(node, sigma.time_s, sigma.sequence, values, adds)

    def _join_interval(self, node: int, adds: str = "interval") -> Snapshot | None:
        """Where force and loads lie, first in the plane, then across it too where the node sends that."""
        plane, across = (self._whole_of_newest(name, node) for name in ("interval", "interval_across"))
        if plane is None:
            return None
        values = plane.values()
        if across is not None and across.sequence == plane.sequence:
            values = across.values() | values
        return self._add_interval(node, plane.time_s, plane.sequence, values, adds)

    def _whole_of_newest(self, message: str, node: int) -> _Parts | None:
        """What has come of a message, if it is whole and of the newest snapshot."""
        parts = self._parts.get((message, node))
        if parts is None or not parts.is_whole or self._of_newest(node, parts.time_s, parts.sequence) is None:
            return None
        return parts

    def _add_load(
        self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value], adds: str
    ) -> Snapshot | None:
        newest, load = self._of_newest(node, time_s, sequence), load_of(values)
        if newest is None or newest.load == load:
            return None  # the same, or less what is across the plane, never follows
        self._newest[node] = newest._replace(adds=adds, load=load)
        return self._newest[node]

    def _add_space(self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value]) -> Snapshot | None:
        newest = self._of_newest(node, time_s, sequence)
        if newest is None or newest.space is not None:
            return None
        self._newest[node] = newest._replace(adds="space", space=space_snapshot(values))
        return self._newest[node]

    def _add_sigma(
        self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value], adds: str = "sigma"
    ) -> Snapshot | None:
        newest, sigma = self._of_newest(node, time_s, sequence), sigma_of(values)
        if newest is None or newest.sigma == sigma:
            return None
        self._newest[node] = newest._replace(adds=adds, sigma=sigma)
        return self._newest[node]

    def _add_interval(
        self, node: int, time_s: float, sequence: Value, values: Mapping[str, Value], adds: str = "interval"
    ) -> Snapshot | None:
        newest, interval = self._of_newest(node, time_s, sequence), interval_of(values)
        if newest is None or newest.interval == interval:
            return None
        self._newest[node] = newest._replace(adds=adds, interval=interval)
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
        parameter_tag=values["parameter_tag"],
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
    if frame.identifier & ~NODE_MASK != _HEARTBEAT.identifier or len(frame.data) != 8 or frame.node == 0:
        return None
    values = _HEARTBEAT.decode(frame.data)
    return Heartbeat(
        frame.node,
        frame.time_s,
        name_of(_HEARTBEAT, "state", values),
        name_of(_HEARTBEAT, "mode", values),
        name_of(_HEARTBEAT, "setting", values),
        int(values["protocol"] or 0),
        int(values["dictionary_hash"] or 0),
    )


def condition_of(frame: Frame) -> Condition | None:
    """A controller's condition, or None."""
    is_part = frame.identifier & ~NODE_MASK == _DETAILS and len(frame.data) == 8 and frame.node != 0
    if not is_part or frame.data[_PART_BYTE] != _CONDITION.part:
        return None
    values = _CONDITION.decode(frame.data)
    return Condition(
        frame.node,
        frame.time_s,
        name_of(_CONDITION, "mode", values),
        name_of(_CONDITION, "setting", values),
        bit_names(_CONDITION, "faults", values),
    )


def emergency_of(frame: Frame) -> Emergency | None:
    """An emergency, or None."""
    if frame.identifier & ~NODE_MASK != _EMERGENCY.identifier or len(frame.data) != 8 or frame.node == 0:
        return None
    values = _EMERGENCY.decode(frame.data)
    return Emergency(
        frame.node,
        frame.time_s,
        int(values["error_code"] or 0),
        name_of(_EMERGENCY, "mode", values),
        bit_names(_EMERGENCY, "faults", values),
        name_of(_EMERGENCY, "drift_cause", values),
    )


def name_of(layout: Layout, field: str, values: Mapping[str, Value]) -> str:
    """A number's meaning."""
    return layout.codes_of(field).word_of(int(values[field] or 0))


def bit_names(layout: Layout, field: str, values: Mapping[str, Value]) -> tuple[str, ...]:
    """The set bits' meanings; those of faults in small letters, as brace sim prints them."""
    found = layout.codes_of(field).names_of_bits(int(values[field] or 0))
    return tuple(name.lower() for name in found) if field == "faults" else found
