"""What the page's server costs for each second of a bus with four limbs, at 30 updates a second."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Iterator
from pathlib import Path

from brace.bus.frame import Frame
from brace.bus.slcan import SlcanBus
from brace.bus.url import parse
from brace.bus.watch import Watch
from brace.live.feed import Feed
from brace.live.thinning import thinned
from brace.model import load_limb
from brace.wire.frames import DICTIONARY_HASH, MESSAGES, MULTIPLEXED
from brace.wire.layout import Layout

NODES = 4
SECONDS = 4.0
STIFFNESS_S, POSTURE_S, LOAD_S, HEARTBEAT_S = 0.005, 0.02, 0.1, 1.0  # as controllers send by default
PERIOD_S, UPDATE_S = 0.025, 1.0 / 30.0


def frame_of(layout: Layout, node: int, time_s: float, sequence: int, angle_rad: float) -> Frame:
    known = {"sequence": sequence, "theta1": angle_rad, "theta2": 1.4, "dictionary_hash": DICTIONARY_HASH}
    values = {field.name: known.get(field.name, 1) for field in layout.fields}
    return Frame(time_s, layout.identifier + node, layout.encode(values))


def frames_of_a_bus() -> Iterator[Frame]:
    """In the order of time; the limbs move, so that what is worked out by posture is worked out anew."""
    for tick in range(round(SECONDS / STIFFNESS_S)):
        now = tick * STIFFNESS_S
        names = ["stiffness_a", "stiffness_b"]
        names += ["eigenvalues", "posture"] if tick % round(POSTURE_S / STIFFNESS_S) == 0 else []
        layouts = [MESSAGES[name] for name in names]
        layouts += MULTIPLEXED["load"] if tick % round(LOAD_S / STIFFNESS_S) == 0 else []
        layouts += [MESSAGES["heartbeat"]] if tick % round(HEARTBEAT_S / STIFFNESS_S) == 0 else []
        for node in range(1, NODES + 1):
            for layout in layouts:
                yield frame_of(layout, node, now, tick & 0xFF, 0.5 + 0.1 * now)


class Adapter:
    """An SLCAN adapter that answers, and gives what a bus says in one period at each call of `next`."""

    def __init__(self) -> None:
        self.waiting: deque[bytes] = deque()

    def write(self, data: bytes) -> None:
        self.waiting.extend(b"V1013\r" if line == b"V" else b"\r" for line in data.split(b"\r")[:-1])

    def read(self, timeout_s: float) -> bytes:
        return self.waiting.popleft() if self.waiting else b""

    def close(self) -> None:
        return


def periods() -> list[bytes]:
    lines: list[list[bytes]] = [[] for _ in range(round(SECONDS / PERIOD_S))]
    for frame in frames_of_a_bus():
        text = b"t%03X%d%s\r" % (frame.identifier, len(frame.data), frame.data.hex().encode())
        lines[int(frame.time_s / PERIOD_S + 1e-6)].append(text)
    return [b"".join(texts) for texts in lines]


CALLS_MOST = 140_000  # in each second of the bus


def test_four_limbs_cost_less_than_a_twentieth_of_a_core(paper_limb: Path) -> None:
    """All but handing the text to the browser's socket, counted in calls of Python and C functions: the same number on
    every machine, however busy. A call, with the bytecode that belongs to it, takes 0.2 to 0.3 us on a core of 2.4 GHz
    that does nothing else, so 5 % of it are at least 165,000 calls. Here it is 111,000; where every frame is decoded,
    153,000."""
    adapter = Adapter()
    bus = SlcanBus(parse("tcp://nowhere:1"), adapter, 1_000_000)
    feed = Feed(parse("tcp://nowhere:1"), 1_000_000, models={0: load_limb(paper_limb)})
    whole = periods()
    for text in whole[:8]:  # cards are made, modules are loaded
        adapter.waiting.append(text)
        feed._take_frames(bus)
        feed.as_json()
    calls = updates = 0

    def count(_: object, event: str, __: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        for number, text in enumerate(whole):
            adapter.waiting.append(text)
            feed._take_frames(bus)
            while updates * UPDATE_S < number * PERIOD_S:
                feed.as_json()
                updates += 1
    finally:
        sys.setprofile(None)
    assert updates > 29 * SECONDS
    assert calls / SECONDS < CALLS_MOST


def test_what_is_not_decoded_is_older_and_counts() -> None:
    """Of a period the newest snapshot is whole, and so is the newest with a posture and with the load."""
    frames = [frame for frame in frames_of_a_bus() if 0.095 < frame.time_s < 0.125]
    kept = [frame for frame, is_needed in thinned(frames) if is_needed]
    assert len(kept) < 0.8 * len(frames)
    watch, every = Watch("here"), Watch("here")
    for frame, is_needed in thinned(frames):
        every.add(frame)
        if is_needed:
            watch.add(frame)
        else:
            watch.count(frame)
    assert sorted(watch.nodes) == sorted(every.nodes) == [1, 2, 3, 4]
    for node, state in every.nodes.items():
        thin = watch.nodes[node]
        assert thin.posture == state.posture is not None and thin.load == state.load is not None
        assert thin.snapshot is not None and state.snapshot is not None
        assert (thin.snapshot.sequence, thin.last_s) == (state.snapshot.sequence, state.last_s)
