"""`brace k`: the firmware's K against formulas written down apart from it."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from command_bench import LIMB, Outcome, physics_k

PLANAR_KEYS = {
    "k_xx_n_per_mm",
    "k_xz_n_per_mm",
    "k_zz_n_per_mm",
    "c_xx_mm_per_n",
    "c_xz_mm_per_n",
    "c_zz_mm_per_n",
    "lambda_min_n_per_mm",
    "lambda_max_n_per_mm",
    "stiff_axis_rad",
    "flags",
}


def planar(values: dict[str, float]) -> np.ndarray:
    return np.array(
        [
            [values["k_xx_n_per_mm"], values["k_xz_n_per_mm"]],
            [values["k_xz_n_per_mm"], values["k_zz_n_per_mm"]],
        ]
    )


@pytest.mark.parametrize("arith", ["f32", "fixed", "general"])
def test_check_values(arith: str, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    outcome = brace("k", "--model", paper_limb, "--theta1", 1.0, "--theta2", 1.4, "--arith", arith, "--json")
    values = json.loads(outcome.out)
    assert outcome.code == 0 and PLANAR_KEYS <= values.keys()
    assert values["arith"] == arith and values["flags"] == 0
    for key, expected in (("k_xx", 3.96389818), ("k_xz", -0.63872477), ("k_zz", 0.42806022)):
        assert values[f"{key}_n_per_mm"] == pytest.approx(expected, abs=2e-6 * 4.1)


@pytest.mark.parametrize("arith", ["f32", "fixed", "general"])
def test_k_over_the_workspace(
    arith: str, brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    random = np.random.default_rng(5)
    angles = np.column_stack([random.uniform(-3.1, 3.1, 300), random.uniform(-3.1, 3.1, 300)])
    rows = _table(brace, paper_limb, tmp_path, angles, arith)
    for (theta1, theta2), row in zip(angles, rows):
        values = {key: float(row[key]) for key in PLANAR_KEYS}
        expected = physics_k(theta1, theta2)
        low, high = np.linalg.eigvalsh(expected)
        # 2e-6 of the arithmetic, and the angles' own rounding to float (2^-24 relative, 3e-7 rad at pi) through
        # dK/dtheta <= 2 lambda_max, and through lambda_max's slope near the straight limb
        assert np.abs(planar(values) - expected).max() <= 5e-6 * high
        assert values["lambda_min_n_per_mm"] == pytest.approx(low, rel=6e-6)
        assert values["lambda_max_n_per_mm"] == pytest.approx(high, rel=2e-5)
        c = np.linalg.inv(expected)
        assert values["c_xx_mm_per_n"] == pytest.approx(c[0, 0], abs=2e-6 * np.abs(c).max())
        axis = np.array([math.cos(values["stiff_axis_rad"]), math.sin(values["stiff_axis_rad"])])
        assert axis @ expected @ axis == pytest.approx(high, rel=2e-5)


def test_model_features_reach_the_firmware(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(
        LIMB.replace("[link.tibia]", "moment_transfer = 0.5\n[link.tibia]")
        .replace("= 1.0e-5\n", "= 1.0e-5\nzero_offset_rad = 0.1\n")
        .replace("= 1.6e-5\n", "= 1.6e-5\nzero_offset_rad = -0.2\n")
    )
    values = json.loads(brace("k", "--model", limb, "--theta1", 0.9, "--theta2", 1.6, "--json").out)
    expected = physics_k(1.0, 1.4, moment_transfer=0.5)
    assert np.abs(planar(values) - expected).max() < 5e-6 * np.linalg.eigvalsh(expected)[1]
    assert values["theta1_true_rad"] == pytest.approx(1.0, abs=1e-6)


def test_a_yielding_base_takes_the_general_path(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB + "[base]\nx_mm_per_n = 0.2\nz_mm_per_n = 0.01\nrotation_rad_per_n_mm = 2e-6\n")
    values = json.loads(brace("k", "--model", limb, "--theta1", 1.0, "--theta2", 1.4, "--json").out)
    c = np.linalg.inv(physics_k(1.0, 1.4, joint=(1.2e-5, 1.6e-5))) + np.diag([0.2, 0.01])
    assert values["arith"] == "general"
    assert np.abs(planar(values) - np.linalg.inv(c)).max() < 5e-6 * 5
    refused = brace("k", "--model", limb, "--theta1", 1.0, "--theta2", 1.4, "--arith", "fixed")
    assert refused.code == 2 and "--arith" in refused.err


def test_polar_coordinates_and_both_knees(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    for knee in ("up", "down"):
        values = json.loads(
            brace("k", "--model", paper_limb, "--r", 400, "--phi", -0.3, "--knee", knee, "--json").out
        )
        theta1, theta2 = values["theta1_rad"], values["theta2_rad"]
        tip = 185 * np.exp(1j * theta1) + 313.5 * np.exp(1j * (theta1 - theta2))
        assert abs(tip - 400 * np.exp(-0.3j)) < 1e-3
        assert (theta2 > 0) == (knee == "up")
        assert np.abs(planar(values) - physics_k(theta1, theta2)).max() < 1e-4
        assert values["r_mm"] == pytest.approx(400, abs=1e-3)


def test_sigma_is_that_of_a_simulated_calibration(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    """The limb's parameters drawn from [uncertainty] 4,000 times: the spread of K is what is printed."""
    random = np.random.default_rng(2)
    values = json.loads(brace("k", "--model", paper_limb, "--theta1", 1.0, "--theta2", 1.4, "--json").out)
    draws = []
    for _ in range(4000):
        rel = 1 + 0.05 * random.standard_normal(6)
        k = physics_k(
            1.0 + 0.003 * random.standard_normal(),
            1.4 + 0.003 * random.standard_normal(),
            axial=(0.001 * rel[0], 0.002 * rel[1]),
            bending=(0.06 * rel[2], 0.25 * rel[3]),
            joint=(1e-5 * rel[4], 1.6e-5 * rel[5]),
            lengths=(185 + 0.5 * random.standard_normal(), 313.5 + 0.5 * random.standard_normal()),
        )
        draws.append(k * (1 + 0.005 * random.standard_normal()))
    spread = np.std(draws, axis=0)
    for key, entry in (("xx", spread[0, 0]), ("xz", spread[0, 1]), ("zz", spread[1, 1])):
        # 4,000 draws know a spread to 1.1 % (one sigma); first order is good to some per cent
        assert values[f"sigma_k_{key}_n_per_mm"] == pytest.approx(entry, rel=0.08)


