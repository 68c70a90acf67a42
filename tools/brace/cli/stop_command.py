"""`brace stop`: every limb of a bus stands."""

from __future__ import annotations

import argparse
import contextlib

from brace.cli import common
from brace.cli.bus_options import add_bus, bus_url
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "stop",
        help=SUBCOMMANDS["stop"],
        description="Every limb of the bus stands where it is, or the one of --node; over Modbus the unit of the URL. "
        "The stop leaves before anything is asked. It needs no key, and nothing is let go.",
        epilog="Exit codes: 0 every limb that is heard stands, 4 no answer, 5 the device refuses, or moves on.",
    )
    add_bus(parser)
    parser.add_argument(
        "--stop-id",
        type=common.count(1, 127),
        metavar="N",
        help="the CAN identifier that stops every limb of this bus (controller.stop_id; default 1); a limb that "
        "answers and obeys another one gets that, too",
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.bus.open import DEFAULT_BIT_RATE, open_bus
    from brace.bus.stopping import STOP_ID, stop_by_register, stop_on

    url = bus_url(arguments, answers=True)
    if url.is_modbus and arguments.stop_id is not None:
        raise UsageError(
            "Modbus has no frame that stops every limb",
            where="--stop-id",
            why=f"{url.text} is one unit, and a register stops it",
            next_step="without --stop-id, once for each unit",
        )
    if url.is_modbus:
        held = stop_by_register(url)
    else:
        with contextlib.closing(open_bus(url, getattr(arguments, "bit_rate", None) or DEFAULT_BIT_RATE)) as bus:
            held = stop_on(bus, arguments.node, arguments.stop_id or STOP_ID)
    if arguments.json:
        common.print_json({"nodes": list(held), "held": [node for node in held if held[node]], "stopped": True})
        return 0
    for node, is_held in held.items():
        common.say(f"{url.text}, node {node}: {'the limb is held' if is_held else 'nothing moves'}")
    return 0
