"""`brace completion`: what a shell needs to complete brace's commands, options and file names."""

from __future__ import annotations

import argparse
from pathlib import Path

from brace.cli import common
from brace.cli.options import OptionParser, Subcommands
from brace.cli.subcommands import SUBCOMMANDS

SHELLS = ("bash", "zsh", "fish")


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "completion",
        help=SUBCOMMANDS["completion"],
        description="Prints a completion script for a shell. bash: brace completion bash > "
        "~/.local/share/bash-completion/completions/brace. zsh: brace completion zsh > _brace, in a folder of $fpath. "
        "fish: brace completion fish > ~/.config/fish/completions/brace.fish.",
    )
    parser.add_argument("shell", choices=SHELLS, help="the shell")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    script = completion(arguments.shell).rstrip("\n")
    if arguments.json:
        common.print_json({"shell": arguments.shell, "script": script})
    else:
        common.emit(script)
    return 0


def completion(shell: str) -> str:
    """The script, made from the parsers."""
    import shtab

    from brace.cli.command_line import build_parser

    parser = build_parser()
    _name_files(parser)
    return str(shtab.complete(parser, shell))


def _name_files(parser: OptionParser) -> None:
    """Options that take a file or a folder, and arguments that name one, complete file names."""
    import shtab

    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                _name_files(command)
        elif action.type in (common.path, Path):
            action.complete = shtab.FILE  # type: ignore[attr-defined]
