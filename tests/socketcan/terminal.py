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

SHOWN_WITHIN_S = 20.0  # python-can itself sleeps 2 s when it opens
ESCAPES = re.compile(rb"\x1b(?:\[[0-9;?]*[A-Za-z]|\(B|[=>])")


def screen_of(command: list[str], wanted: list[str]) -> str:
    """What a full-screen program writes to a terminal until all of it is there; without the escapes between."""
    child, terminal = pty.fork()
    if child == 0:
        os.environ["TERM"] = "xterm"
        os.execv(command[0], command)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 60, 160, 0, 0))
    shown, end = b"", time.monotonic() + SHOWN_WITHIN_S
    try:
        while time.monotonic() < end:
            if select.select([terminal], [], [], 0.2)[0]:
                try:
                    shown += os.read(terminal, 65536)
                except OSError:
                    break  # it has ended
            text = ESCAPES.sub(b"", shown).decode(errors="replace")
            if all(re.search(pattern, text) for pattern in wanted):
                return text
        raise AssertionError(f"not all of {wanted} in: {ESCAPES.sub(b'', shown).decode(errors='replace')}")
    finally:
        with contextlib.suppress(OSError):
            os.write(terminal, b"q")
        time.sleep(0.2)
        os.kill(child, 9)
        os.waitpid(child, 0)
        os.close(terminal)
