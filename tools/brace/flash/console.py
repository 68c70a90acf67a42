"""Asking a board that has just been written what runs on it."""

from __future__ import annotations

import os
import re
import select
import termios
import time
from pathlib import Path

from brace.flash.image import ImageInfo
from brace.ground.errors import NoDeviceError, NotVerifiedError

ANSWER_S = 6.0
AGAIN_S = 2.5  # a console that has heard itself, before the port was set up, listens when it has been quiet for 2 s
_BANNER = re.compile(rb"^# brace (\S+) \((\S+), (\S+)\) on (\S+)\s*$", re.MULTILINE)


def check_running(port: Path, wanted: ImageInfo) -> str:
    """The banner's first line; refused when the board is silent or says that another image runs."""
    found = _banner(port)
    if found is None:
        raise NoDeviceError(
            "the board does not say what runs on it",
            where=str(port),
            why=f"no banner within {ANSWER_S:g} s of asking, at 115200 baud",
            next_step="is this the console's port, are TX and RX crossed? The image itself has been written",
        )
    version, source, _build, board = (field.decode(errors="replace") for field in found.groups())
    if (version, source, board) != (wanted.version, wanted.hash, wanted.board):
        raise NotVerifiedError(
            f"the board runs brace {version} ({source}) on {board}",
            where=str(port),
            why=f"brace {wanted.version} ({wanted.hash}) on {wanted.board} was written",
            next_step="is the port another board's? else write again",
        )
    return found[0].decode(errors="replace").strip().removeprefix("# ")


def _banner(port: Path) -> re.Match[bytes] | None:
    try:
        handle = os.open(port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    except OSError as error:
        raise NoDeviceError(
            "the port cannot be opened",
            where=str(port),
            why=error.strerror or str(error),
            next_step="brace doctor lists the ports; the group dialout may use them",
        ) from None
    try:
        _raw(handle)
        heard, end, asked = b"", time.monotonic() + ANSWER_S, -AGAIN_S
        while time.monotonic() < end:
            if time.monotonic() - asked > AGAIN_S:
                asked = time.monotonic()
                _write(handle)
            if select.select([handle], [], [], 0.1)[0]:
                heard += _read(handle)
            if found := _BANNER.search(heard.replace(b"\r", b"")):
                return found
        return None
    finally:
        os.close(handle)


def _raw(handle: int) -> None:
    try:
        mode = termios.tcgetattr(handle)
        mode[0] = mode[1] = mode[3] = 0
        mode[2] = termios.CS8 | termios.CREAD | termios.CLOCAL
        mode[4] = mode[5] = termios.B115200
        termios.tcsetattr(handle, termios.TCSANOW, mode)
        termios.tcflush(handle, termios.TCIFLUSH)
    except termios.error:
        pass  # no terminal: a socket's end or a pipe, as in tests


def _write(handle: int) -> None:
    try:
        os.write(handle, b"\rbanner\r")
    except OSError:
        pass


def _read(handle: int) -> bytes:
    try:
        return os.read(handle, 4096)
    except OSError:
        return b""
