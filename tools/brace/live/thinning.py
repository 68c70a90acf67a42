"""What a page needs of the frames of one period: the newest snapshot with its posture, and the newest of each further
part. Decoding all frames would be most of a page's cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from brace.bus.frame import NODE_MASK, Frame
from brace.wire.frames import FD_MESSAGES, MESSAGES, MULTIPLEXED

_FIRST, _POSTURE = MESSAGES["stiffness_a"].identifier, MESSAGES["posture"].identifier  # of a snapshot in several frames
_K = frozenset((_FIRST, MESSAGES["stiffness_b"].identifier))
_WHOLE = FD_MESSAGES["snapshot_fd"].identifier
_HAS_K = _K | {_WHOLE}
_WITH_POSTURE = frozenset((_POSTURE, _WHOLE))
_OF_SNAPSHOT = frozenset(
    (
        *_K,
        *(MESSAGES[name].identifier for name in ("eigenvalues", "posture")),
        *(layout.identifier for layout in FD_MESSAGES.values()),
        *(MULTIPLEXED[name][0].identifier for name in ("space", "load", "load_across")),
    )
)  # in all of them the first byte counts the snapshots
_ALWAYS = frozenset((MESSAGES["heartbeat"].identifier, MESSAGES["emergency"].identifier))

_Key = tuple[int, bytes]  # identifier, first byte


@dataclass
class Thinned:
    """The frames of one period, each kind in its order."""

    needed: list[Frame] = field(default_factory=list)
    counted: list[Frame] = field(default_factory=list)  # their content is not needed
    held: list[Frame] = field(default_factory=list)  # for the next period: more of their snapshot may come


def thinned(frames: Sequence[Frame], may_hold: bool) -> Thinned:
    """A page shows K with its posture; K alone only of a limb that sends no posture. A snapshot that has begun, and may
    get its posture in the next period, is held until then."""
    keys = [(frame.identifier, frame.data[:1]) for frame in frames]
    last = dict(keys)
    by_node: dict[int, list[int]] = {}
    for identifier in last:
        by_node.setdefault(identifier & NODE_MASK, []).append(identifier & ~NODE_MASK)
    needed, held = set[_Key](), set[_Key]()
    for node, messages in by_node.items():
        parts = _OF_SNAPSHOT.intersection(messages)
        shown = _WITH_POSTURE & parts or _K & parts
        for message in parts - _K | shown:
            its = parts if message in shown else (message, *_HAS_K)  # K's parts are what it is joined to
            needed |= {(part | node, last[message | node]) for part in its}
        for always in _ALWAYS.intersection(messages):
            needed |= {key for key in keys if key[0] == always | node}
        begun = last.get(_FIRST | node)
        if may_hold and begun is not None and last.get(_POSTURE | node) != begun:
            held |= {(part | node, begun) for part in parts}
    out = Thinned()
    for frame, key in zip(frames, keys, strict=True):
        (out.held if key in held else out.needed if key in needed else out.counted).append(frame)
    return out
