"""From the command line to an exit code: one file per subcommand, every failure a message."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from importlib import import_module

from brace import __version__
from brace.cli.doubts import doubts_said
from brace.cli.options import OptionParser
from brace.cli.streams import OutputLost, finish, hush, prepare, say
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import EXIT_CHECK_FAILED, EXIT_OK, EXIT_USAGE, BraceError

ABOUT_ALL = {"-h", "--help", "--version"}  # options that brace answers without loading a subcommand
_NEGATIVE_NUMBER = re.compile(r"^-(\d|\.\d|inf|nan)", re.IGNORECASE)


def run_command_line(argv: Sequence[str] | None) -> int:
    """Runs the command line; returns its exit code. Only Ctrl-C leaves as an exception."""
    prepare()
    try:
        with doubts_said():
            code = _run(argv)
        finish()
        return code
    except BrokenPipeError:  # the reader of our stdout has gone, as `| head` does
        finish(lost=True)
        return EXIT_OK
    except OutputLost as error:
        finish(lost=True)
        say(error.render())
        return error.exit_code
    except BraceError as error:
        if os.environ.get("BRACE_DEBUG"):
            raise
        say(error.render())
        return error.exit_code
    except MemoryError:
        say("brace: out of memory\n  why: the request is larger than this machine\n  try: fewer rows or postures")
        return EXIT_CHECK_FAILED
    except Exception as error:  # a defect of ours: still no traceback unless asked for
        if os.environ.get("BRACE_DEBUG"):
            raise
        say(
            f"brace: internal error: {type(error).__name__}: {error}\n  why: this is a defect of brace, not of your "
            "files\n  try: the same command with BRACE_DEBUG=1, and report what it prints"
        )
        return EXIT_CHECK_FAILED


def _run(argv: Sequence[str] | None) -> int:
    try:
        arguments = build_parser(sys.argv[1:] if argv is None else argv).parse_args(argv)
    except SystemExit as stop:  # --help, --version
        return int(stop.code or 0)
    if arguments.quiet:
        hush()
    return int(arguments.run(arguments))


def build_parser(argv: Sequence[str] = ()) -> OptionParser:
    """The parser of all subcommands; where the command line begins with one, of that one alone.

    A command line about all of them gets their names and no options: to load every subcommand takes 0.1 s.
    """
    parser = OptionParser(
        prog="brace",
        description="Stiffness at the tip of a climbing robot's limb: predict it, measure it, explain it. "
        "Units: mm, N, N mm, rad, s, degC.",
        epilog="Exit codes: 0 done, 1 a check failed, 2 usage, 3 bad model or data file, 4 no device or time-out, 5 "
        "device fault or K not valid, 6 version mismatch, 7 write not verified and rolled back, 130 "
        "interrupted.",
    )
    parser.add_argument("--version", action="version", version=f"brace {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", dest="command")
    for name in argv[:1] if argv[:1] and argv[0] in SUBCOMMANDS else SUBCOMMANDS:
        if argv and ABOUT_ALL.issuperset(argv):
            commands.add_parser(name, help=SUBCOMMANDS[name])
        else:
            import_module(f"brace.cli.{name.replace('-', '_')}_command").add(commands)
    _finish_parsers(parser)
    parser.set_defaults(run=lambda _arguments: _help(parser), quiet=False)
    return parser


def _finish_parsers(parser: OptionParser) -> None:
    """What all commands have, at every level."""
    parser._negative_number_matcher = _NEGATIVE_NUMBER  # -1e-3 is a value, not an option
    parser.add_argument(
        "--quiet", action="store_true", default=argparse.SUPPRESS, help="say on stderr only what went wrong"
    )
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _finish_parsers(command)


def _help(parser: OptionParser) -> int:
    parser.print_help(sys.stderr)
    return EXIT_USAGE
