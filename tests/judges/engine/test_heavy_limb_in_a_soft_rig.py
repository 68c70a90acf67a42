"""A rig that yields under a heavy limb, played by the engine: the diagnosis names the rig and leaves the limb alone."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

try:
    import mujoco  # noqa: F401
except ImportError as missing:
    pytest.skip(f"no physics engine ({missing}): .venv/bin/python -m pip install mujoco", allow_module_level=True)

from designs import true_limb
from diagnoser import diagnose
from engine_plant import play
from engine_world import setting
from files import limb_text, meta_text, noisy, table_of, write_dataset
from plant import INDEX

RIG_MM_PER_N = 0.012
WEIGHTS_N = {"gravity.femur_n": 2.5, "gravity.tibia_n": 1.5, "gravity.knee_n": 2.0}


def test_the_weight_separates_the_rig_from_the_base(tmp_path: Path) -> None:
    rng = np.random.default_rng(77_003)
    believed, given, shown, _, left_out = setting(rng, [], small=True)
    for key, value in WEIGHTS_N.items():
        believed[INDEX[key]] = value
    shown.held_at_rest = shown.zeroed = False
    limb = true_limb(rng, believed, given)
    limb[INDEX["outside.rig_mm_per_n"]] = RIG_MM_PER_N
    write_dataset(tmp_path, meta_text(shown, "soft rig"), table_of(shown, noisy(rng, shown, play(limb, shown.rows))))
    (tmp_path / "limb.toml").write_text(limb_text(believed, given, "soft rig", left_out))
    diagnose(tmp_path, tmp_path / "out")
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert found["verdict"] == "ambiguous" and not found["exported"]
    first = found["effects"][0]
    assert (first["name"], first["where"]) == ("rig_compliance", "rig")
    assert "base_compliance@base" not in str(found["members"])
    size = first["parameters"]["rig.mm_per_n"]
    assert size["low"] < RIG_MM_PER_N < size["high"]
