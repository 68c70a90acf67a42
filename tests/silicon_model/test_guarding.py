"""The key of a guarded board and its random words, on the register models."""

from __future__ import annotations

import pytest
from silicon import Maker, Silicon

OK, NONE_YET, RANGE, DEVICE = 0, 0, -3, -4
KEY = bytes(range(0x10, 0x20))
BLOCK = 32


@pytest.fixture
def chip(silicon: Maker) -> Silicon:
    made: Silicon = silicon()
    made.start("board_with_key")
    return made


def keep(chip: Silicon, key: bytes) -> int:
    chip.chip.put("buffer", key)
    return chip.key_write()


def kept(chip: Silicon) -> bytes | None:
    chip.chip.put("buffer", bytes(16))
    found = chip.key_read()
    assert found in (0, 1)
    return chip.chip.get("buffer", 16) if found else None


def word(chip: Silicon) -> int | None:
    return chip.chip.words("random_word", 1)[0] if chip.random_word_read() == OK else None


def test_a_new_board_is_guarded_and_has_no_key(chip: Silicon) -> None:
    assert chip.is_guarded() == 1
    assert kept(chip) is None


def test_a_board_that_does_not_ask_is_a_bench(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    assert chip.is_guarded() == 0


def test_a_key_is_kept_once(chip: Silicon) -> None:
    assert keep(chip, KEY) == OK
    assert kept(chip) == KEY
    before = bytes(chip.flash.otp)
    assert keep(chip, bytes(16)) == RANGE
    assert kept(chip) == KEY and bytes(chip.flash.otp) == before


def test_nothing_else_of_the_flash_is_written(chip: Silicon) -> None:
    before = bytes(chip.flash.memory)
    assert keep(chip, KEY) == OK
    assert bytes(chip.flash.memory) == before and chip.flash.erased == []
    assert bytes(chip.flash.otp[BLOCK:]) == b"\xff" * (len(chip.flash.otp) - BLOCK)
    assert chip.flash.cr >> 31 & 1  # locked again


@pytest.mark.parametrize("words", range(8))
def test_a_write_that_the_power_cut_is_no_key_and_the_next_block_takes_it(chip: Silicon, words: int) -> None:
    whole = KEY + bytes(byte ^ 0xFF for byte in KEY)
    chip.flash.otp[: 4 * words] = whole[: 4 * words]
    assert kept(chip) is None
    assert keep(chip, KEY[::-1]) == OK
    assert kept(chip) == KEY[::-1]


@pytest.mark.parametrize("bit", range(0, 8 * BLOCK, 7))
def test_a_key_that_has_lost_a_bit_is_no_key(chip: Silicon, bit: int) -> None:
    assert keep(chip, KEY) == OK
    chip.flash.otp[bit // 8] ^= 1 << bit % 8
    assert kept(chip) is None


def test_full_memory_says_so(chip: Silicon) -> None:
    chip.flash.otp[: 16 * BLOCK] = bytes(16 * BLOCK)
    assert keep(chip, KEY) == DEVICE
    assert kept(chip) is None


def test_no_key_is_written_while_the_supply_is_low(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_with_key")
    chip.supply.supply_v = 2.85
    assert keep(chip, KEY) == DEVICE
    assert bytes(chip.flash.otp) == b"\xff" * len(chip.flash.otp)


def test_random_words_differ_and_the_first_is_not_used(chip: Silicon) -> None:
    words = [word(chip) for _ in range(20)]
    assert None not in words and len(set(words)) == 20
    assert chip.random.given[0] not in words
    assert chip.random.given[1:] == words


def test_a_generator_that_repeats_itself_gives_nothing(chip: Silicon) -> None:
    assert word(chip) is not None
    chip.random.repeats = True
    word(chip)  # the one that was ready
    assert [word(chip) for _ in range(5)] == [None] * 5


@pytest.mark.parametrize("bit", [5, 6])
def test_a_fault_gives_no_word_and_the_generator_starts_anew(chip: Silicon, bit: int) -> None:
    assert word(chip) is not None
    chip.random.fail(bit)
    assert word(chip) is None
    assert word(chip) is not None
    assert chip.random.given[0] != chip.chip.words("random_word", 1)[0]


def test_without_the_pll_there_is_no_word_and_no_waiting(silicon: Maker) -> None:
    chip = silicon(pll_locks=False)
    chip.start("board_with_key")
    began_us = chip.chip.time_us
    assert word(chip) is None
    assert chip.chip.time_us - began_us < 30
