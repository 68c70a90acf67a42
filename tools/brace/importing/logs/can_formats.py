"""Files of CAN frames by other programs than candump (.asc, .blf, .trc), read by python-can; what no clock wrote."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError
from brace.importing.logs.dbc import Frame

_HEAD_BYTES = 4096
_ASC = re.compile(rb"(?mi)^\s*base\s+(?:hex|dec)\b[^\r\n]*")
_TRC = re.compile(rb"(?m)^;(?:\$FILEVERSION=|#{20,}|\s+Message\s+Number)")
_SECONDS = 1e7  # less is no date
_FALLING_RATIO, _RISING_RATIO = 0.2, 0.65  # of the steps of times that are distances
_FEW = 5


def kind_of(path: Path) -> str:
    """`.asc`, `.blf` or `.trc` by the file's first bytes; empty for any other file."""
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except OSError:
        return ""
    if head.startswith(b"LOGG"):
        return ".blf"
    if _ASC.search(head) and re.search(rb"(?mi)^\s*(?:date\s|begin\s+triggerblock|(?:no\s+)?internal\s+events)", head):
        return ".asc"
    return ".trc" if _TRC.search(head) else ""


def read(path: Path, kind: str) -> list[Frame]:
    """All frames of the file."""
    from can.io.asc import ASCReader
    from can.io.blf import BLFReader
    from can.io.trc import TRCReader

    if kind == ".asc":
        with path.open("rb") as file:
            header = _ASC.search(file.read(_HEAD_BYTES))
        if header is not None and b"relative" in header.group().lower():
            raise _no_clock(path, "its header says so (timestamps relative)", "record anew with timestamps absolute")
    readers = {".asc": ASCReader, ".blf": BLFReader, ".trc": TRCReader}
    try:
        return list(readers[kind](path))
    except Exception as error:  # the readers let through whatever their parsers raise
        raise BadFileError(
            f"this {kind} log cannot be read",
            where=str(path),
            why=f"python-can: {type(error).__name__}: {str(error)[:160]}",
            next_step="convert it with the program that wrote it, or with python -m can.logconvert FILE out.log",
        ) from None


def refuse_distances(path: Path, times_s: Sequence[float]) -> None:
    """Refuses times that are distances to the entry before (candump -td): they neither rise nor fall over the log."""
    if are_distances(np.asarray(times_s)):
        raise _no_clock(
            path,
            "over the whole log its times neither rise nor fall",
            "record anew with candump -l (or -L alone, without -td)",
        )


def are_distances(times: np.ndarray) -> bool:
    """Whether times are no readings of a clock: nearly all of one value, or up and down at random. The first may be 0.
    A clock with few steps repeats its value, and rises; one that begins anew in each run falls once a run."""
    rest = times[1:]
    if rest.size < _FEW or float(np.abs(rest).max()) > _SECONDS:
        return False
    most = float(np.unique(rest, return_counts=True)[1].max()) / rest.size
    steps = np.diff(rest)
    rises, falls = float(np.mean(steps > 0)), float(np.mean(steps < 0))
    is_flat = most > 0.5 and not (falls == 0.0 and rises > 0.0)
    return is_flat or (falls > _FALLING_RATIO and rises < _RISING_RATIO)


def _no_clock(path: Path, why: str, way: str) -> BadFileError:
    return BadFileError(
        "the times of this log are distances from frame to frame",
        where=str(path),
        why=f"{why}; when a reading was taken does not stand in it",
        next_step=way,
    )
