"""`brace take-up`: takes up the backlash of joints, so that a chosen side of it is loaded."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus, controller
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS

if TYPE_CHECKING:
    from brace.bus.taking_up import Flank

WAIT_S = 30.0
_CALLED = {"yaw": "coxa", "hip": "femur", "knee": "tibia", "ankle": "tibia", "coxa": "coxa", "tibia": "tibia"}


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "take-up",
        help=SUBCOMMANDS["take-up"],
        description="The motors move through the backlash until the chosen side of each joint's backlash is loaded, "
        "one joint after the other, and hold it there. The limb moves by its backlash. brace let-go takes it back.",
        epilog="Exit codes: 0 every joint is held, 2 no such joint, 4 no answer or not in time, 5 the device refuses "
        "or a take-up failed, 6 another dictionary.",
    )
    parser.add_argument(
        "flanks", type=_flank, nargs="+", metavar="JOINT+|JOINT-", help="femur+ tibia-, say: + turns as the angle grows"
    )
    parser.add_argument(
        "--wait", type=common.duration, default=WAIT_S, metavar="S", help=f"for each joint; default {WAIT_S:g}"
    )
    add_bus(parser)
    common.add_json(parser)
    parser.set_defaults(run=run)


def _flank(text: str) -> Flank:
    from brace.bus.drift import TAKE_UPS
    from brace.bus.taking_up import Flank

    joint, sign = text[:-1].lower(), text[-1:]
    if joint not in TAKE_UPS or sign not in "+-":
        meant, side = _CALLED.get(text.rstrip("+-").lower(), "femur"), sign if sign in ("+", "-") else "+"
        raise refused(
            f"{text!r} does not name a side of a joint's backlash",
            f"the joints are {', '.join(TAKE_UPS)} (the tibia's is the knee), and each has a side + and a side -",
            f"brace take-up {meant}{side}",
        )
    return Flank(joint, 1 if sign == "+" else -1)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.bus.taking_up import take_up

    with controller(arguments) as device:
        take_up(device, arguments.flanks, arguments.wait)
        where = f"{device.url}, node {device.node}"
    held = [flank.text for flank in arguments.flanks]
    if arguments.json:
        common.print_json({"node": device.node, "held": held})
    else:
        common.say(f"{where}: held {' '.join(held)}")
    return 0
