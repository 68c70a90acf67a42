"""The tool's next experiment: its rig file played on the true limb, after the record and by itself."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import follow_up
import pytest
from generate import identity, schedule, write_case
from plant import INDEX, NEUTRAL
from seeds import SUBSET_SEED

RIG = """format = 1
[rig]
step_mm = 0.5
steps = 2
repeats = 1
axes = ["x"]
preload_x_mm = 0.25
dwell_s = 3.0
[sensor]
encoders = true
base_gauge = true
[[configuration]]
theta1_rad = 0.5
theta2_rad = 1.0
"""


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_played_after_the_record(tmp_path: Path) -> None:
    """Rows, runs, configurations and time go on; columns of which the record had none are empty there."""
    index = next(i for i, (kind, _) in enumerate(schedule(SUBSET_SEED, 24)) if kind == "single")
    write_case(SUBSET_SEED, index, 24, tmp_path)
    name = identity(SUBSET_SEED, index)
    case = tmp_path / "cases" / name
    follow_up.play(tmp_path / "answers" / name, RIG, case, tmp_path / "together", tmp_path / "alone")
    before, after, both = (rows(p / "data.csv") for p in (case, tmp_path / "alone", tmp_path / "together"))
    assert len(after) == 9
    assert len(both) == len(before) + len(after)
    assert [float(row["dx_mm"]) for row in after] == pytest.approx(
        [0.25, 0.75, 1.25, 0.75, 0.25, -0.25, -0.75, -0.25, 0.25]
    )
    assert all(float(row["t_s"]) > float(before[-1]["t_s"]) for row in after)
    assert int(after[0]["run"]) == int(before[-1]["run"]) + 1
    assert int(after[0]["config"]) not in {int(row["config"]) for row in before}
    assert all(row["enc1_rad"] and row["base_x_mm"] for row in after)
    for column in set(after[0]) - set(before[0]):
        assert {row[column] for row in both[: len(before)]} == {""}
    for row, old in zip(both, before, strict=False):
        assert {key: row[key] for key in old} == old
    assert (tmp_path / "together" / "limb.toml").read_bytes() == (case / "limb.toml").read_bytes()


@pytest.mark.parametrize("knee", ["up", "down"])
def test_polar_poses(knee: str) -> None:
    """r and phi come back from the angles; knee up is a positive flexion; out of reach is an error."""
    p = NEUTRAL.copy()
    p[INDEX["geometry.femur_mm"]], p[INDEX["geometry.tibia_mm"]] = 185.0, 313.5
    th1, th2 = follow_up._pose({"r_mm": 400.0, "phi_rad": 0.3, "knee": knee}, p)
    assert (th2 > 0.0) == (knee == "up")
    x = 185.0 * math.cos(th1) + 313.5 * math.cos(th1 - th2)
    z = 185.0 * math.sin(th1) + 313.5 * math.sin(th1 - th2)
    assert (math.hypot(x, z), math.atan2(z, x)) == pytest.approx((400.0, 0.3), abs=1e-3)
    with pytest.raises(follow_up.NotPlayable):
        follow_up._pose({"r_mm": 600.0, "phi_rad": 0.3}, p)
