"""Joint tests in the wrong unit, with a sign turned, or with rows copied."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from command_bench import LIMB, Outcome


def record(
    folder: Path,
    *,
    angle_factor: float = 1.0,
    torque_factor: float = 1.0,
    command: bool = True,
    copies: int = 0,
    tick_s: float = 0.0,
) -> Path:
    """Spring, play and friction by formula; the drive stops at 1600 N mm when more is commanded."""
    random = np.random.default_rng(5)
    sweep = np.concatenate([np.linspace(0, 1, 200), np.linspace(1, -1, 400), np.linspace(-1, 1, 400)])
    angle = 0.02 * sweep
    spring = np.where(np.abs(angle) > 0.003, angle - 0.003 * np.sign(angle), 0.0) / 1e-5
    wanted = spring + 120.0 * np.sign(np.diff(angle, prepend=-1e-9))
    torque = np.clip(wanted, -1600.0, 1600.0) + 5.0 * random.standard_normal(angle.size)
    time = 0.1 * np.arange(angle.size)
    if tick_s:
        time = np.floor(time / tick_s) * tick_s
    table = np.column_stack([time, angle * angle_factor, torque * torque_factor, wanted * 1.2])
    names = ["t_s", "angle_rad", "torque_n_mm", "command_n_mm"][: 4 if command else 3]
    lines = [",".join(f"{value:.7f}" for value in row[: len(names)]) for row in table]
    lines[300:300] = [lines[299]] * copies
    folder.mkdir(exist_ok=True)
    (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    (folder / "data.csv").write_text("\n".join([",".join(names), *lines]) + "\n")
    return folder


def test_a_sound_record_is_noted_to_saturate_and_no_more(tmp_path: Path) -> None:
    faults = load_dataset(record(tmp_path)).faults
    assert [(fault.field, fault.blocking) for fault in faults] == [("torque_n_mm", False)]
    assert "saturated" in faults[0].why
    assert not load_dataset(record(tmp_path, command=False)).faults


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"angle_factor": 180 / np.pi}, "angle_rad", "degrees"),
        ({"torque_factor": 1e-3}, "torque_n_mm", "N m: multiply by 1000"),
        ({"torque_factor": 1e-3, "command": False}, "torque_n_mm", "N m: multiply by 1000"),
        # A strong joint's: too much for a small one in the wrong unit, too little for what it turns.
        ({"torque_factor": 0.1, "angle_factor": 20.0, "command": False}, "torque_n_mm", "N m: multiply by 1000"),
        ({"angle_factor": -1.0}, "angle_rad", "sign turned"),
        ({"torque_factor": -1.0}, "angle_rad", "sign turned"),
    ],
)
def test_what_fits_only_otherwise_is_refused(
    change: dict[str, float], field: str, words: str, tmp_path: Path, brace: Callable[..., Outcome]
) -> None:
    folder = record(tmp_path / "d", **change)  # type: ignore[arg-type]
    faults = load_dataset(folder).faults
    assert [(fault.row, fault.field, fault.blocking) for fault in faults if fault.blocking] == [
        (None, field, True)
    ]
    assert any(words in str(fault.suggestion) for fault in faults)
    (tmp_path / "limb.toml").write_text(LIMB)
    out = tmp_path / "f.toml"
    outcome = brace("identify", folder, "--model", tmp_path / "limb.toml", "--out", out)
    assert outcome.code == 3 and words in outcome.err and not out.exists()


def test_copied_rows_are_flagged(tmp_path: Path) -> None:
    faults = [fault for fault in load_dataset(record(tmp_path, copies=1)).faults if fault.field == "t_s"]
    assert [(fault.row, fault.blocking) for fault in faults] == [(301, False)]
    # a coarse clock repeats times of itself; a twentieth of all rows copied is no chance even then
    assert not [f for f in load_dataset(record(tmp_path, tick_s=0.4)).faults if f.field == "t_s"]
    assert [
        f.row for f in load_dataset(record(tmp_path, tick_s=0.4, copies=50)).faults if f.field == "t_s"
    ] == [301]


def test_friction_that_grows_with_the_load_is_told_from_the_spring(
    tmp_path: Path, brace: Callable[..., Outcome]
) -> None:
    """A gearbox's loop by formula: 100 N mm of friction and 15 % of the torque carried."""
    random = np.random.default_rng(2)
    sweep = np.concatenate([np.linspace(0, 1, 200), np.linspace(1, -1, 400), np.linspace(-1, 1, 400)])
    angle = 0.02 * sweep
    spring = np.where(np.abs(angle) > 0.003, angle - 0.003 * np.sign(angle), 0.0) / 1e-5
    friction = (100.0 + 0.15 * np.abs(spring)) * np.sign(np.diff(angle, prepend=-1e-9))
    torque = spring + friction + 10.0 * random.standard_normal(angle.size)
    (tmp_path / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    rows = "".join(f"{0.1 * i:.1f},{a:.7f},{t:.3f}\n" for i, (a, t) in enumerate(zip(angle, torque)))
    (tmp_path / "data.csv").write_text("t_s,angle_rad,torque_n_mm\n" + rows)
    (tmp_path / "limb.toml").write_text(LIMB)
    out = tmp_path / "f.toml"
    outcome = brace("identify", tmp_path, "--model", tmp_path / "limb.toml", "--out", out, "--json")
    found = {key: entry["value"] for key, entry in json.loads(outcome.out)["parameters"].items()}
    assert found["joint.femur.coulomb_per_load_ratio"] == pytest.approx(0.15, rel=0.05)
    assert found["joint.femur.compliance_rad_per_n_mm"] == pytest.approx(1e-5, rel=0.02)
    assert found["joint.femur.coulomb_n_mm"] == pytest.approx(100.0, rel=0.1)
    assert found["joint.femur.gap_rad"] == pytest.approx(0.006, rel=0.05)
    assert "coulomb_per_load_ratio" in out.read_text()