def test_space_at_zero_yaw_is_the_plane(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(
        LIMB.replace("[link.tibia]", "lateral_mm_per_n = 0.05\ntorsion_rad_per_n_mm = 1e-6\n[link.tibia]")
        + "[joint.coxa]\ncompliance_rad_per_n_mm = 8e-6\n"
    )
    flat = planar(json.loads(brace("k", "--model", limb, "--theta1", 0.8, "--theta2", 1.2, "--json").out))
    c_yy = None
    for yaw in (0.0, 0.7, -2.0):
        v = json.loads(
            brace("k", "--model", limb, "--theta0", yaw, "--theta1", 0.8, "--theta2", 1.2, "--json").out
        )
        k = np.array([[v[f"k_{''.join(sorted(a + b))}_n_per_mm"] for b in "xyz"] for a in "xyz"])
        c = np.array([[v[f"c_{''.join(sorted(a + b))}_mm_per_n"] for b in "xyz"] for a in "xyz"])
        turn = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
        back = turn.T @ k @ turn
        assert np.abs(back[np.ix_([0, 2], [0, 2])] - flat).max() < 1e-5 * np.linalg.eigvalsh(flat)[1] * 2
        assert abs(back[0, 1]) < 1e-4 and abs(back[1, 2]) < 1e-4
        assert np.abs(c @ k - np.eye(3)).max() < 1e-6
        assert np.sort(
            [v["lambda_min_n_per_mm"], v["lambda_mid_n_per_mm"], v["lambda_max_n_per_mm"]]
        ) == pytest.approx(np.linalg.eigvalsh(k), rel=2e-5)
        c_yy = c_yy or 1 / back[1, 1]
        assert 1 / back[1, 1] == pytest.approx(c_yy, rel=2e-5)
    reach = 57 + 185 * math.cos(0.8) + 313.5 * math.cos(-0.4)
    aside = 313.5 * math.sin(1.2)
    assert c_yy == pytest.approx(8e-6 * reach**2 + 0.05 + 1e-6 * aside**2, rel=2e-5)


def test_refusals(brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path) -> None:
    model = ("k", "--model", paper_limb)
    for arguments in (
        (),
        ("--theta1", 1),
        ("--theta1", "nan", "--theta2", 1),
        ("--theta1", "abc", "--theta2", 1),
        ("--theta1", 50, "--theta2", 1),
        ("--r", 600, "--phi", 0),
        ("--r", 100, "--phi", 0),
        ("--theta1", 1, "--theta2", 1, "--r", 300, "--phi", 0),
        ("--theta1", 1, "--theta2", 1, "--out", "x"),
        ("--theta1", 1, "--theta2", 1, "--arith", "f64"),
        ("--csv", "a.csv"),
        ("--r", -5, "--phi", 0),
    ):
        outcome = brace(*model, *arguments)
        assert outcome.code == 2 and outcome.out == "" and outcome.err
    assert brace("k").code == 2 and brace().code == 2 and brace("kay").code == 2
    assert brace("--version").code == 0 and brace("k", "--help").code == 0


def test_negative_numbers_are_values(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    assert brace("k", "--model", paper_limb, "--theta1", "-1e-3", "--theta2", "-.5", "--json").code == 0


def test_many_postures_keep_their_rows(
    brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    source, out = tmp_path / "in.csv", tmp_path / "out.csv"
    source.write_text("label,theta2_rad,theta1_rad\nfirst one,1.4,1.0\nsecond,0.5,-0.25\n")
    outcome = brace("k", "--model", paper_limb, "--csv", source, "--out", out, "--json")
    assert outcome.code == 0 and json.loads(outcome.out)["rows"] == 2
    lines = out.read_text().split("\n")
    assert lines[0].startswith("label,theta2_rad,theta1_rad,k_xx_n_per_mm") and lines[0].endswith(",flags")
    assert lines[1].startswith("first one,1.4,1.0,3.9638") and lines[2].startswith("second,0.5,-0.25,")
    single = json.loads(brace("k", "--model", paper_limb, "--theta1", -0.25, "--theta2", 0.5, "--json").out)
    assert float(next(csv.DictReader(lines[0:1] + lines[2:3]))["k_zz_n_per_mm"]) == pytest.approx(
        single["k_zz_n_per_mm"], rel=1e-8
    )


def test_a_bad_row_leaves_the_old_result(
    brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    source, out = tmp_path / "in.csv", tmp_path / "out.csv"
    out.write_text("old")
    for text, words in (
        ("theta1_rad,theta2_rad\n1,1\n1,x\n", ":3 (row 2), theta2_rad"),
        ("theta1_rad,theta2_rad\n1,1\n1,99\n", ":3 (row 2)"),
        ("theta1_rad\n1\n", "theta2_rad"),
        ("theta1_rad,theta2_rad,flags\n1,1,0\n", "flags is there already"),
    ):
        source.write_text(text)
        outcome = brace("k", "--model", paper_limb, "--csv", source, "--out", out)
        assert outcome.code == 3 and words in outcome.err and out.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.csv", "out.csv"]


def _table(
    brace: Callable[..., Outcome], limb: Path, folder: Path, angles: np.ndarray, arith: str
) -> list[dict[str, str]]:
    source, out = folder / "in.csv", folder / "out.csv"
    source.write_text("theta1_rad,theta2_rad\n" + "".join(f"{a!r},{b!r}\n" for a, b in angles.tolist()))
    assert brace("k", "--model", limb, "--csv", source, "--out", out, "--arith", arith).code == 0
    with out.open() as file:
        return list(csv.DictReader(file))
