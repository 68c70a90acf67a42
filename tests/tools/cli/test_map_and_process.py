"""`brace map`, and the command as a process: time, interruption, missing library."""

from __future__ import annotations

import csv
import json
import os
import signal
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from command_bench import LIMB, Outcome, assert_a_million_takes_two_seconds, physics_k, processor_s, spawn


def test_map_draws_the_papers_curves(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    outcome = brace(
        "map", "--model", paper_limb, "--out", tmp_path / "m", "--postures", 10_000, "--npy", "--json"
    )
    summary = json.loads(outcome.out)
    assert outcome.code == 0
    assert sorted(path.name for path in (tmp_path / "m").iterdir()) == [
        "eigenvalues.csv",
        "ellipses.csv",
        "map.png",
        "map.svg",
        "postures.npy",
    ]
    with (tmp_path / "m" / "eigenvalues.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 100
    for row in rows[5:-5:9]:
        low, high = np.linalg.eigvalsh(physics_k(0.3, float(row["theta2_rad"])))
        assert float(row["lambda_min_n_per_mm"]) == pytest.approx(low, rel=1e-5)
        assert float(row["lambda_max_n_per_mm"]) == pytest.approx(high, rel=2e-5)
        r = abs(185 + 313.5 * np.exp(1j * float(row["theta2_rad"])))
        assert float(row["r_mm"]) == pytest.approx(r, abs=1e-3)
    assert summary["quasi_convex_lambda_max"] and len(summary["turning_points_r_mm"]["lambda_max"]) == 1
    table = np.load(tmp_path / "m" / "postures.npy")
    assert table.size == summary["postures"] == 10_000
    k = physics_k(float(table["theta1_rad"][1234]), float(table["theta2_rad"][1234]))
    assert table["k_xz_n_per_mm"][1234] == pytest.approx(k[0, 1], abs=5e-6 * np.linalg.eigvalsh(k)[1])
    assert (tmp_path / "m" / "map.png").read_bytes().startswith(b"\x89PNG")


def test_map_says_how_k_goes_with_reach(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    """lambda_min of the paper's limb falls all the way; lambda_max turns once."""
    asked = ("map", "--model", paper_limb, "--postures", 2500, "--out")
    summary = json.loads(brace(*asked, tmp_path / "a", "--json").out)
    (turn_mm,) = summary["turning_points_r_mm"]["lambda_max"]
    _, least, most, *_ = brace(*asked, tmp_path / "b").out.splitlines()
    assert least.startswith("lambda_min ") and least.endswith("; falls steadily with reach")
    assert most.startswith("lambda_max ")
    assert most.endswith(f"; turns between rising and falling at r = {turn_mm:.1f} mm")


def test_map_of_a_yielding_base_shows_a_band(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB + "[base]\nx_mm_per_n = 0.5\n")
    outcome = brace("map", "--model", limb, "--out", tmp_path / "m", "--postures", 2500, "--json")
    assert json.loads(outcome.out)["path"] == "general"
    with (tmp_path / "m" / "eigenvalues.csv").open() as file:
        row = list(csv.DictReader(file))[25]
    assert float(row["lambda_max_high_n_per_mm"]) > 1.1 * float(row["lambda_max_low_n_per_mm"])


def test_map_under_a_load(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    """Its ellipses are those of `brace k`, drawn where the loaded tip is; folded postures are counted and left out."""
    asked = ("map", "--model", paper_limb, "--postures", 2500, "--out")
    outcome = brace(*asked, tmp_path / "m", "--fx", -20, "--npy", "--json")
    summary = json.loads(outcome.out)
    assert (summary["path"], summary["fx_n"], summary["fz_n"], summary["folded_postures"]) == ("loaded", -20, 0, 0)
    with (tmp_path / "m" / "ellipses.csv").open() as file:
        row = list(csv.DictReader(file))[17]
    angles = ("--theta1", row["theta1_rad"], "--theta2", row["theta2_rad"])
    k = json.loads(brace("k", "--model", paper_limb, *angles, "--fx", -20, "--json").out)
    for name in ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm", "tip_dx_mm", "tip_dz_mm"):
        assert float(row[name]) == pytest.approx(k[name], rel=1e-5, abs=1e-5)
    x_mm = k["r_mm"] * np.cos(k["phi_rad"]) + k["tip_dx_mm"]
    assert float(row["x_mm"]) == pytest.approx(x_mm, abs=0.01)
    table = np.load(tmp_path / "m" / "postures.npy")
    moved_mm = np.hypot(table["tip_dx_mm"], table["tip_dz_mm"])
    assert summary["displacement_most_mm"] == pytest.approx(float(moved_mm.max()))
    assert summary["buckling_factor_least"] == pytest.approx(float(table["buckling_factor"].min()))
    folds = json.loads(brace(*asked, tmp_path / "f", "--fz", 3000, "--json").out)
    assert folds["folded_postures"] > 0
    for force_n in (9000, 10_000):
        none = brace(*asked, tmp_path / "n", "--fz", -force_n)
        assert none.code == 2 and "of 2500 postures have no K under this load" in none.err
        assert not (tmp_path / "n").exists()


def test_map_takes_no_force_across_the_plane(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    """Its K is in the plane: such a force would be left out in silence."""
    outcome = brace("map", "--model", paper_limb, "--out", tmp_path / "m", "--fx", 1, "--fy", 5)
    assert outcome.code == 2 and "--fy" in outcome.err and not (tmp_path / "m").exists()


def test_map_is_the_same_every_time(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    for name in ("a", "b"):
        assert brace("map", "--model", paper_limb, "--out", tmp_path / name, "--postures", 400).code == 0
    for name in ("map.png", "map.svg", "eigenvalues.csv", "ellipses.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_map_refuses_ranges_that_are_none(
    tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path
) -> None:
    for arguments in (
        ("--theta2", 1, 1),
        ("--theta2", 2, 1),
        ("--theta1", 0, 10),
        ("--postures", 1),
        ("--postures", "many"),
    ):
        outcome = brace("map", "--model", paper_limb, "--out", tmp_path / "m", *arguments)
        assert outcome.code == 2 and not (tmp_path / "m").exists()


@pytest.mark.minutes
def test_a_million_postures_in_two_seconds_of_processor(tmp_path: Path, paper_limb: Path) -> None:
    spent_s, _ = processor_s("map", "--model", paper_limb, "--postures", 1_000_000, "--out", tmp_path / "m")
    assert_a_million_takes_two_seconds(spent_s, paper_limb, tmp_path / "few")


def map_is_under_way(pid: int) -> None:
    """A start of Python takes less than a second of a processor, this map a minute."""
    spent_s = 0.0
    while spent_s < 3.0:
        time.sleep(0.05)
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        spent_s = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_interruption_leaves_nothing(tmp_path: Path, paper_limb: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB + "[base]\nx_mm_per_n = 0.5\n")  # the general path: some time to interrupt
    out = tmp_path / "m"
    process = spawn("map", "--model", limb, "--postures", 40_000_000, "--out", out)
    map_is_under_way(process.pid)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130 and "interrupted" in err and "Traceback" not in err
    assert not out.exists() and sorted(path.name for path in tmp_path.iterdir()) == ["limb.toml"]


def test_a_missing_library_is_said(tmp_path: Path, paper_limb: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for content in (None, b"not a library"):
        path = tmp_path / "libbrace_host.so"
        if content:
            path.write_bytes(content)
        monkeypatch.setenv("BRACE_LIBRARY", str(path))
        process = spawn("k", "--model", paper_limb, "--theta1", 1, "--theta2", 1)
        out, err = process.communicate(timeout=120)
        assert process.returncode == 2 and out == "" and "libbrace_host.so" in err and "try:" in err
        assert "Traceback" not in err


def test_a_closed_pipe_is_no_error(paper_limb: Path) -> None:
    process = spawn("k", "--model", paper_limb, "--theta1", 1, "--theta2", 1)
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    err = process.stderr.read()
    assert process.wait(timeout=120) == 0 and "Traceback" not in err and "Error" not in err
