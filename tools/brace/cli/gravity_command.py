"""`brace gravity`: where down is, sent to a controller or asked from it."""

from __future__ import annotations

import argparse
import math
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import add_bus, controller
from brace.cli.options import Quantity, Subcommands, at_most_a_turn, refused
from brace.cli.subcommands import SUBCOMMANDS

if TYPE_CHECKING:
    from brace.bus.controller import Controller
    from brace.wire.layout import Value


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "gravity",
        help=SUBCOMMANDS["gravity"],
        description="The limb's weight pulls down, and K counts it. A robot that climbs turns: --direction says where "
        "down is now, in the limb's plane, from +x (-1.5708 where the plane stands upright), and --lean how far it "
        "leans out of it. This holds until the controller's next start; the parameters [gravity] direction_rad and "
        "lean_rad stay as they are. Without options the command shows where the controller takes down to be.",
        epilog="Exit codes: 0 done, 2 no direction, 4 no answer, 5 the device refuses, 6 another dictionary.",
    )
    add_bus(parser)
    parser.add_argument(
        "--direction", type=_within("gravity.direction_rad"), metavar="RAD", help="of down in the limb's plane, from +x"
    )
    parser.add_argument(
        "--lean",
        type=_within("gravity.lean_rad"),
        metavar="RAD",
        help="of down out of the limb's plane; with --direction; default 0",
    )
    parser.add_argument(
        "--as-parameters", action="store_true", help="down is again where the controller's parameters say"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def _within(key: str) -> Quantity:
    """An angle in a parameter's range."""

    def check(value_rad: float, text: str, has_unit: bool) -> None:
        from brace.wire.names import PARAMETERS

        at_most_a_turn(value_rad, text, has_unit)
        parameter = next(parameter for parameter in PARAMETERS if parameter.key == key)
        if not parameter.low <= value_rad <= parameter.high:
            raise refused(
                f"{value_rad:.6g} rad is outside {parameter.low:.4f} to {parameter.high:.4f}",
                f"{key} has this range",
                "the same direction by another full turn",
            )

    return Quantity("angle", "-90deg", check=check)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    _check(arguments)
    with controller(arguments) as device:
        if arguments.as_parameters:
            direction, lean = device.set_gravity(math.nan, math.nan)
        elif arguments.direction is not None:
            direction, lean = device.set_gravity(arguments.direction, arguments.lean or 0.0)
        else:
            direction, lean = _asked(device)
        where = f"{device.url}, node {device.node}"
        node = device.node
    if arguments.json:
        common.print_json({"node": node, "gravity_direction_rad": direction, "gravity_lean_rad": lean})
        return 0
    until = ", until the controller's next start" if arguments.direction is not None else ""
    common.emit(f"{where}: down is {_rad(direction)} from +x in the limb's plane, {_rad(lean)} out of it{until}")
    return 0


def _check(arguments: argparse.Namespace) -> None:
    from brace.ground.errors import UsageError

    if arguments.lean is not None and arguments.direction is None:
        raise UsageError(
            "--lean without --direction",
            where="gravity",
            why="the lean alone is no direction",
            next_step="give both, or none to ask where down is",
        )
    if arguments.as_parameters and arguments.direction is not None:
        raise UsageError(
            "--as-parameters with --direction",
            where="gravity",
            why="down is either where you say or where the parameters say",
            next_step="drop one of them",
        )


def _asked(device: Controller) -> tuple[Value, Value]:
    from brace.bus.entries import number_of

    found = [number_of(name, device.read_entry(name)) for name in ("gravity_direction", "gravity_lean")]
    direction, lean = (None if math.isnan(value) else value for value in found)
    return direction, lean


def _rad(value: Value) -> str:
    return "not known" if value is None else f"{value:.4f} rad"
