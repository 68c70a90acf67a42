"""The load of `brace k`: its options, and what it can not be asked together with."""

from __future__ import annotations

import argparse

from brace.cli.options import OptionParser, number, refused
from brace.errors import UsageError
from brace.limits import FORCE_MOST_N

SOFTENED = 3.0  # of the buckling factor: below it a limb is much softer than without load, and a controller flags its K


def add_load(parser: OptionParser) -> None:
    """Declares --fx and --fz."""
    meaning = "force of the ground on the tip along {}; K is then K under this load, at the equilibrium"
    parser.add_argument("--fx", type=force, metavar="N", help=meaning.format("x"))
    parser.add_argument("--fz", type=force, metavar="N", help=meaning.format("z (up)"))


def force(text: str) -> float:
    """A force [N] on the tip."""
    value = number(text)
    if abs(value) > FORCE_MOST_N:
        raise refused(f"{text} N is no force on a tip", f"it lies within +-{FORCE_MOST_N:g} N", "OPTION 10")
    return value


def fill_in(arguments: argparse.Namespace) -> None:
    """One component alone: the other is 0."""
    if arguments.fx is not None or arguments.fz is not None:
        arguments.fx, arguments.fz = arguments.fx or 0.0, arguments.fz or 0.0


def refuse_load_with(arithmetic: str, in_space: bool) -> None:
    """K under a load is float and in the plane."""
    if in_space:
        raise UsageError(
            "K under a load with theta0",
            why="under a load K is computed in the limb's plane only",
            next_step="leave theta0 out for K in the plane, or the load for K in space without load",
        )
    if arithmetic != "f32":
        raise UsageError(
            f"--arith {arithmetic} with a load",
            why="under a load K is computed in float only",
            next_step="drop --arith",
        )
