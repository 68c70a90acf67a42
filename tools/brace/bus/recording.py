"""A log that is being written: readable after any end, in its place only after a good one."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from brace.bus.frame import Frame
from brace.bus.log import ENDINGS, Writer, writer
from brace.ground.errors import UsageError
from brace.ground.files import checked_destination

FLUSH_S = 0.5


class Recording:
    """FILE.part until finish(), then FILE."""

    def __init__(self, path: Path, interface: str, inputs: Iterable[Path] = ()) -> None:
        if path.suffix not in ENDINGS:
            raise UsageError(
                f"--out {path}: no kind of log ends so",
                where="record",
                why=".log is candump's form, .mcap is MCAP",
                next_step=f"--out {path.with_suffix('.log')}",
            )
        self.path = checked_destination(path, inputs)
        self.part = self.path.with_name(self.path.name + ".part")
        self._refuse_recorded()
        self._interface = interface
        self._file: BinaryIO | None = None
        self._writer: Writer | None = None
        self._flushed_s = 0.0
        self.frames = 0

    def _refuse_recorded(self) -> None:
        """What was recorded is never replaced: nobody can record it again."""
        if self.path.exists():
            raise UsageError(
                "the output would replace a log that is there",
                where=str(self.path),
                why="what it holds may not come again",
                next_step="choose another --out, or move the log away",
            )
        if self.part.exists():
            raise UsageError(
                "the output would replace what a recording before this one left",
                where=str(self.part),
                why="a recording that was cut off leaves its frames there, or another one is running",
                next_step=f"rename it to keep it (it can be read: --bus log:{self.part}) or delete it; or choose "
                "another --out",
            )

    def add(self, frame: Frame) -> None:
        """One more; the file begins with the first. OSError becomes a message."""
        try:
            if self._file is None:
                self._file = self.part.open("wb")
                self._writer = writer(self._file, self.path.suffix, self._interface)
            assert self._writer is not None
            self._writer.add(frame)
            self.frames += 1
            if time.monotonic() - self._flushed_s > FLUSH_S:
                self._file.flush()
                self._flushed_s = time.monotonic()
        except OSError as error:
            raise self._unwritable(error) from None

    def finish(self) -> None:
        """Whole, on the disk, in its place."""
        try:
            if self._file is None:
                self._file = self.part.open("wb")
                self._writer = writer(self._file, self.path.suffix, self._interface)
            self._close()
            os.replace(self.part, self.path)
        except OSError as error:
            raise self._unwritable(error) from None

    def leave(self) -> None:
        """What there is stays under its other name."""
        try:
            self._close()
        except OSError:
            pass

    def _close(self) -> None:
        if self._file is None or self._file.closed:
            return
        if self._writer is not None:
            self._writer.finish()
        self._file.flush()
        os.fsync(self._file.fileno())
        self._file.close()

    def _unwritable(self, error: OSError) -> UsageError:
        return UsageError(
            "the log cannot be written",
            where=str(self.part),
            why=error.strerror or str(error),
            next_step="check the folder's permissions and free space",
        )
