"""The load of `brace k`: its options, and what it can not be asked together with."""

from __future__ import annotations

import argparse

from brace.cli.options import OptionParser, force
from brace.ground.errors import UsageError

SOFTENED = 3.0  # of the buckling factor: below it a limb is much softer than without load, and a controller flags its K


def add_load(parser: OptionParser, in_space: bool = True) -> None:
    """Declares --fx and --fz, and --fy of a command that computes K in space."""
    meaning = "force of the ground on the tip {}; K is then K under this load, at the equilibrium"
    parser.add_argument("--fx", type=force, metavar="N", help=meaning.format("outwards in the limb's plane"))
    if in_space:
        parser.add_argument("--fy", type=force, metavar="N", help="across the plane, to the left; only with --theta0")
    parser.add_argument("--fz", type=force, metavar="N", help="upwards in the plane")


def fill_in(arguments: argparse.Namespace) -> None:
    """One component alone: the others are 0."""
    given = [value is not None for value in (arguments.fx, getattr(arguments, "fy", None), arguments.fz)]
    arguments.is_loaded = any(given)
    if arguments.is_loaded:
        arguments.fx, arguments.fz = arguments.fx or 0.0, arguments.fz or 0.0


def refuse_load_with(arithmetic: str) -> None:
    """The chain knows no load."""
    if arithmetic == "general":
        raise UsageError(
            "--arith general with a load",
            why="the general chain tells K without load",
            next_step="--arith f32 or fixed",
        )


def refuse_in_space(arithmetic: str, what: str) -> None:
    """what: the option or column that asks for K in space."""
    if arithmetic != "f32":
        path = "fixed point" if arithmetic == "fixed" else f"--arith {arithmetic}"
        raise UsageError(
            f"--arith {arithmetic} with {what}",
            why=f"{path} works in the plane",
            next_step=f"--arith f32 for K in space, or drop {what} for K in the plane",
        )


def refuse_across_the_plane(what: str) -> None:
    """A force across the plane, and K in the plane."""
    raise UsageError(
        f"{what} without theta0",
        why="a force across the limb's plane bends it out of the plane, so K is one in space",
        next_step="add --theta0 RAD (a table: a column theta0_rad) for K in space, or leave the force across out",
    )
