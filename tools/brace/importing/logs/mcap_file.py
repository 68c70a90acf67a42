"""MCAP logs: topics of JSON and of ROS 2, and the CAN frames of our own recordings."""

from __future__ import annotations

import json
import struct
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from brace.ground.errors import BadFileError, BraceError, MissingLibraryError
from brace.importing.logs import mcap_records, our_frames
from brace.importing.logs.collect import Collector
from brace.importing.logs.dbc import Databases, decode
from brace.importing.logs.fields import LIST_MOST, numbers
from brace.importing.logs.ros_units import unit_of_field
from brace.importing.logs.wanted import Wanted
from brace.importing.signal import Log, Signal
from brace.importing.stamps import stamp_s

if TYPE_CHECKING:
    from mcap.records import Channel, Message, Schema

MAGIC = b"\x89MCAP0"
OUR_FRAMES = "can_frame"  # the schema of brace record's frames
OUR_STIFFNESS = "stiffness"

# What decoders raise of a message that is none.
_UNREADABLE = (EOFError, struct.error, ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError)

Decoder = Callable[[bytes], object]


def is_mcap(path: Path) -> bool:
    """By its first bytes."""
    try:
        with path.open("rb") as file:
            return file.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


class _Frame:
    """A frame of our own recording, as python-can would give it."""

    is_extended_id = is_error_frame = is_remote_frame = False

    def __init__(self, time_s: float, entry: dict[str, object]) -> None:
        self.timestamp = time_s
        self.arbitration_id = int(str(entry["id"]))
        self.data = bytes.fromhex(str(entry["data"]))
        self.channel: object = entry.get("bus", "")


def read(path: Path, databases: Sequence[Path], wanted: Wanted) -> Log:
    """The signals of a log. Refuses one of which no topic can be read."""
    return _Reading(path, databases, wanted).log()


