"""stdout is data, stderr is messages; either may be closed, full, or unable to show a character."""

from __future__ import annotations

import os
import sys

from brace.ground.errors import BraceError, printable


class OutputLost(BraceError):
    """What was asked for could not be printed."""

    def __init__(self, why: str) -> None:
        super().__init__(
            "the result cannot be printed",
            where="standard output",
            why=f"{why} (files that --out names are in place)",
            next_step="send standard output to a terminal, a pipe or a file with room",
        )


def prepare() -> None:
    """Characters that a stream cannot show are written as \\x.., so that no name stops a command."""
    global _quiet
    _quiet = False  # main() may be called more than once
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


def emit(text: str) -> None:
    """The command's result, on stdout."""
    if sys.stdout is None:
        raise OutputLost("it is closed")
    try:
        print(printable(text))
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OutputLost(error.strerror or str(error)) from None


_quiet = False


def hush() -> None:
    """From now on only what went wrong is said: --quiet."""
    global _quiet
    _quiet = True


def is_quiet() -> bool:
    """Whether --quiet was given."""
    return _quiet


def say(text: str) -> None:
    """A message for the person, on stderr, if there is one."""
    if sys.stderr is None:
        return
    try:
        print(printable(text), file=sys.stderr)
    except OSError:
        pass  # nobody can be reached


def finish(lost: bool = False) -> None:
    """Empties stdout; when what it holds is lost, it goes nowhere, so that nothing fails after us."""
    if sys.stdout is None:
        return
    if lost:
        try:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        except (OSError, ValueError):
            pass
        return
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except (OSError, ValueError) as error:
        raise OutputLost(getattr(error, "strerror", None) or str(error)) from None
