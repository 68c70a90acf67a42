"""`brace k --csv IN --out OUT`: the same rows with K's columns added."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from brace.cli import common
from brace.cli.k_flags import flags_of_postures
from brace.cli.k_load import refuse_across_the_plane, refuse_in_space, refuse_load_with
from brace.dataset.posture_table import PostureTable, read_postures
from brace.ground.errors import BadFileError, UsageError
from brace.ground.files import check_file, write_file
from brace.model import LimbModel
from brace.stiffness import at_rest
from brace.stiffness.in_space_under_load import LOADED_SPACE_REST, LoadedLimbInSpace
from brace.stiffness.names import PLANAR_C, PLANAR_K, PLANAR_REST, SPATIAL_C, SPATIAL_K, SPATIAL_REST
from brace.stiffness.play_under_load import Play, PlayInSpaceUnderLoad, PlayUnderLoad, put_into
from brace.stiffness.under_load import LOADED_REST, stiffness_under_load


def run_table(arguments: argparse.Namespace, model: LimbModel) -> int:
    """Reads IN, computes, writes OUT whole or not at all."""
    inputs = [arguments.model, arguments.csv]
    check_file(arguments.out, inputs)
    table = read_postures(arguments.csv)
    spatial = "theta0_rad" in table.angles
    loaded = bool(table.forces) or arguments.is_loaded
    _check_load(table, arguments)
    loaded_rest = LOADED_SPACE_REST if spatial else LOADED_REST
    rest = loaded_rest if loaded else SPATIAL_REST if spatial else PLANAR_REST
    k, c = (SPATIAL_K, SPATIAL_C) if spatial else (PLANAR_K, PLANAR_C)
    names = (*k, *c, *rest, "flags")
    _refuse_taken(table, names)
    try:
        under_load = _in_space_under_load if spatial else _under_load
        choose = under_load if loaded else _in_space if spatial else _in_plane
        result, path = choose(table, model, arguments)
    except at_rest.PostureError as error:
        angles = ", ".join(f"{name} = {values[error.index]:g}" for name, values in table.angles.items())
        raise BadFileError(
            f"the posture {angles} is refused",
            where=table.place(error.index),
            why=error.text,
            next_step="angles are in rad, theta2_rad within [-pi, pi]; a singular posture needs another limb",
        ) from None
    result["flags"] |= flags_of_postures(model, table.angles, unloaded=not (spatial or loaded))
    if loaded:
        _take_up(table, model, arguments, result)
    write_file(arguments.out, table.with_columns(names, [_texts(result[name]) for name in names]), inputs)
    no_rest = int(np.count_nonzero(np.isnan(result[k[0]])))
    summary = {
        "rows": len(table.rows),
        "rows_without_rest": no_rest,
        "out": arguments.out,
        "arith": path,
        "model": model.name,
        "flagged_rows": int(np.count_nonzero(result["flags"])),
    }
    if arguments.json:
        common.print_json(summary)
    else:
        common.say(f"{len(table.rows)} postures ({path}) -> {arguments.out}")
    if no_rest:
        common.say(
            f"{no_rest} of {len(table.rows)} rows have no K: no rest was found under their load; they "
            "have flags and no numbers; a smaller force or another posture has K"
        )
    return 0


def _in_plane(table: PostureTable, model: LimbModel, arguments: argparse.Namespace) -> tuple[np.ndarray, str]:
    limb = at_rest.planar_limb(model, arguments.arith)
    true1, true2 = limb.true_angles(table.angles["theta1_rad"], table.angles["theta2_rad"])
    return limb.stiffness(at_rest.within_half_turn(true1), true2), limb.path


def _under_load(table: PostureTable, model: LimbModel, arguments: argparse.Namespace) -> tuple[np.ndarray, str]:
    limb = at_rest.planar_limb(model)
    true1, true2 = limb.true_angles(table.angles["theta1_rad"], table.angles["theta2_rad"])
    force_n = _forces(table, {"fx_n": arguments.fx, "fz_n": arguments.fz})
    true1 = at_rest.within_half_turn(true1)
    path = "loaded, fixed" if arguments.arith == "fixed" else "loaded"
    return stiffness_under_load(model, true1, true2, *force_n, arithmetic=arguments.arith), path


def _in_space_under_load(
    table: PostureTable, model: LimbModel, arguments: argparse.Namespace
) -> tuple[np.ndarray, str]:
    angles = [table.angles[name] for name in ("theta0_rad", "theta1_rad", "theta2_rad")]
    force_n = _forces(table, {"fx_n": arguments.fx, "fy_n": arguments.fy or 0.0, "fz_n": arguments.fz})
    return LoadedLimbInSpace(model).stiffness(np.column_stack(angles), np.column_stack(force_n)), "loaded"


def _take_up(table: PostureTable, model: LimbModel, arguments: argparse.Namespace, result: np.ndarray) -> None:
    """K of now where the load leaves a gap open, and the flags of the play that it holds."""
    for index, find in enumerate(_plays(table, model, arguments)):
        play = None if np.isnan(result["k_xx_n_per_mm"][index]) else find()
        if play is None:
            continue
        values = {name: result[name][index].item() for name in result.dtype.names or ()}
        put_into(values, play)
        for name, value in values.items():
            result[name][index] = value


def _plays(
    table: PostureTable, model: LimbModel, arguments: argparse.Namespace
) -> Iterator[Callable[[], Play | None]]:
    """For each row, what finds its play."""
    if "theta0_rad" in table.angles:
        angles = [table.angles[name] for name in ("theta0_rad", "theta1_rad", "theta2_rad")]
        force_n = _forces(table, {"fx_n": arguments.fx, "fy_n": arguments.fy or 0.0, "fz_n": arguments.fz})
        in_space = PlayInSpaceUnderLoad(model)
        for theta_rad, force in zip(np.column_stack(angles), np.column_stack(force_n), strict=True):
            yield partial(in_space.at, theta_rad, force)
    else:
        true1, true2 = at_rest.planar_limb(model).true_angles(table.angles["theta1_rad"], table.angles["theta2_rad"])
        force_n = _forces(table, {"fx_n": arguments.fx, "fz_n": arguments.fz})
        limb = PlayUnderLoad(model, arguments.arith)
        for row in np.column_stack([at_rest.within_half_turn(true1), true2, *force_n]).tolist():
            yield partial(limb.at, *row)


def _forces(table: PostureTable, given: dict[str, float]) -> list[np.ndarray]:
    """Each component from its column, or the same in every row."""
    return [table.forces.get(name, np.full(len(table.rows), value)) for name, value in given.items()]


def _check_load(table: PostureTable, arguments: argparse.Namespace) -> None:
    if "theta0_rad" in table.angles:
        refuse_in_space(arguments.arith, "the column theta0_rad")
    elif arguments.fy is not None or "fy_n" in table.forces:
        refuse_across_the_plane("--fy" if arguments.fy is not None else "column fy_n")
    if table.forces and arguments.is_loaded:
        raise UsageError(
            "--fx, --fy or --fz with columns fx_n and fz_n",
            where=f"{table.path}:1",
            why="each row's force stands in the file",
            next_step="drop --fx, --fy and --fz, or rename the columns",
        )
    if table.forces or arguments.is_loaded:
        refuse_load_with(arguments.arith)


def _in_space(table: PostureTable, model: LimbModel, arguments: argparse.Namespace) -> tuple[np.ndarray, str]:
    angles = [table.angles[name] for name in ("theta0_rad", "theta1_rad", "theta2_rad")]
    return at_rest.spatial_stiffness(model, *angles), "spatial"


def _refuse_taken(table: PostureTable, names: tuple[str, ...]) -> None:
    taken = [name for name in names if name in table.names]
    if taken:
        raise BadFileError(
            f"column {taken[0]} is there already",
            where=f"{table.path}:1",
            why="it would be there twice in the result",
            next_step="rename or drop it",
        )


def _texts(values: np.ndarray) -> list[str]:
    if values.dtype.kind == "u":
        return list(map(str, values.tolist()))
    # + 0.0: -0 is 0; NaN is no number
    return ["" if value != value else f"{value:.9g}" for value in (values + 0.0).tolist()]
