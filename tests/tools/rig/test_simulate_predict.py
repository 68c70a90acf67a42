"""`brace simulate` and `brace predict`: the load sequence on the simulated limb."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.ground.files import OutputSet
from command_bench import LIMB, LOADING_META, Outcome, loading_rows, physics_k, write_loading

RIG = """format = 1
seed = 3
[rig]
repeats = 2
[sensor]
noise_n = 0.1
resolution_n = 0.0
[[configuration]]
theta1_rad = 0.7
theta2_rad = 1.1
[[configuration]]
r_mm = 300.0
phi_rad = -0.4
"""


@pytest.fixture
def files(tmp_path: Path) -> dict[str, Path]:
    paths = {"limb": tmp_path / "limb.toml", "rig": tmp_path / "rig.toml", "out": tmp_path / "set"}
    paths["limb"].write_text(LIMB)
    paths["rig"].write_text(RIG)
    return paths


def read(path: Path) -> dict[str, np.ndarray]:
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_a_simulated_test_is_a_sound_dataset(files: dict[str, Path], brace: Callable[..., Outcome]) -> None:
    outcome = brace(
        "simulate", "--model", files["limb"], "--rig", files["rig"], "--out", files["out"], "--json"
    )
    assert outcome.code == 0 and json.loads(outcome.out)["rows"] == 2 * 2 * 2 * 17
    dataset = load_dataset(files["out"])
    assert not dataset.faults and dataset.rows == 136
    sigma = []
    for row in range(dataset.rows):
        k = physics_k(dataset["theta1_rad"][row], dataset["theta2_rad"][row])
        d = np.array([dataset["dx_mm"][row], dataset["dz_mm"][row]])
        sigma += [*(np.array([dataset["fx_n"][row], dataset["fz_n"][row]]) - k @ d)]
    # 272 draws of N(0, 0.1): their rms is within 4 sigma = 4 * 0.1 / sqrt(2 * 272) of 0.1, their mean of 0
    assert np.std(sigma) == pytest.approx(0.1, abs=0.017)
    assert abs(np.mean(sigma)) < 0.025


def test_same_seed_same_bytes(files: dict[str, Path], brace: Callable[..., Outcome], tmp_path: Path) -> None:
    contents = []
    for seed in (3, 3, 4):
        assert (
            brace(
                "simulate",
                "--model",
                files["limb"],
                "--rig",
                files["rig"],
                "--out",
                tmp_path / "s",
                "--seed",
                seed,
            ).code
            == 0
        )
        contents.append((tmp_path / "s" / "data.csv").read_bytes())
    assert contents[0] == contents[1] != contents[2]


def test_sensor_columns_appear_when_asked_for(files: dict[str, Path], brace: Callable[..., Outcome]) -> None:
    files["rig"].write_text(RIG.replace("noise_n = 0.1", "noise_n = 0.0\nencoders = true\nbase_gauge = true"))
    files["limb"].write_text(LIMB + "[base]\nx_mm_per_n = 0.02\n")
    assert brace("simulate", "--model", files["limb"], "--rig", files["rig"], "--out", files["out"]).code == 0
    dataset = load_dataset(files["out"])
    assert np.allclose(dataset["base_x_mm"], 0.02 * dataset["fx_n"], atol=2e-6)
    lever = np.array([-313.5 * np.sin(-0.4), 313.5 * np.cos(-0.4)])  # of joint 2 at theta1 - theta2 = -0.4
    torque = lever[0] * dataset["fx_n"] + lever[1] * dataset["fz_n"]
    first = dataset["config"] == 1
    # The lever turns with the limb, by up to 0.02 rad; beside a lever across the force that is a few per cent.
    assert np.allclose(dataset["enc2_rad"][first], 1.6e-5 * torque[first], atol=6e-4)
    assert np.abs(dataset["enc2_rad"][first]).max() > 1e-2


def test_prediction_has_the_datasets_rows(
    files: dict[str, Path], brace: Callable[..., Outcome], tmp_path: Path
) -> None:
    folder = write_loading(tmp_path / "data", loading_rows())
    out = tmp_path / "pred.csv"
    assert brace("predict", folder, "--model", files["limb"], "--out", out).code == 0
    predicted = read(out)
    assert list(predicted) == ["fx_n", "fz_n"]
    dataset = load_dataset(folder)
    for row in range(dataset.rows):
        k = physics_k(dataset["theta1_rad"][row], dataset["theta2_rad"][row])
        f = k @ [dataset["dx_mm"][row], dataset["dz_mm"][row]]
        assert predicted["fx_n"][row] == pytest.approx(f[0], abs=1e-6)
        assert predicted["fz_n"][row] == pytest.approx(f[1], abs=1e-6)


def test_simulated_and_predicted_agree_with_every_effect(
    files: dict[str, Path], brace: Callable[..., Outcome], tmp_path: Path
) -> None:
    files["limb"].write_text(
        LIMB.replace(
            "[joint.tibia]\n",
            "gap_rad = 0.004\ncoulomb_n_mm = 60.0\n[joint.tibia]\n" "hardening_n_mm_per_rad3 = 1e6\n",
        )
        + "[gravity]\nfemur_n = 2.0\ntibia_n = 3.0\n[sensor]\n"
        "bias_x_n = 0.3\nrotation_rad = 0.02\n[creep]\nratio = 0.1\ntime_constant_s = 30.0\n"
        "[contact]\nplay_mm = 0.05\n"
    )
    files["rig"].write_text(RIG.replace("noise_n = 0.1", "noise_n = 0.0"))
    assert brace("simulate", "--model", files["limb"], "--rig", files["rig"], "--out", files["out"]).code == 0
    out = tmp_path / "pred.csv"
    assert brace("predict", files["out"], "--model", files["limb"], "--out", out).code == 0
    predicted, dataset = read(out), load_dataset(files["out"])
    for name in ("fx_n", "fz_n"):
        assert (
            np.abs(predicted[name] - dataset[name]).max() < 2e-5
        )  # the file's six decimals of displacement and force
    assert np.abs(dataset["fx_n"]).max() > 0.3


def test_zeroed_per_run(files: dict[str, Path], brace: Callable[..., Outcome], tmp_path: Path) -> None:
    files["limb"].write_text(LIMB + "[sensor]\nbias_x_n = 0.7\n[gravity]\ntibia_n = 5.0\n")
    folder = write_loading(tmp_path / "data", loading_rows(), meta=LOADING_META.replace("never", "per_run"))
    assert brace("predict", folder, "--model", files["limb"], "--out", tmp_path / "p.csv").code == 0
    predicted = read(tmp_path / "p.csv")
    steps = np.array([int(row[6]) for row in loading_rows()])
    assert np.abs(predicted["fx_n"][steps == 0]).max() == 0.0


def test_prediction_of_the_table_and_of_a_joint_test(
    brace: Callable[..., Outcome], paper_table: Path, paper_limb: Path, tmp_path: Path
) -> None:
    out = tmp_path / "p.csv"
    outcome = brace("predict", paper_table, "--model", paper_limb, "--out", out)
    assert outcome.code == 0 and "inference" in outcome.err
    assert len(read(out)["k_xx"]) == 12
    assert (
        brace("predict", paper_table, "--model", paper_limb, "--out", out, "--tip-height-mm", -120).code == 0
    )
    high = brace(
        "predict", paper_table, "--model", paper_limb, "--out", tmp_path / "q.csv", "--tip-height-mm", 159
    )
    assert high.code == 2 and "out of reach" in high.err and not (tmp_path / "q.csv").exists()
    predicted = read(out)
    r, z = 158.0, -120.0
    theta2 = np.arccos((r * r - 185**2 - 313.5**2) / (2 * 185 * 313.5))
    theta1 = np.arcsin(z / r) + np.arctan2(313.5 * np.sin(theta2), 185 + 313.5 * np.cos(theta2))
    expected = physics_k(theta1, theta2)
    assert predicted["k_xx"][0] == pytest.approx(expected[0, 0], rel=1e-4)
    assert predicted["k_zx"][0] == predicted["k_xz"][0] == pytest.approx(expected[0, 1], rel=1e-4)
    joint = tmp_path / "joint"
    joint.mkdir()
    (joint / "meta.toml").write_text('format = 1\nkind = "joint_test"\njoint = "tibia"\n')
    angle = np.linspace(-0.01, 0.01, 21)
    (joint / "data.csv").write_text(
        "t_s,angle_rad,torque_n_mm\n"
        + "".join(f"{i},{a:.6f},{a / 1.6e-5:.3f}\n" for i, a in enumerate(angle))
    )
    assert brace("predict", joint, "--model", paper_limb, "--out", out).code == 0
    assert np.allclose(read(out)["torque_n_mm"], np.round(angle, 6) / 1.6e-5, rtol=1e-8, atol=1e-6)


RIG_REFUSED = {
    "unknown key": (("repeats = 2", "repeat = 2"), "did you mean rig.repeats"),
    "fractions of a step": (("repeats = 2", "steps = 2.5"), "whole number"),
    "no poses": (("[[configuration]]", "[[configurations]]"), "configurations"),
    "both": (("theta1_rad = 0.7", "theta1_rad = 0.7\nr_mm = 300.0"), "given twice"),
    "half": (("theta2_rad = 1.1\n", ""), "theta2_rad is missing"),
    "out of reach": (("r_mm = 300.0", "r_mm = 600.0"), "out of reach"),
    "axes": (("repeats = 2", 'axes = ["y"]'), "axes"),
    "too many rows": (("repeats = 2", "repeats = 1000\nsteps = 10000"), "rows"),
    "knee": (("phi_rad = -0.4", 'phi_rad = -0.4\nknee = "left"'), "choices"),
}


@pytest.mark.parametrize("case", RIG_REFUSED)
def test_hostile_rigs(case: str, files: dict[str, Path], brace: Callable[..., Outcome]) -> None:
    (before, after), words = RIG_REFUSED[case]
    assert before in RIG
    files["rig"].write_text(RIG.replace(before, after))
    outcome = brace("simulate", "--model", files["limb"], "--rig", files["rig"], "--out", files["out"])
    assert (
        outcome.code == 3 and words in outcome.err and "rig.toml" in outcome.err and not files["out"].exists()
    )


def test_outputs_are_whole_or_untouched(
    files: dict[str, Path], brace: Callable[..., Outcome], tmp_path: Path
) -> None:
    command = ("simulate", "--model", files["limb"], "--rig", files["rig"], "--out")
    (tmp_path / "file").write_text("mine")
    for out in (tmp_path / "file", tmp_path / "file" / "deeper"):
        outcome = brace(*command, out)
        assert outcome.code == 2 and "in the way" in outcome.err and (tmp_path / "file").read_text() == "mine"
    assert brace(*command, files["out"]).code == 0
    before = (files["out"] / "data.csv").read_bytes()
    files["limb"].write_text(LIMB.replace("0.25", "-0.25"))
    assert brace(*command, files["out"]).code == 3
    assert (files["out"] / "data.csv").read_bytes() == before
    assert sorted(path.name for path in files["out"].iterdir()) == ["data.csv", "meta.toml"]


def test_a_failure_while_writing_leaves_no_trace(tmp_path: Path) -> None:
    (tmp_path / "one").write_text("old")
    with pytest.raises(RuntimeError), OutputSet() as outputs:
        outputs.add(tmp_path / "one", "new")
        outputs.add(tmp_path / "folder" / "two", "new")
        raise RuntimeError("the machine stops here")
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("one", "old")]
