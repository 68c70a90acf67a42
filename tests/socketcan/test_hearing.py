"""A node hears its own requests on a bus full of other nodes' frames. The simulated bus has the hardware's ring and its
filter; time passes tick by tick."""

from __future__ import annotations

import os
import random
from collections import deque

import pytest
from bus_of_ticks import SlcanClient, limbs
from wire_by_hand import ANSWER, NODE, REQUEST, SEQUENCE_ENTRY, entry_request

TICK_S = 1e-3
REQUESTS = int(os.environ.get("BRACE_REQUESTS", "10000"))  # docs/trust.md: 100000
MOST_TICKS = 2


def others_frame(rng: random.Random) -> tuple[int, bytes]:
    """Of another node, of the same kinds as ours or of no known kind; requests to other nodes among them."""
    number = rng.choice([REQUEST + rng.randrange(NODE + 1, 128), rng.randrange(0x800)])
    return (number if number != REQUEST + NODE else 0x7FF), rng.randbytes(8)


@pytest.mark.parametrize("others", [5, 8])
def test_a_request_a_millisecond_is_answered_within_two_ticks(others: int) -> None:
    """Beside as many frames of other nodes as a bus of 1 Mbit/s carries: with 8 of them it is full."""
    rng = random.Random(others)
    with limbs(1) as node:
        client = SlcanClient(node.can_place)
        node.step(0.5)
        list(client.frames())
        waiting: deque[tuple[int, int]] = deque()  # token, tick
        slowest = 0
        for tick in range(REQUESTS):
            frames = [others_frame(rng) for _ in range(others)]
            frames.insert(rng.randrange(others + 1), (REQUEST + NODE, entry_request(tick & 0xFF, SEQUENCE_ENTRY)))
            client.send(frames)
            waiting.append((tick & 0xFF, tick))
            node.step(TICK_S)
            for number, data in client.frames():
                if number == ANSWER + NODE:
                    token, asked = waiting.popleft()
                    assert data[1] == token, "an answer is missing, or out of order"
                    slowest = max(slowest, tick + 1 - asked)
        assert len(waiting) <= 1, f"{len(waiting)} requests have no answer"
        assert slowest <= MOST_TICKS, f"{slowest} ticks"
        client.close()
