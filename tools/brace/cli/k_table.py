"""`brace k --csv IN --out OUT`: the same rows with K's columns added."""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from brace import stiffness
from brace.cli import common
from brace.dataset.columns import Column
from brace.dataset.csv_table import read_columns
from brace.errors import BadFileError, UsageError
from brace.files import write_file
from brace.model import LimbModel

_WANTED = (
    Column("theta1_rad", "rad", "commanded femur angle", limit=1e3),
    Column("theta2_rad", "rad", "commanded knee angle", limit=1e3),
    Column("theta0_rad", "rad", "commanded coxa yaw", required=False, limit=1e3),
)


def run_table(arguments: argparse.Namespace, model: LimbModel) -> int:
    """Reads IN, computes, writes OUT whole or not at all."""
    columns, rows = read_columns(arguments.csv, _WANTED)
    header = _header_line(arguments)
    spatial = "theta0_rad" in columns
    if spatial and arguments.arith != "f32":
        raise UsageError(
            f"--arith {arguments.arith} with a theta0_rad column",
            why="K in space is computed in float only",
            next_step="drop --arith or the column",
        )
    try:
        if spatial:
            names = (*stiffness.SPATIAL_K, *stiffness.SPATIAL_C, *stiffness.SPATIAL_REST, "flags")
            result = stiffness.spatial_stiffness(
                model, columns["theta0_rad"], columns["theta1_rad"], columns["theta2_rad"]
            )
            path = "spatial"
        else:
            names = (*stiffness.PLANAR_K, *stiffness.PLANAR_C, *stiffness.PLANAR_REST, "flags")
            limb = stiffness.planar_limb(model, arguments.arith)
            path = limb.path
            result = limb.stiffness(*limb.true_angles(columns["theta1_rad"], columns["theta2_rad"]))
    except stiffness.PostureError as error:
        angles = ", ".join(f"{name} = {columns[name][error.index]:g}" for name in columns)
        raise BadFileError(
            f"the posture {angles} is refused",
            where=f"{arguments.csv}:{error.index + 2} (row {error.index + 1})",
            why=error.text,
            next_step="angles are in rad, within [-pi, pi]",
        ) from None
    taken = [name for name in names if name in header.split(",")]
    if taken:
        raise BadFileError(
            f"column {taken[0]} is there already",
            where=f"{arguments.csv}:1",
            why="it would be there twice in the result",
            next_step="rename or drop it",
        )
    write_file(arguments.out, _table(header, rows, result, names))
    summary = {
        "rows": len(rows),
        "out": arguments.out,
        "arith": path,
        "model": model.name,
        "flagged_rows": int(np.count_nonzero(result["flags"])),
    }
    if arguments.json:
        common.print_json(summary)
    else:
        common.say(f"{len(rows)} postures ({path}) -> {arguments.out}")
    return 0


def _header_line(arguments: argparse.Namespace) -> str:
    with arguments.csv.open("rb") as file:
        line = file.readline(1 << 16)
    return ",".join(name.strip().strip('"') for name in line.decode("utf-8-sig").strip().split(","))


def _table(header: str, rows: list[bytes], result: np.ndarray, names: tuple[str, ...]) -> bytes:
    added: list[list[str]] = []
    for name in names:
        values: Any = result[name]
        text = (
            map(str, values.tolist())
            if values.dtype.kind == "u"
            else (f"{value:.9g}" for value in values.tolist())
        )
        added.append(list(text))
    lines = [header + "," + ",".join(names)]
    lines += [
        row.decode("utf-8", "replace").rstrip() + "," + ",".join(extra)
        for row, extra in zip(rows, zip(*added))
    ]
    return ("\n".join(lines) + "\n").encode()
