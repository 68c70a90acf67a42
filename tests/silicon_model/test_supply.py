"""The supply on the register models: brown-out level and detector, and what is refused while the supply falls."""

from __future__ import annotations

from silicon import Maker

OK, DEVICE = 0, -4


def test_a_new_chip_gets_the_highest_brown_out_level_once(silicon: Maker) -> None:
    chip = silicon()
    assert chip.flash.brown_out_level() == 0
    chip.start()
    assert chip.flash.brown_out_level() == 3
    assert len(chip.flash.options_written) == 1
    assert chip.flash.optcr & 1  # locked again
    again = silicon()
    again.flash.optcr = chip.flash.optcr
    again.start()
    assert again.flash.options_written == [] and again.flash.option_keys == []


def test_no_other_option_changes(silicon: Maker) -> None:
    chip = silicon()
    before = chip.flash.optcr
    chip.start()
    assert (chip.flash.optcr ^ before) & ~0xC == 0


def test_the_detector_stands_at_2_9_volts(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    assert chip.supply.threshold_v() == 2.9


def test_nothing_is_written_or_erased_while_the_supply_is_low(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    chip.chip.put("buffer", bytes(range(32)))
    chip.supply.supply_v = 2.85
    memory = bytes(chip.flash.memory)
    assert chip.nvm_write(0, 0, 32) == DEVICE
    assert chip.nvm_erase(0) == DEVICE
    assert bytes(chip.flash.memory) == memory and chip.flash.erased == []
    chip.supply.supply_v = 3.3
    assert chip.nvm_write(0, 0, 32) == OK


def test_options_are_not_written_while_the_supply_is_low(silicon: Maker) -> None:
    chip = silicon()
    chip.supply.supply_v = 2.85
    chip.start()
    assert chip.flash.options_written == []


def test_a_board_that_does_not_ask_is_left_as_it_is(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_without_can")
    assert chip.flash.options_written == [] and chip.supply.threshold_v() is None
    chip.supply.supply_v = 2.0
    assert chip.nvm_write(0, 0, 32) == OK
