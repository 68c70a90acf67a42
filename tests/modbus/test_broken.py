"""What no client would send, on real wires: frames with wrong checks, halves, noise without end, streams that are no
Modbus. The server counts, stays silent or answers as the standard says, and the next good request is answered."""

from __future__ import annotations

import os
import random
import select
import socket
import struct
import termios
import time
import tty
from collections.abc import Iterator
from pathlib import Path

import pytest
from clients import Place
from conftest import server
from values import MAP

GOOD = bytes((1, 4, 0, 0, 0, 4))
PROBES = bytes.fromhex("4640e60001020304")
SILENT_S, PATIENCE_S = 0.25, 60.0


def crc(data: bytes) -> bytes:
    """Modbus over serial line 1.02, appendix B."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return struct.pack("<H", value)


def answer_bytes(beginning: bytes) -> int:
    """The length of an answer to a read: an exception, or with so many bytes of values."""
    return 5 if beginning[1] & 0x80 else 5 + beginning[2]


class Line:
    """A serial line, raw."""

    def __init__(self, place: Place) -> None:
        self.is_emulated = not place.name.startswith("sim")
        self.file = os.open(place.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.file)
        termios.tcflush(self.file, termios.TCIOFLUSH)

    def say(self, data: bytes) -> None:
        """Writes all of it, however slowly the other end takes it."""
        end = time.monotonic() + PATIENCE_S
        while data:
            assert time.monotonic() < end, "the line takes nothing"
            if select.select([], [self.file], [], 0.1)[1]:
                data = data[os.write(self.file, data) :]

    def hear(self, first_s: float = SILENT_S) -> bytes:
        """What comes until it is silent. Silence alone proves little on a busy machine: whatever comes later stands
        before the next answer, which is then not a good one."""
        heard, wait = b"", first_s
        while select.select([self.file], [], [], wait)[0]:
            heard += os.read(self.file, 4096)
            wait = 0.05
        return heard

    def ask(self, pdu: bytes, unit: int = 1) -> bytes:
        """The answer's PDU, however slowly it comes; nothing may come before it. An emulated board notices no
        pause during which its emulator stood still. It takes the question for the end of the broken frame before, so
        this asks once more."""
        frame = bytes((unit,)) + pdu
        self.say(frame + crc(frame))
        heard, end = b"", time.monotonic() + PATIENCE_S
        again = end - 0.5 * PATIENCE_S if self.is_emulated else end
        # its length counts, too: where the check ends with a zero, the bytes before that one have a good check as well
        while len(heard) < 5 or len(heard) < answer_bytes(heard) or crc(heard[:-2]) != heard[-2:]:
            assert time.monotonic() < end, f"no answer, or no good one: {heard!r}"
            if not heard and time.monotonic() > again:
                self.say(frame + crc(frame))
                again = end
            if select.select([self.file], [], [], SILENT_S)[0]:
                heard += os.read(self.file, 4096)
        assert heard[0] == unit, heard
        return heard[1:-2]

    def count(self, name: str) -> int:
        """A counter."""
        reported = self.ask(struct.pack(">BHH", 4, int(MAP[name]["address"]), 2))
        assert reported[:2] == b"\4\4" and len(reported) == 6, f"another answer: {reported!r}"
        return int.from_bytes(reported[2:], "big")

    def pause_s(self) -> float:
        """Forty ticks, as long as they take now: twice what a controller waits for the rest of a frame."""
        begun, first = time.monotonic(), self.count("sequence")
        ticks = self.count("sequence") - first
        return max(SILENT_S, 40 * (time.monotonic() - begun) / ticks)


# Both boards run the same code of the frames; the second one's clock is slow here.
@pytest.fixture(
    scope="module", params=["sim-line", "netduinoplus2", pytest.param("mps2-an386", marks=pytest.mark.minutes)]
)
def line(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Line]:
    with server(request.param, tmp_path_factory.mktemp("board")) as place:
        found = Line(place)
        yield found
        os.close(found.file)


# Before the boards are there: an emulated one works all the time.
def test_tcp_streams_that_are_no_modbus(tmp_path: Path) -> None:
    good = b"\0\7\0\0\0\6" + GOOD

    def answer(place: Place, sent: bytes, wanted: int = 17, patience_s: float = PATIENCE_S) -> bytes:
        """What comes: as much as is wanted, or until the server hangs up or is silent."""
        with socket.create_connection((place.host, place.port), PATIENCE_S) as wire:
            wire.settimeout(patience_s)
            wire.sendall(sent)
            heard = b""
            try:
                while len(heard) < wanted and (part := wire.recv(4096)):
                    heard += part
            except TimeoutError:
                pass
            return heard

    with server("sim-tcp", tmp_path) as place:
        whole = good[:4] + b"\0\x0b" + bytes((1, 4, 8)) + PROBES
        assert answer(place, good) == whole
        noise = random.Random(5)
        for _ in range(20):
            heard = answer(place, noise.randbytes(200), patience_s=1.0)
            assert b"\xe6\0\1\2\3" not in heard
        assert answer(place, b"GET / HTTP/1.0\r\n\r\n") == b""
        # no such unit behind this door
        assert answer(place, good[:6] + b"\x09" + good[7:], wanted=9)[6:] == b"\x09\x84\x0b"
        with socket.create_connection((place.host, place.port), PATIENCE_S) as half:
            half.sendall(good[:9])  # and never goes on
            assert answer(place, good) == whole


def test_the_sample_is_good(line: Line) -> None:
    assert line.ask(GOOD[1:])[2:] == PROBES


def test_broken_frames_are_counted_and_not_answered(line: Line) -> None:
    whole = GOOD + crc(GOOD)
    frames = [whole[:length] for length in (1, 2, 5, 7)]  # halves
    frames += [whole[:-1] + bytes((whole[-1] ^ 1,)), bytes((1, 4, 0, 1)) + whole[4:]]  # wrong checks
    frames += [whole + b"\x55", b"\1" * 300, b"\0\0\0"]  # wrong lengths
    after = line.count("modbus_broken")
    for frame in frames:
        before, pause_s = after, line.pause_s()
        line.say(frame)
        assert line.hear(pause_s) == b"", frame
        after = line.count("modbus_broken")
        counted = after - before
        assert counted == 1 or (len(frame) > 256 and counted > 1), frame  # the emulator may pause within a long one


def test_a_pause_of_the_host_within_a_frame_is_no_silence(line: Line) -> None:
    """On an emulated board, whose clock counts instructions while a frame comes: 50 ms of the host are few
    there. Were it asleep, they would be longer than it waits for the rest of a frame."""
    if not line.is_emulated:
        pytest.skip("its clock is the host's")
    whole = GOOD + crc(GOOD)
    line.count("sequence")  # the emulator has found this end of the line, and passes bytes on at once
    for _ in range(10):  # the host may pause for longer
        line.say(whole[:4])
        time.sleep(0.05)
        line.say(whole[4:])
        if PROBES in line.hear(2.0):
            return
    raise AssertionError("each pause ended its frame")


def test_others_and_everybody_get_no_answer(line: Line) -> None:
    for unit in (0, 2, 247):
        frame, pause_s = bytes((unit,)) + GOOD[1:], line.pause_s()
        line.say(frame + crc(frame))
        assert line.hear(pause_s) == b""
        line.count("sequence")  # the answer to this is the next thing heard


def test_exceptions(line: Line) -> None:
    for pdu, code in ((b"\x63", 1), (b"\x04\xff\xff\x00\x01", 2), (b"\x04\x00\x00\x00\x7e", 3),
                      (b"\x10\0\0\0\2\4\0\0\0\0", 1)):
        assert line.ask(pdu) == bytes((pdu[0] | 0x80, code))


def test_a_flood_of_noise_stops_nothing(line: Line) -> None:
    noise = random.Random(4)
    before, ticks = line.count("modbus_broken"), line.count("sequence")
    for _ in range(40):
        line.say(noise.randbytes(256))
    end = time.monotonic() + PATIENCE_S
    line.say(GOOD + crc(GOOD))
    while PROBES not in line.hear(1.0):  # the noise that is still on its way swallows requests
        assert time.monotonic() < end, "no answer after the noise"
        line.say(GOOD + crc(GOOD))
    while line.hear(2.0):  # the answers to all of these
        pass
    assert line.count("modbus_broken") > before and line.count("sequence") > ticks
    assert line.ask(GOOD[1:])[2:] == PROBES
