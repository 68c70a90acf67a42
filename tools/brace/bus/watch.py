"""What a bus says, node by node: the newest K, posture, heartbeat, and how often they come."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import attrgetter

from brace.bus.controller import check_dictionary
from brace.bus.frame import NODE_MASK, Frame
from brace.bus.snapshot import (
    Condition,
    Emergency,
    Heartbeat,
    Joiner,
    Snapshot,
    condition_of,
    emergency_of,
    heartbeat_of,
)
from brace.wire.frames import FD_MESSAGES, GROUPS, MESSAGES

RATE_S = 2.0
_READ = {
    MESSAGES["heartbeat"].identifier: heartbeat_of,
    MESSAGES["emergency"].identifier: emergency_of,
    GROUPS["condition"][0].identifier: condition_of,
}
_IDENTIFIER = attrgetter("identifier")
_ENDS_K = (MESSAGES["stiffness_b"].identifier, FD_MESSAGES["snapshot_fd"].identifier)

Event = Snapshot | Heartbeat | Condition | Emergency


@dataclass
class NodeState:
    """The newest of each."""

    snapshot: Snapshot | None = None  # K
    posture: Snapshot | None = None  # the newest with eigenvalues and posture
    space: Snapshot | None = None  # the newest with K in space
    load: Snapshot | None = None  # the newest with its load
    sigma: Snapshot | None = None  # the newest with its uncertainty
    interval: Snapshot | None = None  # the newest with where its force and loads lie
    heartbeat: Heartbeat | None = None
    mode: str = ""  # as last heard; empty: not heard yet
    faults: tuple[str, ...] | None = None  # as last heard; None: not heard yet
    drift_cause: str = ""  # as the last emergency sent it; empty: none has come
    snapshots: int = 0
    valid: int = 0
    in_space: int = 0  # snapshots with K in space
    frames: int = 0
    last_s: float = 0.0
    marks: deque[tuple[float, int]] = field(default_factory=deque)  # when, and how many snapshots there were then

    @property
    def rate_hz(self) -> float:
        """Snapshots a second, over the last two."""
        if len(self.marks) < 2:
            return 0.0
        (first_s, first), (last_s, last) = self.marks[0], self.marks[-1]
        return (last - first) / (last_s - first_s)

    def mark(self, time_s: float) -> None:
        """Counts the snapshots up to now; what an adapter hands over together, or out of order, has one time."""
        if self.marks and time_s <= self.marks[-1][0]:
            time_s = self.marks.pop()[0]
        self.marks.append((time_s, self.snapshots))
        while time_s - self.marks[0][0] > RATE_S:
            self.marks.popleft()


class Watch:
    """Frames in, events out."""

    def __init__(self, where: str, node: int | None = None, any_dictionary: bool = False) -> None:
        self.nodes: dict[int, NodeState] = {}
        self.joiner = Joiner()
        self.first_s = self.last_s = 0.0
        self._where = where
        self._only = node
        self._any_dictionary = any_dictionary

    def add(self, frame: Frame) -> Event | None:
        """What the frame reports or completes. VersionMismatchError when a node speaks another dictionary."""
        node = frame.identifier & NODE_MASK
        if node == 0 or (self._only is not None and node != self._only):
            return None
        event: Event | None = self.joiner.add(frame)
        if event is None and frame.identifier & ~NODE_MASK in _READ:
            event = _READ[frame.identifier & ~NODE_MASK](frame)
        state = self.nodes.get(node)
        if state is None:
            if event is None:
                return None
            state = self.nodes[node] = NodeState()
        self.first_s = self.first_s or frame.time_s
        state.last_s = self.last_s = frame.time_s
        state.frames += 1
        if event is None:
            return None
        if isinstance(event, Snapshot):
            self.take(state, event)
        elif isinstance(event, Heartbeat):
            if not self._any_dictionary:
                check_dictionary(event.dictionary_hash, f"{self._where}, node {node}")
            state.heartbeat = event
            state.mode = event.mode
        else:
            state.mode, state.faults = event.mode, event.faults
            state.drift_cause = event.drift_cause if isinstance(event, Emergency) else state.drift_cause
        return event

    def count(self, frames: Sequence[Frame]) -> None:
        """Frames whose content nobody needs, in their order: they count for how often K comes."""
        times_s = {frame.identifier: frame.time_s for frame in frames}  # of the newest
        for identifier, number in Counter(map(_IDENTIFIER, frames)).items():
            state = self.nodes.get(identifier & NODE_MASK)
            if state is None:  # `add` has not let it in
                continue
            state.last_s = self.last_s = max(state.last_s, times_s[identifier])
            state.frames += number
            if identifier & ~NODE_MASK in _ENDS_K:
                state.snapshots += number  # for the rate, too, from the next snapshot on that `add` is given

    def take(self, state: NodeState, snapshot: Snapshot) -> None:
        """A snapshot, or more of the newest one; each counts once."""
        newest = state.snapshot
        is_more = newest is not None and (newest.sequence, newest.time_s) == (snapshot.sequence, snapshot.time_s)
        state.snapshot = snapshot
        state.mode = snapshot.mode
        state.faults = state.faults if snapshot.faults is None else snapshot.faults
        if snapshot.sigma is not None:
            state.sigma = snapshot
        if snapshot.has_posture:
            state.posture = snapshot
        if snapshot.load is not None:
            state.load = snapshot
        if snapshot.interval is not None:
            state.interval = snapshot
        if snapshot.space is not None:
            state.in_space += snapshot.adds == "space" or not is_more
            state.space = snapshot
        if is_more:
            return
        state.snapshots += 1
        state.valid += snapshot.is_valid
        state.mark(snapshot.time_s)


def as_json(event: Event) -> dict[str, object]:
    """One object for a line of --json."""
    if isinstance(event, Snapshot):
        return {"event": event.adds} | event.as_json()
    if isinstance(event, Heartbeat):
        return {
            "event": "heartbeat",
            "node": event.node,
            "time_s": round(event.time_s, 6),
            "state": event.state,
            "mode": event.mode,
            "setting": event.setting,
            "protocol": event.protocol,
            "dictionary_hash": f"{event.dictionary_hash:08x}",
        }
    if isinstance(event, Condition):
        return {
            "event": "condition",
            "node": event.node,
            "time_s": round(event.time_s, 6),
            "mode": event.mode,
            "setting": event.setting,
            "faults": list(event.faults),
        }
    return {
        "event": "emergency",
        "node": event.node,
        "time_s": round(event.time_s, 6),
        "error_code": f"{event.error_code:04x}",
        "mode": event.mode,
        "faults": list(event.faults),
        "drift_cause": event.drift_cause,
    }
