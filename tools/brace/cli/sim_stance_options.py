"""The options of `brace sim --stance`, and which options do not go together."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from brace.cli import common, sim_values
from brace.ground.errors import UsageError
from brace.sim.spec import LIFT_MM

# What is for limbs without a body, and what is for a stance: the option, and what it is when nobody gave it.
_ALONE: dict[str, tuple[str, object]] = {
    "--plant": ("plant", None),
    "--limbs": ("limbs", 1),
    "--node": ("node", None),
    "--contact": ("contact", math.inf),
    "--press": ("press", (0.0, 0.0)),
    "--press-across": ("press_across", 0.0),
    "--theta0": ("theta0", 0.0),
    "--posture": ("posture", []),
}
_OF_A_STANCE: dict[str, tuple[str, object]] = {
    "--stance-plant": ("stance_plant", None),
    "--payload": ("payload", []),
    "--move": ("move", []),
    "--lift": ("lift", []),
    "--truth": ("truth", None),
}


def add(parser: argparse.ArgumentParser) -> None:
    """All but --stance itself, which stands beside --model."""
    group = parser.add_argument_group("limbs under one body (with --stance; docs/stance.md)")
    group.add_argument(
        "--stance-plant",
        type=common.path,
        metavar="TRUE.toml",
        help="the true stance: other limbs, friction, footholds; the same limbs by name. Footholds lie where the tips "
        "of --stance are believed without load, and by offset_mm of this file elsewhere",
    )
    group.add_argument(
        "--payload",
        type=sim_values.payload,
        action="append",
        default=[],
        metavar="FACTOR[@S[+RAMP]]",
        help="the payload's factor from second S on, reached within RAMP seconds; 0 before; may be repeated; "
        "default 1@2",
    )
    group.add_argument(
        "--move",
        type=sim_values.move,
        action="append",
        default=[],
        metavar="LIMB:D0,D1,D2[@S]",
        help="moves a limb's set-points by so much [rad]; LIMB is its name or number; may be repeated",
    )
    group.add_argument(
        "--lift",
        type=sim_values.lift,
        action="append",
        default=[],
        metavar="LIMB[@S[+DURATION]]",
        help=f"lets the grip go and lifts the foot {LIFT_MM:.0f} mm off its ground, for good or for a while",
    )
    group.add_argument(
        "--truth",
        type=Path,
        metavar="FILE.csv",
        help="what is true at 100 Hz: each foot's force in the body's frame, its state and place, what motors bear, "
        "how the body has moved",
    )


def refuse_mixture(arguments: argparse.Namespace) -> None:
    """Options of limbs that stand alone with a stance, or the reverse."""
    with_stance = arguments.stance is not None
    for option, (name, unless_given) in (_ALONE if with_stance else _OF_A_STANCE).items():
        if getattr(arguments, name) != unless_given:
            raise UsageError(
                f"{option} is for limbs without a body" if with_stance else f"{option} is for limbs under one body",
                where="sim",
                why="the stance says it for each limb" if with_stance else "there is no --stance",
                next_step=f"leave {option} out" if with_stance else "add --stance STANCE.toml",
            )
    if with_stance and arguments.servos not in (None, "sim"):
        raise UsageError(
            "--servos: a stance has simulated servos",
            where="sim",
            why="no simulated body stands on real servos",
            next_step="--servos sim, or --model LIMB.toml for a limb with real ones",
        )
    if arguments.truth is not None:
        from brace.ground.files import check_file

        inputs = [path for path in (arguments.stance, arguments.stance_plant) if path is not None]
        check_file(arguments.truth, inputs)
