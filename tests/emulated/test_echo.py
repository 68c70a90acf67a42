"""The controller images at serial lines that echo, BRACE_ECHO_S seconds long (default 2): no restart, no self-test, no
byte of memory changes, and the board says once that it hears itself.

    BRACE_ECHO_S=60 .venv/bin/python -m pytest -q tests/emulated/test_echo.py
"""

from __future__ import annotations

import os
import random
import select
import socket
import subprocess
import termios
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from board import PATIENCE_S, address_of, digits_of, image

ECHO_S = float(os.environ.get("BRACE_ECHO_S", "2"))
IMAGES = {  # image: the machine that runs it
    "brace-mps2-an386": "mps2-an386",
    "brace-netduinoplus2": "netduinoplus2",
    "brace-netduinoplus2-servos": "netduinoplus2",
    "brace-stm32f405": "netduinoplus2",
}
NVM_BYTES = 16 + 2 * 4096  # of the emulated boards' memory, in RAM: a marker and two slots
WORDS = (
    "help", "?", "k", "banner", "forget", "restart", "test", "test slot", "test drives", "key", "bench", "T", "r", "B",
)  # fmt: skip


class Line:
    """A board whose console's bytes come and go here; its other serial ports lead nowhere."""

    def __init__(self, name: str, folder: Path) -> None:
        self.said = b""
        self._elf, self._folder, self._in_flash = image(name), folder, name == "brace-stm32f405"
        listener, monitor = socket.socket(), folder / "monitor"
        listener.bind(("127.0.0.1", 0))
        listener.listen(1)
        command = [
            "qemu-system-arm", "-machine", IMAGES[name], "-display", "none",
            "-monitor", f"unix:{monitor},server,nowait",
            "-serial", f"tcp:127.0.0.1:{listener.getsockname()[1]}",
            "-kernel", str(self._elf),
        ]  # fmt: skip
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
        listener.settimeout(PATIENCE_S)
        self._socket, _ = listener.accept()
        listener.close()

    def close(self) -> None:
        """Ends the emulator, and only it."""
        self._socket.close()
        self._process.kill()
        self._process.wait(10)

    def fileno(self) -> int:
        """For select."""
        return self._socket.fileno()

    def hear(self) -> bytes:
        """What the board has sent since the last time."""
        some = self._socket.recv(4096)
        assert some, "the emulator ended"
        self.said += some
        return some

    def send(self, some: bytes) -> None:
        """To the board."""
        self._socket.sendall(some)

    def says(self, words: bytes, patience_s: float) -> bool:
        """Has the board said that, or does it now?"""
        end = time.monotonic() + patience_s
        while words not in self.said and time.monotonic() < end:
            if select.select([self], [], [], 0.2)[0]:
                self.hear()
        return words in self.said

    def until(self, words: bytes) -> None:
        """Waits until the board has said that."""
        assert self.says(words, PATIENCE_S), self.said.decode(errors="replace")

    def memory(self) -> bytes | None:
        """The emulated board's non-volatile memory; None: the image keeps it in flash, which this machine lacks."""
        if self._in_flash:
            return None
        at = address_of(self._elf, "_kept_nvm")
        dump = self._folder / "dump"
        dump.unlink(missing_ok=True)
        with socket.socket(socket.AF_UNIX) as monitor:
            monitor.connect(str(self._folder / "monitor"))
            monitor.sendall(f'pmemsave {at:#x} {NVM_BYTES} "{dump}"\n'.encode())
            end = time.monotonic() + PATIENCE_S
            while not dump.is_file() or dump.stat().st_size < NVM_BYTES:
                assert time.monotonic() < end, "the emulator does not show its memory"
                time.sleep(0.05)
        return dump.read_bytes()


@contextmanager
def running(name: str, folder: Path) -> Iterator[Line]:
    """A board that has started; nothing is sent to it."""
    line = Line(name, folder)
    try:
        line.until(b"# stack: ")
        yield line
    finally:
        line.close()


@contextmanager
def default_terminal() -> Iterator[int]:
    """The wire's end of a terminal with Linux's default settings that `cat` reads, as in `cat /dev/ttyUSB0`."""
    wire, device = os.openpty()
    settings = termios.tcgetattr(device)
    assert settings[3] & termios.ECHO and settings[3] & termios.ECHOCTL and settings[0] & termios.ICRNL
    assert settings[1] & termios.ONLCR
    cat = subprocess.Popen(["cat"], stdin=device, stdout=subprocess.DEVNULL)
    os.set_blocking(wire, False)
    try:
        yield wire
    finally:
        cat.kill()
        cat.wait(10)
        os.close(device)
        os.close(wire)


