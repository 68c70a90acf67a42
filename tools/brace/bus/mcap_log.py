"""MCAP logs: every frame as it was (topic /can), and each whole K with units (topic /limb_N/stiffness) for viewers."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, BinaryIO

from brace.bus.frame import Frame
from brace.bus.snapshot import Joiner
from brace.ground.errors import BadFileError, MissingLibraryError

TOPIC = "/can"
_FRAME_SCHEMA = {
    "type": "object",
    "properties": {
        "bus": {"type": "string"},
        "id": {"type": "integer"},
        "data": {"type": "string", "description": "bytes in hexadecimal"},
        "time_s": {"type": "number", "description": "since 1970"},
    },
}


def _library() -> ModuleType:
    try:
        import mcap
    except ImportError as error:
        raise MissingLibraryError(
            "the mcap package is not installed",
            why=str(error),
            next_step="pip install mcap, or --out FILE.log",
        ) from None
    return mcap


class McapWriter:
    """Frames and snapshots to a file that is being written."""

    def __init__(self, file: BinaryIO, interface: str) -> None:
        _library()
        from mcap.writer import CompressionType, Writer

        self._interface = interface
        self._joiner = Joiner()
        self._channels: dict[int, int] = {}
        # without chunks, what has been written can be read after any end
        self._writer: Any = Writer(file, compression=CompressionType.NONE, use_chunking=False)
        self._writer.start(profile="", library="brace")
        schema = self._writer.register_schema("can_frame", "jsonschema", json.dumps(_FRAME_SCHEMA).encode())
        self._frames = self._writer.register_channel(TOPIC, "json", schema)
        self._sequence = 0

    def add(self, frame: Frame) -> None:
        """One more."""
        entry = {
            "bus": self._interface,
            "id": frame.identifier,
            "data": frame.data.hex(),
            "time_s": frame.time_s,
        }
        self._message(self._frames, frame.time_s, entry)
        snapshot = self._joiner.add(frame)
        if snapshot is not None:
            self._message(self._channel_of(snapshot.node), frame.time_s, snapshot.as_json())

    def finish(self) -> None:
        """Index and footer."""
        self._writer.finish()

    def _channel_of(self, node: int) -> int:
        if node not in self._channels:
            schema = self._writer.register_schema(
                "stiffness", "jsonschema", json.dumps({"type": "object"}).encode()
            )
            self._channels[node] = self._writer.register_channel(f"/limb_{node}/stiffness", "json", schema)
        return self._channels[node]

    def _message(self, channel: int, time_s: float, entry: object) -> None:
        stamp = round(time_s * 1e9)
        self._sequence += 1
        self._writer.add_message(
            channel,
            log_time=stamp,
            publish_time=stamp,
            sequence=self._sequence,
            data=json.dumps(entry).encode(),
        )


def read(path: Path) -> Iterator[Frame]:
    """The frames of a log, in the order they were written; one that was cut off ends where it ends."""
    _library()
    from mcap.exceptions import EndOfFile, McapError
    from mcap.reader import NonSeekingReader

    count = 0
    with path.open("rb") as file:
        try:
            for _schema, channel, message in NonSeekingReader(file).iter_messages(
                topics=[TOPIC], log_time_order=False
            ):
                if channel.topic == TOPIC:
                    entry = json.loads(message.data)
                    yield Frame(float(entry["time_s"]), int(entry["id"]), bytes.fromhex(entry["data"]))
                    count += 1
        except EndOfFile:
            return
        except (McapError, struct.error, ValueError, KeyError, TypeError) as error:
            if count and not file.read(1):
                return  # cut off within an entry
            if count == 0:
                raise BadFileError(
                    "not a log of brace",
                    where=str(path),
                    why=f"{type(error).__name__}: {error}",
                    next_step="brace record --out FILE.mcap writes one",
                ) from None
            raise BadFileError(
                f"a broken log: {count} frames, then nothing that can be read",
                where=str(path),
                why=f"{type(error).__name__}: {error}",
                next_step="mcap recover, of the mcap tools, saves what there is",
            ) from None
