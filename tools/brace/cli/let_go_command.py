"""`brace let-go`: takes back what `brace take-up` has done."""

from __future__ import annotations

import argparse

from brace.cli import common
from brace.cli.bus_options import add_bus, controller
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS

WAIT_S = 30.0


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "let-go",
        help=SUBCOMMANDS["let-go"],
        description="The joints go back to where their set-points are, the last taken up first. A loading test that "
        "runs ends too.",
        epilog="Exit codes: 0 every joint is back, 4 no answer or not in time, 5 the device refuses, 6 another "
        "dictionary.",
    )
    parser.add_argument("--wait", type=common.duration, default=WAIT_S, metavar="S", help=f"default {WAIT_S:g}")
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.bus.taking_up import let_go

    with controller(arguments) as device:
        let_go(device, arguments.wait)
        where = f"{device.url}, node {device.node}"
    if arguments.json:
        common.print_json({"node": device.node, "let_go": True})
    else:
        common.say(f"{where}: every joint is let go")
    return 0
