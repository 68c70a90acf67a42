"""Along which axis each row was loaded; displacements and forces along x and z, of columns that say the axis or not."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from brace.ground.errors import BadFileError
from brace.importing.mapping import MappingTable
from brace.importing.part import Table
from brace.importing.runs import driven_axis

Columns: TypeAlias = dict[str, np.ndarray]


def axis_of(table: Table, mapping: MappingTable, rows: int, group: np.ndarray) -> np.ndarray:
    """0 (x) or 1 (z) a row. group: rows between which displacements may count from another place."""
    if "axis" in table.texts:
        wrong = next((text for text in table.texts["axis"] if text not in ("x", "z")), None)
        if wrong is not None:
            raise BadFileError(
                f"axis is {wrong!r} in a row",
                where=table.part.where,
                why="it is x (outwards) or z (up)",
                next_step=f'e.g. values = {{ "{wrong}" = "x" }} in its [[column]]',
            )
        return np.array([text == "z" for text in table.texts["axis"]], np.int32)
    constant = mapping.constant(table.part.places, "axis")
    if constant is not None and constant.value != "?":
        return np.full(rows, constant.value == "z", np.int32)
    have = table.columns
    if "dx_mm" in have and "dz_mm" in have:
        firsts = np.searchsorted(group, group)
        found = driven_axis(have["dx_mm"] - have["dx_mm"][firsts], have["dz_mm"] - have["dz_mm"][firsts])
        if found is not None:
            return found.astype(np.int32)
        if "weight_n" in have:
            return np.ones(rows, np.int32)
    elif "dx_mm" in have or "dz_mm" in have:
        return np.full(rows, "dz_mm" in have, np.int32)
    raise BadFileError(
        "the axis along which the tip was moved is not given",
        where=table.part.where,
        why="one displacement has no direction" if "d_mm" in have else "the tip moves along x and z at once",
        next_step="--set axis=x or --set axis=z (for one of several files: --set FILE:axis=x)",
    )


def displacements(table: Table, axis: np.ndarray, rows: int, notes: list[str]) -> Columns:
    have, along_z = table.columns, axis == 1
    out = {name: have.get(name, np.zeros(rows)) for name in ("dx_mm", "dz_mm")}
    if "d_mm" in have:
        _refuse_twice(table, axis, "d_mm", ("dx_mm", "dz_mm"))
        out["dx_mm"] = np.where(along_z, out["dx_mm"], have["d_mm"])
        out["dz_mm"] = np.where(along_z, have["d_mm"], out["dz_mm"])
    lacking = [name for name in ("dx_mm", "dz_mm") if name not in have]
    if "weight_n" in have and (lacking and not ("d_mm" in have and len(lacking) < 2)):
        raise BadFileError(
            "hung weights, and the tip's displacement is known along one axis only",
            where=table.part.where,
            why="a weight moves the tip sideways too, and K follows from both displacements",
            next_step="measure dx_mm and dz_mm under each weight; or hold the tip sideways and read the force there",
        )
    if lacking:
        were = "was" if len(lacking) == 1 else "were"
        notes.append(
            f"{table.part.places[0]}: {' and '.join(lacking)} {were} not measured and taken as 0 across the axis: the "
            "rig is taken to hold the tip there. If the tip was free to move that way, this record gives a wrong K: "
            "measure both displacements"
        )
    return out


def forces(table: Table, axis: np.ndarray, rows: int, notes: list[str]) -> Columns:
    have, along_z = table.columns, axis == 1
    out = {name: have.get(name, np.full(rows, math.nan)) for name in ("fx_n", "fz_n")}
    if "f_n" in have:
        _refuse_twice(table, axis, "f_n", ("fx_n", "fz_n"))
        out["fx_n"] = np.where(along_z, out["fx_n"], have["f_n"])
        out["fz_n"] = np.where(along_z, have["f_n"], out["fz_n"])
    if "weight_n" in have:
        if "fz_n" in have or "f_n" in have:
            raise BadFileError(
                "a force and a hung weight",
                where=table.part.where,
                why="both would be the force on the tip",
                next_step="ignore one of the two in the mapping",
            )
        out["fz_n"] = -np.abs(have["weight_n"])
        notes.append(
            f"{table.part.places[0]}: the force is that of hung weights, downwards (kg times 9.80665); it was not "
            "measured, "
            "and along x nothing was"
        )
    return out


def _refuse_twice(table: Table, axis: np.ndarray, plain: str, along: tuple[str, str]) -> None:
    """A column along the motion and one along this axis are two readings of one direction. A record keeps one of the
    two, and nothing here says which."""
    for number, name in enumerate(along):
        if name in table.columns and bool(np.any((axis == number) & ~np.isnan(table.columns[name]))):
            raise BadFileError(
                f"{plain} and {name} are both of the motion along {'xz'[number]}",
                where=table.part.where,
                why=f"{plain} is along the motion, and {name} is so too in the runs along {'xz'[number]}",
                next_step=f'is = "ignore" for the one that is a resultant or is not wanted ({plain}, as a rule)',
            )
