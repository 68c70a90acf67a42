"""What the page's server costs for each second of a bus with four limbs, at 30 updates a second."""

from __future__ import annotations

import asyncio
import json
import sys
from collections import deque
from collections.abc import Sequence
from pathlib import Path

import pytest

from brace.bus.frame import NODE_MASK, EndOfLog, Frame
from brace.bus.open import open_bus
from brace.bus.slcan import SlcanBus
from brace.bus.url import parse
from brace.bus.watch import RATE_S, Watch
from brace.ground.errors import NoDeviceError
from brace.live.feed import Feed
from brace.live.server import UPDATES_PER_S
from brace.bus.thinning import thinned
from brace.model import load_limb
from brace.wire.frames import MESSAGES

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "judges" / "bench"))

from four_limbs import NODES, SECONDS, STIFFNESS_S, frames, lines_by_tick  # noqa: E402

PERIOD_S = 1.0 / UPDATES_PER_S


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


CALLS_MOST = 63_000  # in each second of the bus


def test_four_limbs_cost_less_than_a_twentieth_of_a_core(paper_limb: Path) -> None:
    """All but handing the text to the browser's socket, counted in calls of Python and C functions: the same number on
    every machine, however busy. A call, with the bytecode that belongs to it, takes 0.2 to 0.3 us on a core of 2.4 GHz
    that does nothing else, so 5 % of it are at least 165,000 calls. Here it is 60,000; where every frame is decoded,
    more than 99,000. tests/judges/bench/page_cost.py measures the time."""
    adapter = Adapter()
    bus = SlcanBus(parse("tcp://nowhere:1"), adapter, 1_000_000)
    feed = Feed(parse("tcp://nowhere:1"), 1_000_000, models={0: load_limb(paper_limb)})
    whole = lines_by_tick(PERIOD_S)
    for text in whole[:8]:  # cards are made, modules are loaded
        adapter.waiting.append(text)
        feed._take_frames(bus)
        feed.messages()
    calls = 0

    def count(_: object, event: str, __: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    sys.setprofile(count)
    try:
        for text in whole:
            adapter.waiting.append(text)
            feed._take_frames(bus)
            feed.messages()
    finally:
        sys.setprofile(None)
    assert len(whole) == UPDATES_PER_S * SECONDS
    assert calls / SECONDS < CALLS_MOST


def played(taken: Sequence[Frame], split: int) -> tuple[Watch, Watch, int]:
    """Gives the frames to the page's server in two periods; the first has `split` of them. Returns a watch that got the
    thinned frames, a watch that got all frames, and how many frames were decoded."""
    watch, every = Watch("here"), Watch("here")
    decoded, held = 0, list[Frame]()
    for part in (taken[:split], taken[split:], []):
        thin = thinned([*held, *part], may_hold=bool(part))
        held = thin.held
        for frame in thin.needed:
            watch.add(frame)
        watch.count(thin.counted)
        decoded += len(thin.needed)
    for frame in taken:
        every.add(frame)
    return watch, every, decoded


def test_what_is_not_decoded_is_older_and_counts() -> None:
    """Of a period the newest snapshot with a posture is whole, and so is the newest with the load, wherever it ends."""
    taken = [frame for frame in frames() if 0.095 < frame.time_s < 0.125]
    for split in range(len(taken)):
        watch, every, decoded = played(taken, split)
        assert decoded < 0.8 * len(taken)
        assert sorted(watch.nodes) == sorted(every.nodes) == [1, 2, 3, 4]
        for node, state in every.nodes.items():
            thin = watch.nodes[node]
            assert thin.posture == state.posture is not None and thin.load is not None and state.load is not None
            assert (thin.load.load, thin.load.sequence) == (state.load.load, state.load.sequence)
            assert (thin.last_s, thin.snapshots) == (state.last_s, state.snapshots)


def test_a_frame_counts_for_the_rate_decoded_or_not() -> None:
    """An adapter gives all frames of a period one time. K comes 200 times a second: over two seconds, one K more or
    less at either end, and what is held for the next period."""
    watch, held = Watch("here"), list[Frame]()
    periods: dict[int, list[Frame]] = {}
    for frame in frames():
        periods.setdefault(int(frame.time_s / PERIOD_S), []).append(frame)
    for number, part in periods.items():
        handed = [Frame((number + 1) * PERIOD_S, frame.identifier, frame.data) for frame in part]
        thin = thinned([*held, *handed], may_hold=True)
        held = thin.held
        for frame in thin.needed:
            watch.add(frame)
        watch.count(thin.counted)
        rates_hz = [state.rate_hz for state in watch.nodes.values()]
        assert number < RATE_S / PERIOD_S or rates_hz == pytest.approx([1.0 / STIFFNESS_S] * NODES, abs=2.0 / RATE_S)
    last = [frame for frame in held if frame.identifier & ~NODE_MASK == MESSAGES["stiffness_b"].identifier]
    assert sum(state.snapshots for state in watch.nodes.values()) + len(last) == NODES * SECONDS / STIFFNESS_S


class Lost:
    """A bus that says a heartbeat, and is gone."""

    url = "tcp://nowhere:1"

    def __init__(self) -> None:
        self.is_heard = self.is_closed = False

    def receive_all(self) -> list[Frame]:
        if self.is_heard:
            raise NoDeviceError("the connection is lost")
        self.is_heard = True
        return [next(frame for frame in frames() if frame.identifier == MESSAGES["heartbeat"].identifier + 1)]

    def close(self) -> None:
        self.is_closed = True


def test_a_bus_that_is_lost_is_told_and_opened_again(paper_limb: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    buses: list[Lost] = []

    def opened(url: object, bit_rate: int) -> Lost:
        buses.append(Lost())
        return buses[-1]

    monkeypatch.setattr("brace.live.feed.open_bus", opened)
    monkeypatch.setattr("brace.live.feed._AGAIN_S", 0.02)
    feed = Feed(parse("tcp://nowhere:1"), 1_000_000, models={0: load_limb(paper_limb)})

    async def stepped() -> list[str]:
        following = asyncio.create_task(feed.follow())
        told = []
        while len(buses) < 3:
            await asyncio.sleep(0.001)
            feed.step()
            told.append(feed.trouble)
        following.cancel()
        return told

    told = asyncio.run(asyncio.wait_for(stepped(), timeout=10.0))
    assert "" in told and any("the connection is lost" in one for one in told)
    assert 1 in feed.watch.nodes and [bus.is_closed for bus in buses[:2]] == [True, True]


def test_a_limb_that_sends_no_posture_shows_its_newest_k() -> None:
    k = [MESSAGES[name].identifier for name in ("stiffness_a", "stiffness_b")]
    taken = [frame for frame in frames() if 0.095 < frame.time_s < 0.125 and frame.identifier & ~NODE_MASK in k]
    for split in range(len(taken)):
        watch, every, _ = played(taken, split)
        assert all(watch.nodes[node].snapshot == every.nodes[node].snapshot is not None for node in (1, 2, 3, 4))


def test_a_short_log_is_shown(tmp_path: Path, paper_limb: Path) -> None:
    """Shorter than what is read at once: its last picture is its last snapshot."""
    log = tmp_path / "run.log"
    taken = [frame for frame in frames() if frame.time_s < 0.05]
    log.write_text("".join(f"({100.0 + one.time_s:.6f}) can0 {one.identifier:03X}#{one.data.hex()}\n" for one in taken))
    url = parse(f"log:{log}")
    feed = Feed(url, 1_000_000, models={0: load_limb(paper_limb)})
    bus = open_bus(url, 1_000_000)
    with pytest.raises(EndOfLog):
        while True:
            feed._take_frames(bus)
    words, numbers = (json.loads(text) for text in feed.messages())
    assert [limb["node"] for limb in words["words"]] == [limb["node"] for limb in numbers["numbers"]] == [1, 2, 3, 4]
    assert all(limb["theta_rad"][1:] == [0.504, 1.4] for limb in numbers["numbers"])
