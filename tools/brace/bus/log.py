"""A log as a bus: what was recorded, in its order, at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import BinaryIO, Protocol

from brace.bus import candump
from brace.bus.frame import EndOfLog, Frame
from brace.ground.errors import BadFileError, UsageError

ENDINGS = (".log", ".mcap")
_AT_ONCE_MOST = 500


class Writer(Protocol):
    """What a recording is written by."""

    def add(self, frame: Frame) -> None: ...

    def finish(self) -> None: ...


def is_mcap(path: Path) -> bool:
    """By its first bytes; by its name when there is no such file yet."""
    try:
        with path.open("rb") as file:
            return file.read(5) == b"\x89MCAP"
    except OSError:
        return path.suffix == ".mcap"


def read(path: Path, passed_over: Callable[[], None] = candump.do_nothing) -> Iterator[Frame]:
    """Frames of a candump or MCAP log. Calls `passed_over` once for each frame that it leaves out (29-bit identifiers,
    remote frames)."""
    if not path.is_file():
        raise BadFileError(
            "no such log",
            where=str(path),
            why="the file does not exist or is no regular file",
            next_step="check the path",
        )
    try:
        if is_mcap(path):
            from brace.bus import mcap_log

            yield from mcap_log.read(path)
        else:
            yield from candump.read(path, passed_over)
    except OSError as error:
        raise BadFileError(
            "the log cannot be read",
            where=str(path),
            why=error.strerror or str(error),
            next_step="check its permissions",
        ) from None


def writer(file: BinaryIO, ending: str, interface: str) -> Writer:
    """By the ending: .log is candump's, .mcap MCAP."""
    if ending == ".mcap":
        from brace.bus.mcap_log import McapWriter

        return McapWriter(file, interface)
    return candump.CandumpWriter(file, interface)


def no_answers(url: str) -> UsageError:
    """Said before the log is read, where a command needs answers, whatever the log holds."""
    return UsageError(
        "a log answers no requests",
        where=url,
        why="it holds what was sent when it was recorded",
        next_step="brace monitor --bus log:FILE or brace replay FILE shows it; requests need a controller",
    )


class LogBus:
    """Listening only."""

    def __init__(self, url: str, path: Path) -> None:
        self.url = url
        self.bit_rate: int | None = None
        self.other_frames = 0
        self._frames = read(path, self._count_other)
        self._first = next(self._frames, None)  # a file that is no log is refused at once

    def _count_other(self) -> None:
        self.other_frames += 1

    def receive(self, timeout_s: float) -> Frame:
        """The next; never waits."""
        if self._first is not None:
            frame, self._first = self._first, None
            return frame
        try:
            return next(self._frames)
        except StopIteration:
            raise EndOfLog from None

    def receive_all(self) -> list[Frame]:
        """The next few hundred."""
        return [self.receive(0.0), *islice(self._frames, _AT_ONCE_MOST)]

    def send(self, identifier: int, data: bytes) -> None:
        """Nobody is there."""
        raise no_answers(self.url)

    def silence(self) -> tuple[str, str]:
        """Short logs."""
        return (
            "the log holds no frames of a controller",
            "give a log of brace record or of candump -l, taken while a controller was on the bus",
        )

    def close(self) -> None:
        """Nothing to do."""
        close = getattr(self._frames, "close", None)
        if close:
            close()
