"""`brace export`: a limb for the simulators and for the C programs that people have."""

from __future__ import annotations

import argparse
from pathlib import Path

from brace.cli import common
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "export",
        help=SUBCOMMANDS["export"],
        description="Writes the limb as const C data for a program that has Brace's core; in its plane as a MuJoCo "
        "model whose servos and springs give its K; or its lengths, travel, weights and friction as a URDF. What the "
        "format has no words for is said.",
    )
    common.add_model(parser)
    parser.add_argument(
        "--c", type=common.path, metavar="FILE.c", help="C source, and a header beside it; the stem names the limb in C"
    )
    parser.add_argument(
        "--arith",
        choices=("f32", "fixed"),
        default="f32",
        help="constants of --c; fixed: for a processor without an FPU",
    )
    parser.add_argument("--mujoco", type=common.path, metavar="FILE.xml", help="MuJoCo model (MJCF)")
    parser.add_argument("--urdf", type=common.path, metavar="FILE.urdf", help="URDF; compliances stand in a comment")
    parser.add_argument(
        "--theta1", type=common.angle, metavar="RAD", help="of the MuJoCo model's keyframe; default 0.7"
    )
    parser.add_argument("--theta2", type=common.flexion, metavar="RAD", help="default 1.4")
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.export import c_source, mujoco_model, urdf_model
    from brace.ground.errors import UsageError
    from brace.ground.files import OutputSet
    from brace.model import load_limb

    if arguments.c is None and arguments.mujoco is None and arguments.urdf is None:
        raise UsageError(
            "none of --c, --mujoco and --urdf",
            why="one of them is to be written",
            next_step=f"brace export --model {arguments.model} --c limb.c, or --mujoco limb.xml, or --urdf limb.urdf",
        )
    model = load_limb(arguments.model)
    theta1 = 0.7 if arguments.theta1 is None else arguments.theta1
    theta2 = 1.4 if arguments.theta2 is None else arguments.theta2
    written: list[Path] = []
    left_out: set[str] = set()
    with OutputSet([arguments.model]) as outputs:
        if arguments.c is not None:
            c = c_source.c_files(model, arguments.c, arguments.arith == "fixed")
            outputs.add(arguments.c, c.source)
            outputs.add(arguments.c.with_name(c.header_name), c.header)
            written += [arguments.c, arguments.c.with_name(c.header_name)]
            left_out.update(c.left_out)
        if arguments.mujoco is not None:
            outputs.add(arguments.mujoco, mujoco_model.model_xml(model, theta1, theta2))
            written.append(arguments.mujoco)
        if arguments.urdf is not None:
            outputs.add(arguments.urdf, urdf_model.model_xml(model))
            written.append(arguments.urdf)
        outputs.commit()
    if arguments.mujoco is not None or arguments.urdf is not None:
        left_out.update(_left_out(model.number))
    if arguments.json:
        common.print_json({"written": written, "left_out": sorted(left_out)})
        return 0
    for key in sorted(left_out):
        common.say(f"{key} is left out: the format has no word for it")
    common.say(f"-> {', '.join(map(str, written))}")
    return 0


def _left_out(number: object) -> list[str]:
    """Keys of the limb that neither format holds."""
    keys = [f"joint.{joint}.{key}" for joint in ("femur", "tibia") for key in ("gap_rad", "hardening_n_mm_per_rad3")]
    keys += ["creep.ratio", "thermal.joint_compliance_per_degc", "contact.play_mm"]
    return [key for key in keys if callable(number) and number(key) != 0.0]
