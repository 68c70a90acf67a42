"""`brace k` of a limb with backlash: K while a gap is open is the limit of a joint that grows softer without end."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import Outcome

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


def test_the_text_tells_both(brace: Brace, with_gap: Path, paper_limb: Path) -> None:
    text = brace("k", "--model", with_gap, *POSTURE).out
    assert "joint.tibia 0.004 rad (0.229 deg)" in text and "while it is open K = 2.16054" in text
    assert "backlash" not in brace("k", "--model", paper_limb, *POSTURE).out


def test_under_a_load_the_gap_is_taken_up(brace: Brace, with_gap: Path) -> None:
    text = brace("k", "--model", with_gap, *POSTURE, "--fz", 10).out
    assert "once it is taken up" in text and "while it is open" not in text
