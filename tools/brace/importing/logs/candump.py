"""Logs of CAN frames, read by python-can: of candump -l and -L, and of other programs (can_formats)."""

from __future__ import annotations

import datetime
import io
import re
from collections.abc import Sequence
from pathlib import Path

from brace.ground.errors import BadFileError
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.importing.logs import can_formats, our_frames
from brace.importing.logs.collect import Collector
from brace.importing.logs.dbc import Databases, Frame, decode
from brace.importing.logs.wanted import Wanted
from brace.importing.signal import Log

_LINE = re.compile(rb"\((?:\d+\.\d+|\d{4}-\d\d-\d\d[ T][\d:.]+)\)\s+\S+\s+[0-9A-Fa-f]{3,8}#")
_SCREEN = re.compile(rb"\s*(?:\([^)]*\)\s+)?\w+\s+(?:(?:RX|TX)\s+\S+\s+\S+\s+)?[0-9A-Fa-f]{3,8}\s+\[ *\d+\]")
_REMARK = re.compile(rb"(?m)^[ \t]*#[^\r\n]*")
# An identifier whose bit 29 is set: the kernel's report of an error on the bus. python-can drops the bit of most.
_ERROR = re.compile(rb"(?m)^\([^)]*\)[ \t]+\S+[ \t]+[2367ABEFabef][0-9A-Fa-f]{7}#[^\r\n]*")
_RAW_LENGTH = re.compile(rb"(?m)_[0-9A-Fa-f](?=[ \t]*(?:[RT][ \t]*)?\r?$)")  # of candump -8, behind eight bytes
_DATE = re.compile(rb"(?m)^\((\d{4}-\d\d-\d\d)[ T](\d\d:\d\d:\d\d)(\.\d+)\)")
_HEAD_BYTES = 4096


def is_candump(path: Path) -> bool:
    """By the file's first lines: -l, -L, what candump shows on a screen, or another program's log of frames."""
    try:
        with path.open("rb") as file:
            lines = file.read(_HEAD_BYTES).splitlines()
    except OSError:
        return False
    first = _first(lines)
    return bool(_LINE.match(first) or _SCREEN.match(first)) or bool(can_formats.kind_of(path))


def _first(lines: Sequence[bytes]) -> bytes:
    """The first line that is neither empty nor a remark."""
    return next((line for line in lines if line.strip() and not line.lstrip().startswith(b"#")), b"")


def _without_remarks(data: bytes) -> tuple[bytes, int]:
    """The log with empty lines for remarks, and how many there were."""
    return _REMARK.subn(b"", data)


def read(path: Path, databases: Sequence[Path], wanted: Wanted) -> Log:
    """The signals of a log. Our own controllers' frames need no database."""
    data = read_bytes(path, DATA_LIMIT_BYTES, "log")
    told: list[str] = []
    if kind := can_formats.kind_of(path):
        frames, program = can_formats.read(path, kind), f"{kind} log"
    else:
        (frames, told), program = _of_candump(path, data), "candump log"
    can_formats.refuse_distances(path, [frame.timestamp for frame in frames])
    known = Databases(databases)
    nodes = sorted({n for f in frames if (n := our_frames.node_of(f.arbitration_id, bytes(f.data))) is not None})
    if nodes:
        known.with_ours(nodes)
    if not known:
        raise BadFileError(
            "a log of CAN frames, and no database that decodes them",
            where=str(path),
            why="what the bytes of a frame mean stands in the bus' DBC file",
            next_step="--dbc FILE.dbc (once for each database)",
        )
    collector = Collector(path, wanted)
    notes = decode(path, frames, known, collector) + collector.notes() + [
        f"decoded by {name}, sha256 {digest}" for name, digest in known.sums.items()
    ]
    notes += told + wanted.notes()
    ours = f"our controllers {', '.join(map(str, nodes))}" if nodes else ""
    by = " and ".join(text for text in (known.how, ours) if text)
    return Log(collector.signals(), f"{program}, decoded by {by}", tuple(notes))


def _of_candump(path: Path, data: bytes) -> tuple[list[Frame], list[str]]:
    """The frames of a log of candump, and what of it is not among them."""
    first = _first(data[:_HEAD_BYTES].splitlines())
    if _SCREEN.match(first) and not _LINE.match(first):
        raise BadFileError(
            "this is what candump shows on a screen",
            where=str(path),
            why="it shows times as candump was asked to (-t a, d, z, A), or none, in no form that programs read",
            next_step="record anew with candump -l can0 (or -L), and give the .log file",
        )
    data, remarks = _without_remarks(data)
    data, errors = _ERROR.subn(b"", data)
    if _DATE.match(first):
        data = _DATE.sub(_seconds, data)
    frames, cut_off = _frames(path, _RAW_LENGTH.sub(b"", data))
    told = []
    if remarks:
        told.append(f"{remarks} line{'s' if remarks > 1 else ''} with # in front left out")
    if errors:
        told.append(f"{errors} error frame{'s' if errors > 1 else ''} (reports of the bus, no data) left out")
    if cut_off:
        told.append("the log's last line is cut off: left out")
    return frames, told


def _seconds(found: re.Match[bytes]) -> bytes:
    """A date of candump -tA as seconds since 1970, read as UTC: only differences count."""
    moment = datetime.datetime.fromisoformat(f"{found[1].decode()} {found[2].decode()}+00:00")
    return b"(%d%b)" % (int(moment.timestamp()), found[3])


class _Counted(io.StringIO):
    """Lines, and how many have been read."""

    number = 0

    def __next__(self) -> str:  # type: ignore[override]  # typeshed says bytes of every file
        self.number += 1
        return super().__next__()


def _frames(path: Path, data: bytes) -> tuple[list[Frame], bool]:
    """All frames, and whether the last line was cut off."""
    from can.io.canutils import CanutilsLogReader

    lines = _Counted(data.decode("latin-1"))
    found: list[Frame] = []
    last = data.count(b"\n") + 1
    try:
        for frame in CanutilsLogReader(lines):
            found.append(frame)
    except (ValueError, IndexError) as error:
        if found and lines.number == last and not data.endswith(b"\n"):
            return found, True
        raise BadFileError(
            "not a line of a candump log",
            where=f"{path}:{lines.number}",
            why=f"the form is (SECONDS) can0 181#0102030405060708 ({error})",
            next_step="delete the line, or record anew with candump -l",
        ) from None
    return found, False
