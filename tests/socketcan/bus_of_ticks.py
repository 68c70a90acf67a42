"""A node whose ticks the test makes, and an SLCAN client of it in the same process."""

from __future__ import annotations

import contextlib
import socket
from collections.abc import Iterator
from typing import Any

import numpy as np
from wire_by_hand import LIMB, NODE

_HEX = np.full(256, 255, np.uint8)
_HEX[np.frombuffer(b"0123456789ABCDEF", np.uint8)] = np.arange(16)


def line_of(number: int, data: bytes) -> bytes:
    """A frame as text."""
    return b"t%03X%d%s\r" % (number, len(data), data.hex().upper().encode())


class SlcanClient:
    """Speaks the text itself; nothing is waited for."""

    def __init__(self, place: str) -> None:
        host, _, port = place.rpartition("/")[2].rpartition(":")
        self.socket = socket.create_connection((host, int(port)), timeout=5.0)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.sendall(b"S8\rO\r")
        self.socket.setblocking(False)
        self._rest = b""

    def send(self, frames: list[tuple[int, bytes]]) -> None:
        """In order, in one piece."""
        self.send_lines([line_of(*frame) for frame in frames])

    def send_lines(self, lines: list[bytes]) -> None:
        """The same of frames that are text already."""
        self.socket.setblocking(True)
        self.socket.sendall(b"".join(lines))
        self.socket.setblocking(False)

    def text(self) -> bytes:
        """Whole lines that have come."""
        parts = [self._rest]
        while True:
            try:
                part = self.socket.recv(1 << 20)
            except BlockingIOError:
                break
            assert part, "the bus has closed the connection"
            parts.append(part)
        text, end, self._rest = b"".join(parts).rpartition(b"\r")
        return text + end

    def frames(self) -> Iterator[tuple[int, bytes]]:
        """Frames that have come."""
        for line in self.text().split(b"\r"):
            if line[:1] == b"t":
                yield int(line[1:4], 16), bytes.fromhex(line[5:].decode())

    def close(self) -> None:
        self.socket.close()


def eight_byte_frames(text: bytes) -> tuple[np.ndarray, np.ndarray]:
    """All eight-byte frames of some lines: identifiers, and bytes n x 8. Fast: millions of them."""
    raw = np.frombuffer(text, np.uint8)
    ends = np.flatnonzero(raw == ord("\r"))
    starts = np.concatenate([[0], ends[:-1] + 1]) if ends.size else ends
    whole = (ends - starts == 21) & (raw[np.minimum(starts, raw.size - 1)] == ord("t"))
    rows = raw[starts[whole, None] + np.arange(21)]
    assert (rows[:, 4] == ord("8")).all()
    digits = _HEX[rows[:, 1:]].astype(np.uint16)
    identifiers = digits[:, 0] << 8 | digits[:, 1] << 4 | digits[:, 2]
    data = (digits[:, 4::2] << 4 | digits[:, 5::2]).astype(np.uint8)
    return identifiers, data


@contextlib.contextmanager
def limbs(count: int, **changes: float) -> Iterator[Any]:
    """Limbs on one bus; time passes when the test says so. Nothing presses their tips and their sensors are free of
    noise, so that K is the one without load."""
    from brace.model import load_limb
    from brace.sim.node import LimbSetup, Node

    model = load_limb(LIMB)
    posture = (0.0, 1.0, 1.4)
    setups = []
    for limb in range(count):
        own = {"controller.node_id": NODE + limb, **changes}
        setups.append(LimbSetup(model, model, own, theta_rad=posture, hold_n_per_mm=0.0, force_noise_n=0.0))
    with Node(setups, "tcp://127.0.0.1:0") as node:
        yield node
