"""The `brace` command. Only this much is imported before failures, Ctrl-C included, are turned into messages."""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # the true one is not imported yet
if TYPE_CHECKING:
    from collections.abc import Callable

_INTERRUPTED = 130


def main(argv: list[str] | None = None) -> int:
    """Runs the command line; returns the exit code of contracts: 0 done, 2 usage, 3 bad file, 130 interrupted."""
    try:
        return _prepared()(argv)
    except KeyboardInterrupt:
        _say_interrupted()
        return _INTERRUPTED


def _prepared() -> Callable[[list[str] | None], int]:
    """The command, imported. Until it is, Ctrl-C ends the process at once: raised inside an import it may be lost."""
    import signal

    def leave(_number: object, _frame: object) -> None:
        import os

        _say_interrupted()
        os._exit(_INTERRUPTED)

    guard = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    try:
        if guard:
            signal.signal(signal.SIGINT, leave)
    except ValueError:  # not the main thread: its interruption is somebody else's
        guard = False
    import brace.ground.one_thread  # noqa: F401  before numpy is loaded
    from brace.cli.command_line import run_command_line

    if guard:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return run_command_line


def _say_interrupted() -> None:
    if sys.stderr is not None:
        sys.stderr.write("brace: interrupted; nothing was written\n")
        sys.stderr.flush()
