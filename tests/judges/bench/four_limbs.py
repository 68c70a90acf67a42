"""What four moving limbs say on one bus, at the rates that controllers have by default."""

from __future__ import annotations

from collections.abc import Iterator

from brace.bus.frame import Frame
from brace.wire.frames import DICTIONARY_HASH, GROUPS, MESSAGES
from brace.wire.layout import Layout

NODES = 4
SECONDS = 4.0
STIFFNESS_S, POSTURE_S, LOAD_S, SIGMA_S, HEARTBEAT_S = 0.005, 0.02, 0.1, 0.1, 1.0


def frame_of(layout: Layout, node: int, time_s: float, sequence: int, angle_rad: float) -> Frame:
    known = {"sequence": sequence, "theta1": angle_rad, "theta2": 1.4, "dictionary_hash": DICTIONARY_HASH}
    values = {field.name: known.get(field.name, 1) for field in layout.fields}
    return Frame(time_s, layout.identifier + node, layout.encode(values))


def frames() -> Iterator[Frame]:
    """In the order of time; the limbs move, so that what is worked out by posture is worked out anew."""
    for tick in range(round(SECONDS / STIFFNESS_S)):
        now = tick * STIFFNESS_S
        names = ["stiffness_a", "stiffness_b"]
        names += ["eigenvalues", "posture"] if tick % round(POSTURE_S / STIFFNESS_S) == 0 else []
        layouts = [MESSAGES[name] for name in names]
        layouts += GROUPS["load"] if tick % round(LOAD_S / STIFFNESS_S) == 0 else []
        layouts += GROUPS["sigma"] if tick % round(SIGMA_S / STIFFNESS_S) == 0 else []
        layouts += [MESSAGES["heartbeat"], *GROUPS["condition"]] if tick % round(HEARTBEAT_S / STIFFNESS_S) == 0 else []
        for node in range(1, NODES + 1):
            for layout in layouts:
                yield frame_of(layout, node, now, tick & 0xFF, 0.5 + 0.1 * now)


def lines_by_tick(tick_s: float) -> list[bytes]:
    """As SLCAN text, what comes in each tick together."""
    lines: list[list[bytes]] = [[] for _ in range(round(SECONDS / tick_s))]
    for frame in frames():
        text = b"t%03X%d%s\r" % (frame.identifier, len(frame.data), frame.data.hex().encode())
        lines[int(frame.time_s / tick_s + 1e-6)].append(text)
    return [b"".join(texts) for texts in lines]
