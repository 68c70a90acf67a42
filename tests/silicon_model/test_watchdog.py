"""The watchdog, and the restart, on register models."""

from __future__ import annotations

import pytest

from silicon import Maker

OK = 0


@pytest.mark.parametrize("board", ["board_8_mhz", "board_without_crystal"])
@pytest.mark.parametrize("pll_locks", [True, False])
@pytest.mark.parametrize("lsi_hz", [17e3, 25e3, 32e3, 40e3, 47e3])  # data sheet: 17-47 kHz
def test_patience_is_within_the_doors_contract(silicon: Maker, lsi_hz: float, pll_locks: bool, board: str) -> None:
    chip = silicon(lsi_hz=lsi_hz, pll_locks=pll_locks)
    chip.start(board)
    assert 2.5 <= chip.watchdog.patience_us() / 1e6 <= 3.6
    assert not chip.rcc.enabled(0x40, 3)  # TIM5 off again


def test_without_a_measurement_the_nominal_frequency_counts(silicon: Maker) -> None:
    chip = silicon()
    chip.stopwatch.captures = False
    chip.flash.optcr &= ~0xC  # not its first start, in which the brown-out level is programmed for half a second
    before = chip.chip.time_us
    chip.start()
    assert chip.watchdog.patience_us() / 1e6 == pytest.approx(3.5, rel=0.01)
    assert chip.chip.time_us - before <= 10_000


@pytest.mark.parametrize("lsi_hz", [17e3, 32e3, 47e3])
def test_watchdog_bites_when_it_is_not_fed(silicon: Maker, lsi_hz: float) -> None:
    chip = silicon(lsi_hz=lsi_hz)
    chip.start()
    for _ in range(20):
        chip.chip.wait_us(2.4e6, step_us=1e5)
        chip.feed()
    assert chip.watchdog.bites_at_us == []
    chip.chip.wait_us(5e6, step_us=1e5)
    assert len(chip.watchdog.bites_at_us) >= 1


def test_watchdog_outlasts_an_erase_whatever_came_before(silicon: Maker) -> None:
    chip = silicon(lsi_hz=47e3)
    chip.start()
    chip.chip.wait_us(2.3e6, step_us=1e5)
    assert chip.nvm_erase(0) == OK  # 2 s without a turn of the loop
    chip.chip.wait_us(2.3e6, step_us=1e5)
    assert chip.watchdog.bites_at_us == []


def test_board_may_leave_the_watchdog_off(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_without_can")
    chip.feed()
    assert not chip.watchdog.running and chip.watchdog.feeds == 0


def test_watchdog_sleeps_under_a_debugger(silicon: Maker) -> None:
    chip = silicon()
    halted = Register()
    chip.chip.models[0xE0042000] = halted
    chip.start()
    assert halted.words[0x08] >> 12 & 1


def test_restart_asks_for_a_reset_with_the_key(silicon: Maker) -> None:
    chip = silicon()
    control = Register()
    chip.chip.models[0xE000ED00] = control
    chip.start()
    chip.restart()
    assert control.words[0x0C] == 0x05FA0004


class Register:
    """Registers that keep what is written."""

    def __init__(self) -> None:
        self.words: dict[int, int] = {}

    def read(self, offset: int) -> int:
        return self.words.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        self.words[offset] = value
