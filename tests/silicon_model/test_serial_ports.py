"""The serial ports on the register model of a USART."""

from __future__ import annotations

import random

import pytest

from silicon import Maker, Silicon
from usart_model import Usart

CONSOLE, MODBUS, SLCAN = 0, 1, 2
NONE, EVEN, ODD = 0, 1, 2
OK, UNSUPPORTED, RANGE, DEVICE = 0, -2, -3, -4


def console(chip: Silicon) -> Usart:
    return Usart(chip.chip, 0x40011000, 37, "usart1_handler", 84e6, None)


def modbus(chip: Silicon) -> Usart:
    return Usart(chip.chip, 0x40004400, 38, "usart2_handler", 42e6, (chip.ports["D"], 4))


def write(chip: Silicon, port: int, data: bytes) -> int:
    chip.chip.put("buffer", data)
    return chip.serial_write_port(port, len(data))


def read(chip: Silicon, port: int, room: int = 1024) -> bytes:
    count = chip.serial_read_port(port, room)
    return chip.chip.get("buffer", count)


@pytest.mark.parametrize("baud", [9600, 19200, 115200, 230400, 921600])
def test_baud_is_met(silicon: Maker, baud: int) -> None:
    chip = silicon()
    chip.start()
    for port, usart in ((CONSOLE, console(chip)), (MODBUS, modbus(chip))):
        assert chip.serial_setup_port(port, baud, NONE) == OK
        assert usart.baud() == pytest.approx(baud, rel=0.02)


@pytest.mark.parametrize("parity, bits", [(NONE, 0x0000), (EVEN, 0x1400), (ODD, 0x1600)])
def test_eight_data_bits_whatever_the_parity(silicon: Maker, parity: int, bits: int) -> None:
    chip = silicon()
    chip.start()
    usart = modbus(chip)
    assert chip.serial_setup_port(MODBUS, 19200, parity) == OK
    assert usart.cr1 & 0x1600 == bits  # M, PCE, PS: the parity bit is the ninth
    assert chip.ports["D"].function(5) == chip.ports["D"].function(6) == 7


def test_what_can_not_be_set_up_is_refused(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    console(chip)
    assert chip.serial_setup_port(SLCAN, 115200, NONE) == UNSUPPORTED
    assert chip.serial_setup_port(77, 115200, NONE) == UNSUPPORTED
    assert chip.serial_setup_port(CONSOLE, 300, NONE) == RANGE
    assert chip.serial_setup_port(CONSOLE, 4_000_000, NONE) == RANGE
    assert chip.serial_setup_port(CONSOLE, 115200, 3) == RANGE
    assert write(chip, CONSOLE, b"x") == DEVICE  # not set up
    assert write(chip, SLCAN, b"x") == UNSUPPORTED


def test_bytes_out_whole_and_in_order_with_the_drive_line_around_them(silicon: Maker) -> None:
    chip, source = silicon(seed=5), random.Random(5)
    chip.start()
    usart, port = modbus(chip), chip.ports["D"]
    assert chip.serial_setup_port(MODBUS, 115200, EVEN) == OK
    wanted = b""
    for _ in range(30):
        assert port.outputs >> 4 & 1 == 0
        message = source.randbytes(source.randrange(1, 40))
        assert write(chip, MODBUS, message) == len(message)
        wanted += message
        chip.chip.wait_us(source.choice((100, 300)))
        if usart.shift is not None:
            more = source.randbytes(3)  # while it is still sending
            assert write(chip, MODBUS, more) == 3
            wanted += more
        chip.chip.wait_us(45 * 100)
    assert bytes(usart.sent) == wanted
    assert usart.drive_wrong == 0
    assert port.outputs >> 4 & 1 == 0


def test_ring_takes_what_there_is_room_for(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    usart = console(chip)
    assert chip.serial_setup_port(CONSOLE, 115200, NONE) == OK
    data = bytes(i % 251 for i in range(800))
    taken = write(chip, CONSOLE, data)
    assert 512 <= taken <= 520
    assert write(chip, CONSOLE, b"z") in (0, 1)
    chip.chip.wait_us(60_000)
    assert bytes(usart.sent)[:taken] == data[:taken]


def test_bytes_in_whole_and_in_order_damaged_ones_dropped(silicon: Maker) -> None:
    chip, source = silicon(seed=6), random.Random(6)
    chip.start()
    usart = console(chip)
    assert chip.serial_setup_port(CONSOLE, 115200, EVEN) == OK
    wanted, got = bytearray(), bytearray()
    for _ in range(1500):
        byte, errors = source.randrange(256), source.choice((0,) * 20 + (1, 2, 3))
        usart.arrive(byte, errors)
        if errors == 0:
            wanted.append(byte)
        chip.chip.wait_us(87)
        if source.random() < 0.1:
            got += read(chip, CONSOLE, source.randrange(1, 60))
    got += read(chip, CONSOLE)
    assert bytes(got) == bytes(wanted)


def test_overrun_does_not_stop_reception(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    usart = console(chip)
    assert chip.serial_setup_port(CONSOLE, 115200, NONE) == OK
    chip.chip.interrupts_on = False
    usart.arrive(1)
    usart.arrive(2)
    chip.chip.interrupts_on = True
    chip.chip.serve_interrupts()
    usart.arrive(3)
    chip.chip.serve_interrupts()
    assert read(chip, CONSOLE) == b"\x01\x03"


def test_overrun_between_status_and_data_does_not_hang(silicon: Maker) -> None:
    """A byte that comes between the handler's two reads leaves ORE without RXNE."""
    chip = silicon()
    chip.start()
    usart = console(chip)
    assert chip.serial_setup_port(CONSOLE, 115200, NONE) == OK
    usart.overrun = True
    chip.chip.serve_interrupts()
    usart.arrive(7)
    chip.chip.serve_interrupts()
    assert read(chip, CONSOLE) == b"\x07"


def test_an_erase_waits_for_what_is_on_its_way(silicon: Maker) -> None:
    """The processor stands still for up to 2 s, and the direction pin of RS-485 falls in an interrupt."""
    chip = silicon()
    chip.start()
    usart, port = modbus(chip), chip.ports["D"]
    assert chip.serial_setup_port(MODBUS, 9600, EVEN) == OK
    assert write(chip, MODBUS, bytes(range(250))) == 250
    at_erase: list[tuple[int, int]] = []
    chip.flash.at_erase = lambda: at_erase.append((len(usart.sent), port.outputs >> 4 & 1))
    assert chip.nvm_erase(0) == OK
    assert at_erase == [(250, 0)]
    assert usart.drive_wrong == 0


def test_a_line_that_never_ends_does_not_hold_up_an_erase(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    modbus(chip)
    assert chip.serial_setup_port(MODBUS, 1200, EVEN) == OK
    assert write(chip, MODBUS, bytes(250)) == 250  # 2.3 s
    began_us = chip.chip.time_us
    taken_us: list[float] = []
    chip.flash.at_erase = lambda: taken_us.append(chip.chip.time_us - began_us)
    assert chip.nvm_erase(0) == OK
    assert 250e3 < taken_us[0] < 400e3
