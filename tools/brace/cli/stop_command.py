"""`brace stop`: every limb of a bus stands."""

from __future__ import annotations

import argparse
import contextlib

from brace.cli import common
from brace.cli.bus_options import add_bus, bus_url
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "stop",
        help=SUBCOMMANDS["stop"],
        description="Every limb of the bus stands where it is, or the one of --node; over Modbus the unit of the URL. The "
        "stop leaves before anything is asked. It needs no key, and nothing is let go.",
        epilog="Exit codes: 0 every limb that is heard stands, 4 no answer, 5 the device refuses.",
    )
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.bus.open import DEFAULT_BIT_RATE, open_bus
    from brace.bus.stopping import stop_by_register, stop_on

    url = bus_url(arguments, answers=True)
    if url.is_modbus:
        nodes = [stop_by_register(url)]
    else:
        with contextlib.closing(open_bus(url, getattr(arguments, "bit_rate", None) or DEFAULT_BIT_RATE)) as bus:
            nodes = stop_on(bus, arguments.node)
    if arguments.json:
        common.print_json({"nodes": nodes, "stopped": True})
    else:
        common.say(f"{url.text}: {', '.join(f'node {node}' for node in nodes)}: every limb stands")
    return 0
