"""`brace k`: the stiffness at a posture, or at many from a CSV file."""

from __future__ import annotations

import argparse
import contextlib
from typing import TYPE_CHECKING

from brace.cli import common, k_load
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from brace.model import LimbModel
    from brace.stiffness.at_rest import PostureError
    from brace.stiffness.play_under_load import Play

ARITHMETICS = ("f32", "fixed", "general")


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "k",
        help=SUBCOMMANDS["k"],
        description="K [N/mm], C [mm/N], eigenvalues [N/mm], stiff axis [rad] at a posture, computed by the firmware's "
        "own C. With --theta0 (or a theta0_rad column) in space, otherwise in the limb's plane. With --fx and --fz (or "
        "columns fx_n, fz_n), in space also --fy (fy_n), K under this load and the weights of [gravity], at the limb's "
        "equilibrium. Angles are commanded ones: the model's zero offsets are added; theta0, theta1 and phi lie within "
        "a full turn, theta2 in [-pi, pi]. Forces and the tip's displacement are in the limb's plane (x outwards, y to "
        "the left of it, z up), K in space in the robot's frame. --temp warms the joints as [thermal] says.",
    )
    common.add_model(parser)
    parser.add_argument("--theta0", type=common.angle, metavar="RAD", help="coxa yaw: K in space (3x3)")
    parser.add_argument("--theta1", type=common.angle, metavar="RAD", help="femur angle from +x")
    parser.add_argument("--theta2", type=common.flexion, metavar="RAD", help="knee flexion, 0 is straight")
    parser.add_argument("--r", type=common.positive_length, metavar="MM", help="tip distance, instead of the angles")
    parser.add_argument("--phi", type=common.angle, metavar="RAD", help="tip direction from +x, with --r")
    parser.add_argument("--knee", choices=("up", "down"), help="which posture reaches (r, phi); default up")
    k_load.add_load(parser)
    parser.add_argument(
        "--temp",
        type=common.temperature,
        metavar="DEGC",
        help="the joints' temperature, of every row with --csv; default: thermal.reference_degc of the model",
    )
    parser.add_argument(
        "--arith",
        choices=ARITHMETICS,
        default="f32",
        help="the controller's float path (default), its fixed-point path, or the general chain",
    )
    parser.add_argument(
        "--csv",
        type=common.path,
        metavar="IN",
        help="many postures: columns theta1_rad,theta2_rad[,theta0_rad][,fx_n[,fy_n],fz_n]",
    )
    parser.add_argument(
        "--out", type=common.path, metavar="OUT", help="with --csv: the same rows with K's columns added"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.model import load_limb
    from brace.model.temperature import at_temperature

    k_load.fill_in(arguments)
    _check_usage(arguments)
    model = load_limb(arguments.model)
    if arguments.temp is not None:
        model = at_temperature(model, arguments.temp)
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
    _check_one_posture(arguments)
    by_angles = arguments.theta1 is not None
    if by_angles and arguments.knee:
        raise UsageError("--knee with --theta2", why="the angles say it already", next_step="drop --knee")
    if arguments.theta0 is not None:
        k_load.refuse_in_space(arguments.arith, "--theta0")
    if arguments.is_loaded:
        k_load.refuse_load_with(arguments.arith)
    if arguments.fy is not None and arguments.theta0 is None:
        k_load.refuse_across_the_plane("--fy")


def _check_one_posture(arguments: argparse.Namespace) -> None:
    given = {
        name: value for name in ("theta1", "theta2", "r", "phi") if (value := getattr(arguments, name)) is not None
    }
    options = " and ".join(f"--{name}" for name in given)
    if set(given) in ({"theta1", "theta2"}, {"r", "phi"}):
        return
    if not given:
        raise UsageError(
            "no posture is given",
            why="K depends on it",
            next_step=f"brace k --model {arguments.model} --theta1 0.5 --theta2 1.2, or --r 400mm --phi -30deg, or "
            "--csv IN --out OUT",
        )
    if given.keys() & {"theta1", "theta2"} and given.keys() & {"r", "phi"}:
        raise UsageError(
            f"{options}: two ways to give the posture",
            why="joint angles and tip coordinates may contradict each other",
            next_step="keep --theta1 and --theta2, or --r and --phi",
        )
    other = {"theta1": "--theta2 RAD", "theta2": "--theta1 RAD", "r": "--phi RAD", "phi": "--r MM"}
    raise UsageError(
        f"{options} alone is half a posture",
        why="the limb has two joints in its plane",
        next_step=f"add {other[next(iter(given))]}",
    )


def _run_single(arguments: argparse.Namespace, model: LimbModel) -> int:
    import numpy as np

    from brace.cli.k_flags import flags_of_postures, outside
    from brace.stiffness import at_rest
    from brace.stiffness.in_space_under_load import LoadedLimbInSpace
    from brace.stiffness.under_load import LoadedLimb, stiffness_under_load, without_rest
    from brace.stiffness.with_gap import gaps_rad

    limb = at_rest.planar_limb(model, arguments.arith)
    try:
        if arguments.r is not None:
            true1, true2 = limb.posture(arguments.r, at_rest.within_half_turn(arguments.phi), arguments.knee or "up")
            offset1, offset2 = (float(a[0]) for a in limb.true_angles(np.zeros(1), np.zeros(1)))
            theta1, theta2 = true1 - offset1, true2 - offset2
        else:
            theta1, theta2 = arguments.theta1, arguments.theta2
            true1, true2 = (float(a[0]) for a in limb.true_angles(np.array([theta1]), np.array([theta2])))
            true1 = at_rest.within_half_turn(true1)
        r_mm, phi_rad = limb.polar(true1, true2)
        sigma: Mapping[str, float | None]
        if arguments.theta0 is not None and arguments.is_loaded:
            theta_rad = np.array([[arguments.theta0, theta1, theta2]])
            force_n = np.array([[arguments.fx, arguments.fy or 0.0, arguments.fz]])
            in_space = LoadedLimbInSpace(model)
            result = in_space.stiffness(theta_rad, force_n)
            if without_rest(result)[0]:
                raise in_space.refusal(0)
            sigma = in_space.sigma(theta_rad, force_n)
        elif arguments.theta0 is not None:
            result = at_rest.spatial_stiffness(model, *(np.array([a]) for a in (arguments.theta0, theta1, theta2)))
            theta_rad = np.array([[arguments.theta0, theta1, theta2]])
            sigma = LoadedLimbInSpace(model, is_weightless=True).sigma(theta_rad, np.zeros((1, 3)))
        elif arguments.is_loaded:
            given = (true1, true2, arguments.fx, arguments.fz)
            result = stiffness_under_load(model, *(np.array([value]) for value in given), arithmetic=arguments.arith)
            if without_rest(result)[0]:
                raise LoadedLimb(model, arguments.arith).refusal(0, *given)
            sigma = LoadedLimb(model).sigma(*given)
        else:
            result = limb.stiffness(np.array([true1]), np.array([true2]))
            sigma = limb.sigma(true1, true2)
    except at_rest.PostureError as error:
        raise _refused(error, arguments, model) from None
    values = {name: result[name][0].item() + 0 for name in result.dtype.names or ()}  # -0 is 0
    posture = {
        "theta1_rad": theta1,
        "theta2_rad": theta2,
        "theta1_true_rad": true1,
        "theta2_true_rad": true2,
        "r_mm": r_mm,
        "phi_rad": phi_rad,
        "knee": "down" if true2 < 0 else "up",
    }
    if arguments.theta0 is not None:
        posture["theta0_rad"] = arguments.theta0
    if arguments.temp is not None:
        posture["temp_degc"] = arguments.temp
    if arguments.is_loaded:
        across = {"fy_n": arguments.fy or 0.0} if arguments.theta0 is not None else {}
        posture |= {"fx_n": arguments.fx, **across, "fz_n": arguments.fz}
    under_load = "loaded, fixed" if arguments.arith == "fixed" else "loaded"
    path = under_load if arguments.is_loaded else "spatial" if arguments.theta0 is not None else limb.path
    unloaded = arguments.theta0 is None and not arguments.is_loaded
    while_open = _while_open(model, true1, true2, values) if unloaded else {}
    names: tuple[str, ...] = ("theta0_rad", "theta1_rad", "theta2_rad")
    commanded = {name: float(posture[name]) for name in names if name in posture}
    at = {name: np.array([angle]) for name, angle in commanded.items()}
    values["flags"] |= int(flags_of_postures(model, at, unloaded=unloaded)[0])
    play = _play(model, (theta1, theta2), (true1, true2), values, arguments)
    if play and play.open:
        sigma = {}  # of K with every gap closed
    free = _both_open(gaps_rad(model), while_open)
    if arguments.json:
        common.print_json(
            {
                **values,
                "while_open": while_open,
                "open": free,
                **({"held": play.held, "engaged": play.engaged} if play else {}),
                "flag_names": at_rest.flag_names(values["flags"]),
                **sigma,
                **posture,
                "arith": path,
                "model": model.name,
            }
        )
    else:
        common.emit(_text(model.name, values, sigma, posture, path, at_rest.flag_names(values["flags"])))
        for joint, gap_rad in gaps_rad(model, arguments.theta0 is not None).items():
            common.emit(_gap_text(joint, gap_rad, while_open.get(joint), is_told=play is not None))
        for line in _play_text(gaps_rad(model), free, arguments, play):
            common.emit(line)
        if reported := outside(model, commanded):
            common.say(reported)
    return 0


def _both_open(gaps: dict[str, float], while_open: dict[str, dict[str, float]]) -> dict[str, float]:
    """K with every gap open, the lower bound: what a controller reports while no load is seen. Empty without play, or
    where it is not known."""
    from brace.stiffness.names import PLANAR_K

    if not while_open or len(while_open) < len(gaps):
        return {}
    if len(gaps) == 1:
        return {name: next(iter(while_open.values()))[name] for name in PLANAR_K}
    return dict.fromkeys(PLANAR_K, 0.0)


def _play(
    model: LimbModel,
    commanded_rad: tuple[float, float],
    true_rad: tuple[float, float],
    values: dict[str, float],
    arguments: argparse.Namespace,
) -> Play | None:
    """Which play the load takes up; K of now goes into `values`."""
    from brace.stiffness.play_under_load import PlayInSpaceUnderLoad, PlayUnderLoad, put_into

    if not arguments.is_loaded:
        return None
    if arguments.theta0 is None:
        play = PlayUnderLoad(model, arguments.arith).at(*true_rad, arguments.fx, arguments.fz)
    else:
        force_n = (arguments.fx, arguments.fy or 0.0, arguments.fz)
        play = PlayInSpaceUnderLoad(model).at((arguments.theta0, *commanded_rad), force_n)
    if play:
        put_into(values, play)
    return play


def _play_text(
    gaps: dict[str, float], free: dict[str, float], arguments: argparse.Namespace, play: Play | None
) -> list[str]:
    """Which of the two K holds."""
    if play:
        sides = {joint: "+" if side > 0 else "-" for joint, side in play.held.items()}
        lines = [
            f"           this load holds the {joint} on its {side} side"
            + (
                "; nothing has proven it (PLAY_ASSUMED)"
                if joint in play.assumed
                else ": its motor's torque proves it in a controller there"
            )
            for joint, side in sides.items()
        ]
        for joint in play.open:
            lines.append(
                f"           this load does not hold the {joint}: its gap is open, and K above is that of the open gap; "
                f"brace take-up {joint}- --bus URL (or {joint}+) takes it up"
            )
        if play.open:
            shown = ("xx", "xz", "zz") if arguments.theta0 is None else ("xx", "xy", "xz", "yy", "yz", "zz")
            once = ", ".join(f"{play.engaged[f'k_{entry}_n_per_mm']:.6g}" for entry in shown)
            lines.append(f"           once all is taken up K = {once} N/mm ({', '.join(shown)})")
        return lines
    if not gaps or arguments.theta0 is not None or not free:
        return []
    entries = ", ".join(f"{value:.6g}" for value in free.values())
    return [
        f"bounds     K without a load, every gap open: {entries} N/mm (a controller tells this, with GAP_OPEN); once "
        "a load "
        "has taken up the play: the K above"
    ]


def _while_open(
    model: LimbModel, theta1_rad: float, theta2_rad: float, engaged: dict[str, float]
) -> dict[str, dict[str, float]]:
    """K for each joint's open gap. A joint is missing where the tip lies on its axis."""
    from brace.stiffness.at_rest import PostureError
    from brace.stiffness.with_gap import gaps_rad, stiffness_while_open

    found = {}
    for joint in gaps_rad(model):
        with contextlib.suppress(PostureError):
            found[joint] = stiffness_while_open(model, theta1_rad, theta2_rad, engaged, joint)
    return found


def _gap_text(joint: str, gap_rad: float, k: dict[str, float] | None, *, is_told: bool) -> str:
    import math

    size = f"{gap_rad:g} rad ({math.degrees(gap_rad):.3g} deg)"
    if is_told:
        return f"backlash  joint.{joint} {size}"
    head = f"backlash  joint.{joint} {size}: the K above holds once it is taken up"
    if k is None:
        return head
    entries = ", ".join(f"{k[f'k_{entry}_n_per_mm']:.6g}" for entry in ("xx", "xz", "zz"))
    return head + (
        f"\n           while it is open K = {entries} N/mm "
        f"(xx, xz, zz), eigenvalues {k['lambda_min_n_per_mm']:.6g} and {k['lambda_max_n_per_mm']:.6g}"
    )


def _refused(error: PostureError, arguments: argparse.Namespace, model: LimbModel) -> UsageError:
    from brace.stiffness.at_rest import E_SINGULAR, E_UNREACHABLE

    if error.status == E_UNREACHABLE:
        femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
        return UsageError(
            f"--r {arguments.r:g} is out of reach",
            why=error.text,
            next_step=f"{abs(femur - tibia):g} <= r <= {femur + tibia:g} mm",
        )
    given = ("theta0", "theta1", "theta2", "r", "phi")
    options = " ".join(
        f"--{name} {getattr(arguments, name):g}" for name in given if getattr(arguments, name) is not None
    )
    if error.status == E_SINGULAR and arguments.is_loaded:
        return UsageError(
            f"{options}: no K under {arguments.fx:g} N along x and {arguments.fz:g} N along z"
            + (f", {arguments.fy:g} N across" if arguments.fy else ""),
            where=model.where("link"),
            why=error.text,
            next_step="a smaller force or another posture; leave --fx, --fy and --fz out for K without load",
        )
    if error.status == E_SINGULAR:
        return UsageError(
            f"{options}: C is singular at this posture",
            where=model.where("link"),
            why=error.text,
            next_step="another posture, or give the links their axial_mm_per_n (in space lateral_mm_per_n too)",
        )
    return UsageError(
        f"{options}: this posture is refused",
        why=error.text,
        next_step="theta2 in [-pi, pi] rad, the others within a full turn; zero offsets count",
    )


def _plus_minus(sigma: float | None, unit: str) -> str:
    return "" if sigma is None else f" +- {sigma:.2g}{unit}"


def _sigma_text(sigma: Mapping[str, float | None]) -> list[str]:
    """Of the entries of K; what +- means, in words. Nothing where K itself is nearly singular."""
    entries = {
        name.removeprefix("sigma_k_").removesuffix("_n_per_mm"): value
        for name, value in sigma.items()
        if name.startswith("sigma_k_")
    }
    if None in entries.values():
        return ["  one sigma is not known: a limb that differs by a quarter of a sigma has no K here"]
    reported = ", ".join(f"{name} {value:.2g}" for name, value in entries.items())
    return [f"  +- one sigma, from [uncertainty]: {reported}"] if entries else []


def _text(
    name: str,
    values: dict[str, float],
    sigma: Mapping[str, float | None],
    posture: dict[str, float | str],
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
        f"{key} = {posture[key + '_rad']:.6g} rad" for key in ("theta0", "theta1", "theta2") if key + "_rad" in posture
    )
    how = "before the load moves it" if "buckling_factor" in values else path
    how += f"; joints at {posture['temp_degc']:g} degC" if "temp_degc" in posture else ""
    lines = [f"{name}: {angles}; tip at r = {posture['r_mm']:.5g} mm, phi = {posture['phi_rad']:.5g} rad ({how})"]
    if "buckling_factor" in values:
        force = ", ".join(f"{posture[f'f{axis}_n']:g}" for axis in axes)
        moved = ", ".join(f"{values[f'tip_d{axis}_mm']:.4g}" for axis in axes)
        factor = values["buckling_factor"]
        lines.append(
            f"under the ground's force on the tip ({force}) N and the limb's weight: tip moves ({moved}) mm, "
            + "buckling factor "
            + (f"{factor:.3g}" if math.isfinite(factor) else "above 11")
            + (": the load makes the limb much softer" if factor < k_load.SOFTENED else "")
        )
    lines += ["K [N/mm]", *matrix("k", "n_per_mm"), *_sigma_text(sigma), "C [mm/N]", *matrix("c", "mm_per_n")]
    eigen = [
        f"lambda_{which} {values[f'lambda_{which}_n_per_mm']:.6g}"
        + _plus_minus(sigma.get(f"sigma_lambda_{which}_n_per_mm"), "")
        for which in (("min", "mid", "max") if spatial else ("min", "max"))
    ]
    lines.append("eigenvalues [N/mm]  " + "   ".join(eigen))
    if spatial:
        lines.append("stiff axis  ({stiff_axis_x:.5f}, {stiff_axis_y:.5f}, {stiff_axis_z:.5f})".format(**values))
    else:
        axis = values["stiff_axis_rad"]
        lines.append(
            f"stiff axis {axis:.6g} rad ({math.degrees(axis):.2f} deg)"
            + _plus_minus(sigma.get("sigma_stiff_axis_rad"), " rad")
        )
    lines.append("flags  " + (", ".join(flags) if flags else "none"))
    return "\n".join(lines)
