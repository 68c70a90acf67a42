"""What a page needs of the frames of one period: the newest snapshot with its posture, and the newest of each further
part. Decoding all frames would be most of a page's cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from brace.bus.frame import NODE_MASK, Frame
from brace.wire.frames import FD_GROUPS, FD_MESSAGES, GROUPS, MESSAGES

_FIRST, _POSTURE = MESSAGES["stiffness_a"].identifier, MESSAGES["posture"].identifier  # of a snapshot in several frames
_K = frozenset((_FIRST, MESSAGES["stiffness_b"].identifier))
_WHOLE = FD_MESSAGES["snapshot_fd"].identifier
_HAS_K = _K | {_WHOLE}
_WITH_POSTURE = frozenset((_POSTURE, _WHOLE))
# A message's kind: its identifier, of node 0; for frames that share one, with the group's number above it.
_GROUP_BIT = 12
_GROUPED = {
    (layout.identifier, bytes([layout.part or 0])): layout.identifier | number << _GROUP_BIT
    for number, group in enumerate((*GROUPS.values(), *FD_GROUPS.values()), 1)
    for layout in group
}
_SHARED = frozenset(identifier for identifier, _ in _GROUPED)
_PART_BYTE = GROUPS["condition"][0].part_at // 8
_CONDITION = _GROUPED[GROUPS["condition"][0].identifier, bytes([GROUPS["condition"][0].part or 0])]
_OF_SNAPSHOT = frozenset(
    (
        *_K,
        *(MESSAGES[name].identifier for name in ("eigenvalues", "posture")),
        *(layout.identifier for layout in FD_MESSAGES.values()),
        *_GROUPED.values(),
    )
) - {_CONDITION}  # in all of them the first byte counts the snapshots
_ALWAYS = frozenset((MESSAGES["heartbeat"].identifier, MESSAGES["emergency"].identifier, _CONDITION))



@dataclass
class Thinned:
    """The frames of one period, each kind in its order."""

    needed: list[Frame] = field(default_factory=list)
    counted: list[Frame] = field(default_factory=list)  # their content is not needed
    held: list[Frame] = field(default_factory=list)  # for the next period: more of their snapshot may come


def thinned(frames: Sequence[Frame], may_hold: bool) -> Thinned:
    """A page shows K with its posture; K alone only of a limb that sends no posture. A snapshot that has begun, and may
    get its posture in the next period, is held until then."""
    kinds = [
        frame.identifier if frame.identifier & ~NODE_MASK not in _SHARED else _kind(frame) for frame in frames
    ]
    last = {kind: frame.data[:1] for kind, frame in zip(kinds, frames, strict=True)}
    by_node: dict[int, list[int]] = {}
    for identifier in last:
        by_node.setdefault(identifier & NODE_MASK, []).append(identifier & ~NODE_MASK)
    needed: dict[int, list[bytes]] = {identifier: [] for identifier in last}  # first bytes
    held: dict[int, bytes] = {}
    for node, messages in by_node.items():
        for message, part in _needed_parts(tuple(messages)):
            needed[part | node].append(last[message | node])
        begun = last.get(_FIRST | node)
        if may_hold and begun is not None and last.get(_POSTURE | node) != begun:
            held |= {part | node: begun for part in _OF_SNAPSHOT.intersection(messages)}
    out = Thinned()
    for identifier, frame in zip(kinds, frames, strict=True):
        first = frame.data[:1]
        if held.get(identifier) == first:
            out.held.append(frame)
        elif first in needed[identifier] or identifier & ~NODE_MASK in _ALWAYS:
            out.needed.append(frame)
        else:
            out.counted.append(frame)
    return out


def _kind(frame: Frame) -> int:
    """What kind of message a frame of a shared identifier is, with its node."""
    message, parts = frame.identifier & ~NODE_MASK, frame.data[_PART_BYTE : _PART_BYTE + 1]
    return _GROUPED.get((message, parts), message) | frame.identifier & NODE_MASK


@lru_cache(maxsize=256)  # a node sends its messages in few different orders
def _needed_parts(messages: tuple[int, ...]) -> list[tuple[int, int]]:
    """Pairs: a message that came from a node, and a part that the message needs beside it. The part is the one with the
    first byte of the message's newest frame."""
    parts = _OF_SNAPSHOT.intersection(messages)
    shown = _WITH_POSTURE & parts or _K & parts
    whole = [(message, part) for message in shown for part in parts]
    further = parts - _K - shown
    return whole + [(message, part) for message in further for part in (message, *(_HAS_K & parts))]
