"""What the C client reports of a motion that a fault or a restart of the controller meets. A controller in Python plays
it step by step, by its entries."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from contextlib import contextmanager

from slcan_controller import SlcanController
from test_commanding import DONE, FAILED, INDEX, NOT_BEGUN, STOPPED, TIMEOUT, acts

from brace.wire.frames import REQUESTS

START, MONITOR, TAKING_UP, FAULT = 0, 1, 3, 5  # modes
BENCH = 1  # setting
NONE, RUNNING, HELD, FAILED_BY_TORQUE = 0, 1, 2, 255
NOTHING = -1  # in place of a mode: the controller answers no question
LONG_S = 60.0
LIFE_S = 0.2  # a sign of life comes every 40 ms; on a busy machine later


@contextmanager
def played(*steps: tuple[float, int, int]) -> Iterator[SlcanController]:
    """Steps: how long, mode, outcome of the tibia's take-up; from the time when the motion is asked for."""
    ends = list(itertools.accumulate(step[0] for step in steps))

    def entries(index: int) -> int | None:
        begun = [
            at for at, data in zip(controller.heard_s, controller.requests)
            if data[0] in (REQUESTS["take_up"].command, REQUESTS["let_go"].command)
        ]  # fmt: skip
        since_s = time.monotonic() - begun[0] if begun else 0.0
        _, mode, outcome = steps[next((i for i, end in enumerate(ends) if since_s < end), len(steps) - 1)]
        if mode == NOTHING:
            return None
        return {INDEX["setting"]: BENCH, INDEX["mode"]: mode, INDEX["take_up_tibia"]: outcome}.get(index, 0)

    with SlcanController(entries=entries) as controller:
        yield controller


def longest_silence_s(controller: SlcanController) -> float:
    """Between signs of life."""
    life = REQUESTS["sign_of_life"].command
    times = [at for at, data in zip(controller.heard_s, controller.requests) if data[0] == life]
    return max(later - earlier for earlier, later in itertools.pairwise(times))


def test_a_fault_on_the_way_back_is_lived_through() -> None:
    with played((0.2, TAKING_UP, RUNNING), (0.6, FAULT, NONE), (0.3, TAKING_UP, NONE), (LONG_S, MONITOR, NONE)) as limb:
        (_, waited), why = acts(limb.url, "let_go", "wait")
        assert (waited.status, waited.state) == (0, DONE), why
        assert limb.heard_s[-1] - limb.heard_s[0] > 1.0
        assert longest_silence_s(limb) < LIFE_S


def test_a_take_up_that_a_fault_ends_has_failed() -> None:
    with played((0.2, TAKING_UP, RUNNING), (0.3, FAULT, RUNNING), (LONG_S, MONITOR, NONE)) as limb:
        (_, waited), why = acts(limb.url, "take_up:2:-1", "wait")
        assert (waited.state, waited.reason) == (FAILED, 0) and "a fault" in why


def test_one_that_failed_in_a_fault_has_ended_when_the_limb_is_back() -> None:
    failed = FAILED_BY_TORQUE
    with played((0.1, TAKING_UP, RUNNING), (0.6, FAULT, failed), (LONG_S, MONITOR, failed)) as limb:
        (_, waited), why = acts(limb.url, "take_up:2:-1", "wait")
        assert (waited.state, waited.reason) == (FAILED, -1), why
        assert limb.heard_s[-1] - limb.heard_s[0] > 0.6


def test_a_fault_that_stays_is_reported_at_the_limit() -> None:
    with played((0.2, TAKING_UP, RUNNING), (LONG_S, FAULT, NONE)) as limb:
        (_, waited), why = acts(limb.url, "take_up:2:-1:1000", "wait")
        assert waited.state == FAILED and "a fault stays" in why


def test_a_restart_on_the_way_back_is_no_arrival() -> None:
    with played((0.2, TAKING_UP, NONE), (LONG_S, START, NONE)) as limb:
        (_, waited), why = acts(limb.url, "let_go", "wait")
        assert waited.state == STOPPED and "started anew" in why


def test_a_motion_that_could_not_be_asked_for_is_not_the_one_before() -> None:
    with played((0.2, TAKING_UP, RUNNING), (1.0, MONITOR, HELD), (LONG_S, NOTHING, NONE)) as limb:
        done, why = acts(limb.url, "take_up:2:-1", "wait", "silent:1500", "take_up:2:-1", "wait")
        assert done[1].state == DONE, why
        assert (done[3].status, done[3].state, done[3].reason) == (TIMEOUT, NOT_BEGUN, -TIMEOUT), why
        assert (done[4].status, done[4].state) == (TIMEOUT, NOT_BEGUN), why
