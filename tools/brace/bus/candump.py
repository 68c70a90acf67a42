"""Logs as candump -L writes them: `(1436509052.249713) can0 181#0102030405060708`, a frame a line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

from brace.bus.frame import Frame
from brace.ground.errors import BadFileError

_LINE = re.compile(
    r"\((\d+\.\d+)\)\s+(\S+)\s+([0-9A-Fa-f]{3})"
    r"(?:#((?:[0-9A-Fa-f]{2}){0,8})|##[0-9A-Fa-f]((?:[0-9A-Fa-f]{2}){0,64}))(?:\s+[RT])?\s*"
)
_OTHER = re.compile(r"\((\d+\.\d+)\)\s+(\S+)\s+[0-9A-Fa-f]{3,8}#.*")  # extended, remote, error frames
_RATE_SWITCH = "#1"  # of a CAN FD frame: its flags


def line_of(frame: Frame, interface: str) -> str:
    """One line, with its end."""
    kind = _RATE_SWITCH if frame.is_fd else ""
    return f"({frame.time_s:.6f}) {interface} {frame.identifier:03X}#{kind}{frame.data.hex().upper()}\n"


class CandumpWriter:
    """Frames to a file that is being written."""

    def __init__(self, file: BinaryIO, interface: str) -> None:
        self._file = file
        self._interface = interface

    def add(self, frame: Frame) -> None:
        """One more."""
        self._file.write(line_of(frame, self._interface).encode())

    def finish(self) -> None:
        """Does nothing: each frame was written when it came."""


def do_nothing() -> None:
    """Does nothing: for a caller that does not count the frames that are left out."""


def read(path: Path, passed_over: Callable[[], None] = do_nothing) -> Iterator[Frame]:
    """The frames of a log, without a last line that was cut off. Calls `passed_over` once for each frame with a 29-bit
    identifier and each remote frame, which it leaves out."""
    with path.open("rb") as file:
        for number, raw in enumerate(file, 1):
            text = raw.decode("latin-1")
            found = _LINE.fullmatch(text)
            if found is not None:
                identifier = int(found[3], 16)
                if identifier <= 0x7FF:
                    yield Frame(
                        float(found[1]), identifier, bytes.fromhex(found[4] if found[4] is not None else found[5])
                    )
                else:
                    passed_over()
            elif not text.strip() or not text.endswith("\n"):
                continue
            elif _OTHER.fullmatch(text.rstrip()):
                passed_over()
            else:
                raise BadFileError(
                    "not a line of a candump log",
                    where=f"{path}:{number}",
                    why=f"{text.rstrip()[:60]!r}; the form is (SECONDS) can0 181#0102030405060708",
                    next_step="candump -L writes this form, and so does brace record --out FILE.log",
                )
