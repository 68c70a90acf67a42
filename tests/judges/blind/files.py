"""Writing what a tool reads: limb.toml, meta.toml, data.csv."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from designs import Design, Rng, Trust
from plant import IN_LIMB_TOML, INDEX, LINKS, NEUTRAL, ROW, Array

Table = dict[str, Any]
INTEGERS = ("run", "config", "rep", "step")
RANGE_N = 145.0  # of the force sensor
_ALWAYS = ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad", "compliance_rad_per_n_mm")


def limb_text(p: Array, given: Trust, name: str, left_out: Sequence[str] = ()) -> str:
    """The believed limb as limb.toml. Keys of `left_out` are not written."""
    tables: dict[str, list[str]] = {"geometry": ["coxa_mm = 57.0"]}
    for key in IN_LIMB_TOML:
        value, (table, leaf) = float(p[INDEX[key]]), key.rsplit(".", 1)
        if key in left_out or (value == NEUTRAL[INDEX[key]] and leaf not in _ALWAYS):
            continue
        text = f'"{LINKS[int(value)]}"' if key == "change.link" else repr(value)
        tables.setdefault(table, []).append(f"{leaf} = {text}")
    lines = ["format = 1", f'name = "{name}"']
    for table, entries in tables.items():
        lines += [f"[{table}]", *entries]
    lines += ["[uncertainty]", *(f"{k} = {v!r}" for k, v in vars(given).items())]
    return "\n".join(lines) + "\n"


def meta_text(design: Design, title: str, *, displacements: str = "") -> str:
    """meta.toml of a loading test. `displacements`: what it says of them; a record that is to be diagnosed says nothing,
    and the tool has to find it out."""
    said = f'displacements = "{displacements}"\n' if displacements else ""
    held = 'held = "at rest"\n' if design.held_at_rest else ""
    return (
        f'format = 1\nkind = "loading"\ntitle = "{title}"\n{said}{held}[sensor]\n'
        f"resolution_n = {design.resolution_n!r}\n"
        f"range_n = {RANGE_N!r}\n[rig]\nstep_mm = {design.step_mm!r}\ndwell_s = {design.dwell_s!r}\n"
        f'zeroed = "{"per_run" if design.zeroed else "never"}"\n'
    )


def noisy(rng: Rng, design: Design, clean: Array) -> Array:
    """Readings with noise, rounded as the rig does."""
    sigma = design.sigma(clean)
    out = np.array(clean[:, design.columns])
    for i, name in enumerate(design.readings):
        if name in ("fx_n", "fz_n"):
            scatter = np.hypot(design.noise.force_n, design.noise.growth * out[:, i])
            out[:, i] += scatter * rng.standard_normal(len(out))
            if design.noise.rounding_n > 0.0:
                out[:, i] = np.round(out[:, i] / design.noise.rounding_n) * design.noise.rounding_n
        else:
            out[:, i] += sigma[:, i] * rng.standard_normal(len(out))
    return design.seen(out)


def table_of(design: Design, readings: Array) -> Table:
    """Columns of data.csv."""
    r = {name: design.rows[:, i] for i, name in enumerate(ROW)}
    table: Table = {
        "run": [int(v) for v in r["run"]],
        "config": [int(v) for v in design.config],
        "theta1_rad": r["theta1_rad"].tolist(),
        "theta2_rad": r["theta2_rad"].tolist(),
        "axis": list(design.axis),
        "rep": [int(v) for v in design.rep],
        "step": [int(v) for v in design.step],
        "t_s": r["t_s"].tolist(),
        "temp_degc": r["temp_degc"].tolist(),
        "dx_mm": r["dx_mm"].tolist(),
        "dz_mm": r["dz_mm"].tolist(),
    }
    for i, name in enumerate(design.readings):
        table[name] = readings[:, i].tolist()
    return table


def _text(name: str, value: Any) -> str:
    if name == "axis" or name in INTEGERS:
        return str(value)
    return "" if math.isnan(value) else f"{value:.6f}"


def write_dataset(folder: Path, meta: str, table: Table) -> None:
    """A dataset's two files."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "meta.toml").write_text(meta)
    lines = [",".join(table)]
    lines += [
        ",".join(_text(n, v) for n, v in zip(table, row, strict=True)) for row in zip(*table.values(), strict=True)
    ]
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
