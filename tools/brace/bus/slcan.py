"""SLCAN: CAN frames as lines of text, over a serial device or TCP.

The LAWICEL protocol: commands end with CR, an adapter answers CR (done) or BEL (refused); frames come as
tIIILDD...CR. python-can's own sleeps two seconds at each opening; this one does not wait for what it can ask for.
"""

from __future__ import annotations

import contextlib
import time
from binascii import Error as NotHex
from binascii import unhexlify
from collections import deque
from functools import lru_cache
from typing import Protocol

from brace.bus.frame import Frame
from brace.bus.url import BusUrl
from brace.ground.errors import NoDeviceError, UsageError
from brace.wire.names import PARAMETERS

BIT_RATES = {10000: 0, 20000: 1, 50000: 2, 100000: 3, 125000: 4, 250000: 5, 500000: 6, 800000: 7, 1000000: 8}
CONTROLLER_BIT_RATES = sorted(
    next(each.numbers for each in PARAMETERS if each.key == "controller.can_bit_rate"), reverse=True
)
CONNECT_S = 1.0
ANSWER_S = 0.7
SYNC_S = 0.4
SEND_S = 1.0
_LONGEST_LINE = 160
_MUCH_BYTES = 2048  # of one read: more may be there
_BYTES = (*range(9), 12, 16, 20, 24, 32, 48, 64)  # by a line's length code
_HEX = frozenset(b"0123456789abcdefABCDEF")
_NO_FRAME = (0, -1000)
_LONG_OR_REMOTE = (b"T", b"D", b"B", b"r", b"R")  # how frames begin that have 29-bit identifiers, or are remote
_SHORTEST_REMOTE = len(b"r1230")
_ERROR_BITS = (
    "receive queue full",
    "send queue full",
    "error warning",
    "",
    "data overrun",
    "error passive",
    "arbitration lost",
    "bus error",
)


class Line(Protocol):
    """Bytes both ways."""

    def read(self, timeout_s: float) -> bytes:
        """What has come; empty when nothing came in time. OSError when the other end has gone."""

    def write(self, data: bytes) -> None:
        """All of it, or OSError."""

    def close(self) -> None: ...


