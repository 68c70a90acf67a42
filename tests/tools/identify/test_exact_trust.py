"""A limb.toml without [uncertainty]: `identify` has nothing to turn and says so; `diagnose` assumes a trust."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import Outcome

Brace = Callable[..., Outcome]


@pytest.fixture
def exact(paper_limb: Path, tmp_path: Path) -> Path:
    limb = tmp_path / "exact.toml"
    said = paper_limb.read_text().replace("[link.tibia]", "[link.tibia]\nmoment_transfer = false")
    limb.write_text(re.sub(r"\[uncertainty\][^\[]*", "", said))
    return limb


@pytest.fixture
def record(brace: Brace, exact: Path, paper_rig: Path, tmp_path: Path) -> Path:
    """Of the same limb with play at the knee, at a third of the paper's postures."""
    true, rig = tmp_path / "true.toml", tmp_path / "rig.toml"
    true.write_text(exact.read_text().replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.004"))
    head, *postures = paper_rig.read_text().split("[[configuration]]")
    rig.write_text("[[configuration]]".join([head, *postures[::3]]))
    assert brace("simulate", "--model", true, "--rig", rig, "--out", tmp_path / "record").code == 0
    return tmp_path / "record"


def test_diagnose_names_what_is_missing(brace: Brace, exact: Path, record: Path, tmp_path: Path) -> None:
    outcome = brace("diagnose", record, "--model", exact, "--out", tmp_path / "found", "--json")
    assert outcome.code == 0, outcome.err
    assert [effect["name"] for effect in json.loads(outcome.out)["effects"]] == ["backlash"]


def test_identify_says_that_nothing_is_to_be_fitted(brace: Brace, exact: Path, record: Path, tmp_path: Path) -> None:
    outcome = brace("identify", record, "--model", exact, "--out", tmp_path / "fitted.toml")
    assert outcome.code == 2 and "[uncertainty]" in outcome.err and "--free" in outcome.err
    assert not (tmp_path / "fitted.toml").exists()


@pytest.mark.minutes
def test_identify_fits_what_it_is_told_to(brace: Brace, exact: Path, record: Path, tmp_path: Path) -> None:
    fitted = tmp_path / "fitted.toml"
    outcome = brace("identify", record, "--model", exact, "--out", fitted, "--fit", "joint.tibia.gap_rad")
    assert outcome.code == 0, outcome.err
    assert "gap_rad = 0.00" in fitted.read_text()
