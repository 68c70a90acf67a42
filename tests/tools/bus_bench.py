"""What the tests of buses share: a simulation on TCP, one command with its time, and adapters that misbehave."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from command_bench import FREE, Outcome, running, spawn

from brace.bus.can_controller import CanController
from brace.bus.open import open_bus
from brace.bus.session import Session
from brace.bus.url import parse

TELLING_S = 3.0  # within which every failure is told
START_S = 0.5  # what a command that waits for nothing takes of it on an idle machine


@contextlib.contextmanager
def limb_on_tcp(model: Path, *options: object) -> Iterator[str]:
    """The CAN bus' URL."""
    with running(model, *FREE, *options) as (_, ready):
        yield ready["limbs"][0]["can"]


@contextlib.contextmanager
def device_on(url: str) -> Iterator[CanController]:
    bus = open_bus(parse(url))
    try:
        yield CanController(Session(bus))
    finally:
        bus.close()


def wait_for_mode(url: str, mode: str) -> None:
    until = time.monotonic() + 60
    with device_on(url) as device:
        while device.read_entry("mode") != {"monitor": 1, "configuration": 2, "loading_test": 4}[mode]:
            assert time.monotonic() < until, f"never in {mode}"


def timed(*arguments: object) -> tuple[Outcome, float]:
    """A command in a process of its own, and how long it took [s]."""
    started = time.monotonic()
    process = spawn(*arguments)
    try:
        out, err = process.communicate(timeout=120)
    finally:
        process.kill()
    assert "Traceback" not in err and "internal error" not in err, err
    return Outcome(process.returncode, out, err), time.monotonic() - started


def told_in_time(code: int, *arguments: object) -> str:
    """Its message; the exit code and the time are as promised, and there is a way on."""
    outcome, seconds = timed(*arguments)
    assert outcome.code == code, outcome.err
    # a busy machine? the waits are the same there, the rest takes as much longer as this one does
    if seconds >= TELLING_S:
        nothing = [timed("query", "--bus", "slcan:/dev/ttyNONE")[1] for _ in range(2)]
        slack = 2.0 * max(max(nothing) - START_S, 0.0)
        assert seconds < TELLING_S + slack, f"{seconds:.1f} s, of which {slack:.1f} s are the machine's: {outcome.err}"
    assert "why:" in outcome.err and "try:" in outcome.err
    return outcome.err


@contextlib.contextmanager
def adapter(answer: Callable[[bytes], bytes], sends: bytes = b"", period_s: float = 0.1) -> Iterator[str]:
    """A TCP server: answers each line as told, and sends something again and again. Yields its URL."""
    server = socket.create_server(("127.0.0.1", 0))
    ended = threading.Event()

    def serve(client: socket.socket) -> None:
        client.settimeout(0.02)
        rest, next_s = b"", time.monotonic()
        with client, contextlib.suppress(OSError):
            while not ended.is_set():
                if sends and time.monotonic() >= next_s:
                    client.sendall(sends)
                    next_s = time.monotonic() + period_s
                try:
                    part = client.recv(4096)
                except TimeoutError:
                    continue
                if not part:
                    return
                *lines, rest = (rest + part).split(b"\r")
                for line in lines:
                    if reply := answer(line):
                        client.sendall(reply)

    def accept() -> None:
        with contextlib.suppress(OSError):
            while True:
                client, _ = server.accept()
                threading.Thread(target=serve, args=(client,), daemon=True).start()

    threading.Thread(target=accept, daemon=True).start()
    try:
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
    finally:
        ended.set()
        server.close()


def obliging(line: bytes) -> bytes:
    """An adapter with nothing on its bus."""
    return b"V1013\r" if line == b"V" else b"F00\r" if line == b"F" else b"\r"
