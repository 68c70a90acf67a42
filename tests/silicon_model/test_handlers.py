"""What an interrupt handler costs at most: counted, instruction by instruction."""

from __future__ import annotations

from collections.abc import Callable

import unicorn

from bxcan_model import Frame
from silicon import Maker, Silicon
from usart_model import Usart

CAN_INSTRUCTIONS, USART_INSTRUCTIONS = 200, 120  # what the header promises


def longest_handler(chip: Silicon, prepare: Callable[[], object]) -> int:
    """Instructions of the one handler that what is prepared calls for."""
    executed = [0]

    def count(*_: object) -> None:
        executed[0] += chip.chip.in_handler

    chip.chip.interrupts_on = False
    prepare()
    chip.chip.interrupts_on = True
    taken, hook = chip.chip.interrupts_taken, chip.chip.cpu.hook_add(unicorn.UC_HOOK_CODE, count)
    chip.chip.serve_interrupts()
    chip.chip.cpu.hook_del(hook)
    assert chip.chip.interrupts_taken == taken + 1
    return executed[0]


def test_can_handler_with_a_full_fifo_and_an_overrun(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    assert chip.setup_can(1_000_000, 0, 0, 0) == 0
    chip.bus.bit_rate = 1_000_000

    def five_frames() -> None:
        chip.can.arriving.extend(Frame(i, b"12345678") for i in range(5))
        chip.chip.wait_us(2000)

    assert 100 < longest_handler(chip, five_frames) <= CAN_INSTRUCTIONS


def test_usart_handler_with_a_byte_in_and_two_out(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    usart = Usart(chip.chip, 0x40004400, 38, "usart2_handler", 42e6, (chip.ports["D"], 4))
    assert chip.serial_setup_port(1, 115200, 1) == 0

    def both_ways() -> None:
        chip.serial_write_port(1, 3)
        usart.arrive(0x55)

    assert 50 < longest_handler(chip, both_ways) <= USART_INSTRUCTIONS
