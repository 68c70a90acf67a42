"""`brace plan`: where a foot should stand and how hard it should press, for a wanted stiffness, contact and payload."""

from __future__ import annotations

import argparse
import functools
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.k_load import SOFTENED
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import BraceError, UsageError
from brace.ground.units import G_M_PER_S2

if TYPE_CHECKING:
    from brace.model import LimbModel
    from brace.stiffness.plan import Plan, Wish
    from brace.stiffness.play_under_load import Play

APART_RATIO = 0.05  # of the reach, between the tips of postures that are printed
_NEEDS = {"steady": ("payload", "a payload"), "light": ("friction", "the surface's friction"), "k": ("k", "a K")}


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "plan",
        help=SUBCOMMANDS["plan"],
        description="Looks over the places that the tip can reach within the joints' travel, keeps the postures that "
        "satisfy every demand, and prints the best: angles to command, K, the sag under the payload, the force with "
        "which to press against the surface, where to set the tip for it. K is the firmware's own under that force and "
        "the limb's weight, every gap closed; the tip stands at its place under them.",
        epilog="Exit code 1 when no posture satisfies all demands; the message says how far each can be met.",
    )
    common.add_model(parser)
    where = parser.add_argument_group("where the tip may stand [mm], x outwards, z up, from the femur axis")
    span = functools.partial(where.add_argument, type=common.length, nargs=2, metavar=("LOW", "HIGH"))
    span("--x", help="default: from 0 as far as it reaches")
    span("--z", help="default: as far as it reaches")
    where.add_argument("--knee", choices=("up", "down", "either"), default="either", help="default either")
    contact = parser.add_argument_group("contact and payload")
    contact.add_argument("--payload", type=common.weight, metavar="N", help="weight that the foot carries; 10N, 1kg")
    contact.add_argument(
        "--friction", type=common.positive_ratio, metavar="MU", help="of the surface: the foot must not slide"
    )
    contact.add_argument(
        "--normal", type=common.angle, default=math.pi / 2, metavar="RAD",
        help="direction out of the surface, towards the limb; default pi/2, a floor; pi is a wall ahead",
    )  # fmt: skip
    contact.add_argument(
        "--bears", type=common.length, default=0.0, metavar="MM",
        help="error of position, in any direction, that must not let it slide; default 0",
    )  # fmt: skip
    demands = parser.add_argument_group("demands")
    for option, kind, unit, meaning in (
        ("--lambda-min", common.positive_stiffness, "N_PER_MM", "stiffness at least, in any direction"),
        ("--lambda-max", common.positive_stiffness, "N_PER_MM", "stiffness at most, in any direction"),
        ("--sag-most", common.positive_length, "MM", "under the payload"),
        ("--press-most", common.positive_force, "N", "against the surface, beside the payload"),
    ):
        demands.add_argument(option, type=kind, metavar=unit, help=meaning)
    demands.add_argument(
        "--k", type=common.stiffness, nargs=3, metavar=("XX", "XZ", "ZZ"), help="the K that is wanted [N/mm]"
    )
    parser.add_argument(
        "--prefer", choices=("firm", "soft", "steady", "light", "k"),
        help="largest lambda_min, smallest lambda_max, least sag, least pressing, nearest K; default: k with --k, else "
        "light with --friction, else steady with --payload, else firm",
    )  # fmt: skip
    parser.add_argument(
        "--count", type=common.count(1, 1000), default=3, metavar="N", help="postures to print; default 3"
    )
    parser.add_argument(
        "--places", type=common.count(100, 1_000_000), default=10_000, metavar="N", help="of the tip; default 10000"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.model import load_limb
    from brace.stiffness.plan import KNEES, PREFERENCES, Wish, plan

    _check(arguments)
    model = load_limb(arguments.model)
    prefer = arguments.prefer or _preference(arguments)
    wish = Wish(
        x_mm=tuple(arguments.x) if arguments.x else None,
        z_mm=tuple(arguments.z) if arguments.z else None,
        knees=KNEES if arguments.knee == "either" else (arguments.knee,),
        payload_n=arguments.payload or 0.0,
        normal_rad=arguments.normal,
        friction_ratio=arguments.friction,
        bears_mm=arguments.bears,
        lambda_min_n_per_mm=arguments.lambda_min,
        lambda_max_n_per_mm=arguments.lambda_max,
        sag_most_mm=arguments.sag_most,
        press_most_n=arguments.press_most,
        k_n_per_mm=tuple(arguments.k) if arguments.k else None,
    )
    for joint in _without_travel(model):
        common.say(joint)
    found = plan(model, wish, arguments.places)
    if not found.count:
        raise BraceError(
            "no posture reaches there",
            where=str(arguments.model),
            why="the tip's places lie beyond the links, the joints' travel ([motor.*] angle_min_rad, angle_max_rad) "
            "keeps it away, or no rest was found there under the load",
            next_step="a wider --x or --z; brace map draws what the limb reaches" + _lighter(wish.payload_n),
        )
    reach = model.number("geometry.femur_mm") + model.number("geometry.tibia_mm")
    best = found.best(prefer, arguments.count, APART_RATIO * reach)
    if not best:
        raise _nothing(found, str(arguments.model), wish.payload_n)
    postures = [
        {name: float(column[index]) for name, column in found.columns.items()} | {"knee": str(found.knee[index])}
        for index in best
    ]
    held = [_play_of(model, posture) for posture in postures]
    for posture, play in zip(postures, held, strict=True):
        posture["play_open"] = " ".join(play.open) if play else ""
    if arguments.json:
        common.print_json(
            {"model": model.name, "postures": found.count, "satisfying": int(found.kept.sum()), "prefer": prefer,
             "demands": {demand.words: int(demand.satisfied.sum()) for demand in found.demands}, "best": postures}
        )  # fmt: skip
        return 0
    common.emit(
        f"{model.name}: {found.kept.sum()} of {found.count} postures satisfy all demands; best first: "
        f"{PREFERENCES[prefer][0]}"
    )
    for number, (posture, play) in enumerate(zip(postures, held, strict=True), start=1):
        for line in (*_lines(number, posture, wish), *_play_lines(model, posture, play)):
            common.emit(line)
    return 0


def _lighter(payload_n: float) -> str:
    """What else to try where there is a payload; in kg too, because newtons are taken for them."""
    return f"; or a --payload below {payload_n:g}N, the weight of {payload_n / G_M_PER_S2:.3g} kg" if payload_n else ""


def _without_travel(model: LimbModel) -> list[str]:
    """A sentence for each joint whose travel limb.toml does not give."""
    from brace.model.travel import KNEE_MOST_RAD, has_travel

    sentences = []
    if not has_travel(model, "femur"):
        sentences.append(
            f"{model.where('motor')}: no travel of the femur ([motor.femur] angle_min_rad, angle_max_rad): any angle "
            "of it "
            "is taken for one that it reaches"
        )
    if not has_travel(model, "tibia"):
        sentences.append(
            f"{model.where('motor')}: no travel of the knee ([motor.tibia] angle_min_rad, angle_max_rad): postures "
            "with the "
            f"knee beyond {KNEE_MOST_RAD:g} rad are left out"
        )
    return sentences


def _play_of(model: LimbModel, p: Mapping[str, float | str]) -> Play | None:
    """Which play the planned force holds there, as a controller settles at; None: no joint of the plane has play."""
    from brace.stiffness.play_under_load import PlayUnderLoad

    names = ("theta1_true_rad", "theta2_true_rad", "force_x_n", "force_z_n")
    return PlayUnderLoad(model).at(*(float(p[name]) for name in names))


def _play_lines(model: LimbModel, p: Mapping[str, float | str], held: Play | None) -> list[str]:
    """Whether the planned force holds a joint's play, and what the posture's K is until the play is taken up."""
    from brace.stiffness.play_of_posture import plays

    lines = []
    for play in plays(model, float(p["theta1_true_rad"]), float(p["theta2_true_rad"]), p):
        k = ", ".join(f"{value:.4g}" for value in play.open_k_n_per_mm) if play.open_k_n_per_mm else "not known there"
        is_open = held is not None and play.joint in held.open
        lines.append(
            f"   play of the {play.joint}: "
            + (
                f"force and weight do not hold it (GAP_OPEN; brace take-up {play.joint}+ or {play.joint}- does); "
                if is_open
                else "force and weight hold it; "
            )
            + f"until it is taken up the tip goes {play.tip_mm:.2g} mm, with K [N/mm] {k}"
        )
    return lines


def _check(arguments: argparse.Namespace) -> None:
    for axis in ("x", "z"):
        span = getattr(arguments, axis)
        if span and span[0] > span[1]:
            raise UsageError(
                f"--{axis} {span[0]:g} {span[1]:g} is no range",
                why="low comes before high",
                next_step=f"--{axis} {span[1]:g} {span[0]:g}",
            )
    for option, needed in (("sag_most", "payload"), ("press_most", "friction")):
        if getattr(arguments, option) is not None and getattr(arguments, needed) is None:
            raise UsageError(
                f"--{option.replace('_', '-')} without --{needed}",
                why="without it there is none",
                next_step=f"add --{needed}",
            )
    for option in ("payload", "bears"):
        if (getattr(arguments, option) or 0.0) < 0.0:
            raise UsageError(
                f"--{option} is negative",
                why="a payload is a weight, an error of position a size",
                next_step=f"--{option} {-getattr(arguments, option):g}",
            )
    needed, what = _NEEDS.get(arguments.prefer, ("model", ""))
    if getattr(arguments, needed) is None:
        raise UsageError(
            f"--prefer {arguments.prefer} without --{needed}", why=f"it needs {what}", next_step=f"add --{needed}"
        )


def _preference(arguments: argparse.Namespace) -> str:
    for prefer, given in (("k", arguments.k), ("light", arguments.friction), ("steady", arguments.payload)):
        if given is not None:
            return prefer
    return "firm"


def _nothing(found: Plan, model: str, payload_n: float) -> BraceError:
    """No posture satisfies all: how many each demand leaves, and how far it can be met."""
    each = (f"{demand.words}: {demand.satisfied.sum()} of {found.count} postures, the best {demand.best:.4g}"
            for demand in found.demands)  # fmt: skip
    return BraceError(
        "no posture satisfies all demands",
        where=model,
        why="; ".join(each),
        next_step="a wider --x or --z, or less of the demand that the fewest satisfy" + _lighter(payload_n),
    )


def _lines(number: int, p: Mapping[str, float | str], wish: Wish) -> list[str]:
    lines = [
        f"{number}. tip at x {p['x_mm']:.1f}, z {p['z_mm']:.1f} mm, knee {p['knee']}: "
        f"theta1 {p['theta1_rad']:.4f}, theta2 {p['theta2_rad']:.4f} rad",
        f"   K [N/mm] {p['k_xx_n_per_mm']:.4g}, {p['k_xz_n_per_mm']:.4g}, {p['k_zz_n_per_mm']:.4g}; eigenvalues "
        f"{p['lambda_min_n_per_mm']:.4g} and {p['lambda_max_n_per_mm']:.4g}, stiff axis {p['stiff_axis_rad']:.3f} rad",
    ]
    if "off_n_per_mm" in p:
        lines.append(f"   off the wanted K by {p['off_n_per_mm']:.3g} N/mm")
    factor = float(p["buckling_factor"])
    if factor < SOFTENED:
        lines.append(f"   the load makes it much softer: buckling factor {factor:.2g}")
    if wish.payload_n:
        kg = wish.payload_n / G_M_PER_S2
        lines.append(f"   {wish.payload_n:g} N let it sag by {p['sag_mm']:.3g} mm; they are the weight of {kg:.3g} kg")
    if wish.friction_ratio is not None:
        lines.append(
            f"   press with {p['press_n']:.3g} N: force on the foot ({p['force_x_n']:.3g}, {p['force_z_n']:.3g}) N, "
            f"bears {p['bears_mm']:.3g} mm"
        )
    if wish.payload_n or wish.friction_ratio is not None:
        lines.append(f"   set the tip to x {p['set_x_mm']:.2f}, z {p['set_z_mm']:.2f} mm while it stands there")
    return lines
