"""Run where the kernel has CAN (test_vcan.py does):
the client's SocketCAN against python-can and the kernel's own faults."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Iterator

import can
import pytest
from conftest import PROBE, PROMISED_MS, Answer
from test_transports import FRAMES, dump, frames_in

NO_DEVICE, DOWN, SILENT, BIT_RATE, NODE = 2, 4, 7, 8, 9
HEARTBEAT = 0x700
FLOOD = 6000  # frames; were there room for all of them, none would be lost, and the test would say so
Probe = Callable[..., Answer]


@pytest.fixture
def empty() -> Iterator[str]:
    """A bus with nobody on it."""
    subprocess.run(["ip", "link", "add", "vcan9", "type", "vcan"], check=True)
    subprocess.run(["ip", "link", "set", "vcan9", "up"], check=True)
    yield "vcan9"
    subprocess.run(["ip", "link", "del", "vcan9"], check=True)


def test_frames_from_python_can(empty: str) -> None:
    process = dump(empty, len(FRAMES) + 1)
    with can.Bus(interface="socketcan", channel=empty) as bus:
        for identifier, data in FRAMES:
            bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))
        bus.send(can.Message(arbitration_id=0x181, data=b"x", is_extended_id=True))
        bus.send(can.Message(arbitration_id=0x181, is_remote_frame=True, is_extended_id=False))
        bus.send(can.Message(arbitration_id=0x123, data=b"end", is_extended_id=False))
        out, _ = process.communicate(timeout=60)
    assert frames_in(out) == [*FRAMES, (0x123, b"end")]


def test_frames_to_python_can(empty: str, probe: Probe) -> None:
    with can.Bus(interface="socketcan", channel=empty) as bus:
        for identifier, data in FRAMES:
            assert probe(empty, "send", identifier, *data).code == 0
            message = bus.recv(20)
            assert message is not None and (message.arbitration_id, bytes(message.data)) == (identifier, data)


def test_no_interface(probe: Probe) -> None:
    answer = probe("can77", "identity")
    assert answer.code == NO_DEVICE and "no such interface" in answer.err and "ip -br link" in answer.err
    answer = probe("lo", "identity")
    assert answer.code == NO_DEVICE and "is it a CAN interface?" in answer.err


def test_interface_down(empty: str, probe: Probe) -> None:
    subprocess.run(["ip", "link", "set", empty, "down"], check=True)
    answer = probe(empty, "identity")
    assert answer.code == DOWN and "exit 4" in answer.err and f"ip link set {empty} up" in answer.err


def test_interface_goes_down_meanwhile(empty: str) -> None:
    process = subprocess.Popen(
        [PROBE, empty, "1", "2500", "identity"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    time.sleep(0.5)
    subprocess.run(["ip", "link", "set", empty, "down"], check=True)
    _, err = process.communicate(timeout=30)
    assert process.returncode == DOWN and "has gone" in err


def test_silence(empty: str, probe: Probe) -> None:
    answer = probe(empty, "identity", timeout_ms=PROMISED_MS)
    assert answer.code == SILENT and answer.reported_in_time


def test_error_frames_are_a_wrong_bit_rate(empty: str, probe: Probe) -> None:
    process = subprocess.Popen(
        [PROBE, empty, "1", "2500", "identity"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    with can.Bus(interface="socketcan", channel=empty) as bus:
        for _ in range(10):
            time.sleep(0.1)
            bus.send(can.Message(arbitration_id=0x88, is_error_frame=True, is_extended_id=False, data=bytes(8)))
    _, err = process.communicate(timeout=30)
    assert process.returncode == BIT_RATE and "bit rate" in err and "exit 4" in err


def test_a_full_queue_is_reported(empty: str) -> None:
    """The kernel drops what finds no room, and says how many: the joiner must know."""
    process = dump(empty)
    subprocess.run(["kill", "-STOP", str(process.pid)], check=True)
    with can.Bus(interface="socketcan", channel=empty) as bus:
        for i in range(FLOOD):
            bus.send(can.Message(arbitration_id=0x181, data=i.to_bytes(4, "little"), is_extended_id=False), timeout=1)
        subprocess.run(["kill", "-CONT", str(process.pid)], check=True)
        time.sleep(0.5)
        bus.send(can.Message(arbitration_id=0x181, data=b"last", is_extended_id=False))
        out, _ = process.communicate(timeout=30)
    frames = frames_in(out)
    lost = int(out.splitlines()[-1].split()[1])
    assert frames[-1] == (0x181, b"last")
    assert lost > 0 and lost + len(frames) == FLOOD + 1