def play(line: Line, seconds: float, answer: Callable[[bytes], bytes], types: Callable[[float], bytes]) -> None:
    """The far end answers what it hears, and types by itself."""
    begun = time.monotonic()
    while time.monotonic() - begun < seconds:
        if select.select([line], [], [], 0.01)[0]:
            line.send(answer(line.hear()))
        line.send(types(time.monotonic() - begun))


def check(line: Line, before: bytes | None) -> None:
    """Nothing has happened but words."""
    text = line.said.decode(errors="replace")
    assert text.count("# start: ") - text.count("# start: power") == 0, text  # no restart
    assert "selftest" not in text and "bench until" not in text and "kept" not in text.replace("is kept", ""), text
    assert line.memory() == before
    # it still works, when it has been quiet for 2 s of its own time, which a busy host makes longer
    line.said = b""
    for quiet_s in (2.5, 5.0, 10.0, 20.0):
        time.sleep(quiet_s)
        line.send(b"\rk\r")
        if line.says(b" tick ", 2.0):
            break
    assert b"# k: " in line.said, line.said.decode(errors="replace")


def nobody(_: float) -> bytes:
    return b""


@pytest.mark.parametrize("name", IMAGES)
def test_cat_on_a_terminal_as_linux_opens_it(name: str, tmp_path: Path) -> None:
    """The banner comes back. Then a person at another terminal types each word, and its answer comes back."""
    with running(name, tmp_path) as line, default_terminal() as wire:
        before = line.memory()

        def echo(some: bytes) -> bytes:
            os.write(wire, some)
            back = b""
            while select.select([wire], [], [], 0.002)[0]:
                back += os.read(wire, 4096)
            return back

        line.send(echo(line.said))  # the banner
        line.until(b"this terminal echoes")
        line.send(echo(line.said[line.said.index(b"# this") :]))
        play(line, ECHO_S / 2, echo, nobody)
        assert line.said.count(b"this terminal echoes") == 1
        left = [f"{word}\r".encode() for word in WORDS]

        def person(passed_s: float) -> bytes:
            return left.pop() if left and passed_s > (len(WORDS) - len(left)) * ECHO_S / 2 / len(WORDS) else b""

        play(line, ECHO_S / 2, echo, person)
        check(line, before)


@pytest.mark.parametrize("name", IMAGES)
def test_every_byte_comes_back(name: str, tmp_path: Path) -> None:
    """Receiver and sender are joined."""
    with running(name, tmp_path) as line:
        before = line.memory()
        line.send(line.said + b"k\r")
        line.until(b"this terminal echoes")
        line.send(line.said[line.said.index(b"# this") :])
        play(line, ECHO_S, bytes, nobody)
        assert line.said.count(b"this terminal echoes") == 1
        check(line, before)


@pytest.mark.parametrize("name", IMAGES)
def test_noise_and_its_own_banner_again_and_again(name: str, tmp_path: Path) -> None:
    draw = random.Random(7)
    with running(name, tmp_path) as line:
        before = line.memory()
        banner = line.said

        def noise(_: float) -> bytes:
            if draw.random() > 0.2:
                return b""  # an emulated board takes about 1,000 bytes a second
            cut = draw.randrange(len(banner))
            return draw.choice((draw.randbytes(20), banner[cut : cut + 60], draw.choice(WORDS).encode() + b"\r"))

        play(line, ECHO_S, lambda _: b"", noise)
        check(line, before)


def test_two_boards_on_one_line_fall_silent(tmp_path: Path) -> None:
    """Each hears what the other says."""
    folders = [tmp_path / "a", tmp_path / "b"]
    for folder in folders:
        folder.mkdir()
    with running("brace-mps2-an386", folders[0]) as one, running("brace-netduinoplus2", folders[1]) as other:
        before = one.memory(), other.memory()
        one.send(other.said + b"restart\r")
        other.send(one.said + b"restart\r")
        silent_since = time.monotonic()
        end = time.monotonic() + ECHO_S
        while time.monotonic() < end:
            for ours, theirs in ((one, other), (other, one)):
                if select.select([ours], [], [], 0.01)[0]:
                    theirs.send(ours.hear())
                    silent_since = time.monotonic()
        assert time.monotonic() - silent_since > ECHO_S / 2
        check(one, before[0])
        check(other, before[1])


def test_the_same_words_do_what_they_say_where_nothing_comes_back(tmp_path: Path) -> None:
    """The tests above would pass on a board that is deaf."""
    with running("brace-mps2-an386", tmp_path) as line:
        line.send(b"restart\r")
        line.until(b"# sure? ")
        line.until(b"\r\n# sure?")
        while not line.said.endswith(b"\r\n"):
            line.hear()
        line.send(digits_of(line.said.decode().rstrip()).encode() + b"\r")
        line.until(b"# start: requested")
