"""Frames of our controllers in somebody's log: which of them are measurements."""

from __future__ import annotations

from collections.abc import Sequence

from brace.wire.dbc import CLASSIC, FD, NODE_MOST, for_nodes
from brace.wire.frames import DICTIONARY_HASH, MESSAGES

_HEARTBEAT = MESSAGES["heartbeat"]
# Signals by message. All else that a controller sends is computed with its model.
MEASURED = {
    "posture": frozenset(("theta1", "theta2")),
    "details": frozenset(("load_counted_force_x", "load_counted_force_z")),
    "snapshot_fd": frozenset(("theta1", "theta2")),
    "details_fd": frozenset(("load_counted_force_x", "load_counted_force_z")),
}
WHY_NOT = (
    "of our controller's frames only the joint angles and the force that K counts with are taken: stiffness and "
    "displacements are computed with its model and are no measurement"
)


def node_of(identifier: int, data: bytes) -> int | None:
    """The node, if this is the heartbeat of a controller with our list of frames."""
    node = identifier - _HEARTBEAT.identifier
    if not 1 <= node <= NODE_MOST or len(data) != _HEARTBEAT.size:
        return None
    return node if int.from_bytes(data[4:8], "little") == DICTIONARY_HASH else None


def database(nodes: Sequence[int]) -> str:
    """The DBC of these nodes, CAN FD's frames behind the classic ones."""
    texts = [for_nodes(path.read_text(), nodes) for path in (CLASSIC, FD)]
    messages = texts[1][texts[1].index("BO_ ") :] if "BO_ " in texts[1] else ""
    first, mark, rest = texts[0].partition("\nCM_ ")
    only_frames = "\n".join(line for line in messages.splitlines() if line.startswith(("BO_ ", " SG_")))
    return f"{first}\n{only_frames}\n{mark}{rest}"
