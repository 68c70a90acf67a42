"""What a page needs of the frames of one period: the newest snapshot, and the newest that has each further part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from brace.bus.frame import NODE_MASK, Frame
from brace.wire.frames import FD_MESSAGES, MESSAGES, MULTIPLEXED

_OF_SNAPSHOT = frozenset(
    (
        *(MESSAGES[name].identifier for name in ("stiffness_a", "stiffness_b", "eigenvalues", "posture")),
        *(layout.identifier for layout in FD_MESSAGES.values()),
        *(MULTIPLEXED[name][0].identifier for name in ("space", "load", "load_across")),
    )
)  # in all of them the first byte counts the snapshots
_ALWAYS = frozenset((MESSAGES["heartbeat"].identifier, MESSAGES["emergency"].identifier))


def thinned(frames: Sequence[Frame]) -> Iterator[tuple[Frame, bool]]:
    """Each frame in its order, and whether its content is needed. Decoding all of them is most of a page's cost."""
    last = {frame.identifier: frame.data[:1] for frame in frames if frame.identifier & ~NODE_MASK in _OF_SNAPSHOT}
    wanted = {(identifier & NODE_MASK, sequence) for identifier, sequence in last.items()}
    for frame in frames:
        message = frame.identifier & ~NODE_MASK
        if message in _OF_SNAPSHOT:
            yield frame, (frame.identifier & NODE_MASK, frame.data[:1]) in wanted
        else:
            yield frame, message in _ALWAYS
