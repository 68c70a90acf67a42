"""CAN frames to signals, by databases (DBC) that cantools reads."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from brace.ground.errors import BadFileError, MissingLibraryError, UsageError
from brace.importing.logs import our_frames
from brace.importing.logs.collect import Collector

if TYPE_CHECKING:
    from cantools.database.can import Message

NAMED = 6  # of a list of messages, before '... and N more'


class Frame(Protocol):
    """What python-can calls a message."""

    @property
    def timestamp(self) -> float: ...
    @property
    def arbitration_id(self) -> int: ...
    @property
    def is_extended_id(self) -> bool: ...
    @property
    def is_error_frame(self) -> bool: ...
    @property
    def is_remote_frame(self) -> bool: ...
    @property
    def data(self) -> bytes | bytearray: ...
    @property
    def channel(self) -> object: ...


@dataclass(frozen=True)
class _Entry:
    message: Message
    name: str
    only: frozenset[str] | None = None  # the signals that are measurements; None: all


class Databases:
    """Several DBC files as one. Two that know one identifier are refused."""

    def __init__(self, paths: Sequence[Path]) -> None:
        self.how = ", ".join(path.name for path in paths)
        self.sums = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in paths if path.is_file()}
        self._of: dict[tuple[int, bool], _Entry] = {}
        self._ours: set[tuple[int, bool]] = set()
        for path in paths:
            for message in _loaded(path):
                key = (message.frame_id, message.is_extended_frame)
                if key in self._of:
                    raise UsageError(
                        f"two databases have the identifier 0x{message.frame_id:X}",
                        where=str(path),
                        why=f"it would be {self._of[key].name} and {message.name}",
                        next_step="import with one database for each bus, or take the message out of one of them",
                    )
                taken = {entry.name for entry in self._of.values()}
                self._of[key] = _Entry(
                    message, message.name if message.name not in taken else f"{path.stem}.{message.name}"
                )

    def with_ours(self, nodes: Sequence[int]) -> None:
        """Frames of our controllers too, where no file names their identifiers."""
        for message in _parsed(our_frames.database(nodes), "brace.dbc"):
            key = (message.frame_id, message.is_extended_frame)
            if key not in self._of:
                self._ours.add(key)
                only = our_frames.MEASURED.get(message.name.rstrip("0123456789").rstrip("_"), frozenset())
                self._of[key] = _Entry(message, message.name, only)

    def find(self, frame: Frame) -> _Entry | None:
        return self._of.get((frame.arbitration_id, frame.is_extended_id))

    def missing(self, seen: set[tuple[int, bool]]) -> list[str]:
        """Messages of the files that never came."""
        return [entry.name for key, entry in self._of.items() if key not in seen and key not in self._ours]

    def __bool__(self) -> bool:
        return bool(self._of)


def decode(path: Path, frames: Iterable[Frame], databases: Databases, collector: Collector) -> list[str]:
    """Adds every decoded reading to the collector. Returns what of the log is not in it."""
    reader = _Reader(path, databases, collector)
    for frame in frames:
        reader.add(frame)
    return reader.notes()


class _Reader:
    def __init__(self, path: Path, databases: Databases, collector: Collector) -> None:
        self._path, self._databases, self._collector = path, databases, collector
        self._seen: set[tuple[int, bool]] = set()
        self._wanted: dict[tuple[int, bool], bool] = {}
        self._channels: dict[tuple[int, bool], object] = {}
        self._unknown: Counter[str] = Counter()
        self._broken: Counter[str] = Counter()
        self._beyond: Counter[str] = Counter()
        self._of_bus = 0
        self._computed = False

    def add(self, frame: Frame) -> None:
        self._collector.clock(frame.timestamp)
        if frame.is_error_frame or frame.is_remote_frame:
            self._of_bus += 1
            return
        entry = self._databases.find(frame)
        if entry is None:
            self._unknown[f"0x{frame.arbitration_id:X}"] += 1
            return
        key = (frame.arbitration_id, frame.is_extended_id)
        if self._channels.setdefault(key, frame.channel) != frame.channel:
            raise BadFileError(
                f"{entry.name} (0x{frame.arbitration_id:X}) comes from two buses: "
                f"{self._channels[key]} and {frame.channel}",
                where=str(self._path),
                why="two senders of one identifier are two instruments",
                next_step=f"take one bus out of the log: grep ' {frame.channel} ' FILE > {frame.channel}.log",
            )
        self._seen.add(key)
        if entry.only is not None and not entry.only:
            self._computed = True
            return
        if not self._is_wanted(key, entry):
            return
        try:
            values = entry.message.decode(bytes(frame.data), decode_choices=False)
        except Exception as error:  # cantools raises classes of three packages for a frame that is too short
            self._broken[f"{entry.name} ({error})"] += 1
            return
        for name, value in values.items() if isinstance(values, dict) else ():
            if isinstance(value, (int, float)) and (entry.only is None or name in entry.only):
                self._one(entry, name, float(value), frame.timestamp)

    def _is_wanted(self, key: tuple[int, bool], entry: _Entry) -> bool:
        if key not in self._wanted:
            names = [f"{entry.name}.{s.name}" for s in entry.message.signals if not entry.only or s.name in entry.only]
            self._wanted[key] = self._collector.wanted.takes_any(entry.name, names)
        return self._wanted[key]

    def _one(self, entry: _Entry, name: str, value: float, time_s: float) -> None:
        signal = entry.message.get_signal_by_name(name)
        low, high = signal.minimum, signal.maximum
        full = f"{entry.name}.{name}"
        if low is not None and high is not None and low < high and not low <= value <= high:
            self._beyond[full] += 1
            value = math.nan
        self._collector.add(entry.name, full, signal.unit or "", time_s, value)

    def _listed_unknown(self) -> str:
        return _listed([f"{name} ({count})" for name, count in self._unknown.most_common()])

    def notes(self) -> list[str]:
        if not self._seen:
            raise BadFileError(
                f"no frame of this log is in {self._databases.how or 'any database'}",
                where=str(self._path),
                why=f"the log has {self._listed_unknown() or 'no frames'}; another node's, or another bus",
                next_step="give the database of these frames: --dbc FILE.dbc",
            )
        notes = []
        if self._unknown:
            notes.append(
                f"frames that no database has, another node's or another device's, left out: {self._listed_unknown()}"
            )
        if missing := self._databases.missing(self._seen):
            notes.append(f"messages of the database that never came: {_listed(missing)}")
        for text, count in self._broken.items():
            notes.append(f"{count} frames left out that do not fit their database: {text}")
        for name, count in self._beyond.items():
            notes.append(f"{name}: {count} readings beyond the range of the database are taken as not known")
        if self._of_bus:
            notes.append(f"{self._of_bus} error and remote frames left out")
        if self._computed:
            notes.append(our_frames.WHY_NOT)
        return notes


def _listed(texts: Sequence[str]) -> str:
    more = f" and {len(texts) - NAMED} more" if len(texts) > NAMED else ""
    return ", ".join(texts[:NAMED]) + more


def _loaded(path: Path) -> list[Message]:
    from brace.ground.files import DATA_LIMIT_BYTES, read_bytes

    data = read_bytes(path, DATA_LIMIT_BYTES, "CAN database")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:  # what most editors of databases write
        text = data.decode("cp1252", "replace")
    return _parsed(text, str(path))


def _parsed(text: str, where: str) -> list[Message]:
    try:
        import cantools
    except ImportError:
        raise MissingLibraryError(
            "cantools is not installed",
            where=where,
            why="it reads CAN databases (DBC)",
            next_step="pip install cantools",
        ) from None
    try:
        database = cantools.database.load_string(text, database_format="dbc", strict=False)
    except Exception as error:  # the parser's own classes, and KeyErrors of a damaged file
        raise BadFileError(
            "not a CAN database (DBC)",
            where=where,
            why=str(error).splitlines()[0][:160] if str(error) else type(error).__name__,
            next_step="export the database as .dbc",
        ) from None
    assert isinstance(database, cantools.database.can.Database)
    return database.messages
