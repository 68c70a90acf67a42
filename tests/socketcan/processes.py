"""A simulated limb and an emulated board as processes; ended, and only they, on leaving."""

from __future__ import annotations

import contextlib
import json
import os
import re
import select
import shutil
import struct
import subprocess
import sys
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from wire_by_hand import LIMB, NODE, PROJECT

IMAGES = Path(os.environ.get("BRACE_IMAGES", PROJECT / "build" / "m4f" / "images"))
PATIENCE_S = 30.0  # a loaded machine; an idle one takes a second
# The board's clock counts its instructions. The host may take the emulator off the processor for as long as it likes:
# the board's timers and rates stay in step with its program, and so do the silences within a Modbus frame. Between
# ticks the board sleeps, unless such a frame comes, and its clock follows the host's.
AT_PACE = ("-icount", "shift=3")  # 8 ns each, about an STM32F405 at 168 MHz: a tick takes an idle host about 1 ms
# For Modbus RTU, where a silence of 2 ms on the board's clock ends a frame, the board runs slower than the host, which
# so has longer to pass on the next byte: 2 ns each where a program gives up on a slow board, else 1 ns each.
SLOWER = ("-icount", "shift=1")
SLOWLY = ("-icount", "shift=0")


@contextlib.contextmanager
def simulated(*options: object) -> Iterator[dict[str, Any]]:
    """`brace sim`; its 'ready' line."""
    command = [sys.executable, "-m", "brace", "sim", "--model", str(LIMB), "--json", *map(str, options)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None and process.stderr is not None
        ready, _, _ = select.select([process.stdout], [], [], PATIENCE_S)
        line = process.stdout.readline() if ready else ""
        assert line, process.stderr.read() if process.poll() is not None else "brace sim says nothing"
        yield json.loads(line)
    finally:
        process.kill()
        process.communicate()


def memory_image(path: Path, changes: dict[str, float]) -> Path:
    """Non-volatile memory of an emulated board: the paper's limb, as brace/store.h lays a slot out."""
    from brace.model import load_limb
    from brace.params import pack

    block = pack(load_limb(LIMB).with_values({"controller.node_id": NODE, **changes})).content
    crc = block[-4:]
    assert crc == struct.pack("<I", zlib.crc32(block[:-4]))
    slot = (block.ljust(3584, b"\xff") + b"KEEP" + crc).ljust(4096, b"\xff")
    path.write_bytes(b"BRACE-NVM-IN-RAM" + slot + b"\xff" * 4096)
    return path


def _address_of(elf: Path, symbol: str) -> int:
    listing = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    return next(int(line.split()[0], 16) for line in listing.splitlines() if line.split()[-1] == symbol)


@contextlib.contextmanager
def emulated(
    folder: Path,
    name: str = "netduinoplus2",
    changes: dict[str, float] | None = None,
    clock: tuple[str, ...] = AT_PACE,
) -> Iterator[dict[str, str]]:
    """A controller image on an emulated board with the paper's limb in its memory; ptys of its serial ports console,
    modbus, slcan."""
    program = shutil.which("qemu-system-arm")
    if program is None or shutil.which("arm-none-eabi-nm") is None:
        pytest.skip("qemu-system-arm or binutils-arm-none-eabi is missing")
    elf = IMAGES / f"brace-{name}.elf"
    if not elf.is_file():
        pytest.skip(f"{elf.name} is not built: ./dev setup builds it")
    memory = memory_image(folder / "memory", changes or {})
    ports = ("console", "modbus", "slcan")
    serial = [word for port in ports for word in ("-chardev", f"pty,id={port}", "-serial", f"chardev:{port}")]
    loaded = ["-device", f"loader,file={memory},addr={_address_of(elf, '_kept_nvm'):#x}"]
    quiet = ["-display", "none", "-monitor", "none"]
    command = [program, "-machine", name, *quiet, *serial, "-kernel", str(elf.with_suffix(".bin")), *loaded, *clock]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        yield _places(process, len(ports))
    finally:
        process.kill()
        process.communicate()


def _places(process: subprocess.Popen[bytes], count: int) -> dict[str, str]:
    assert process.stdout is not None
    said, end = b"", time.monotonic() + PATIENCE_S
    places: dict[str, str] = {}
    while len(places) < count and time.monotonic() < end:
        if select.select([process.stdout], [], [], 0.2)[0]:
            part = os.read(process.stdout.fileno(), 4096)
            assert part, f"the emulator ended: {said.decode()}"
            said += part
        places = {label: tty for tty, label in re.findall(r"redirected to (\S+) \(label (\w+)\)", said.decode())}
    assert len(places) == count, said.decode()
    return places


def in_guest(*command: object, serial: str | None = None) -> subprocess.CompletedProcess[str]:
    """Runs a command where the kernel has CAN; skips when this machine cannot."""
    runner = [str(PROJECT / "tests" / "socketcan" / "with_vcan"), *(("--serial", serial) if serial else ())]
    run = subprocess.run(
        [*runner, *map(str, command)], cwd=PROJECT, capture_output=True, text=True, timeout=400, check=False
    )
    if run.returncode == 4:
        pytest.skip(run.stderr.strip())
    return run
