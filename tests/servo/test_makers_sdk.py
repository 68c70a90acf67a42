"""The simulated servos against their makers' own client: what the client asks for, it gets."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass

import dynamixel_sdk as sdk
import pytest
from brace.sim.servos import MODELS, ServoLine

IDS = (11, 12, 13)
MODEL, TORQUE, STATUS_LEVEL, HARDWARE_ERROR, GOAL, PRESENT_CURRENT, POSITION = 0, 64, 68, 70, 116, 126, 132
OPERATING_MODE, MIN_POSITION, VOLTAGE = 11, 52, 144
INSTRUCTION, CRC, RANGE, LENGTH, LIMIT, ACCESS, ALERT = 2, 3, 4, 5, 6, 7, 0x80
OK, TIMEOUT = sdk.COMM_SUCCESS, sdk.COMM_RX_TIMEOUT


@dataclass
class Bench:
    line: ServoLine
    port: sdk.PortHandler
    packets: sdk.Protocol2PacketHandler


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    # The client waits twice this long for an answer. Its own 16 ms are those of a USB adapter; on a busy machine the
    # simulated servos may have to wait longer for a processor.
    monkeypatch.setattr(sdk.port_handler, "LATENCY_TIMER", 100)
    with ServoLine(IDS) as line:
        port = sdk.PortHandler(line.place)
        assert port.setBaudRate(3_000_000)
        yield Bench(line, port, sdk.PacketHandler(2.0))
        port.closePort()


def test_ping(bench: Bench) -> None:
    for identity in IDS:
        assert bench.packets.ping(bench.port, identity) == (MODELS["MX-106"], OK, 0)
    assert bench.packets.ping(bench.port, 99)[1] == TIMEOUT


def test_broadcast_ping(bench: Bench) -> None:
    found, result = bench.packets.broadcastPing(bench.port)
    assert result == OK
    assert {identity: model for identity, (model, _) in found.items()} == dict.fromkeys(IDS, MODELS["MX-106"])


def test_read_and_write_of_each_size(bench: Bench) -> None:
    packets, port = bench.packets, bench.port
    assert packets.write1ByteTxRx(port, 12, TORQUE, 1) == (OK, 0)
    assert packets.read1ByteTxRx(port, 12, TORQUE) == (1, OK, 0)
    assert packets.write2ByteTxRx(port, 12, 102, 300) == (OK, 0)
    assert packets.read2ByteTxRx(port, 12, 102) == (300, OK, 0)
    assert packets.write4ByteTxRx(port, 12, GOAL, 1500) == (OK, 0)
    assert packets.read4ByteTxRx(port, 12, GOAL) == (1500, OK, 0)
    deadline = time.monotonic() + 1.0
    while packets.read4ByteTxRx(port, 12, POSITION)[0] != 1500 and time.monotonic() < deadline:
        pass
    assert packets.read4ByteTxRx(port, 12, POSITION) == (1500, OK, 0)
    assert bench.line.peek(0, GOAL, 4) == 0  # the others did not hear it


def test_values_that_look_like_a_header(bench: Bench) -> None:
    """FF FF FD within the data is stuffed on both ways."""
    data = [0xFF, 0xFF, 0xFD, 0xFF]  # -131073 counts
    assert bench.packets.writeTxRx(bench.port, 11, GOAL, 4, data) == (OK, 0)
    assert bench.line.peek(0, GOAL, 4) == -131073
    assert bench.packets.readTxRx(bench.port, 11, GOAL, 4) == (data, OK, 0)
    bench.line.shaft(1, math.pi, current_a=-0.003)  # current -1, velocity 0
    bench.line.poke(1, 128, 4, -3)
    read = bench.packets.readTxRx(bench.port, 12, PRESENT_CURRENT, 6)
    assert read == ([0xFF, 0xFF, 0xFD, 0xFF, 0xFF, 0xFF], OK, 0)


def test_sync_read(bench: Bench) -> None:
    for fast in (False, True):
        group = sdk.GroupSyncRead(bench.port, bench.packets, PRESENT_CURRENT, 10)
        for place, identity in enumerate(IDS):
            bench.line.shaft(place, 0.5 + place, current_a=0.1 * place)
            assert group.addParam(identity)
        assert (group.fastSyncRead() if fast else group.txRxPacket()) == OK
        for place, identity in enumerate(IDS):
            assert group.isAvailable(identity, POSITION, 4)
            assert group.getData(identity, POSITION, 4) == round((0.5 + place) * 2048 / math.pi)
            assert group.getData(identity, PRESENT_CURRENT, 2) == round(0.1 * place / 3.36e-3)


def test_a_silent_servo_in_a_sync_read_is_missed(bench: Bench) -> None:
    for fast in (False, True):
        group = sdk.GroupSyncRead(bench.port, bench.packets, POSITION, 4)
        for identity in IDS:
            group.addParam(identity)
        bench.line.plug(1, False)
        assert (group.fastSyncRead() if fast else group.txRxPacket()) != OK
        bench.line.plug(1, True)
        assert (group.fastSyncRead() if fast else group.txRxPacket()) == OK


def test_sync_write(bench: Bench) -> None:
    group = sdk.GroupSyncWrite(bench.port, bench.packets, GOAL, 4)
    for place, identity in enumerate(IDS):
        assert group.addParam(identity, list((1000 + place).to_bytes(4, "little")))
    assert group.txPacket() == OK
    assert bench.packets.ping(bench.port, 11)[1] == OK  # whatever came before is done by now
    assert [bench.line.peek(place, GOAL, 4) for place in range(3)] == [1000, 1001, 1002]


def test_reg_write_waits_for_action(bench: Bench) -> None:
    assert bench.packets.regWriteTxRx(bench.port, 11, GOAL, 4, [7, 0, 0, 0]) == (OK, 0)
    assert bench.packets.read4ByteTxRx(bench.port, 11, GOAL)[0] == 0
    assert bench.packets.action(bench.port, sdk.BROADCAST_ID) == OK
    assert bench.packets.read4ByteTxRx(bench.port, 11, GOAL)[0] == 7


def test_reboot_forgets_what_is_in_ram_and_takes_its_time(bench: Bench) -> None:
    packets, port = bench.packets, bench.port
    assert packets.write1ByteTxRx(port, 12, OPERATING_MODE, 3) == (OK, 0)
    assert packets.write1ByteTxRx(port, 12, TORQUE, 1) == (OK, 0)
    assert packets.reboot(port, 12) == (OK, 0)
    assert packets.ping(port, 12)[1] == TIMEOUT
    assert packets.ping(port, 11)[1] == OK
    deadline = time.monotonic() + 3.0
    while packets.ping(port, 12)[1] != OK:
        assert time.monotonic() < deadline
    assert packets.read1ByteTxRx(port, 12, TORQUE) == (0, OK, 0)
    assert packets.read1ByteTxRx(port, 12, OPERATING_MODE) == (3, OK, 0)


def test_errors_have_their_numbers(bench: Bench) -> None:
    packets, port = bench.packets, bench.port
    assert packets.write1ByteTxRx(port, 11, TORQUE, 2) == (OK, RANGE)
    assert packets.write2ByteTxRx(port, 11, GOAL, 5) == (OK, LENGTH)  # half a register
    assert packets.write2ByteTxRx(port, 11, VOLTAGE, 5) == (OK, ACCESS)  # read only
    assert packets.readTxRx(port, 11, 250, 20)[2] == ACCESS  # beyond the table
    assert packets.write1ByteTxRx(port, 11, OPERATING_MODE, 3) == (OK, 0)
    assert packets.write4ByteTxRx(port, 11, GOAL, 5000) == (OK, LIMIT)
    assert packets.write1ByteTxRx(port, 11, TORQUE, 1) == (OK, 0)
    assert packets.write1ByteTxRx(port, 11, OPERATING_MODE, 5) == (OK, ACCESS)  # locked while it holds
    assert packets.factoryReset(port, 11, 1) == (OK, INSTRUCTION)  # not simulated
    for number in (RANGE, LENGTH, ACCESS, LIMIT, INSTRUCTION):
        assert packets.getRxPacketError(number).startswith("[RxPacketError]")


def test_a_damaged_request_is_refused_by_its_number(bench: Bench) -> None:
    ping = bytearray(b"\xff\xff\xfd\x00\x0b\x03\x00\x01\x00\x00")
    crc = bench.packets.updateCRC(0, ping, 8)
    ping[8], ping[9] = crc & 0xFF, (crc >> 8) ^ 0x01
    bench.port.setPacketTimeout(11)
    bench.port.writePort(bytes(ping))
    status, result = bench.packets.rxPacket(bench.port, False)
    assert (result, status[4], status[8]) == (OK, 11, CRC)


def test_a_hardware_error_sets_the_alert_bit_and_a_reboot_clears_it(bench: Bench) -> None:
    packets, port = bench.packets, bench.port
    assert packets.write1ByteTxRx(port, 13, TORQUE, 1) == (OK, 0)
    bench.line.fail(2, 0x20)
    assert packets.read1ByteTxRx(port, 13, HARDWARE_ERROR) == (0x20, OK, ALERT)
    assert packets.read1ByteTxRx(port, 13, TORQUE)[0] == 0
    assert packets.write1ByteTxRx(port, 13, TORQUE, 1)[1] == ALERT | 1
    packets.reboot(port, 13)
    time.sleep(0.6)
    assert packets.read1ByteTxRx(port, 13, HARDWARE_ERROR) == (0, OK, 0)


def test_status_return_level(bench: Bench) -> None:
    packets, port = bench.packets, bench.port
    assert packets.write1ByteTxRx(port, 11, STATUS_LEVEL, 1) == (OK, 0)
    assert packets.write1ByteTxRx(port, 11, 65, 1)[0] == TIMEOUT
    assert packets.read1ByteTxRx(port, 11, 65) == (1, OK, 0)
    assert packets.write1ByteTxRx(port, 11, STATUS_LEVEL, 0)[0] == TIMEOUT
    assert packets.read1ByteTxRx(port, 11, 65)[1] == TIMEOUT
    assert packets.ping(port, 11)[1] == OK


def test_the_client_sees_damage(bench: Bench) -> None:
    bench.line.damage(0.5)
    results = [bench.packets.read4ByteTxRx(bench.port, 12, POSITION) for _ in range(60)]
    right = [value for value, result, error in results if result == OK and error == 0]
    assert 5 < len(right) < 55
    assert set(right) == {2048}
