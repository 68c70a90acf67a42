"""The `brace` command. Only this much is imported before failures, Ctrl-C included, are turned into messages."""

from __future__ import annotations

import sys
from collections.abc import Sequence

_INTERRUPTED = 130


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command line; returns the exit code of contracts: 0 done, 2 usage, 3 bad file, 130 interrupted."""
    try:
        from brace.cli.command_line import run_command_line

        return run_command_line(argv)
    except KeyboardInterrupt:
        if sys.stderr is not None:
            sys.stderr.write("brace: interrupted; nothing was written\n")
        return _INTERRUPTED
