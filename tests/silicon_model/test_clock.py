"""Clocks and time on the register model: what runs, what is reported, and what happens when parts do not start."""

from __future__ import annotations

import pytest

from silicon import Maker
from test_watchdog import Register


@pytest.mark.parametrize("board, crystal_hz", [("board_8_mhz", 8_000_000), ("board_25_mhz", 25_000_000)])
def test_crystal_gives_168_mhz(silicon: Maker, board: str, crystal_hz: int) -> None:
    chip = silicon(crystal_hz=crystal_hz)
    chip.start(board)
    real = chip.rcc.clocks()
    assert (real["core"], real["apb1"], real["apb2"], real["timer"]) == (168e6, 42e6, 84e6, 84e6)
    assert chip.chip.words("clock_reported", 4) == (168_000_000, 42_000_000, 84_000_000, 84_000_000)
    assert chip.chip.get("clock_reported", 18)[16:] == b"\x01\x01"


@pytest.mark.parametrize("board", ["board_8_mhz", "board_without_crystal"])
def test_without_crystal_the_inner_oscillator_feeds_the_pll(silicon: Maker, board: str) -> None:
    chip = silicon(crystal_hz=None)
    chip.start(board)
    real = chip.rcc.clocks()
    assert (real["core"], real["apb1"], real["apb2"]) == (168e6, 42e6, 84e6)
    assert chip.chip.words("clock_reported", 1) == (168_000_000,)
    assert chip.chip.get("clock_reported", 18)[16:] == b"\x00\x01"


def test_pll_that_never_locks_leaves_16_mhz(silicon: Maker) -> None:
    chip = silicon(pll_locks=False)
    chip.start()
    real = chip.rcc.clocks()
    reported = chip.chip.words("clock_reported", 4)
    assert reported == (16_000_000,) * 4 == tuple(real[name] for name in ("core", "apb1", "apb2", "timer"))
    before = chip.now()
    chip.chip.wait_us(1000)
    assert abs(chip.now() - before - 1000) <= 3


def test_clocks_a_boot_loader_left_are_taken_over(silicon: Maker) -> None:
    """Runs at 50 MHz on a PLL fed by the inner oscillator: its settings may change only when it is off."""
    chip = silicon()
    chip.flash.acr = chip.rcc.wait_states = 5
    chip.rcc.registers |= {0x00: 0x01000083, 0x04: 0x24000000 | 2 << 16 | 300 << 6 | 16, 0x08: 0x9402}
    assert chip.rcc.clocks()["core"] == 50e6
    chip.start()
    assert chip.rcc.clocks()["core"] == 168e6
    assert chip.chip.words("clock_reported", 1) == (168_000_000,)


def test_a_crystal_that_stops_is_reported_and_time_goes_on(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    before = chip.now()
    chip.lose_crystal()
    real = chip.rcc.clocks()
    assert (real["core"], real["apb1"], real["apb2"], real["timer"]) == (168e6, 42e6, 84e6, 84e6)  # from the HSI
    assert chip.rcc.registers[0x0C] >> 7 & 1 == 0  # else the exception comes again at once
    assert chip.now() >= before  # time never runs backwards
    again = chip.now()
    chip.chip.wait_us(1000)
    assert abs(chip.now() - again - 1000) <= 3
    chip.report_clock()
    assert chip.chip.get("clock_reported", 19)[16:] == b"\x00\x01\x01"


def test_a_crystal_that_stops_when_the_pll_will_not_start_again_restarts_the_processor(silicon: Maker) -> None:
    chip = silicon()
    control = Register()
    chip.chip.models[0xE000ED00] = control
    chip.start()
    chip.rcc.pll_locks = False
    chip.lose_crystal()
    assert control.words[0x0C] == 0x05FA0004


def test_without_a_crystal_there_is_nothing_to_watch(silicon: Maker) -> None:
    chip = silicon(crystal_hz=None)
    chip.start()
    assert chip.rcc.registers[0x00] >> 19 & 1 == 0


def test_time_counts_microseconds_and_wraps(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    before = chip.now()
    chip.chip.wait_us(123_456, step_us=1000)
    assert abs(chip.now() - before - 123_456) <= 2
    chip.timer.ticks = 2.0**32 - 5
    assert chip.now() < 0  # the answer's top bit
    chip.chip.wait_us(100)
    assert 90 <= chip.now() < 110


@pytest.mark.parametrize(
    "flags, cause",
    [
        (0x0E000000, 0),  # power: PORRSTF, BORRSTF and the pin
        (0x14000000, 1),  # software, and the pin
        (0x24000000, 2),  # watchdog, and the pin
        (0x04000000, 4),  # the pin alone
        (0x00000000, 0),
    ],
)
def test_reset_cause_is_read_and_cleared(silicon: Maker, flags: int, cause: int) -> None:
    chip = silicon(csr=flags)
    chip.start()
    assert chip.reset_cause() == cause
    assert chip.rcc.registers[0x74] & 0xFE000000 == 0
