"""The key of a guarded board and its random words, on the register models."""

from __future__ import annotations

import random

import pytest
from silicon import Maker, Silicon

OK, AGAIN, RANGE, DEVICE, DAMAGED = 0, -1, -3, -4, -6
NONE, LOCKED, OPEN = 0, 1, 2  # what key_read finds
KEY = bytes(range(0x10, 0x20))
WHOLE = KEY + bytes(byte ^ 0xFF for byte in KEY)
BLOCK, LOCKS = 32, 512


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
    return chip.chip.get("buffer", 16) if chip.key_read() in (LOCKED, OPEN) else None


def started_again(silicon: Maker, otp: bytes) -> Silicon:
    """A chip that is switched on with such one-time programmable memory."""
    chip: Silicon = silicon()
    chip.flash.otp[:] = otp
    chip.start("board_with_key")
    return chip


def word(chip: Silicon) -> int | None:
    return chip.chip.words("random_word", 1)[0] if chip.random_word_read() == OK else None


def test_a_new_board_is_guarded_and_has_no_key(chip: Silicon) -> None:
    assert chip.is_guarded() == 1
    assert chip.key_read() == NONE
    assert bytes(chip.flash.otp) == b"\xff" * len(chip.flash.otp)  # and a start writes nothing


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
    blank = bytearray(b"\xff" * len(chip.flash.otp))
    blank[:BLOCK], blank[LOCKS] = WHOLE, 0
    assert bytes(chip.flash.otp) == blank
    assert chip.flash.cr >> 31 & 1  # locked again


def other_image_writes(otp: bytes, seed: int) -> bytes:
    """What the chip makes of the writes of an image that wants another key: it writes over every block, in any order.
    By the manual's rules, apart from the model: bits are only cleared, and a block whose lock byte is 0x00 stays."""
    draw, memory = random.Random(seed), bytearray(otp)
    for number in draw.sample(range(16), 16):
        key = draw.randbytes(16)
        for at, byte in enumerate(key + bytes(byte ^ 0xFF for byte in key)):
            if memory[LOCKS + number] != 0:
                memory[number * BLOCK + at] &= draw.choice((byte, 0, byte))
    return bytes(memory)


@pytest.mark.parametrize("unfinished", range(8))
def test_an_image_that_is_flashed_later_replaces_no_key(silicon: Maker, unfinished: int) -> None:
    """The first block was being written when the power failed; the key went into the second."""
    chip = silicon()
    chip.flash.otp[: 4 * unfinished] = bytes(16 * [0x3C] + 16 * [0xC3])[: 4 * unfinished]
    chip.start("board_with_key")
    assert keep(chip, KEY) == OK and chip.key_read() == LOCKED
    for seed in range(30):
        after = started_again(silicon, other_image_writes(bytes(chip.flash.otp), seed))
        assert kept(after) == KEY, seed


def test_an_image_makes_a_key_of_its_own_where_nothing_is_locked() -> None:
    """The attack of the test above works where it may: else that test would show nothing."""
    taken = other_image_writes(WHOLE + b"\xff" * (528 - BLOCK), 3)
    assert taken[:BLOCK] != WHOLE


def test_a_key_that_was_never_locked_is_reported_and_locked_by_the_next_start(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_with_key")
    chip.flash.otp[:BLOCK] = WHOLE
    assert chip.key_read() == OPEN and kept(chip) == KEY
    again = started_again(silicon, bytes(chip.flash.otp))
    assert again.key_read() == LOCKED and kept(again) == KEY


def test_a_lock_that_was_half_written_is_written_again(silicon: Maker) -> None:
    otp = bytearray(WHOLE + b"\xff" * (528 - BLOCK))
    otp[LOCKS] = 0xF0
    again = started_again(silicon, bytes(otp))
    assert again.flash.otp[LOCKS] == 0 and kept(again) == KEY


def test_the_power_may_fail_at_any_write(silicon: Maker) -> None:
    """An unfinished block, and then a key: cut after each write. The next start has the whole key, locked, or none."""
    chip = silicon()
    chip.flash.otp[:8] = bytes(8)
    chip.flash.otp[:8] = b"\x3c" * 8
    chip.start("board_with_key")
    assert keep(chip, KEY) == OK
    steps = chip.flash.otp_steps
    assert len(steps) == 8 + 2 + 1  # the key's words, two bytes of the unfinished block, the lock
    for number, otp in enumerate(steps):
        again = started_again(silicon, otp)
        if number < 7:
            assert again.key_read() == DAMAGED and again.is_guarded() == 1
            assert keep(again, KEY[::-1]) == OK and kept(again) == KEY[::-1]
        else:
            assert again.key_read() == LOCKED and kept(again) == KEY


@pytest.mark.parametrize("words", range(1, 8))
def test_a_write_that_the_power_cut_is_no_key_and_the_next_block_takes_it(chip: Silicon, words: int) -> None:
    chip.flash.otp[: 4 * words] = WHOLE[: 4 * words]
    assert chip.key_read() == DAMAGED
    assert keep(chip, KEY[::-1]) == OK
    assert kept(chip) == KEY[::-1]


@pytest.mark.parametrize("bit", range(0, 8 * BLOCK, 7))
def test_a_key_that_has_lost_a_bit_is_no_key_and_is_not_replaced(chip: Silicon, bit: int) -> None:
    """Nor does a key count that another image has put behind it."""
    assert keep(chip, KEY) == OK
    chip.flash.otp[bit // 8] ^= 1 << bit % 8
    assert chip.key_read() == DAMAGED
    chip.flash.otp[BLOCK : 2 * BLOCK] = WHOLE[::-1]
    assert chip.key_read() == DAMAGED
    assert keep(chip, KEY) == DEVICE


def test_a_blank_block_that_is_locked_is_no_key(chip: Silicon) -> None:
    chip.flash.otp[LOCKS] = 0
    assert chip.key_read() == DAMAGED
    assert keep(chip, KEY) == OK  # in the next block
    assert kept(chip) == KEY and bytes(chip.flash.otp[:BLOCK]) == b"\xff" * BLOCK


def test_what_others_keep_there_stays(chip: Silicon) -> None:
    theirs = bytes(range(BLOCK))
    chip.flash.otp[:BLOCK] = theirs
    assert keep(chip, KEY) == OK and kept(chip) == KEY
    assert bytes(chip.flash.otp[:BLOCK]) == theirs and chip.flash.otp[LOCKS] == 0xFF


def test_a_lock_that_is_not_taken_is_reported(chip: Silicon) -> None:
    """The supply falls behind the key's words."""
    whole = chip.flash._store_otp

    def falls(cpu: object, offset: int, size: int, value: int, data: object) -> None:
        whole(cpu, offset, size, value, data)
        if len(chip.flash.otp_steps) == 8:
            chip.supply.supply_v = 2.85

    chip.chip.cpu.mem_unmap(0x1FFF7000, 0x1000)
    chip.chip.cpu.mmio_map(0x1FFF7000, 0x1000, chip.flash._load_otp, None, falls, None)
    assert keep(chip, KEY) == AGAIN
    assert chip.key_read() == OPEN and kept(chip) == KEY


def test_full_memory_says_so(chip: Silicon) -> None:
    chip.flash.otp[: 16 * BLOCK] = bytes(16 * BLOCK)
    assert keep(chip, KEY) == DEVICE
    assert chip.key_read() == DAMAGED


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
