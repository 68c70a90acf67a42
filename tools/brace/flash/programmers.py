"""OpenOCD, st-flash, dfu-util: which one, its command, and running it for a bounded time."""

from __future__ import annotations

import shutil
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from brace.flash.boards import Board
from brace.flash.image import Image, read_image
from brace.flash.usb import DFU, Probe
from brace.ground.errors import BadFileError, NoDeviceError

CONNECT_S = 3.0
PROGRAM_S = 120.0
DEBIAN_PACKAGE = {"openocd": "openocd", "st-flash": "stlink-tools", "dfu-util": "dfu-util"}
TOOLS = tuple(DEBIAN_PACKAGE)


@dataclass(frozen=True)
class Plan:
    """What will be run: first `connect`, which changes nothing, then `command`. A board answers if the first
    ends well and says `present` and not `absent`."""

    tool: str
    file: Path
    connect: tuple[str, ...]
    command: tuple[str, ...]
    present: str = ""
    absent: str = ""


def choose_tool(asked: str | None, probe: Probe | None) -> str:
    """The tool asked for, else the one that what is plugged in speaks to, else one that is installed."""
    if asked:
        return asked
    if probe and probe.kind == DFU:
        return "dfu-util"
    if probe and probe.kind != "stlink":
        return "openocd"
    return next((tool for tool in ("openocd", "st-flash") if shutil.which(tool)), "openocd")


def make_plan(tool: str, image: Image, board: Board, probe: Probe | None, serial: str | None) -> Plan:
    """The commands that put the image on the board."""
    if tool == "openocd":
        return _openocd(image, board, probe.kind if probe else "stlink", serial)
    flat = _flat_file(image)
    if tool == "st-flash":
        which = ("--serial", serial) if serial else ()
        return Plan(tool, flat, ("st-info", "--probe"),
                    ("st-flash", "--reset", *which, "write", str(flat), f"{board.flash_start:#010x}"),
                    absent="Found 0 stlink programmers")  # fmt: skip
    which = ("-S", serial) if serial else ()
    return Plan(tool, flat, ("dfu-util", "--list"),
                ("dfu-util", "-d", "0483:df11", *which, "-a", "0", "-s", f"{board.flash_start:#010x}:leave",
                 "-D", str(flat)),
                present="0483:df11")  # fmt: skip


def _openocd(image: Image, board: Board, interface: str, serial: str | None) -> Plan:
    path = str(image.path.resolve())
    if any(character in path for character in '{}\\"$[]\n'):
        raise BadFileError(
            "OpenOCD cannot be told this name",
            where=path,
            why="braces, brackets, quotes, $ and \\ mean something to it",
            next_step="copy the image and its SHA256SUMS to a folder with a plain name",
        )
    which = ("-c", f"adapter serial {serial}") if serial else ()
    start = ("openocd", "-f", f"interface/{interface}.cfg", *which, "-f", board.openocd_target)
    offset = f" {board.flash_start:#010x}" if image.kind == "bin" else ""
    return Plan("openocd", image.path, (*start, "-c", "init; shutdown"),
                (*start, "-c", f"program {{{path}}} verify reset exit{offset}"))  # fmt: skip


def _flat_file(image: Image) -> Path:
    """The .bin of an image: itself, or the one beside it with the same content."""
    if image.kind == "bin":
        return image.path
    beside = image.path.with_suffix(".bin")
    if not beside.is_file() or read_image(beside).flat() != image.flat():
        raise BadFileError(
            f"no {beside.name} with the same content beside it",
            where=str(image.path),
            why="this tool writes plain bytes only",
            next_step="./dev setup builds both; or --tool openocd",
        )
    return beside


def check_installed(tool: str) -> None:
    """Refuses, with the Debian package's name, a tool that is not there."""
    if shutil.which(tool) is None:
        raise NoDeviceError(
            f"{tool} is not installed",
            where="flash",
            why="it is what writes the image",
            next_step=f"sudo apt-get install {DEBIAN_PACKAGE[tool]}",
        )


def nothing_attached(tool: str, said: str) -> NoDeviceError:
    """The message for a board that is not there."""
    return NoDeviceError(
        "no probe and no board answer",
        where="flash",
        why=said,
        next_step="plug the probe in, power the board, see SWDIO, SWCLK, GND; brace doctor shows what is seen"
        if tool != "dfu-util"
        else "hold BOOT0 high while the board resets, and plug its USB in; brace doctor lists what is seen",
    )


def connect(plan: Plan) -> None:
    """Whether a board answers; refuses within CONNECT_S when none does."""
    code, said = _run(plan.connect, CONNECT_S)
    if code is None:
        raise nothing_attached(plan.tool, f"{plan.connect[0]} did not come to an end within {CONNECT_S:g} s")
    if code != 0 or plan.present not in said or (plan.absent and plan.absent in said):
        raise nothing_attached(plan.tool, _last_words(plan.connect[0], said))


def program(plan: Plan) -> float:
    """Writes the image; returns the time it took [s]."""
    began = time.monotonic()
    code, said = _run(plan.command, PROGRAM_S)
    if code is None:
        raise NoDeviceError(
            f"{plan.tool} did not come to an end within {PROGRAM_S:g} s, and was ended",
            where="flash",
            why=_last_words(plan.tool, said),
            next_step="power the board off and on, then again; what is on it now is not known",
        )
    if code != 0:
        raise NoDeviceError(
            f"{plan.tool} failed with exit code {code}",
            where="flash",
            why=_last_words(plan.tool, said),
            next_step="check power and wires, then again; what is on the board now is not known",
        )
    return time.monotonic() - began


def _run(command: Sequence[str], limit_s: float) -> tuple[int | None, str]:
    """Exit code and output; None: it had to be ended."""
    try:
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
    except OSError as error:
        return 127, error.strerror or str(error)
    try:
        said, _ = process.communicate(timeout=limit_s)
        return process.returncode, said.decode(errors="replace")
    except subprocess.TimeoutExpired:
        process.kill()
        try:
            said, _ = process.communicate(timeout=1.0)
        except subprocess.TimeoutExpired:  # a child of it still holds the pipe
            said = b""
        return None, said.decode(errors="replace")
    except BaseException:  # Ctrl-C: nothing of ours goes on
        process.kill()
        process.wait()
        raise


def _last_words(program: str, said: str) -> str:
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    error_lines = [line for line in lines if "error" in line.lower()] or lines
    return f"{program}: {error_lines[-1][:200]}" if error_lines else f"{program} said nothing"
