"""`brace k` of a limb with backlash: K while a gap is open is the limit of a joint that grows softer without end."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import Outcome

Brace = Callable[..., Outcome]
K = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
POSTURE = ("--theta1", 1, "--theta2", 1.4)
KNEE = "compliance_rad_per_n_mm = 1.6e-5"


@pytest.fixture
def with_gap(paper_limb: Path, tmp_path: Path) -> Path:
    limb = tmp_path / "gap.toml"
    limb.write_text(paper_limb.read_text().replace(KNEE, KNEE + "\ngap_rad = 0.004"))
    return limb


def test_an_open_gap_carries_nothing(brace: Brace, with_gap: Path, paper_limb: Path, tmp_path: Path) -> None:
    told = json.loads(brace("k", "--model", with_gap, *POSTURE, "--json").out)
    free = tmp_path / "free.toml"
    free.write_text(paper_limb.read_text().replace(KNEE, "compliance_rad_per_n_mm = 1.0"))
    soft = json.loads(brace("k", "--model", free, *POSTURE, "--arith", "general", "--json").out)
    for name in K:  # a knee of 1 rad/(N mm) leaves 1e-5 of K's size
        assert told["while_open"]["tibia"][name] == pytest.approx(soft[name], abs=1e-4)
    assert told["k_xx_n_per_mm"] == pytest.approx(3.963898, abs=1e-5)  # with the gap closed


def test_without_a_load_the_gap_may_be_open_and_k_says_so(brace: Brace, with_gap: Path, tmp_path: Path) -> None:
    """As a controller there tells it: GAP_OPEN, and K with every gap open as the lower bound."""
    told = json.loads(brace("k", "--model", with_gap, *POSTURE, "--json").out)
    assert "GAP_OPEN" in told["flag_names"] and told["open"]["k_xx_n_per_mm"] == told["while_open"]["tibia"][K[0]]
    both = tmp_path / "both.toml"
    both.write_text(with_gap.read_text().replace("[joint.femur]", "[joint.femur]\ngap_rad = 0.003", 1))
    told = json.loads(brace("k", "--model", both, *POSTURE, "--json").out)
    assert told["open"] == dict.fromkeys(K, 0.0)
    loaded = json.loads(brace("k", "--model", both, *POSTURE, "--fz", 10, "--json").out)
    assert "GAP_OPEN" not in loaded["flag_names"]
    rows = tmp_path / "in.csv"
    rows.write_text("theta1_rad,theta2_rad\n1,1.4\n")
    brace("k", "--model", both, "--csv", rows, "--out", tmp_path / "out.csv")
    assert (tmp_path / "out.csv").read_text().splitlines()[1].endswith(f",{told['flags']}")


def test_a_posture_outside_the_travel_is_flagged(brace: Brace, paper_limb: Path, tmp_path: Path) -> None:
    limb = tmp_path / "travel.toml"
    limb.write_text(paper_limb.read_text() + "\n[motor.tibia]\nangle_min_rad = 0.2\nangle_max_rad = 1.3\n")
    outside = brace("k", "--model", limb, *POSTURE)
    assert "OUT_OF_RANGE" in outside.out and "theta2_rad = 1.4 is outside the travel of [motor.tibia]" in outside.err
    below = brace("k", "--model", limb, "--theta1", 1, "--theta2", 0.1)
    assert "OUT_OF_RANGE" in below.out and "theta2_rad = 0.1 is outside" in below.err
    within = brace("k", "--model", limb, "--theta1", 1, "--theta2", 1.2)
    assert "OUT_OF_RANGE" not in within.out and "outside" not in within.err
    grid = json.loads(brace("map", "--model", limb, "--postures", 400, "--out", tmp_path / "m", "--json").out)
    r = [(185**2 + 313.5**2 + 2 * 185 * 313.5 * math.cos(theta2)) ** 0.5 for theta2 in (1.3, 0.2)]
    assert grid["r_mm"] == pytest.approx(r, rel=1e-5)
    beyond = brace("map", "--model", limb, "--postures", 400, "--theta2", 0, 2, "--out", tmp_path / "m2")
    assert "--theta2 goes beyond the travel" in beyond.err


def test_map_and_plan_tell_the_play(brace: Brace, with_gap: Path, tmp_path: Path) -> None:
    drawn = brace("map", "--model", with_gap, "--postures", 400, "--out", tmp_path / "m")
    assert "backlash of the tibia, 0.229 deg: K of this map holds once a load has taken it up" in drawn.out
    pressed = ("map", "--model", with_gap, "--postures", 400, "--theta2", 0.5, 1.5, "--fz")
    for force_n, low, high in ((20, 0.8, 1.0), (0.001, 0.0, 0.1)):
        loaded = json.loads(brace(*pressed, force_n, "--out", tmp_path / "p", "--json").out)
        assert low <= loaded["play_held_ratio"]["tibia"] <= high
    planned = brace("plan", "--model", with_gap, "--count", 1)
    assert "play of the tibia: force and weight do not hold it (GAP_OPEN; brace take-up tibia+" in planned.out
    assert "until it is taken up the tip goes 1.3 mm" in planned.out  # 0.004 rad at 313.5 mm
    where = ("--x", 300, 350, "--z", -200, -150)
    carries = brace("plan", "--model", with_gap, "--count", 1, *where, "--payload", 20)
    assert "play of the tibia: force and weight hold it; until it is taken up" in carries.out
    best = json.loads(brace("plan", "--model", with_gap, "--count", 1, *where, "--json").out)["best"][0]
    assert best["play_open"] == "tibia"
    assert "no travel of the femur" in planned.err and "no travel of the knee" in planned.err


def test_the_text_tells_both(brace: Brace, with_gap: Path, paper_limb: Path) -> None:
    text = brace("k", "--model", with_gap, *POSTURE).out
    assert "joint.tibia 0.004 rad (0.229 deg)" in text and "while it is open K = 2.16054" in text
    assert "backlash" not in brace("k", "--model", paper_limb, *POSTURE).out


def test_under_a_load_the_gap_is_taken_up(brace: Brace, with_gap: Path) -> None:
    text = brace("k", "--model", with_gap, *POSTURE, "--fz", 2).out
    assert "backlash  joint.tibia 0.004 rad (0.229 deg)" in text and "while it is open" not in text
    assert "this load holds the tibia on its + side; nothing has proven it (PLAY_ASSUMED)" in text
    text = brace("k", "--model", with_gap, *POSTURE, "--fz", 10).out
    assert "this load holds the tibia on its + side: its motor's torque proves it" in text and "PLAY" not in text


def test_a_load_that_holds_no_side_leaves_the_gap_open(brace: Brace, with_gap: Path) -> None:
    """As a controller decides it: K of the open gap, what takes it up, and K once it is taken up."""
    weak = json.loads(brace("k", "--model", with_gap, *POSTURE, "--fz", 0.3, "--json").out)
    assert "GAP_OPEN" in weak["flag_names"] and "PLAY_ASSUMED" not in weak["flag_names"]
    assert weak["lambda_min_n_per_mm"] == 0.0 and weak["engaged"]["k_xx_n_per_mm"] == pytest.approx(3.97, abs=0.01)
    assert "brace take-up tibia-" in brace("k", "--model", with_gap, *POSTURE, "--fz", 0.3).out
    held = json.loads(brace("k", "--model", with_gap, *POSTURE, "--fz", 2, "--json").out)
    assert "PLAY_ASSUMED" in held["flag_names"] and "GAP_OPEN" not in held["flag_names"]
    assert held["held"] == {"tibia": 1}  # its motor holds the tibia up: it stands half the gap off
    shifted = ("--theta1", 1, "--theta2", 1.4 - 0.002)
    none = with_gap.parent / "none.toml"
    none.write_text(with_gap.read_text().replace("gap_rad = 0.004", "gap_rad = 0.0"))
    off = json.loads(brace("k", "--model", none, *shifted, "--fz", 2, "--json").out)
    for name in K:
        assert held[name] == pytest.approx(off[name], rel=1e-6)
