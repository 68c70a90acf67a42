"""`brace new`: a limb.toml from what people know of their limb."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING, cast

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError

if TYPE_CHECKING:
    from brace.newlimb.describe import Known
    from brace.newlimb.quantity import Joint, Link
    from brace.newlimb.urdf import UrdfLeg

PLANE = ("femur", "tibia")
NEEDED = {  # option: what is asked, and an example
    "femur": ("the femur's length (hip axis to knee axis)", "185"),
    "tibia": ("the tibia's length (knee axis to tip)", "313.5"),
    "femur_link": ("what the femur is", "'tube 20 16 aluminium'"),
    "tibia_link": ("what the tibia is", "'rod 12 cfrp'"),
    "femur_joint": ("the stiffness of the femur's joint, a servo's name, or unknown", "'60 N m/rad'"),
    "tibia_joint": ("the stiffness of the knee, a servo's name, or unknown", "'60 N m/rad'"),
}
OPTIONAL = {
    "femur_play": ("full play of the femur's gear, or unknown", "20arcmin"),
    "tibia_play": ("full play of the knee's gear, or unknown", "20arcmin"),
    "femur_travel": ("travel of the femur from +x, or unknown", "-60deg 90deg"),
    "tibia_travel": ("travel of the knee, 0 is straight, or unknown", "10deg 140deg"),
}


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    from brace.newlimb import LINK_FORMS

    parser = commands.add_parser(
        "new",
        help=SUBCOMMANDS["new"],
        description="Asks for what is known of a limb, or takes it as options, and writes a commented limb.toml; "
        "says which "
        "K to expect, how far it may be off, and what is only a guess. Without a terminal nothing is asked. "
        f"A link is {LINK_FORMS}. A joint is its stiffness in N m/rad, a servo's name, rigid, or unknown.",
        epilog="Exit codes: 0 written, 2 something is missing or not possible, 3 the URDF cannot be read.",
    )
    parser.add_argument("--out", type=common.path, required=True, metavar="LIMB.toml", help="the file to write")
    parser.add_argument("--name", metavar="NAME", help="default: the file's name")
    parser.add_argument(
        "--urdf", type=common.path, metavar="FILE", help="lengths and travel of its two or three joints"
    )
    parser.add_argument("--urdf-tip", default="", metavar="LINK", help="the link whose origin is the foot")
    parser.add_argument(
        "--urdf-frame",
        choices=("robot", "leg"),
        default="robot",
        help="z of the limb: the robot's z (default), or the first joint's axis and the leg's own plane",
    )
    for name in (*PLANE, "coxa"):
        parser.add_argument(f"--{name}", metavar="MM", help=f"length of the {name}; 185, 0.185m" if name != "coxa" else
                            "distance of the yaw axis, for a limb in space")  # fmt: skip
    for name in (*PLANE, "coxa"):
        parser.add_argument(f"--{name}-link", metavar="LINK", help=f"what the {name} is")
        parser.add_argument(
            f"--{name}-joint",
            metavar="STIFFNESS",
            help="60, '60 N m/rad', XM430-W350, 'MX-106 P1200 14.8V' (servo, gain, supply), rigid, unknown",
        )
        parser.add_argument(f"--{name}-play", metavar="ANGLE", help="full play: 20arcmin, 0.3deg, none")
        parser.add_argument(f"--{name}-travel", metavar="ANGLE", nargs=2, help="from and to: -60deg 90deg")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.cli.new_questions import ask, has_terminal
    from brace.ground.files import check_file, write_file
    from brace.newlimb import describe

    _refuse_existing(arguments.out)
    check_file(arguments.out)
    leg = _fill_from_urdf(arguments) if arguments.urdf is not None else None
    missing = [name for name in NEEDED if getattr(arguments, name) is None]
    if missing and has_terminal():
        ask(arguments, {**NEEDED, **OPTIONAL}, lambda name, text: _check(arguments, name, text))
        missing = []
    if missing:
        raise UsageError(
            "missing: " + ", ".join(_option(name) for name in missing),
            why=f"{_option(missing[0])} is {NEEDED[missing[0]][0]}; there is no terminal to ask at",
            next_step=" ".join(f"{_option(name)} {NEEDED[name][1]}" for name in missing),
        )
    known = _known(arguments, leg)
    model = describe.model(known, arguments.out)
    reported = _expected(known, model)
    write_file(arguments.out, describe.text(known))
    if arguments.json:
        common.print_json(
            {**reported, "guesses": describe.guesses(known), "out": arguments.out, "urdf": _leg_json(leg)}
        )
        return 0
    common.emit(_text(known, reported))
    for sentence in describe.guesses(known):
        common.emit(f"  {sentence}")
    common.say(f"-> {arguments.out}; brace k --model {arguments.out} --theta1 ... --theta2 ... shows K at a posture")
    return 0


def _refuse_existing(path: Path) -> None:
    if path.exists():
        raise UsageError(
            "there is a file of this name",
            where=str(path),
            why="a limb that was described, perhaps calibrated, is not overwritten",
            next_step="another --out, or remove the file first",
        )


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _naming(name: str, error: UsageError) -> UsageError:
    """The refusal with the option that it is about."""
    error.what = f"{_option(name)}: {error.what}"
    return error


def _check(arguments: argparse.Namespace, name: str, text: str) -> object:
    """Reads one answer; raises UsageError where it cannot be."""
    from brace.newlimb import quantity

    try:
        if name == "coxa":
            return quantity.offset_mm(text)
        if name in PLANE:
            return quantity.length_mm(text)
        if name.endswith("_link"):
            part = name.partition("_")[0]
            length = quantity.offset_mm if part == "coxa" else quantity.length_mm
            return quantity.link(text, length(str(getattr(arguments, part) or "200")))
        if name.endswith("_joint"):
            return quantity.joint(text)
        if name.endswith("_play"):
            return None if text.lower() == "unknown" else quantity.play_rad(text)
        pair = text if isinstance(text, list) else re.split(r"\s+to\s+|\s*\.\.\s*|\s+(?=[-+\d])", text.strip())
        if pair[0].lower() == "unknown":
            return None
        if len(pair) != 2:
            raise quantity.refusal(f"{text!r} is not a range", "a range is two angles", "-60deg 90deg")
        low, high = (quantity.angle_rad(end) for end in pair)
        if not low < high:
            raise quantity.refusal(
                f"{' '.join(pair)} is not a range", "the smaller angle comes first", f"{pair[1]} {pair[0]}"
            )
        return low, high
    except UsageError as error:
        raise _naming(name, error) from None


def _leg_json(leg: UrdfLeg | None) -> dict[str, object] | None:
    """The limb's axes in the robot's frame, and theta = zero_rad + sign * the joint's angle."""
    if leg is None:
        return None
    axes = {name: [float(part) for part in axis] for name, axis in vars(leg.frame).items()}
    return {"axes_of_robot": axes, "angles": {name: vars(angle) for name, angle in leg.angles.items()}}


