"""`brace k`: the stiffness at a posture, or at many from a CSV file."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from brace.cli import common
from brace.errors import UsageError

ARITHMETICS = ("f32", "fixed", "general", "table")


def add(commands: Any) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "k",
        help="K, C, eigenvalues and stiff axis at a posture",
        description="K [N/mm], C [mm/N], eigenvalues [N/mm], stiff axis [rad] at a posture, computed by the firmware's "
        "own C. With --theta0 (or a theta0_rad column) in space, otherwise in the limb's plane. Angles are "
        "commanded ones: the model's zero offsets are added.",
    )
    common.add_model(parser)
    parser.add_argument("--theta0", type=common.number, metavar="RAD", help="coxa yaw: K in space (3x3)")
    parser.add_argument("--theta1", type=common.number, metavar="RAD", help="femur angle from +x")
    parser.add_argument("--theta2", type=common.number, metavar="RAD", help="knee flexion, 0 is straight")
    parser.add_argument("--r", type=common.positive, metavar="MM", help="tip distance, instead of the angles")
    parser.add_argument("--phi", type=common.number, metavar="RAD", help="tip direction from +x, with --r")
    parser.add_argument("--knee", choices=("up", "down"), help="which posture reaches (r, phi); default up")
    parser.add_argument(
        "--arith",
        choices=ARITHMETICS,
        default="f32",
        help="the controller's float path (default), its fixed-point path, the general chain, the table",
    )
    parser.add_argument(
        "--csv", type=Path, metavar="IN", help="many postures: columns theta1_rad,theta2_rad[,theta0_rad]"
    )
    parser.add_argument(
        "--out", type=Path, metavar="OUT", help="with --csv: the same rows with K's columns added"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.model import load_limb

    _check_usage(arguments)
    model = load_limb(arguments.model)
    if arguments.csv is not None:
        from brace.cli.k_table import run_table

        return run_table(arguments, model)
    return _run_single(arguments, model)


def _check_usage(arguments: argparse.Namespace) -> None:
    angles = [arguments.theta1, arguments.theta2]
    polar = [arguments.r, arguments.phi]
    if arguments.csv is not None:
        if any(value is not None for value in (*angles, *polar, arguments.theta0, arguments.knee)):
            raise UsageError(
                "--csv and a single posture",
                why="the postures come from one or the other",
                next_step="drop --theta0/1/2, --r, --phi, --knee or --csv",
            )
        if arguments.out is None:
            raise UsageError("--csv without --out", why="the result is a file", next_step="add --out OUT.csv")
        return
    if arguments.out is not None:
        raise UsageError(
            "--out without --csv",
            why="a single posture is printed, not written",
            next_step="use --json, or --csv IN --out OUT",
        )
    by_angles, by_polar = all(v is not None for v in angles), all(v is not None for v in polar)
    if by_angles == by_polar or (any(v is not None for v in angles) and any(v is not None for v in polar)):
        raise UsageError(
            "no posture, or half of one, or two",
            why="one posture is needed",
            next_step="--theta1 RAD --theta2 RAD, or --r MM --phi RAD [--knee up|down]",
        )
    if by_angles and arguments.knee:
        raise UsageError("--knee with --theta2", why="the angles say it already", next_step="drop --knee")
    if arguments.theta0 is not None and arguments.arith != "f32":
        raise UsageError(
            f"--arith {arguments.arith} with --theta0",
            why="K in space is computed in float only",
            next_step="drop --arith or --theta0",
        )


def _run_single(arguments: argparse.Namespace, model: Any) -> int:
    import numpy as np

    from brace import stiffness

    limb = stiffness.planar_limb(model, arguments.arith)
    try:
        if arguments.r is not None:
            true1, true2 = limb.posture(arguments.r, arguments.phi, arguments.knee or "up")
            offset1, offset2 = (float(a[0]) for a in limb.true_angles(np.zeros(1), np.zeros(1)))
            theta1, theta2 = true1 - offset1, true2 - offset2
        else:
            theta1, theta2 = arguments.theta1, arguments.theta2
            true1, true2 = (float(a[0]) for a in limb.true_angles(np.array([theta1]), np.array([theta2])))
        r_mm, phi_rad = limb.polar(true1, true2)
        if arguments.theta0 is not None:
            result = stiffness.spatial_stiffness(
                model, *(np.array([a]) for a in (arguments.theta0, theta1, theta2))
            )
            sigma: dict[str, float] = {}
        else:
            result = limb.stiffness(np.array([true1]), np.array([true2]))
            sigma = limb.sigma(true1, true2)
    except stiffness.PostureError as error:
        raise _refused(error, arguments, model) from None
    values = {name: result[name][0].item() for name in result.dtype.names or ()}
    posture = {
        "theta1_rad": theta1,
        "theta2_rad": theta2,
        "theta1_true_rad": true1,
        "theta2_true_rad": true2,
        "r_mm": r_mm,
        "phi_rad": phi_rad,
        "knee": "down" if theta2 < 0 else "up",
    }
    if arguments.theta0 is not None:
        posture["theta0_rad"] = arguments.theta0
    path = "spatial" if arguments.theta0 is not None else limb.path
    if arguments.json:
        common.print_json(
            {
                **values,
                "flag_names": stiffness.flag_names(values["flags"]),
                **sigma,
                **posture,
                "arith": path,
                "model": model.name,
            }
        )
    else:
        print(_text(model.name, values, sigma, posture, path, stiffness.flag_names(values["flags"])))
    return 0


def _refused(error: Any, arguments: argparse.Namespace, model: Any) -> UsageError:
    from brace.stiffness import E_UNREACHABLE

    if error.status == E_UNREACHABLE:
        femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
        return UsageError(
            f"r = {arguments.r:g} mm is out of reach",
            why=error.text,
            next_step=f"{abs(femur - tibia):g} <= r <= {femur + tibia:g} mm",
        )
    return UsageError(
        "this posture is refused",
        why=error.text,
        next_step="angles in [-pi, pi] rad; --theta1 is not " "in degrees",
    )


def _text(
    name: str,
    values: dict[str, Any],
    sigma: dict[str, float],
    posture: dict[str, Any],
    path: str,
    flags: list[str],
) -> str:
    import math

    spatial = "k_yy_n_per_mm" in values
    axes = "xyz" if spatial else "xz"

    def matrix(letter: str, unit: str) -> list[str]:
        names = [[f"{letter}_{''.join(sorted(a + b))}_{unit}" for b in axes] for a in axes]
        return ["  " + "  ".join(f"{values[n]:13.6g}" for n in row) for row in names]

    angles = ", ".join(
        f"{key} = {posture[key + '_rad']:.6g} rad"
        for key in ("theta0", "theta1", "theta2")
        if key + "_rad" in posture
    )
    lines = [
        f"{name}: {angles}; tip at r = {posture['r_mm']:.5g} mm, phi = {posture['phi_rad']:.5g} rad ({path})"
    ]
    lines += ["K [N/mm]", *matrix("k", "n_per_mm"), "C [mm/N]", *matrix("c", "mm_per_n")]
    eigen = [
        f"lambda_{which} {values[f'lambda_{which}_n_per_mm']:.6g}"
        + (f" +- {sigma[f'sigma_lambda_{which}_n_per_mm']:.2g}" if sigma else "")
        for which in (("min", "mid", "max") if spatial else ("min", "max"))
    ]
    lines.append("eigenvalues [N/mm]  " + "   ".join(eigen))
    if spatial:
        lines.append(
            "stiff axis  ({stiff_axis_x:.5f}, {stiff_axis_y:.5f}, {stiff_axis_z:.5f})".format(**values)
        )
    else:
        axis = values["stiff_axis_rad"]
        lines.append(
            f"stiff axis {axis:.6g} rad ({math.degrees(axis):.2f} deg)"
            + (f" +- {sigma['sigma_stiff_axis_rad']:.2g} rad" if sigma else "")
        )
    lines.append("flags  " + (", ".join(flags) if flags else "none"))
    return "\n".join(lines)
