"""The client's buses against python-can: SLCAN over TCP, a pty, and text in every cut."""

from __future__ import annotations

import contextlib
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import can
import pytest
from conftest import PROBE, Answer

FRAMES = [(0x181, bytes(range(8))), (0x7FF, b""), (0x000, b"\xff"), (0x5A5, b"\x00\x80\x7f")]


PATIENCE_MS = 20_000  # a busy machine: whoever sends may take its time


def dump(url: str, frames: int | None = None) -> subprocess.Popen[str]:
    """The client's bus, open: prints so many frames; without a number what comes until nothing has for 1.5 s."""
    until = ["1500"] if frames is None else [str(PATIENCE_MS), str(frames)]
    process = subprocess.Popen([PROBE, url, "0", "5000", "dump", *until], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "open\n"
    return process


def frames_in(text: str) -> list[tuple[int, bytes]]:
    frames = []
    for line in text.splitlines():
        if not line.startswith(("open", "errors", "lost")):
            identifier, _, data = line.partition(" ")
            frames.append((int(identifier, 16), bytes.fromhex(data)))
    return frames


@pytest.fixture
def pair(tmp_path: Path) -> Iterator[tuple[Path, Path, subprocess.Popen[bytes]]]:
    """Two serial devices with a line between them, and what makes the line."""
    ends = tmp_path / "a", tmp_path / "b"
    process = subprocess.Popen(["socat", *(f"pty,raw,echo=0,link={end}" for end in ends)])
    until = time.monotonic() + 30
    while not all(end.exists() for end in ends):
        assert time.monotonic() < until, "socat made no ptys"
        time.sleep(0.02)
    yield *ends, process
    process.terminate()
    process.wait(timeout=5)


@contextlib.contextmanager
def relay() -> Iterator[str]:
    """host:port of a server that joins its two callers."""
    server = socket.create_server(("127.0.0.1", 0))

    def pump(source: socket.socket, sink: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while part := source.recv(4096):
                sink.sendall(part)

    def run() -> None:
        with contextlib.suppress(OSError):
            lines = [server.accept()[0] for _ in range(2)]
            for one, other in (lines, lines[::-1]):
                threading.Thread(target=pump, args=(one, other), daemon=True).start()

    threading.Thread(target=run, daemon=True).start()
    yield f"127.0.0.1:{server.getsockname()[1]}"
    server.close()


def exchange(ours: str, theirs: str) -> None:
    """Frames both ways between the client's bus and python-can's."""
    process = dump(ours, len(FRAMES) + 1)
    with can.Bus(interface="slcan", channel=theirs, bitrate=1000000, sleep_after_open=0.2) as bus:
        for identifier, data in FRAMES:
            bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))
        bus.send(can.Message(arbitration_id=0x181, data=b"x", is_extended_id=True))  # passed over
        bus.send(can.Message(arbitration_id=0x123, data=b"end", is_extended_id=False))
        out, _ = process.communicate(timeout=60)
    assert frames_in(out) == [*FRAMES, (0x123, b"end")]
    assert out.splitlines()[-2:] == ["errors 0", "lost 0"]


def test_tcp_from_python_can() -> None:
    with relay() as place:
        exchange(f"tcp://{place}", f"socket://{place}")


def test_serial_from_python_can(pair: tuple[Path, Path, subprocess.Popen[bytes]]) -> None:
    exchange(f"slcan:{pair[0]}", str(pair[1]))


def test_serial_to_python_can(pair: tuple[Path, Path, subprocess.Popen[bytes]], probe: Callable[..., Answer]) -> None:
    with can.Bus(interface="slcan", channel=str(pair[1]), bitrate=1000000, sleep_after_open=0.2) as bus:
        for identifier, data in FRAMES:
            assert probe(f"slcan:{pair[0]}@1000000", "send", identifier, *data).code == 0
            message = bus.recv(20)
            assert message is not None
            assert (message.arbitration_id, bytes(message.data)) == (identifier, data)


def test_text_in_every_cut() -> None:
    """An adapter's answers, time stamps, frames of other kinds, lines that are broken: only frames come out."""
    text = b"\r\az\rZ\rV1013\rt1812abcd\rt18120102FFFF\rT000001812abcd\rr1810\rt1819\rt181\rtXYZ0\rt7ff0\r"
    text += b"t" * 100 + b"\rt0011EE\r"
    whole = [(0x181, b"\xab\xcd"), (0x181, b"\x01\x02"), (0x7FF, b""), (0x001, b"\xee")]
    with socket.create_server(("127.0.0.1", 0)) as server:
        for cut in range(1, len(text), 5):
            process = subprocess.Popen(
                [PROBE, f"tcp://127.0.0.1:{server.getsockname()[1]}", "0", "1000", "dump", str(PATIENCE_MS),
                 str(len(whole))],
                stdout=subprocess.PIPE, text=True,
            )  # fmt: skip
            line, _ = server.accept()
            with line:
                line.sendall(text[:cut])
                time.sleep(0.002)
                line.sendall(text[cut:])
                out, _ = process.communicate(timeout=60)
            assert frames_in(out) == whole, cut
            assert out.splitlines()[-2:] == ["errors 0", "lost 4"]  # the broken lines are counted


def test_a_serial_line_that_goes_is_reported(pair: tuple[Path, Path, subprocess.Popen[bytes]]) -> None:
    process = dump(f"slcan:{pair[0]}", 1)
    pair[2].terminate()
    process.communicate(timeout=60)
    assert process.returncode == 4  # DOWN, not TIMEOUT
