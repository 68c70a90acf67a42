"""A loading test on the simulated limb, as a dataset."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TypedDict

import numpy as np

from brace import toml
from brace.dataset import Dataset
from brace.ground.errors import UsageError
from brace.model import LimbModel
from brace.native.plant import play_rig
from brace.rig.rig import Rig

BETWEEN_TESTS_S = 60.0

_BASE_COLUMNS = (
    "run",
    "config",
    "theta1_rad",
    "theta2_rad",
    "axis",
    "rep",
    "step",
    "t_s",
    "temp_degc",
    "dx_mm",
    "dz_mm",
    "fx_n",
    "fz_n",
)


class MetaTables(TypedDict):
    """Content of meta.toml."""

    format: int
    kind: str
    title: toml.Value
    sensor: dict[str, toml.Value]
    rig: dict[str, toml.Value]
    source: dict[str, toml.Value]


def simulate(model: LimbModel, rig: Rig) -> tuple[MetaTables, dict[str, np.ndarray]]:
    """(content of meta.toml, columns of data.csv). The design is rounded as the file will round it before
    it is played, so that playing the file back meets the same angles."""
    design = rig.design(model)
    for angle in ("theta1_rad", "theta2_rad"):
        design[angle] = np.round(np.asarray(design[angle], float), 6)
    played = play_rig(model, design)
    names = list(_BASE_COLUMNS)
    if rig.values["sensor.encoders"]:
        names += ["enc1_rad", "enc2_rad"]
    if rig.values["sensor.base_gauge"]:
        names += ["base_x_mm", "base_z_mm"]
    value = rig.values
    meta: MetaTables = {
        "format": 1,
        "kind": "loading",
        "title": value["title"],
        "sensor": {"resolution_n": value["sensor.resolution_n"], "range_n": value["sensor.range_n"]},
        "rig": {
            "step_mm": value["rig.step_mm"],
            "dwell_s": value["rig.dwell_s"],
            "zeroed": value["rig.zeroed"],
        },
        "source": {"what": "simulated", "limb": model.name, "seed": value["seed"]},
    }
    return meta, {name: played[name] for name in names}


def behind(before: Dataset, rig: Rig) -> Rig:
    """The rig's test starting after a record's last reading, unless its file says when it starts."""
    end_s = float(before["t_s"].max())
    start_s = toml.number(rig.values, "rig.start_s")
    if start_s == 0.0:
        return replace(rig, values={**rig.values, "rig.start_s": end_s + BETWEEN_TESTS_S})
    if start_s <= end_s:
        raise UsageError(
            "the test would start before the record that it comes after has ended",
            where=rig.document.where("rig.start_s"),
            why=f"rig.start_s = {start_s:g} s, and the record's last reading was taken at {end_s:g} s",
            next_step="leave rig.start_s out, or write a later one",
        )
    return rig


def joined(
    before: Dataset, meta: MetaTables, new: dict[str, np.ndarray]
) -> tuple[MetaTables, dict[str, np.ndarray]]:
    """One record of both tests, with the first one's step, dwell and sensor: runs and configurations
    counted on; readings that only one of them has are NaN in the other's rows."""
    if before.kind != "loading":
        raise UsageError(
            "a loading test comes after a loading record only",
            where=str(before.folder / "meta.toml"),
            why=f'its kind is "{before.kind}"',
            next_step="give --after the loading record that this test adds to",
        )
    zeroed = "per_run" if before.meta.zeroed_per_run else "never"
    if meta["rig"]["zeroed"] != zeroed:
        raise UsageError(
            "the two tests cannot be one record",
            where="rig.zeroed",
            why=f"the record's sensor was zeroed {zeroed}, the rig's is {meta['rig']['zeroed']}",
            next_step=f'rig.zeroed = "{zeroed}"',
        )
    moved = dict(new)
    for name in ("run", "config"):
        moved[name] = new[name] + int(before[name].max())
    names = [*before.columns, *(name for name in new if name not in before)]
    rows = len(new["run"])

    def part(columns: Mapping[str, np.ndarray], name: str, count: int) -> np.ndarray:
        return columns[name] if name in columns else np.full(count, np.nan)

    rig = {key: before.meta.number(f"rig.{key}") for key in ("step_mm", "dwell_s")}
    sensor: dict[str, toml.Value] = {key: before.meta.number(f"sensor.{key}") for key in ("resolution_n", "range_n")}
    columns = {
        name: np.concatenate([part(before.columns, name, before.rows), part(moved, name, rows)])
        for name in names
    }
    return {**meta, "sensor": sensor, "rig": {**meta["rig"], **rig}}, columns
