"""The messages of an MCAP file, whose lengths may be anything: no record, and no chunk unpacked, beyond a bound."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, BinaryIO, cast

from brace.ground.errors import BadFileError

if TYPE_CHECKING:
    from mcap.records import Channel, Chunk, Message, Schema

RECORD_MOST_BYTES = 1 << 28


class _Bounded:
    """A file of which nothing is asked that it has not: a length of 2^62 bytes reserves none."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self._file, self._size = file, size

    def read(self, count: int = -1) -> bytes:
        left = self._size - self._file.tell()
        return self._file.read(left if count < 0 else min(count, left))


def messages(path: Path, file: BinaryIO) -> Iterator[tuple[Schema | None, Channel, Message]]:
    """Each with its channel and the channel's schema, in the order of the file."""
    from mcap.records import Channel, Chunk, Message, Schema
    from mcap.stream_reader import StreamReader, breakup_chunk

    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    bounded = cast(IO[bytes], _Bounded(file, path.stat().st_size))
    for record in StreamReader(bounded, emit_chunks=True, record_size_limit=RECORD_MOST_BYTES).records:
        for each in breakup_chunk(_unpacked(path, record)) if isinstance(record, Chunk) else [record]:
            if isinstance(each, Schema):
                schemas[each.id] = each
            elif isinstance(each, Channel):
                channels[each.id] = each
            elif isinstance(each, Message) and each.channel_id in channels:
                channel = channels[each.channel_id]
                yield schemas.get(channel.schema_id), channel, each


def _unpacked(path: Path, chunk: Chunk) -> Chunk:
    """The chunk without its compression."""
    if chunk.uncompressed_size > RECORD_MOST_BYTES:
        raise too_large(path, f"a chunk of {chunk.uncompressed_size} bytes")
    if chunk.compression == "zstd":
        import zstandard

        data = zstandard.ZstdDecompressor().stream_reader(chunk.data).read(chunk.uncompressed_size + 1)
    elif chunk.compression == "lz4":
        import lz4.frame  # type: ignore[import-untyped]

        data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=chunk.uncompressed_size + 1)
    else:
        return chunk
    if len(data) != chunk.uncompressed_size:
        raise ValueError(f"a chunk unpacks to other than its {chunk.uncompressed_size} bytes")
    return replace(chunk, compression="", data=data)


def too_large(path: Path, what: str) -> BadFileError:
    """The refusal of a length that no log has."""
    return BadFileError(
        "a broken MCAP log: a length that no log has",
        where=str(path),
        why=f"{what}; at most {RECORD_MOST_BYTES} are read at once: the file is damaged, or not written by a recorder",
        next_step="mcap recover, of the mcap tools, saves what there is; or record with smaller chunks",
    )
