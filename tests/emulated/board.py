"""A controller image running on an emulated board, with a person at its console."""

from __future__ import annotations

import os
import queue
import re
import shutil
import subprocess
import threading
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
IMAGES = Path(os.environ.get("BRACE_IMAGES", PROJECT / "build" / "m4f" / "images"))
BOARDS = ("mps2-an386", "netduinoplus2")
COUNTED = ("-icount", "shift=0")  # the board's clock counts its instructions, 1 ns each, and stands while it is paused
DIGITS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
PATIENCE_S = 60.0  # a loaded machine; nothing here takes more than a second on an idle one


def image(name: str) -> Path:
    """An image's .elf."""
    path = IMAGES / f"{name}.elf"
    assert path.is_file(), f"{path} is not built: ./dev setup builds it"
    return path


class Board:
    """Starts the emulator; ends it, and only it, on leaving."""

    def __init__(self, machine: str, elf: Path, *options: str) -> None:
        program = shutil.which("qemu-system-arm")
        assert program, "qemu-system-arm is missing (Debian package qemu-system-arm)"
        self._lines: queue.Queue[str] = queue.Queue()
        self._process = subprocess.Popen(
            [program, "-machine", machine, "-display", "none", "-monitor", "none", "-serial", "stdio",
             "-kernel", str(elf), *options],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, bufsize=0)  # fmt: skip
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self) -> Board:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait(10)
        self._reader.join(10)

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in iter(self._process.stdout.readline, b""):
            self._lines.put(line.decode(errors="replace").rstrip("\r\n").removeprefix("# "))

    def ask(self, word: str) -> None:
        """Types a word, and Enter."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{word}\r".encode())

    def do(self, word: str) -> None:
        """Types a word that changes something, and the digits that the console then spells."""
        self.ask(word)
        self.ask(digits_of(self.until(r"^sure\? ")[-1]))

    def until(self, pattern: str, patience_s: float = PATIENCE_S) -> list[str]:
        """The lines up to the first that matches, which is the last."""
        lines: list[str] = []
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            try:
                lines.append(self._lines.get(timeout=0.2))
            except queue.Empty:
                assert self._process.poll() is None, "\n".join(["the emulator ended", *lines])
                continue
            if re.search(pattern, lines[-1]):
                return lines
        raise AssertionError(
            "\n".join([f"no line like {pattern!r} within {patience_s:g} s; there were:", *lines])
        )

    def processor_s(self) -> float:
        """What the emulator has taken of the host's processors."""
        fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def banner(self) -> dict[str, str]:
        """The next banner, whole: its keys and values; 'brace' is the first line."""
        lines = self.until(r"^stack: ")
        start = max(index for index, line in enumerate(lines) if line.startswith("brace "))
        return {"brace": lines[start], **dict(line.split(": ", 1) for line in lines[start + 1 :])}


def digits_of(question: str) -> str:
    """The digits that the console's question spells."""
    return "".join(str(DIGITS.index(word)) for word in question.rpartition(": ")[2].split())


def registers(banner: dict[str, str]) -> dict[str, int]:
    """The crash record's registers."""
    words = banner["crash-registers"].split()
    return {name: int(value, 16) for name, value in zip(words[::2], words[1::2], strict=True)}


def function_at(elf: Path, address: int) -> str:
    """The name of the function that an address lies in."""
    listing = subprocess.run(
        ["arm-none-eabi-nm", "-S", elf], capture_output=True, text=True, check=True
    ).stdout
    for line in listing.splitlines():
        fields = line.split()
        if len(fields) == 4 and fields[2] in "tT":
            start = int(fields[0], 16) & ~1
            if start <= address < start + int(fields[1], 16):
                return fields[3]
    return f"nowhere ({address:#x})"


def address_of(elf: Path, symbol: str) -> int:
    """Where a symbol lies."""
    listing = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    found = [line.split()[0] for line in listing.splitlines() if line.split()[-1] == symbol]
    assert len(found) == 1, symbol
    return int(found[0], 16)
