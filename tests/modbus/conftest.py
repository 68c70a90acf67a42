"""Servers: a simulated controller by TCP and on a pty, and the firmware's images on emulated boards, on a pty each."""

from __future__ import annotations

import contextlib
import os
import select
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "socketcan")]

from clients import CLIENTS, Client, Place  # noqa: E402
from processes import PATIENCE_S, SLOWLY, emulated, simulated  # noqa: E402
from wire_by_hand import LIMB  # noqa: E402

SIM = ("--can", "none", "--modbus")


@contextlib.contextmanager
def server(name: str, folder: Path) -> Iterator[Place]:
    """A server by its name. The simulated limb's sensor is free of noise: K counts the force that it reads."""
    quiet = folder / "quiet.toml"
    quiet.write_text(LIMB.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    if name == "sim-tcp":
        with simulated("--plant", quiet, *SIM, "modbus-tcp://127.0.0.1:0") as ready:
            host, _, port = ready["limbs"][0]["modbus_tcp"].removeprefix("modbus-tcp://").rpartition(":")
            yield Place(name, host=host, port=int(port))
    elif name == "sim-line":
        with simulated("--plant", quiet, *SIM, "modbus:pty") as ready:
            yield Place(name, device=ready["limbs"][0]["modbus"].removeprefix("modbus:"))
    else:
        with emulated(folder, name, clock=SLOWLY) as places:  # a frame ends with a silence on the board's clock
            wait_for_banner(places["console"])
            # the emulator looks for a new client once a second
            held = os.open(places["modbus"], os.O_RDWR | os.O_NOCTTY)
            try:
                yield Place(name, device=places["modbus"])
            finally:
                os.close(held)


def wait_for_banner(console: str) -> None:
    """Until the board has started."""
    descriptor = os.open(console, os.O_RDWR | os.O_NOCTTY)
    said, end = b"", time.monotonic() + PATIENCE_S
    try:
        while b"stack: " not in said:
            assert time.monotonic() < end, f"no banner: {said!r}"
            if select.select([descriptor], [], [], 0.5)[0]:
                said += os.read(descriptor, 4096)
            else:
                os.write(descriptor, b"banner\r")
    finally:
        os.close(descriptor)


SERVERS = ("sim-tcp", "sim-line", "netduinoplus2", "mps2-an386")


@pytest.fixture(scope="module", params=SERVERS)
def place(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    """Each server in turn."""
    with server(request.param, tmp_path_factory.mktemp("board")) as found:
        yield found


@pytest.fixture(params=list(CLIENTS))
def client(request: pytest.FixtureRequest, place: Place) -> Iterator[Client]:
    """Each client of it in turn."""
    made: Any = CLIENTS[request.param](place)
    try:
        yield made
    finally:
        made.close()


@pytest.fixture(params=[f"{server_name}-{client_name}" for server_name in SERVERS for client_name in CLIENTS])
def client_of_fresh_server(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Client]:
    """Each client of a server of its own, which has stored nothing yet: a controller stores once in ten seconds of its
    own clock."""
    server_name, _, client_name = request.param.rpartition("-")
    with server(server_name, tmp_path) as place:
        made: Any = CLIENTS[client_name](place)
        try:
            yield made
        finally:
            made.close()
