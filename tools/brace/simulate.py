"""A loading test on the simulated limb, as a dataset."""

from __future__ import annotations

from typing import Any

import numpy as np

from brace.model import LimbModel
from brace.native.plant import play_rig
from brace.rig import Rig

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


def simulate(model: LimbModel, rig: Rig) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """(content of meta.toml, columns of data.csv). The design is rounded as the file will round it before it is
    played, so that playing the file back meets the same angles."""
    design = rig.design(model)
    for angle in ("theta1_rad", "theta2_rad"):
        design[angle] = np.round(design[angle], 6)
    played = play_rig(model, design)
    names = list(_BASE_COLUMNS)
    if rig.values["sensor.encoders"]:
        names += ["enc1_rad", "enc2_rad"]
    if rig.values["sensor.base_gauge"]:
        names += ["base_x_mm", "base_z_mm"]
    value = rig.values
    meta: dict[str, Any] = {
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
