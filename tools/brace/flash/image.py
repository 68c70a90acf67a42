"""Reading an image (.elf, .hex, .bin) and what it says of itself; refusing what is not whole."""

from __future__ import annotations

import hashlib
import struct
from dataclasses import dataclass
from pathlib import Path

from brace.ground.errors import BadFileError
from brace.ground.files import read_bytes

IMAGE_LIMIT_BYTES = 16 << 20
_MAGIC = b"BRACEIMG"
_INFO = struct.Struct("<8sI24s16s32s16s")  # firmware/boards/common/image_info.h
_INFO_FORMAT = 1
_ELF_LOAD = 1


@dataclass(frozen=True)
class ImageInfo:
    """What an image says of itself."""

    board: str
    version: str
    hash: str
    build: str


@dataclass(frozen=True)
class Image:
    """`segments` are (address, bytes) in rising order; a .bin, which has no address, begins at 0."""

    path: Path
    kind: str
    segments: tuple[tuple[int, bytes], ...]
    info: ImageInfo | None
    sha256: str

    @property
    def start(self) -> int:
        """Lowest address."""
        return self.segments[0][0]

    @property
    def end(self) -> int:
        """One behind the highest address."""
        address, content = self.segments[-1]
        return address + len(content)

    def flat(self) -> bytes:
        """One piece from start to end; gaps are zeros, as in a .bin."""
        flat = bytearray(self.end - self.start)
        for address, content in self.segments:
            flat[address - self.start : address - self.start + len(content)] = content
        return bytes(flat)


def read_image(path: Path) -> Image:
    """The image in a file."""
    data = read_bytes(path, IMAGE_LIMIT_BYTES, "firmware image")
    readers = {".elf": _elf_segments, ".hex": _hex_segments, ".bin": _bin_segments}
    kind = path.suffix.lower()
    if kind not in readers:
        raise BadFileError(
            f"{kind or 'no ending'!r} is no kind of image",
            where=str(path),
            why="an image is an .elf, a .hex or a .bin",
            next_step="build/m4f/images has them after ./dev setup",
        )
    segments = tuple(sorted(readers[kind](path, data)))
    for (address, content), (following, _) in zip(segments, segments[1:], strict=False):
        if address + len(content) > following:
            raise _broken(path, f"two pieces overlap at {following:#x}")
    if not segments:
        raise _broken(path, "there is nothing in it")
    return Image(path, kind[1:], segments, _info(segments), hashlib.sha256(data).hexdigest())


def _broken(path: Path, why: str) -> BadFileError:
    return BadFileError(
        "the image is not whole",
        where=str(path),
        why=why,
        next_step="build it anew with ./dev setup, or copy it again",
    )


def _bin_segments(_path: Path, data: bytes) -> list[tuple[int, bytes]]:
    return [(0, data)] if data else []


def _elf_segments(path: Path, data: bytes) -> list[tuple[int, bytes]]:
    if data[:6] != b"\x7fELF\x01\x01":
        raise _broken(path, "it does not begin as a 32-bit little-endian ELF file does")
    segments = []
    try:
        offset, (size, count) = struct.unpack_from("<I", data, 28)[0], struct.unpack_from("<HH", data, 42)
        for index in range(count):
            kind, begin, _virtual, load, length = struct.unpack_from("<5I", data, offset + index * size)
            if kind != _ELF_LOAD or not length:
                continue
            if begin + length > len(data):
                raise _broken(path, "it ends before its last piece does")
            segments.append((load, data[begin : begin + length]))
    except struct.error:
        raise _broken(path, "it ends within its own table of contents") from None
    return segments


def _hex_segments(path: Path, data: bytes) -> list[tuple[int, bytes]]:
    pieces: list[tuple[int, bytearray]] = []
    base, ended = 0, False
    for number, line in enumerate(data.decode("ascii", "replace").splitlines(), start=1):
        if ended or not line.strip():
            continue
        try:
            record = bytes.fromhex(line.strip()[1:]) if line.startswith(":") else b""
        except ValueError:
            record = b""
        if len(record) < 5 or len(record) != record[0] + 5 or sum(record) % 256:
            raise _broken(Path(f"{path}:{number}"), "the line is cut, or its check sum is wrong")
        kind, content = record[3], record[4:-1]
        address = base + int.from_bytes(record[1:3], "big")
        if kind == 0:
            if pieces and pieces[-1][0] + len(pieces[-1][1]) == address:
                pieces[-1][1].extend(content)
            else:
                pieces.append((address, bytearray(content)))
        elif kind in (2, 4):
            base = int.from_bytes(content, "big") << (4 if kind == 2 else 16)
        ended = kind == 1
    if not ended:
        raise _broken(path, "it has no last line: it is cut")
    return [(address, bytes(content)) for address, content in pieces]


def _info(segments: tuple[tuple[int, bytes], ...]) -> ImageInfo | None:
    for _address, content in segments:
        at = content.find(_MAGIC)
        while at >= 0:
            if at % 4 == 0 and at + _INFO.size <= len(content):
                _magic, form, *fields = _INFO.unpack_from(content, at)
                if form == _INFO_FORMAT:
                    return ImageInfo(*(field.split(b"\0")[0].decode("ascii", "replace") for field in fields))
            at = content.find(_MAGIC, at + 1)
    return None
