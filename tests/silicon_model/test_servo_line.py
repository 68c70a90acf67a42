"""The servos' half-duplex line on register models of USART6 and DMA 2."""

from __future__ import annotations

import pytest

from servo_line_model import Dma, ServoUsart
from silicon import Maker, Silicon

OK, AGAIN, RANGE = 0, -1, -3
BAUD = 3_000_000
RING = 256


@pytest.fixture
def chip(silicon: Maker) -> Silicon:
    made = silicon()
    made.start()
    return made


@pytest.fixture
def line(chip: Silicon) -> ServoUsart:
    usart = ServoUsart(chip.chip, chip.ports["C"], Dma(chip.chip))
    assert chip.setup_servos(BAUD) == OK
    return usart


def send(chip: Silicon, data: bytes) -> int:
    chip.chip.put("buffer", data)
    return chip.send_to_servos(len(data))


def receive(chip: Silicon, room: int = 64) -> bytes:
    return chip.chip.get("buffer", chip.receive_from_servos(room))


def test_three_million_baud_are_met_exactly(chip: Silicon, line: ServoUsart) -> None:
    assert line.baud() == BAUD
    assert line.cr1 & 0x1600 == 0  # eight bits, no parity
    assert chip.ports["C"].function(6) == chip.ports["C"].function(7) == 8
    assert not line.drives()


@pytest.mark.parametrize("baud", [57_600, 115_200, 1_000_000, 2_000_000, 4_000_000])
def test_other_rates_of_the_servos(chip: Silicon, line: ServoUsart, baud: int) -> None:
    assert chip.setup_servos(baud) == OK
    assert line.baud() == pytest.approx(baud, rel=0.02)


@pytest.mark.parametrize("baud", [0, 9_599, 4_500_001])
def test_rates_that_cannot_be_are_refused(chip: Silicon, line: ServoUsart, baud: int) -> None:
    assert chip.setup_servos(baud) == RANGE


def test_packets_leave_whole_and_the_line_turns_round_behind_the_last_bit(chip: Silicon, line: ServoUsart) -> None:
    for length in (1, 17, 69, 128):
        data = bytes((7 * i + length) % 256 for i in range(length))
        assert send(chip, data) == OK
        assert line.drives()
        assert send(chip, data) == AGAIN  # and disturbs nothing
        chip.chip.wait_us(length * 10 / BAUD * 1e6 + 5)
        assert bytes(line.sent) == data
        assert not line.drives()
        assert line.drive_wrong == 0
        line.sent.clear()


def test_what_cannot_be_sent_is_refused(chip: Silicon, line: ServoUsart) -> None:
    assert chip.send_to_servos(0) == RANGE
    assert chip.send_to_servos(129) == RANGE
    assert not line.drives()


def test_bytes_come_in_order_whatever_the_room_and_the_ring(chip: Silicon, line: ServoUsart) -> None:
    given, taken = bytearray(), bytearray()
    for turn in range(40):
        data = bytes((turn * 31 + i) % 256 for i in range(50))
        given += data
        for byte in data:
            line.arrive(byte)
        taken += receive(chip, 1 + turn % 7)
        taken += receive(chip)
    assert taken == given
    assert receive(chip) == b""


def test_a_full_turn_of_the_ring_is_lost_but_nothing_after(chip: Silicon, line: ServoUsart) -> None:
    for byte in range(RING):
        line.arrive(byte)
    assert receive(chip) == b""  # the packet's CRC shows it
    line.arrive(0x55)
    assert receive(chip) == b"\x55"


def test_an_overrun_is_read_away(chip: Silicon, line: ServoUsart) -> None:
    line.overrun = True
    receive(chip)
    line.arrive(0x77)
    assert receive(chip) == b"\x77"


def test_an_erase_waits_for_the_packet_on_its_way(chip: Silicon, line: ServoUsart) -> None:
    assert send(chip, bytes(128)) == OK
    at_erase: list[bool] = []
    chip.flash.at_erase = lambda: at_erase.append(line.drives())
    assert chip.nvm_erase(0) == OK
    assert at_erase == [False]