class SlcanBus:
    """An adapter with its channel open."""

    def __init__(self, url: BusUrl, line: Line, bit_rate: int) -> None:
        self.url = url.text
        self.bit_rate: int | None = bit_rate
        self.other_frames = 0
        self._line = line
        self._rest = b""
        self._frames: deque[Frame] = deque()
        self._answers: deque[bytes] = deque()
        self._opened = False
        try:
            self._open(bit_rate)
            self._opened = True
        except BaseException:
            line.close()
            raise

    def _open(self, bit_rate: int) -> None:
        self._write(b"\r\rC\rV\r")  # ends what somebody left half said, and closes what was left open
        self._swallow_until_version(SYNC_S)
        for command in (b"S%d" % BIT_RATES[bit_rate], b"O"):
            answer = self._ask(command)
            if answer is None:
                raise NoDeviceError(
                    "it does not answer as an SLCAN adapter does",
                    where=self.url,
                    why=f"no answer to {command.decode()!r} within {ANSWER_S} s",
                    next_step="check that this is the adapter's port (not its console), and its baud "
                    "rate: slcan:PLACE@BAUD",
                )
            if answer.endswith(b"\a"):
                raise NoDeviceError(
                    f"the SLCAN adapter refuses {command.decode()!r}",
                    where=self.url,
                    why=f"it cannot do {bit_rate} bit/s, or another program has the channel open",
                    next_step="another --bit-rate, or end the other program",
                )

    def receive(self, timeout_s: float) -> Frame | None:
        """The next frame."""
        if self._frames:
            return self._frames.popleft()
        until = time.monotonic() + timeout_s
        while not self._frames:
            left = until - time.monotonic()
            self._take(max(left, 0.0))
            if left <= 0 and not self._frames:
                return None
        return self._frames.popleft()

    def receive_all(self) -> list[Frame]:
        """Those that have come."""
        while self._take(0.0) > _MUCH_BYTES:
            pass
        frames = list(self._frames)
        self._frames.clear()
        return frames

    def send(self, identifier: int, data: bytes) -> None:
        """One frame. The adapter's own confirmation is not waited for: an answer from the bus shows more."""
        self._answers.clear()
        self._write(b"t%03X%d%s\r" % (identifier, len(data), data.hex().upper().encode()))

    def silence(self) -> tuple[str, str]:
        """The adapter's flags know of another bit rate."""
        answer = self._ask(b"F") or b""
        if answer.startswith(b"F") and len(answer) == 4:
            with contextlib.suppress(ValueError):
                flags = int(answer[1:3], 16)
                if flags & 0xA4:
                    said = ", ".join(
                        name for bit, name in enumerate(_ERROR_BITS) if flags >> bit & 1 and name
                    )
                    return (
                        f"the adapter sees errors on the bus ({said}): another bit rate "
                        f"than {self.bit_rate} bit/s, or the wiring",
                        f"--bit-rate {self._others()}; or check wires and both 120 ohm ends",
                    )
        return (
            f"the adapter answers, and nothing is on the bus at {self.bit_rate} bit/s",
            "check the controller's power and wiring; one whose node_id is 0 sends nothing by "
            "itself (--node 0 asks it)",
        )

    def _others(self) -> str:
        """The rates that a controller may have, without the one that was tried."""
        *most, least = (rate for rate in CONTROLLER_BIT_RATES if rate != self.bit_rate)
        return f"{', '.join(map(str, most))} or {least}"

    def close(self) -> None:
        """Closes channel and line."""
        with contextlib.suppress(OSError, NoDeviceError):
            self._line.write(b"C\r")
        self._line.close()

    # -------------------------------------------------------------------------------------------- lines

    def _ask(self, command: bytes) -> bytes | None:
        """The answer to a command; frames that come between are kept."""
        self._answers.clear()
        self._write(command + b"\r")
        until = time.monotonic() + ANSWER_S
        while not self._answers:
            if time.monotonic() > until:
                return None
            self._take(0.05)
        return self._answers.popleft()

    def _swallow_until_version(self, seconds: float) -> None:
        """Drops what was under way before us; an adapter that knows no V is not waited for longer."""
        until = time.monotonic() + seconds
        while time.monotonic() < until and not any(answer.startswith(b"V") for answer in self._answers):
            self._take(0.02)
        self._frames.clear()
        self._answers.clear()
        self.other_frames = 0

    def _take(self, timeout_s: float) -> int:
        """How many bytes have come."""
        try:
            part = self._line.read(timeout_s)
        except OSError as error:
            raise self._gone(error) from None
        now = time.time()
        *texts, rest = (self._rest + part).replace(b"\a", b"\a\r").split(b"\r")
        for text in texts:
            frame = frame_of(text, now)
            if frame is not None:
                self._frames.append(frame)
            else:
                self._take_answer(text if text.endswith(b"\a") else text + b"\r")
        self._rest = rest[-_LONGEST_LINE:]
        return len(part)

    def _take_answer(self, text: bytes) -> None:
        """Unless it is a frame that is none of ours, or broken."""
        if text[:1] in _LONG_OR_REMOTE and len(text) >= _SHORTEST_REMOTE:
            self.other_frames += 1
        elif (text[:1] not in b"tTrRdDbB" or len(text) == 1) and len(self._answers) < 1000:
            self._answers.append(text)

    def _write(self, data: bytes) -> None:
        try:
            self._line.write(data)
        except OSError as error:
            raise self._gone(error) from None

    def _gone(self, error: OSError) -> NoDeviceError:
        return NoDeviceError(
            "the connection is lost",
            where=self.url,
            why=error.strerror or str(error) or "the other end has closed it",
            next_step="check that the adapter (or brace sim) still runs, and try again"
            if self._opened
            else "check that SLCAN is spoken there; a Modbus port is modbus-tcp://HOST:PORT",
        )


def frame_of(text: bytes, time_s: float) -> Frame | None:
    """tIIILDD...[TTTT] as a frame, dIII... and bIII... of CAN FD too; None for everything else."""
    identifier, length = _header(text[:5])
    if len(text) - 2 * length not in (5, 9):
        return None
    try:
        return Frame(time_s, identifier, unhexlify(text[5:])[:length])
    except NotHex:
        return None


@lru_cache(maxsize=512)  # a bus has a few dozen
def _header(text: bytes) -> tuple[int, int]:
    """Identifier, and how many bytes follow; a length that no text has where it is no frame's beginning."""
    if len(text) < 5 or text[:1] not in b"tdb" or not _HEX.issuperset(text[1:]):
        return _NO_FRAME
    identifier, code = int(text[1:4], 16), int(text[4:], 16)
    return _NO_FRAME if identifier > 0x7FF or (text[:1] == b"t" and code > 8) else (identifier, _BYTES[code])


def check_bit_rate(bit_rate: int) -> None:
    """Rates that SLCAN has a letter for."""
    if bit_rate not in BIT_RATES:
        raise UsageError(
            f"{bit_rate} bit/s",
            where="--bit-rate",
            why=f"SLCAN knows {', '.join(map(str, BIT_RATES))}",
            next_step="--bit-rate 1000000",
        )