def _known(arguments: argparse.Namespace, leg: UrdfLeg | None) -> Known:
    from brace.newlimb.describe import Known

    given = {name: value for name, value in vars(arguments).items() if value is not None}
    names = [name for name in ("coxa", *PLANE) if name in PLANE or any(key.startswith("coxa") for key in given)]
    said: dict[str, dict[str, object]] = {kind: {} for kind in ("", "_link", "_joint", "_play", "_travel")}
    for name in names:
        for kind, values in said.items():
            value = _check(arguments, name + kind, given[name + kind]) if name + kind in given else None
            if value is not None:
                values[name] = value
    lengths = cast("dict[str, float]", said[""])
    if "coxa" in names:
        lengths.setdefault("coxa", 0.0)
    return Known(
        arguments.name or arguments.out.stem,
        lengths,
        cast("dict[str, Link]", said["_link"]),
        cast("dict[str, Joint]", said["_joint"]),
        cast("dict[str, float | None]", said["_play"]),
        cast("dict[str, tuple[float, float]]", said["_travel"]),
        arguments.urdf.name if arguments.urdf else "",
        tuple(leg.notes) if leg else (),
        leg.down if leg else None,
    )


def _expected(known: Known, model: object) -> dict[str, object]:
    """K at one posture, with its uncertainty, by the firmware's own C."""
    import numpy as np

    from brace.model import LimbModel
    from brace.newlimb.describe import compliance_rel, posture_rad
    from brace.stiffness.at_rest import PostureError, planar_limb
    from brace.stiffness.names import PLANAR_K

    assert isinstance(model, LimbModel)
    theta1, theta2 = posture_rad(known)
    limb = planar_limb(model)
    try:
        found = limb.stiffness(np.array([theta1]), np.array([theta2]))
    except PostureError as error:
        raise UsageError(
            "this limb is rigid in some direction: its K there is infinite",
            why=error.text,
            next_step="a stiffness for the joints, or 'measured BENDING AXIAL' for a link",
        ) from None
    names = (*PLANAR_K, "lambda_min_n_per_mm", "lambda_max_n_per_mm")
    reported: dict[str, object] = {name: float(found[name][0]) for name in names}
    return {
        "theta1_rad": theta1, "theta2_rad": theta2, **reported, **limb.sigma(theta1, theta2),
        "compliance_rel": compliance_rel(known),
    }  # fmt: skip


def _text(known: Known, reported: dict[str, object]) -> str:
    from brace.newlimb.describe import play_rad

    rel = 100 * float(str(reported["compliance_rel"]))
    entries = [
        f"k_{entry} {reported[f'k_{entry}_n_per_mm']:.3g} +- {reported[f'sigma_k_{entry}_n_per_mm']:.2g}"
        for entry in ("xx", "xz", "zz")
    ]
    return (
        f"{known.name}: expect this K [N/mm] at theta1 = {reported['theta1_rad']:.3g} rad, theta2 = "
        f"{reported['theta2_rad']:.3g} rad: {', '.join(entries)} (one sigma: compliances may be off by {rel:.0f} %)"
        + (
            "".join(
                f"\n  while the play of the {name} is open, K is smaller: brace k shows how much"
                for name in known.joints
                if play_rad(known, name)
            )
        )  # fmt: skip
    )


def _fill_from_urdf(arguments: argparse.Namespace) -> UrdfLeg:
    """What the URDF says and no option does."""
    from brace.newlimb.urdf import read_leg

    given = {name for name, value in vars(arguments).items() if value is not None}
    in_space = any(name.startswith("coxa") for name in given)
    leg = read_leg(arguments.urdf, arguments.urdf_tip, in_space, arguments.urdf_frame, given)
    for name, value in leg.options.items():
        if name not in given:
            setattr(arguments, name, value)
    return leg
