"""`brace map`: K over the whole workspace, as pictures and tables."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict

from brace.cli import common, k_load
from brace.cli.options import Subcommands
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from brace.model import LimbModel
    from brace.stiffness.workspace import Workspace


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "map",
        help=SUBCOMMANDS["map"],
        description="Computes K over a grid of postures and writes into --out: map.png and map.svg (eigenvalues over "
        "r, ellipses), eigenvalues.csv (a row per theta2), ellipses.csv (the drawn ones). Says where "
        "the eigenvalues rise and fall with reach. With --fx and --fz K under this load and the limb's weight at the "
        "rest; theta1 and "
        "theta2 are then the commanded angles, and the tip's displacement and the buckling factor come with it.",
    )
    common.add_model(parser)
    parser.add_argument(
        "--out", type=common.path, default=Path("brace-map"), metavar="DIR", help="default: brace-map"
    )
    parser.add_argument(
        "--postures",
        type=common.count(100, 50_000_000),
        default=100_000,
        metavar="N",
        help="number of postures, default 100000",
    )
    parser.add_argument(
        "--theta1",
        type=common.angle,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="range of the true femur angle [rad]; default: its travel, or -pi/2 pi/2",
    )
    parser.add_argument(
        "--theta2",
        type=common.angle,
        nargs=2,
        metavar=("LOW", "HIGH"),
        help="range of the true knee angle [rad]; default: its travel, or 0 pi",
    )
    k_load.add_load(parser, in_space=False)
    parser.add_argument(
        "--npy", action="store_true", help="also every posture, as postures.npy (float32, named columns)"
    )
    common.add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    from brace.ground.files import OutputSet, check_folder
    from brace.model import load_limb
    from brace.stiffness import workspace
    from brace.stiffness.play_under_load import held_ratio
    from brace.stiffness.with_gap import gaps_rad

    for name in ("theta1", "theta2"):
        if getattr(arguments, name) is None:
            continue
        low, high = getattr(arguments, name)
        if not -math.pi - 1e-5 <= low < high <= math.pi + 1e-5:
            raise UsageError(
                f"--{name} {low:g} {high:g} is no range",
                why="low comes before high, both in rad within [-pi, pi], not in degrees",
                next_step=f"--{name} -1.5 1.5",
            )
    k_load.fill_in(arguments)
    force_n = None if arguments.fx is None else (arguments.fx, arguments.fz)
    model = load_limb(arguments.model)
    _fill_in_travel(arguments, model)
    check_folder(arguments.out, ["map.png"], [arguments.model])
    with common.progress("K over the workspace", arguments.postures) as advance:
        grid = workspace.compute(
            model, arguments.postures, tuple(arguments.theta1), tuple(arguments.theta2), advance, force_n
        )
    summary = _summary(model.name, grid)
    load = {} if force_n is None else {"fx_n": force_n[0], "fz_n": force_n[1], **_under_load(grid)}
    with OutputSet([arguments.model]) as outputs:
        title = model.name if force_n is None else f"{model.name} under ({force_n[0]:g}, {force_n[1]:g}) N"
        for name, content in _files(model, grid, arguments.npy, title):
            outputs.add(arguments.out / name, content)
        outputs.commit()
    held = {} if force_n is None else held_ratio(model, grid.postures_rad, force_n)
    if arguments.json:
        play = {"play_rad": gaps_rad(model), **({"play_held_ratio": held} if held else {})}
        common.print_json({**summary, **load, **play, "out": arguments.out})
    else:
        common.emit(_text(summary, arguments.out))
        for joint, gap_rad in gaps_rad(model).items():
            common.emit(
                f"backlash of the {joint}, {math.degrees(gap_rad):.3g} deg: K of this map holds once a load has "
                "taken it up; "
                "until then the limb is free in one direction (lambda_min 0): brace k shows K while it is open"
                + (f"; this load holds it at {100 * held[joint]:.3g} % of the postures" if joint in held else "")
            )
        if load:
            common.emit(_load_text(load))
    return 0


def _fill_in_travel(arguments: argparse.Namespace, model: LimbModel) -> None:
    """Ranges that are not asked for are the travel, where limb.toml gives one; what is asked for beyond it is said."""
    from brace.model.travel import has_travel, travel_rad

    for joint, name, default in (("femur", "theta1", (-math.pi / 2, math.pi / 2)), ("tibia", "theta2", (0.0, math.pi))):
        offset = model.number(f"joint.{joint}.zero_offset_rad")
        low, high = (min(max(end + offset, -math.pi), math.pi) for end in travel_rad(model, joint))
        asked = getattr(arguments, name)
        if asked is None:
            setattr(arguments, name, (low, high) if has_travel(model, joint) else default)
        elif has_travel(model, joint) and (asked[0] < low - 1e-6 or asked[1] > high + 1e-6):
            common.say(f"--{name} goes beyond the travel of [motor.{joint}], {low:.4g} to {high:.4g} rad")


class Summary(TypedDict):
    """What --json prints of a map."""

    model: str
    postures: int
    path: str
    r_mm: list[float]
    lambda_min_n_per_mm: list[float]
    lambda_max_n_per_mm: list[float]
    turning_points_r_mm: dict[str, list[float]]
    rises_with_reach: dict[str, bool]
    quasi_convex_lambda_max: bool
    quasi_concave_lambda_min: bool


def _summary(name: str, grid: Workspace) -> Summary:
    import numpy as np

    from brace.stiffness.workspace import turning_points

    low, high = grid.band("lambda_min_n_per_mm"), grid.band("lambda_max_n_per_mm")
    turns = {
        "lambda_max": turning_points(grid.r_mm, high[:, 1]),
        "lambda_min": turning_points(grid.r_mm, low[:, 1]),
    }
    return {
        "model": name,
        "postures": grid.count,
        "path": grid.path,
        "r_mm": [grid.r_mm.min(), grid.r_mm.max()],
        "lambda_min_n_per_mm": [np.nanmin(low[:, 0]), np.nanmax(low[:, 2])],
        "lambda_max_n_per_mm": [np.nanmin(high[:, 0]), np.nanmax(high[:, 2])],
        "turning_points_r_mm": turns,
        "rises_with_reach": {
            name: _rises(grid.r_mm, band) for name, band in (("lambda_max", high), ("lambda_min", low))
        },
        "quasi_convex_lambda_max": len(turns["lambda_max"]) <= 1,
        "quasi_concave_lambda_min": len(turns["lambda_min"]) <= 1,
    }


def _rises(r_mm: np.ndarray, band: np.ndarray) -> bool:
    """Whether the curve is higher at the greatest reach than at the least."""
    order = r_mm.argsort()
    middle = band[order, 1]
    middle = middle[middle == middle]  # without a rest there is none
    return bool(middle.size and middle[-1] > middle[0])


def _files(model: LimbModel, grid: Workspace, every_posture: bool, title: str) -> list[tuple[str, bytes]]:
    import numpy as np

    from brace.dataset.write import csv_text
    from brace.plots.figure import png_bytes, svg_bytes
    from brace.plots.workspace_plot import workspace_figure

    low, high = grid.band("lambda_min_n_per_mm"), grid.band("lambda_max_n_per_mm")
    curve: dict[str, np.ndarray] = {"theta2_rad": grid.theta2_rad.astype(float), "r_mm": grid.r_mm}
    for which, band in (("min", low), ("max", high)):
        for column, end in enumerate(("_low", "", "_high")):
            curve[f"lambda_{which}{end}_n_per_mm"] = band[:, column].astype(float)
    ellipses, links = _ellipses(model, grid)
    order = np.argsort(grid.r_mm)
    order = order[np.isfinite(low[order]).all(axis=1)]
    keep = order[:: max(1, order.size // 1500)]
    figure = workspace_figure(title, grid.r_mm[keep], low[keep], high[keep], ellipses, links)
    decimals = dict.fromkeys((*curve, *ellipses), 9)
    files = [
        ("map.png", png_bytes(figure)),
        ("map.svg", svg_bytes(figure)),
        ("eigenvalues.csv", csv_text(curve, decimals).encode()),
        ("ellipses.csv", csv_text(ellipses, decimals).encode()),
    ]
    if every_posture:
        files.append(("postures.npy", _npy(grid)))
    return files


def _ellipses(model: LimbModel, grid: Workspace) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Columns of the drawn ellipses, and the limb's outline at some postures: postures x 3 x 2 [mm]."""
    import numpy as np

    rows = np.unique(np.linspace(0, grid.theta2_rad.size - 1, 9).astype(int)[1:-1])
    columns = np.unique(np.linspace(0, grid.theta1_rad.size - 1, 6).astype(int))
    row, column = (index.ravel() for index in np.meshgrid(rows, columns, indexing="ij"))
    theta1, theta2 = grid.theta1_rad[column].astype(float), grid.theta2_rad[row].astype(float)
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    knee = femur * np.column_stack([np.cos(theta1), np.sin(theta1)])
    tip = knee + tibia * np.column_stack([np.cos(theta1 - theta2), np.sin(theta1 - theta2)])
    result = {"theta1_rad": theta1, "theta2_rad": theta2, "x_mm": tip[:, 0], "z_mm": tip[:, 1]}
    result.update({name: values[row, column].astype(float) for name, values in grid.values.items()})
    if grid.path == "loaded":  # where the tip is under the load
        result["x_mm"], result["z_mm"] = tip[:, 0] + result["tip_dx_mm"], tip[:, 1] + result["tip_dz_mm"]
    middle = np.flatnonzero(column == columns[columns.size // 2])[::3]
    stands = np.isfinite(result["k_xx_n_per_mm"])
    result = {name: values[stands] for name, values in result.items()}
    return result, np.stack([np.zeros_like(tip), knee, tip], axis=1)[middle]


def _under_load(grid: Workspace) -> dict[str, float]:
    """How far the load moves the tip at most, the least buckling factor, and at how many postures no rest was found."""
    import numpy as np

    moved_mm = np.hypot(grid.values["tip_dx_mm"], grid.values["tip_dz_mm"])
    return {
        "displacement_most_mm": float(np.nanmax(moved_mm)),
        "buckling_factor_least": float(np.nanmin(grid.values["buckling_factor"])),
        "folded_postures": grid.folded,
    }


def _load_text(load: dict[str, float]) -> str:
    factor = load["buckling_factor_least"]
    folded = f"; {load['folded_postures']:.0f} postures have no K: no rest was found under the load"
    return (
        f"under the ground's force on the tip ({load['fx_n']:g}, {load['fz_n']:g}) N and the limb's weight: the tip "
        "moves by up to "
        f"{load['displacement_most_mm']:.3g} mm, least buckling factor "
        + (f"{factor:.3g}" if math.isfinite(factor) else "above 11")
        + (", where the load makes the limb much softer" if factor < k_load.SOFTENED else "")
        + (folded if load["folded_postures"] else "")
    )


def _npy(grid: Workspace) -> bytes:
    import io

    import numpy as np

    names = ["theta1_rad", "theta2_rad", *grid.values]
    table = np.empty(grid.count, np.dtype([(name, "f4") for name in names]))
    table["theta1_rad"] = np.tile(grid.theta1_rad, grid.theta2_rad.size)
    table["theta2_rad"] = np.repeat(grid.theta2_rad, grid.theta1_rad.size)
    for name, values in grid.values.items():
        table[name] = values.ravel()
    buffer = io.BytesIO()
    np.save(buffer, table)
    return buffer.getvalue()


def _text(summary: Summary, out: Path) -> str:
    def turns(which: str) -> str:
        found = summary["turning_points_r_mm"][which]
        if found:
            return "turns between rising and falling at r = " + ", ".join(f"{r:.1f}" for r in found) + " mm"
        return f"{'rises' if summary['rises_with_reach'][which] else 'falls'} steadily with reach"

    where = "where the tip stands under the load" if summary["path"] == "loaded" else summary["path"]
    return (
        f"{summary['model']}: {summary['postures']} postures, r = {summary['r_mm'][0]:.1f} to "
        f"{summary['r_mm'][1]:.1f} mm ({where})\n"
        f"lambda_min {summary['lambda_min_n_per_mm'][0]:.4g} to {summary['lambda_min_n_per_mm'][1]:.4g} N/mm; "
        f"{turns('lambda_min')}\n"
        f"lambda_max {summary['lambda_max_n_per_mm'][0]:.4g} to {summary['lambda_max_n_per_mm'][1]:.4g} N/mm; "
        f"{turns('lambda_max')}\n"
        f"-> {out}/map.png, map.svg, eigenvalues.csv, ellipses.csv"
    )
