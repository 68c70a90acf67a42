"""The `brace` command: one file per subcommand; this one routes, and turns every failure into a message."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from importlib import import_module

from brace import __version__
from brace.errors import EXIT_CHECK_FAILED, EXIT_INTERRUPTED, EXIT_USAGE, BraceError

SUBCOMMANDS = ("k", "map", "simulate", "predict", "identify", "demo")
_NEGATIVE_NUMBER = re.compile(r"^-(\d|\.\d|inf|nan)", re.IGNORECASE)


def main(argv: Sequence[str] | None = None) -> int:
    """Runs the command line; returns the exit code of contracts: 0 done, 2 usage, 3 bad file, 130 interrupted."""
    try:
        arguments = build_parser().parse_args(argv)
        code = int(arguments.run(arguments))
        sys.stdout.flush()
        return code
    except BraceError as error:
        if os.environ.get("BRACE_DEBUG"):
            raise
        print(error.render(), file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("brace: interrupted; nothing was written", file=sys.stderr)
        return EXIT_INTERRUPTED
    except BrokenPipeError:  # the reader of our stdout has gone, as `| head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except MemoryError:
        print(
            "brace: out of memory\n  why: the request is larger than this machine\n  try: fewer rows or postures",
            file=sys.stderr,
        )
        return EXIT_CHECK_FAILED
    except Exception as error:  # a defect of ours: still no traceback unless asked for
        if os.environ.get("BRACE_DEBUG"):
            raise
        print(
            f"brace: internal error: {type(error).__name__}: {error}\n  why: this is a defect of brace, not of your "
            "files\n  try: the same command with BRACE_DEBUG=1, and report what it prints",
            file=sys.stderr,
        )
        return EXIT_CHECK_FAILED


def build_parser() -> argparse.ArgumentParser:
    """The parser of all subcommands."""
    parser = argparse.ArgumentParser(
        prog="brace",
        description="Stiffness at the tip of a climbing robot's limb: predict it, measure it, explain it. "
        "Units: mm, N, N mm, rad, s, degC.",
        epilog="Exit codes: 0 done, 1 a check failed, 2 usage, 3 bad model or data file, 130 interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"brace {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", dest="command")
    for name in SUBCOMMANDS:
        module = import_module(f"brace.cli.{name}_command")
        module.add(commands)
    for command in commands.choices.values():
        command._negative_number_matcher = _NEGATIVE_NUMBER  # -1e-3 is a value, not an option
    parser.set_defaults(run=lambda _arguments: _help(parser))
    return parser


def _help(parser: argparse.ArgumentParser) -> int:
    parser.print_help(sys.stderr)
    return EXIT_USAGE
