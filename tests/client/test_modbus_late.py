"""Late, slow and lost answers over Modbus: no client takes one for another one's, and they stop no limb."""

from __future__ import annotations

import contextlib
import itertools
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from conftest import Answer, Sim, simulated
from relay import relayed
from rtu_unit import rtu_unit
from test_commanding import DONE, RUNNING, SPEED, UP, acts, with_play  # noqa: F401, a fixture

from brace.bus.modbus_controller import ModbusController
from brace.bus.ownership import register_of
from brace.bus.url import parse
from brace.ground.errors import NoDeviceError
from brace.wire.registers import REGISTERS

SILENT, BIT_RATE, WRITE = 7, 8, 16
OPENED = 3  # requests by which a client looks whom it has before it
SILENCE_S = 0.25  # on a busy machine; where a lost request was waited for, 0.3
LATE_S = 1.0  # the client tries again after 0.8 s
INDICES = range(20, 36)


@pytest.mark.parametrize("late", [{8}, {8, 9}, {8, 10, 12}])
def test_a_late_answer_is_not_the_next_one_s(late: set[int]) -> None:
    """Modbus RTU does not number its requests; an entry's value is its register here. A call of 2 s has time for one
    late answer, not for two of them."""
    with rtu_unit(lambda number: LATE_S if number in late else 0.0) as unit:
        done, why = acts(unit.url, *(f"entry:{index}" for index in INDICES))
    reported = [(index, act.state) for index, act in zip(INDICES, done) if act.status == 0]
    assert all(value == 2 * index for index, value in reported), why
    assert len(reported) >= len(INDICES) - (len(late) - 1) and done[-1].status == 0, why


@pytest.mark.parametrize("late", [{8, 9}, {8, 9, 10}, set(range(8, 14))])
def test_nor_does_brace_query_take_it(late: set[int]) -> None:
    """The same unit and the client in Python, which tries again after 0.6 s, three times in all."""
    holding = [register for register in REGISTERS if register.table == "holding"][:12]
    reported: list[tuple[int, int]] = []
    with rtu_unit(lambda number: 0.75 if number in late else 0.0) as unit:
        controller = ModbusController(parse(unit.url))
        for register in holding:
            with contextlib.suppress(NoDeviceError):
                reported.append((register.address, controller.read_entry(register.name)))
        controller.close()
    assert all(value == address for address, value in reported)
    assert len(reported) >= len(holding) - (len(late) + 1) // 2 and reported[-1][0] == holding[-1].address


def test_an_answer_that_trickles_ends_with_the_time_out(probe: Callable[..., Answer]) -> None:
    """A byte each 0.19 s: a client that waits anew with every byte would wait for all 255 of them, 48 s."""
    with rtu_unit(lambda number: 0.0, byte_s=lambda number: 0.19 if number >= OPENED else 0.0) as unit:
        answer = probe(unit.url, "read", 1, 1)
    assert answer.code in (SILENT, BIT_RATE) and answer.reported_in_time, answer.err
    assert unit.answered == OPENED


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory, with_play: Path) -> Iterator[Sim]:  # noqa: F811
    with simulated(tmp_path_factory.mktemp("bench"), with_play, "--speed", SPEED) as running:
        yield running


def longest_without_a_sign_s(bench: Sim) -> float:
    """While the limb is taken up, read, and let go, every ninth request lost."""
    with relayed(bench.modbus, drops=lambda number: number > 14 and number % 9 == 0) as relay:
        done, why = acts(relay.url, UP, "reads:300", "wait", "let_go", "wait")
        signs_s = [
            at_s for at_s, request in relay.requests()
            if struct.unpack_from(">BH", request) == (WRITE, register_of("life_heard"))
        ]  # fmt: skip
    assert [done[place].state for place in (0, 2, 4)] == [RUNNING, DONE, DONE], why
    assert len(signs_s) > 11
    return max(later - earlier for earlier, later in itertools.pairwise(signs_s))


def test_lost_requests_stop_no_limb(bench: Sim) -> None:
    """Among them signs of life. Each takes 60 ms until it is given up; after 130 ms the limb would stand. A busy
    machine may stall the client once, and does not do so three times."""
    assert any(longest_without_a_sign_s(bench) < SILENCE_S for _ in range(3))
