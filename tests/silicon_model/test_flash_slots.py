"""The non-volatile slots on the register model of the flash interface."""

from __future__ import annotations

import random

import pytest

from silicon import Maker, Silicon

OK, RANGE, DEVICE = 0, -3, -4
SECTORS = (10, 11)  # of board_8_mhz


def started(silicon: Maker) -> Silicon:
    chip = silicon()
    chip.start()
    return chip


def write(chip: Silicon, slot: int, offset: int, data: bytes) -> int:
    chip.chip.put("buffer", data)
    return chip.nvm_write(slot, offset, len(data))


def read(chip: Silicon, slot: int, offset: int, count: int) -> bytes:
    chip.chip.put("buffer", b"\xee" * 1024)
    assert chip.nvm_read(slot, offset, count) == OK
    return chip.chip.get("buffer", count)


def stored(chip: Silicon, slot: int, offset: int, count: int) -> bytes:
    first, _ = chip.flash.sector(SECTORS[slot])
    return bytes(chip.flash.memory[first + offset : first + offset + count])


def test_what_is_written_is_read_and_nothing_else_changes(silicon: Maker) -> None:
    chip, source = started(silicon), random.Random(4)
    assert chip.slot_bytes() == 131072
    before = bytes(chip.flash.memory)
    data = source.randbytes(512)
    assert read(chip, 1, 64, 512) == b"\xff" * 512  # into the cache, before it changes
    assert write(chip, 1, 64, data) == OK
    assert read(chip, 1, 64, 512) == stored(chip, 1, 64, 512) == data
    first, _ = chip.flash.sector(SECTORS[1])
    after = bytes(chip.flash.memory)
    assert after[: first + 64] == before[: first + 64]
    assert after[first + 64 + 512 :] == before[first + 64 + 512 :]
    assert chip.flash.cr >> 31 == 1  # locked again


def test_programmed_words_may_still_be_cleared(silicon: Maker) -> None:
    """The chip's flash has no check bits: the parameter store spoils an old block with zeros before it erases it."""
    chip = started(silicon)
    assert write(chip, 0, 0, b"old block") == RANGE
    assert write(chip, 0, 0, b"old blck") == OK
    assert write(chip, 0, 0, bytes(4)) == OK
    assert read(chip, 0, 0, 8) == bytes(4) + b"blck"


def test_erase_clears_one_sector_and_the_caches(silicon: Maker) -> None:
    chip = started(silicon)
    for slot in (0, 1):
        assert write(chip, slot, 0, b"held") == OK
        assert read(chip, slot, 0, 4) == b"held"
    assert chip.nvm_erase(0) == OK
    assert chip.flash.erased == [10]
    assert read(chip, 0, 0, 4) == b"\xff" * 4
    assert read(chip, 1, 0, 4) == b"held"
    assert write(chip, 0, 0, b"anew") == OK
    assert read(chip, 0, 0, 4) == b"anew"


@pytest.mark.parametrize("slot, offset, count", [(2, 0, 4), (0, 131072, 4), (0, 131068, 8), (0, 0xFFFFFFFC, 8)])
def test_outside_the_slot_is_refused(silicon: Maker, slot: int, offset: int, count: int) -> None:
    chip = started(silicon)
    assert chip.nvm_read(slot, offset, count) == RANGE
    assert chip.nvm_write(slot, offset, count) == RANGE
    assert chip.flash.programmed == []


def test_whole_units_only(silicon: Maker) -> None:
    chip = started(silicon)
    assert write(chip, 0, 2, b"1234") == RANGE
    assert write(chip, 0, 0, b"12345") == RANGE
    assert chip.nvm_erase(2) == RANGE
    assert chip.flash.programmed == []


@pytest.mark.parametrize("bit", [1, 4, 5, 6, 7])  # OPERR, WRPERR, PGAERR, PGPERR, PGSERR
def test_an_error_is_reported_and_does_not_stop_the_next_operation(silicon: Maker, bit: int) -> None:
    chip = started(silicon)
    chip.flash.fails_next = 1 << bit
    assert write(chip, 0, 0, b"lost") == DEVICE
    assert write(chip, 0, 0, b"held") == OK
    chip.flash.fails_next = 1 << bit
    assert chip.nvm_erase(0) == DEVICE
    assert chip.nvm_erase(0) == OK


@pytest.mark.parametrize("bit", [1, 4, 5, 6, 7])
def test_an_error_from_before_does_not_stop_it(silicon: Maker, bit: int) -> None:
    chip = started(silicon)
    chip.flash.sr = 1 << bit  # of a stray store, say
    assert write(chip, 0, 0, b"held") == OK
    chip.flash.sr = 1 << bit
    assert chip.nvm_erase(0) == OK


def test_a_failing_write_stops_at_the_failing_word(silicon: Maker) -> None:
    chip = started(silicon)
    chip.flash.protected = {10}
    assert write(chip, 0, 0, bytes(16)) == DEVICE
    assert chip.flash.programmed == []
    assert chip.nvm_erase(0) == DEVICE
    assert chip.nvm_erase(1) == OK


def test_controller_that_stays_busy_is_given_up(silicon: Maker) -> None:
    chip = started(silicon)
    chip.chip.interrupts_on = False
    chip.flash.sticks = True
    chip.flash.busy_us = 1.0
    before = chip.chip.time_us
    chip.timer.read_takes_us = 1000.0  # a thousand times faster, to have it over
    assert write(chip, 0, 0, b"data") == DEVICE
    assert 4e6 <= chip.chip.time_us - before <= 5e6
    assert chip.flash.programmed == []


def test_a_word_takes_its_time_and_no_longer(silicon: Maker) -> None:
    chip = started(silicon)
    before = chip.chip.time_us
    assert write(chip, 0, 0, bytes(40)) == OK
    assert 10 * 16 <= chip.chip.time_us - before <= 1000
    assert len(chip.flash.programmed) == 10


def test_sixteen_kilobyte_sectors(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_without_can")
    assert chip.slot_bytes() == 16384
    assert chip.nvm_erase(0) == chip.nvm_erase(1) == OK
    assert chip.flash.erased == [1, 2]
    assert write(chip, 1, 16380, b"last") == OK
    assert bytes(chip.flash.memory[0xBFFC:0xC000]) == b"last"
