"""Firmware images that the tests of `brace flash` and `brace doctor` make."""

from __future__ import annotations

import hashlib
import struct
from pathlib import Path

START = 0x08000000


def info_block(board: str, source: str = "0123456789ab") -> bytes:
    return struct.pack(
        "<8sI24s16s32s16s", b"BRACEIMG", 1, board.encode(), b"0.1.0", source.encode(), b"Release"
    )


def content(
    board: str = "stm32f405", stack: int = 0x20002000, reset: int = START + 0x101, size: int = 1000
) -> bytes:
    vectors = struct.pack("<2I", stack, reset) + bytes(56)
    return (vectors + info_block(board)).ljust(size, b"\x5a")


def elf(data: bytes, start: int = START) -> bytes:
    header = b"\x7fELF\x01\x01\x01".ljust(16, b"\0")
    header += struct.pack("<HHIIIIIHHHHHH", 2, 40, 1, start | 1, 52, 0, 0, 52, 32, 1, 40, 0, 0)
    return header + struct.pack("<8I", 1, 84, start, start, len(data), len(data), 5, 4) + data


def list_them(folder: Path) -> None:
    sums = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}"
        for path in sorted(folder.glob("image.*"))
    ]
    (folder / "SHA256SUMS").write_text("\n".join(sums) + "\n")