class _Reading:
    def __init__(self, path: Path, databases: Sequence[Path], wanted: Wanted) -> None:
        self._path, self._wanted = path, wanted
        self._databases = Databases(databases)
        self._collector = Collector(path, wanted)
        self._decoders: dict[int, Decoder | None] = {}
        self._unread: dict[str, str] = {}  # topic: why
        self._no_numbers: dict[str, bool] = {}
        self._frames: list[_Frame] = []
        self._broken: Counter[str] = Counter()
        self._too_long: set[str] = set()

    def log(self) -> Log:
        notes = self._messages()
        by = ""
        signals: tuple[Signal, ...] = ()
        if self._frames:
            nodes = sorted(
                {n for f in self._frames if (n := our_frames.node_of(f.arbitration_id, f.data)) is not None}
            )
            if nodes:
                self._databases.with_ours(nodes)
            of_frames = Collector(self._path, self._wanted)  # the frames' clock runs beside that of the topics
            notes += decode(self._path, self._frames, self._databases, of_frames) + of_frames.notes()
            by = ", CAN frames decoded by " + " and ".join(
                text for text in (self._databases.how, "our own database" if nodes else "") if text
            )
            notes += [f"decoded by {name}, sha256 {digest}" for name, digest in self._databases.sums.items()]
            signals = of_frames.signals()
        of_topics = self._collector.signals()
        signals += of_topics
        notes += self._wanted.notes()
        for topic, why in self._unread.items():
            notes.append(f"topic {topic} is left out: {why}")
        broken = [
            f"topic {topic}: {count} message{'s' if count > 1 else ''} cannot be read: left out"
            for topic, count in self._broken.items()
        ]
        notes += broken
        for field in sorted(self._too_long):
            notes.append(f"{field} is left out: a list of more than {LIST_MOST} entries without names")
        for topic in sorted(topic for topic, none in self._no_numbers.items() if none):
            notes.append(f"topic {topic} is left out: it has no numbers")
        if not signals:
            why = "; ".join([*(f"{topic}: {why}" for topic, why in self._unread.items()), *broken])
            raise BadFileError(
                "no topic of this log can be read",
                where=str(self._path),
                why=why or "it has no messages with numbers",
                next_step="record the topics as JSON or in ROS 2's own encoding (rosbag2 with mcap), or export a CSV",
            )
        choice = self._collector.choice()
        frames = signals[: len(signals) - len(of_topics)]
        clocks = ("log", "stamp") if choice.doubt([*choice.by_stamp, *choice.partly, ""]) else ()
        return Log(
            signals, f"MCAP log{by}", tuple(notes + self._collector.notes()), choice,
            {clock: frames + self._collector.signals(clock) for clock in clocks},
        )  # fmt: skip

    def _messages(self) -> list[str]:
        from mcap.exceptions import RecordLengthLimitExceeded

        count = 0
        try:
            with self._path.open("rb") as file:
                try:
                    for schema, channel, message in mcap_records.messages(self._path, file):
                        try:
                            self._one(schema, channel, message)
                        except _UNREADABLE:
                            self._broken[channel.topic] += 1
                        count += 1
                except RecordLengthLimitExceeded as error:
                    raise mcap_records.too_large(self._path, str(error)) from None
                except BraceError:
                    raise
                except Exception as error:  # the libraries that unpack chunks have classes of their own
                    if count and not file.read(1):
                        return [f"the log ends in the middle of an entry (it was not closed) after {count} messages"]
                    raise BadFileError(
                        f"a broken MCAP log: {count} messages, then nothing that can be read",
                        where=str(self._path),
                        why=f"{type(error).__name__}: {error}"[:200],
                        next_step="mcap recover, of the mcap tools, saves what there is",
                    ) from None
        except OSError as error:
            raise BadFileError(
                "the log cannot be read",
                where=str(self._path),
                why=error.strerror or str(error),
                next_step="check its permissions",
            ) from None
        return []

    def _one(self, schema: Schema | None, channel: Channel, message: Message) -> None:
        time_s = message.log_time * 1e-9
        name = schema.name if schema is not None else ""
        if name == OUR_STIFFNESS and channel.topic.startswith("/limb_"):
            return  # put together from the frames, which are read themselves
        entry = self._decoded(channel, schema, message.data)
        if entry is None:
            return
        if name == OUR_FRAMES and isinstance(entry, dict):
            self._frames.append(_Frame(time_s, entry))
            return
        self._collector.clock(time_s)
        stamp = stamp_s(entry)
        self._collector.stamped(channel.topic, time_s, stamp)
        found = False
        too_long: set[str] = set()
        for field, value in list(numbers(entry, too_long=too_long)):
            found = True
            full = f"{channel.topic}.{field}" if field else channel.topic
            self._collector.add(channel.topic, full, unit_of_field(name, field), time_s, value, stamp)
        self._too_long |= {f"{channel.topic}.{field}" if field else channel.topic for field in too_long}
        self._no_numbers[channel.topic] = self._no_numbers.get(channel.topic, True) and not found

    def _decoded(self, channel: Channel, schema: Schema | None, data: bytes) -> object | None:
        if channel.id not in self._decoders:
            decoder, why = _decoder(channel.message_encoding, schema)
            self._decoders[channel.id] = decoder
            if decoder is None:
                self._unread[channel.topic] = why
        found = self._decoders[channel.id]
        return None if found is None else found(data)


def _decoder(encoding: str, schema: Schema | None) -> tuple[Decoder | None, str]:
    """What decodes a topic, or why nothing does."""
    if encoding == "json":
        return json.loads, ""
    if encoding != "cdr":
        return None, f"its encoding is {encoding or 'not said'}; JSON and ROS 2 (cdr) are read"
    try:
        from mcap_ros2.decoder import DecoderFactory
    except ImportError:
        raise MissingLibraryError(
            "this log has messages of ROS 2, and mcap-ros2-support is not installed",
            why="it reads them",
            next_step="pip install mcap-ros2-support",
        ) from None
    found: Decoder | None = DecoderFactory().decoder_for(encoding, schema)
    kind = getattr(schema, "encoding", "none")
    return found, "" if found else f"its type is described as {kind}; ros2msg is read"
