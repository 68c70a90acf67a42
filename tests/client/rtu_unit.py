"""A Modbus RTU unit on a pseudo-terminal, in Python: answers late, or not at all. Shares no code with the C client."""

from __future__ import annotations

import contextlib
import os
import pty
import select
import struct
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from pymodbus.framer.rtu import FramerRTU

from brace.wire.frames import DICTIONARY_HASH

FIRST_WORDS = struct.pack(">fIII", 12345.5, 0x01020304, DICTIONARY_HASH, 0x00010203)
READ, READ_INPUT = 3, 4


def check(data: bytes) -> bytes:
    """CRC of Modbus, low byte first."""
    return struct.pack(">H", FramerRTU.compute_CRC(data))  # pymodbus has swapped the bytes


def answer_to(request: bytes) -> bytes:
    """Each value of 32 bits is its own address, but the first ones."""
    unit, function, address, count = struct.unpack_from(">BBHH", request)
    if function not in (READ, READ_INPUT):
        return request[:6] + check(request[:6])
    words = FIRST_WORDS + b"".join(struct.pack(">I", place) for place in range(8, 400, 2))
    if function == READ:
        words = b"".join(struct.pack(">I", place) for place in range(0, 400, 2))
    content = bytes((unit, function, 2 * count)) + words[2 * address : 2 * (address + count)]
    return content + check(content)


@dataclass
class Unit:
    """Its URL, and how many requests it has answered whole."""

    url: str
    answered: int = 0


@contextlib.contextmanager
def rtu_unit(late_s: Callable[[int], float], byte_s: Callable[[int], float] = lambda _: 0.0) -> Iterator[Unit]:
    """By the number of the request, from 0: late_s before its answer, byte_s between the bytes of that. Requests
    wait for their turn."""
    ours, theirs = pty.openpty()
    subprocess.run(["stty", "-F", os.ttyname(theirs), "raw", "-echo"], check=True)

    unit, ended = Unit(f"modbus:{os.ttyname(theirs)}"), threading.Event()

    def serve() -> None:
        rest, number = b"", 0
        with contextlib.suppress(OSError):  # the client has closed the device
            while not ended.is_set():
                if not select.select([ours], [], [], 0.02)[0]:
                    continue
                rest += os.read(ours, 256)
                while len(rest) >= 8 and not ended.is_set():
                    length = 9 + rest[6] if rest[1] == 16 else 8
                    if len(rest) < length:
                        break
                    request, rest = rest[:length], rest[length:]
                    time.sleep(late_s(number))
                    answer, pause_s = answer_to(request), byte_s(number)
                    for piece in struct.unpack(f"{len(answer)}c", answer) if pause_s else [answer]:
                        os.write(ours, piece)
                        if ended.wait(pause_s):
                            return
                    number += 1
                    unit.answered = number

    serving = threading.Thread(target=serve, daemon=True)
    serving.start()
    try:
        yield unit
    finally:
        ended.set()
        serving.join()  # the next unit may get the same numbers of files
        os.close(ours)
        os.close(theirs)
