"""Causes outside the catalogue that a record cannot tell from an effect: they are named beside it, and nothing is
exported until somebody takes one."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from conftest import Outcome
from handmade import POSES, RIG

from brace.dataset.write import write_dataset
from brace.model import LimbModel, load_limb
from brace.rig import load_rig
from brace.simulate import simulate

BASE = {"base.x_mm_per_n": 0.08, "base.z_mm_per_n": 0.08}
TURNED_RAD = 0.06
TURNED = {"sensor.rotation_rad": TURNED_RAD, "joint.femur.zero_offset_rad": -TURNED_RAD}
GAUGE = "base_gauge = true\nbase_noise_mm = 0.002\n"


def record(folder: Path, limb: Path, values: Mapping[str, float], sensor: str = "") -> Path:
    rig = folder / "rig.toml"
    poses = "".join(f"[[configuration]]\ntheta1_rad = {a}\ntheta2_rad = {b}\n" for a, b in POSES)
    rig.write_text(RIG.format(title="hidden") + sensor + poses)
    meta, columns = simulate(load_limb(limb).with_values(dict(values)), load_rig(rig))
    (folder / "data").mkdir()
    write_dataset(folder / "data", meta, columns)
    return folder / "data"


@pytest.fixture
def told(brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path) -> Callable[..., tuple[Any, LimbModel]]:
    """What a diagnosis says, and the limb that it writes."""

    def run(values: Mapping[str, float], *options: str, sensor: str = "") -> tuple[Any, LimbModel]:
        data = tmp_path / "data"
        data = data if data.exists() else record(tmp_path, paper_limb, values, sensor)
        outcome = brace("diagnose", data, "--model", paper_limb, "--out", tmp_path / "out", "--json", *options)
        assert outcome.code == 0, outcome.err
        return json.loads(outcome.out), load_limb(tmp_path / "out" / "limb.toml")

    return run


def labels(found: Any) -> set[str]:
    return {f"{effect['name']}@{effect['where']}" for effect in found["effects"]}


def test_a_rig_that_yields_stands_beside_a_base_that_does(
    told: Callable[..., tuple[Any, LimbModel]], paper_limb: Path
) -> None:
    found, limb = told(BASE)
    assert found["verdict"] == "ambiguous" and not found["exported"]
    assert {"base_compliance@base", "rig_compliance@rig"} <= labels(found)
    assert max(effect["confidence"] for effect in found["effects"]) < 0.6
    assert limb.values == load_limb(paper_limb).values
    assert "dial gauge" in found["sentence"] and "--take" in found["sentence"]
    given = {one["take"]: one["k_xx_n_per_mm"] for one in found["members"]}
    assert abs(given["base_compliance@base"] - given["rig_compliance@rig"]) > 0.01 * given["rig_compliance@rig"]
    found, limb = told(BASE, "--take", "base_compliance")
    assert found["verdict"] == "ambiguous" and found["exported"]
    assert limb.number("base.x_mm_per_n") == pytest.approx(BASE["base.x_mm_per_n"], rel=0.3)
    found, limb = told(BASE, "--take", "backlash")
    assert not found["exported"] and any("no member" in note for note in found["notes"])


def test_a_gauge_on_the_base_tells_them_apart(told: Callable[..., tuple[Any, LimbModel]]) -> None:
    found, limb = told(BASE, sensor=GAUGE)
    assert found["verdict"] == "effect" and labels(found) == {"base_compliance@base"} and found["exported"]
    assert found["members"] == []
    assert limb.number("base.z_mm_per_n") == pytest.approx(BASE["base.z_mm_per_n"], rel=0.1)


def test_a_sensor_turned_as_far_as_the_limb_is_a_turned_rig(told: Callable[..., tuple[Any, LimbModel]]) -> None:
    found, _ = told(TURNED)
    first = found["effects"][0]
    assert found["verdict"] == "ambiguous" and not found["exported"]
    assert first["name"] == "rig_rotation" and first["confidence"] > 0.8
    size = first["parameters"]["rig.rotation_rad"]
    assert size["low"] <= TURNED_RAD <= size["high"] and size["high"] - size["low"] < 0.02


def test_a_turned_sensor_alone_is_no_turned_rig(told: Callable[..., tuple[Any, LimbModel]]) -> None:
    found, limb = told({"sensor.rotation_rad": TURNED_RAD})
    assert found["verdict"] == "effect" and labels(found) == {"sensor_rotation@sensor"}
    assert limb.number("sensor.rotation_rad") == pytest.approx(TURNED_RAD, abs=0.01)
