"""What a page needs of the frames of one period: the newest snapshot with its posture, and the newest of each further
part. Decoding all frames would be most of a page's cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from brace.bus.frame import NODE_MASK, Frame
from brace.wire.frames import FD_MESSAGES, MESSAGES, MULTIPLEXED

_FIRST, _POSTURE = MESSAGES["stiffness_a"].identifier, MESSAGES["posture"].identifier  # of a snapshot in several frames
_K = frozenset((_FIRST, MESSAGES["stiffness_b"].identifier))
_WITH_POSTURE = frozenset((_POSTURE, FD_MESSAGES["snapshot_fd"].identifier))
_OF_SNAPSHOT = frozenset(
    (
        *_K,
        *(MESSAGES[name].identifier for name in ("eigenvalues", "posture")),
        *(layout.identifier for layout in FD_MESSAGES.values()),
        *(MULTIPLEXED[name][0].identifier for name in ("space", "load", "load_across")),
    )
)  # in all of them the first byte counts the snapshots
_ALWAYS = frozenset((MESSAGES["heartbeat"].identifier, MESSAGES["emergency"].identifier))


@dataclass
class Thinned:
    """The frames of one period."""

    frames: list[tuple[Frame, bool]] = field(default_factory=list)  # in their order; is the content needed?
    held: list[Frame] = field(default_factory=list)  # for the next period: more of their snapshot may come


def thinned(frames: Sequence[Frame], may_hold: bool) -> Thinned:
    """A page shows K with its posture; K alone only of a limb that sends no posture. A snapshot that has begun, and may
    get its posture in the next period, is held until then."""
    last = {frame.identifier: frame.data[:1] for frame in frames}
    with_posture = {identifier & NODE_MASK for identifier in last if identifier & ~NODE_MASK in _WITH_POSTURE}
    wanted: dict[int, set[bytes]] = {}  # by node
    for identifier, number in last.items():
        message, node = identifier & ~NODE_MASK, identifier & NODE_MASK
        if message in _OF_SNAPSHOT and (message not in _K or node not in with_posture):
            wanted.setdefault(node, set()).add(number)
    begun = {
        identifier & NODE_MASK: number
        for identifier, number in last.items()
        if may_hold and identifier & ~NODE_MASK == _FIRST and last.get(_POSTURE | identifier & NODE_MASK) != number
    }
    of_snapshot = {identifier for identifier in last if identifier & ~NODE_MASK in _OF_SNAPSHOT}
    out = Thinned()
    for frame in frames:
        identifier = frame.identifier
        if identifier not in of_snapshot:
            out.frames.append((frame, identifier & ~NODE_MASK in _ALWAYS))
            continue
        node, number = identifier & NODE_MASK, frame.data[:1]
        if begun.get(node) == number:
            out.held.append(frame)
        else:
            out.frames.append((frame, number in wanted[node]))
    return out
