"""Healthy records spoiled: what goes wrong between a rig and a file."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from designs import Rng

Table = dict[str, Any]  # column name -> list of numbers or labels, all of one length

INTS = ("run", "config", "rep", "step")


def _floats(table: Table, name: str) -> list[float]:
    return [float(v) for v in table[name]]


def _scale(table: Table, names: tuple[str, ...], factor: float) -> None:
    for name in names:
        table[name] = [v * factor for v in _floats(table, name)]


def _loud(rng: Rng, table: Table, name: str, least: float = 0.4) -> int:
    """A row at which the reading is large."""
    values = np.abs(_floats(table, name))
    return int(rng.choice(np.flatnonzero(values > least * values.max())))


def _inches(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("dx_mm", "dz_mm"), 1 / 25.4)
    return ["dx_mm", "dz_mm"]


def _metres(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("dx_mm", "dz_mm"), 1e-3)
    return ["dx_mm", "dz_mm"]


def _micrometres(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("dx_mm", "dz_mm"), 1e3)
    return ["dx_mm", "dz_mm"]


def _degrees(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("theta1_rad", "theta2_rad"), 180 / np.pi)
    return ["theta1_rad", "theta2_rad"]


def _one_degrees(rng: Rng, table: Table) -> list[str]:
    name = str(rng.choice(["theta1_rad", "theta2_rad"]))
    _scale(table, (name,), 180 / np.pi)
    return [name]


def _kilograms(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("fx_n", "fz_n"), 1 / 9.80665)
    return ["fx_n", "fz_n"]


def _millinewtons(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("fx_n", "fz_n"), 1e3)
    return ["fx_n", "fz_n"]


def _milliseconds(_rng: Rng, table: Table) -> list[str]:
    _scale(table, ("t_s",), 1e3)
    return ["t_s"]


def _kelvin(_rng: Rng, table: Table) -> list[str]:
    table["temp_degc"] = [v + 273.15 for v in _floats(table, "temp_degc")]
    return ["temp_degc"]


def _decimal(rng: Rng, table: Table) -> list[str]:
    name = max(("fx_n", "fz_n"), key=lambda n: float(np.max(np.abs(_floats(table, n)))))
    row = _loud(rng, table, name)
    table[name][row] *= float(rng.choice([10.0, 0.1]))
    return [name]


def _sign_slip(rng: Rng, table: Table) -> list[str]:
    name = max(("fx_n", "fz_n"), key=lambda n: float(np.max(np.abs(_floats(table, n)))))
    row = _loud(rng, table, name)
    table[name][row] *= -1.0
    return [name]


def _flipped_column(rng: Rng, table: Table) -> list[str]:
    name = str(rng.choice(["fx_n", "fz_n"]))
    _scale(table, (name,), -1.0)
    return [name]


def _flipped_run(rng: Rng, table: Table) -> list[str]:
    run = int(rng.choice(np.unique(table["run"])))
    for name in ("fx_n", "fz_n"):
        table[name] = [-v if r == run else v for v, r in zip(table[name], table["run"], strict=True)]
    return ["fx_n", "fz_n", "dx_mm", "dz_mm"]


def _swapped(_rng: Rng, table: Table) -> list[str]:
    table["fx_n"], table["fz_n"] = table["fz_n"], table["fx_n"]
    return ["fx_n", "fz_n"]


def _swapped_angles(_rng: Rng, table: Table) -> list[str]:
    table["theta1_rad"], table["theta2_rad"] = table["theta2_rad"], table["theta1_rad"]
    return ["theta1_rad", "theta2_rad"]


def _duplicated(rng: Rng, table: Table) -> list[str]:
    row = int(rng.integers(5, len(table["run"]) - 5))
    for values in table.values():
        values.insert(row + 1, values[row])
    return ["t_s", "step", "run", "row", "rep", "config"]


def _backwards(rng: Rng, table: Table) -> list[str]:
    row = int(rng.integers(5, len(table["run"]) - 5))
    table["t_s"][row], table["t_s"][row + 1] = table["t_s"][row + 1], table["t_s"][row]
    return ["t_s"]


def _stuck(rng: Rng, table: Table) -> list[str]:
    name = max(("fx_n", "fz_n"), key=lambda n: float(np.max(np.abs(_floats(table, n)))))
    row = int(rng.integers(5, len(table["run"]) - 30))
    for i in range(row, row + 20):
        table[name][i] = table[name][row]
    return [name]


def _missing_number(rng: Rng, table: Table) -> list[str]:
    name = str(rng.choice(["fx_n", "fz_n", "dx_mm", "t_s", "theta2_rad"]))
    table[name][int(rng.integers(len(table["run"])))] = float("nan")
    return [name]


def _beyond_range(rng: Rng, table: Table) -> list[str]:
    name = str(rng.choice(["fx_n", "fz_n"]))
    table[name][int(rng.integers(len(table["run"])))] = float(rng.choice([-1.0, 1.0])) * 9999.0
    return [name]


def _mislabelled_axis(rng: Rng, table: Table) -> list[str]:
    run = int(rng.choice(np.unique(table["run"])))
    table["axis"] = [
        ("z" if a == "x" else "x") if r == run else a for a, r in zip(table["axis"], table["run"], strict=True)
    ]
    return ["axis", "dx_mm", "dz_mm"]


def _copied_run(rng: Rng, table: Table) -> list[str]:
    """The force readings of one configuration's runs pasted over another's."""
    configs = np.unique(table["config"])
    here, there = (int(c) for c in rng.choice(configs, 2, replace=False))
    where = [i for i, c in enumerate(table["config"]) if c == here]
    source = [i for i, c in enumerate(table["config"]) if c == there]
    for name in ("fx_n", "fz_n"):
        for i, j in zip(where, source, strict=True):
            table[name][i] = table[name][j]
    return ["fx_n", "fz_n", "config", "theta1_rad", "theta2_rad"]


def _mislabelled_pose(rng: Rng, table: Table) -> list[str]:
    """One configuration's angle typed with a slip of a digit: off by 1 rad."""
    config = int(rng.choice(np.unique(table["config"])))
    name = str(rng.choice(["theta1_rad", "theta2_rad"]))
    off = float(rng.choice([-1.0, 1.0]))
    table[name] = [v + off if c == config else v for v, c in zip(table[name], table["config"], strict=True)]
    return ["theta1_rad", "theta2_rad", "config"]


KINDS: dict[str, Callable[[Rng, Table], list[str]]] = {
    "inches": _inches,
    "metres": _metres,
    "micrometres": _micrometres,
    "degrees": _degrees,
    "degrees_in_one_angle": _one_degrees,
    "kilograms": _kilograms,
    "millinewtons": _millinewtons,
    "milliseconds": _milliseconds,
    "kelvin": _kelvin,
    "decimal": _decimal,
    "sign_slip": _sign_slip,
    "flipped_column": _flipped_column,
    "flipped_run": _flipped_run,
    "swapped_forces": _swapped,
    "swapped_angles": _swapped_angles,
    "duplicated_row": _duplicated,
    "time_backwards": _backwards,
    "stuck": _stuck,
    "missing_number": _missing_number,
    "beyond_range": _beyond_range,
    "mislabelled_axis": _mislabelled_axis,
    "copied_config": _copied_run,
    "mistyped_pose": _mislabelled_pose,
}
