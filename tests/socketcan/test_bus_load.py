"""What limbs put on the bus, and what a full bus does to a limb; counted frame by frame in simulated time."""

from __future__ import annotations

import random
from collections import Counter

import pytest
from bus_of_ticks import SlcanClient, limbs
from wire_by_hand import HEARTBEAT, NODE, REQUEST, STIFFNESS_A, STIFFNESS_B, k_request

BIT_RATE = 1_000_000
TICK_S = 1e-3


def bits_of(data_bytes: int) -> int:
    """A classic frame with an 11-bit identifier, from start bit to interframe space, with as many stuff bits as any
    content can need: 44 bits and data, 3 between frames; of the 34 bits up to the CRC's end and data, one in four."""
    return 44 + 8 * data_bytes + 3 + (34 + 8 * data_bytes - 1) // 4


def test_a_full_frame_is_135_bits() -> None:
    assert bits_of(8) == 135 and bits_of(0) == 55


def test_four_limbs_at_200_hz_use_less_than_a_quarter_of_the_bus() -> None:
    seconds = 20
    with limbs(4) as node:
        client = SlcanClient(node.can_place)
        node.step(2.0)
        list(client.frames())
        bits, counts = 0, Counter[int]()
        for _ in range(seconds * 10):
            node.step(0.1)
            for identifier, data in client.frames():
                bits += bits_of(len(data))
                counts[identifier] += 1
        client.close()
    for limb in range(4):
        for message in (STIFFNESS_A, STIFFNESS_B):
            assert counts[message + NODE + limb] == pytest.approx(200 * seconds, rel=0.005)
        assert counts[HEARTBEAT + NODE + limb] == pytest.approx(seconds, abs=1)
    share = bits / (BIT_RATE * seconds)
    print(f"four limbs at 200 Hz: {100 * share:.2f} % of 1 Mbit/s")
    assert 0.15 < share < 0.25


def test_limbs_do_not_speak_all_at_once() -> None:
    """Started in the same tick, four limbs spread their frames: no tick carries two limbs' K."""
    with limbs(4) as node:
        client = SlcanClient(node.can_place)
        node.step(2.0)
        list(client.frames())
        most = 0
        for _ in range(1000):
            node.step(TICK_S)
            most = max(most, sum(identifier & ~0x7F == STIFFNESS_A for identifier, _ in client.frames()))
        client.close()
    assert most == 1


@pytest.mark.parametrize("kind", ["requests", "strangers", "noise"])
def test_a_flooded_limb_keeps_its_tick_and_heartbeat(kind: str) -> None:
    """The bus is full, for five seconds: all other frames are one sender's."""
    rng = random.Random(3)
    seconds = 5
    with limbs(1) as node:
        flooder, listener = SlcanClient(node.can_place), SlcanClient(node.can_place)
        node.step(1.0)
        list(listener.frames())
        before = node.state()["sequence"]
        counts = Counter[int]()
        for _ in range(seconds * 1000):
            flooder.send(_flood(kind, rng))
            node.step(TICK_S)
            flooder.text()
            for identifier, _data in listener.frames():
                counts[identifier] += 1
        state = node.state()
        flooder.close()
        listener.close()
    # a tick that answers a request leaves out K, and the next one does not answer: every second K at least is there
    assert state["sequence"] - before >= seconds * 500
    assert state["k_is_valid"] and state["mode"] == "monitor" and state["faults"] == []
    assert state["k_xx_n_per_mm"] == pytest.approx(3.964, abs=0.01)  # of the set it was started with
    assert counts[HEARTBEAT + NODE] >= seconds - 1
    assert counts[STIFFNESS_A + NODE] >= 200 * seconds * 0.95
    assert counts[STIFFNESS_A + NODE] == pytest.approx(counts[STIFFNESS_B + NODE], abs=1)


def _flood(kind: str, rng: random.Random) -> list[tuple[int, bytes]]:
    """A tick's worth of a full bus."""
    frames: list[tuple[int, bytes]] = []
    bits = 0
    while bits < BIT_RATE * TICK_S:
        if kind == "requests":
            frame = (REQUEST + NODE, k_request(rng.randrange(256), 0.7, 1.1))
        elif kind == "strangers":
            frame = (0x7E5, b"")
        else:  # whatever a babbling node sends, to this limb
            frame = (REQUEST + NODE, rng.randbytes(rng.randrange(9)))
        frames.append(frame)
        bits += bits_of(len(frame[1]))
    return frames
