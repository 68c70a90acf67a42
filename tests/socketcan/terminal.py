"""What a full-screen program shows a person."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pty
import re
import select
import struct
import termios
import time

import pyte

SHOWN_WITHIN_S = 90.0  # python-can itself sleeps 2 s when it opens
ROWS, COLUMNS = 24, 140


def screen_of(command: list[str], wanted: list[str]) -> str:
    """Runs a program at a terminal until its screen shows all that is wanted; the screen."""
    child, terminal = pty.fork()
    if child == 0:
        os.environ |= {"TERM": "linux", "LINES": str(ROWS), "COLUMNS": str(COLUMNS)}
        fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        os.execv(command[0], command)
    screen = pyte.Screen(COLUMNS, ROWS)
    stream = pyte.ByteStream(screen)
    end = time.monotonic() + SHOWN_WITHIN_S
    try:
        while time.monotonic() < end:
            if select.select([terminal], [], [], 0.2)[0]:
                try:
                    stream.feed(os.read(terminal, 65536))
                except OSError:
                    break  # it has ended
            text = "\n".join(line.rstrip() for line in screen.display).strip()
            if all(re.search(pattern, text) for pattern in wanted):
                return text
        raise AssertionError(f"not all of {wanted} in:\n" + "\n".join(screen.display))
    finally:
        with contextlib.suppress(OSError):
            os.write(terminal, b"q")
        time.sleep(0.2)
        os.kill(child, 9)
        os.waitpid(child, 0)
        os.close(terminal)
