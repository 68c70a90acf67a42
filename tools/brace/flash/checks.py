"""Is this image whole, for this board, and the one that was built?"""

from __future__ import annotations

import re
import struct
from pathlib import Path

from brace.flash.boards import BOARDS, Board
from brace.flash.image import Image
from brace.ground.errors import BadFileError, UsageError, did_you_mean
from brace.ground.files import read_text

SUMS_NAME = "SHA256SUMS"
_SUMS_LIMIT_BYTES = 1 << 20
_SUM_LINE = re.compile(r"([0-9a-f]{64}) [ *](.+)")


def board_of(image: Image, wanted: str | None) -> Board:
    """The board that the image says it is for; refused when it is not the one wanted, or says nothing."""
    if image.info is None:
        raise BadFileError(
            "no Brace image",
            where=str(image.path),
            why="it does not say which board it is for, as every image of ours does",
            next_step="name an image of build/m4f/images",
        )
    if wanted and wanted != image.info.board:
        raise BadFileError(
            f"an image for {image.info.board}, not for {wanted}",
            where=str(image.path),
            why="on another board it would not start, or drive the wrong pins",
            next_step=f"brace flash {wanted}",
        )
    return known_board(image.info.board)


def known_board(name: str) -> Board:
    """A board by its name."""
    if name in BOARDS:
        return BOARDS[name]
    near = did_you_mean(name, BOARDS)
    raise UsageError(
        f"{name!r} is no board and no image file",
        where="flash",
        why=f"boards: {', '.join(BOARDS)}; an image is a file ending in .elf, .hex or .bin",
        next_step=f"did you mean {near}?" if near else "brace flash --help",
    )


def check_fits(image: Image, board: Board) -> int:
    """The address the image begins at; refused when it would reach too far, or could not start."""
    start = board.flash_start if image.kind == "bin" else image.start
    end = start + image.end - image.start
    limit = board.flash_start + board.flash_bytes
    if start != board.flash_start or end > limit:
        raise BadFileError(
            f"it lies at {start:#010x} to {end:#010x}",
            where=str(image.path),
            why=f"images for {board.name} lie at {board.flash_start:#010x} to {limit:#010x}; parameters follow",
            next_step="build it anew with ./dev setup",
        )
    if image.end - image.start < 8:
        stack = reset = 0
    else:
        stack, reset = struct.unpack_from("<2I", image.flat())
    in_ram = board.ram_start < stack <= board.ram_start + board.ram_bytes
    if not in_ram or not reset & 1 or not board.flash_start <= reset < limit:
        raise BadFileError(
            "it could not start",
            where=str(image.path),
            why=f"its vector table names a stack at {stack:#010x} and a first instruction at {reset:#010x}",
            next_step="build it anew with ./dev setup",
        )
    return start


def check_listed(image: Image, unlisted: bool) -> None:
    """The image is the one that SHA256SUMS beside it lists."""
    if unlisted:
        return
    path = image.path.resolve().parent / SUMS_NAME
    if not path.is_file():
        raise BadFileError(
            f"no {SUMS_NAME} beside the image",
            where=str(image.path),
            why="without it nobody can say whether this is what was built",
            next_step="copy it along with the image, or say --unlisted",
        )
    listed = _sums(path)
    name = image.path.resolve().name
    if name not in listed:
        raise BadFileError(
            f"{name} is not listed",
            where=str(path),
            why="it is not of the set of images it lies among",
            next_step="name an image that is listed, or say --unlisted",
        )
    if listed[name] != image.sha256:
        raise BadFileError(
            f"{name} is not the file that was built",
            where=str(path),
            why=f"listed {listed[name][:16]}..., found {image.sha256[:16]}...",
            next_step="build it anew with ./dev setup, or copy it again",
        )


def _sums(path: Path) -> dict[str, str]:
    listed = {}
    for number, line in enumerate(
        read_text(path, _SUMS_LIMIT_BYTES, "list of checksums").splitlines(), start=1
    ):
        found = _SUM_LINE.fullmatch(line)
        if not found:
            raise BadFileError(
                "no line of sha256sum's",
                where=f"{path}:{number}",
                why="each is 64 hexadecimal digits, two blanks and a name",
                next_step="build the images anew with ./dev setup",
            )
        listed[found[2]] = found[1]
    return listed
