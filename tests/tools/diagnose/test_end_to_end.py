"""A record with play hidden in it, from simulation to the controller's block, by the commands that people type."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import Outcome
from handmade import GAP_KEY, GAP_RAD, loading_record

from brace.dataset import load_dataset
from brace.model import load_limb

FILES = ("diagnosis.json", "limb.toml", "report.html")


def _rms_gap(brace: Callable[..., Outcome], record: Path, limb: Path, out: Path) -> float:
    """Of `brace predict` against the record [N]."""
    assert brace("predict", record, "--model", limb, "--out", out).code == 0
    measured = load_dataset(record)
    rows = [line.split(",") for line in out.read_text().splitlines()[1:]]
    square = [
        (float(fx) - mx) ** 2 + (float(fz) - mz) ** 2
        for (fx, fz), mx, mz in zip(rows, measured["fx_n"], measured["fz_n"], strict=True)
    ]
    return float((sum(square) / (2 * len(square))) ** 0.5)


def test_hidden_play_is_named_and_handed_to_the_controller(
    brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    record = loading_record(tmp_path / "measured", paper_limb)
    for out in ("first", "second"):
        outcome = brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / out)
        assert outcome.code == 0, outcome.err
    assert "backlash" in outcome.out.splitlines()[0]
    for name in FILES:  # same data, model, seed: same bytes
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "second" / name).read_bytes()
    found = json.loads((tmp_path / "first" / "diagnosis.json").read_text())
    assert found["verdict"] == "effect"
    assert [(effect["name"], effect["where"]) for effect in found["effects"]] == [("backlash", "joint.tibia")]
    gap = found["effects"][0]["parameters"][GAP_KEY]
    assert gap["value"] == pytest.approx(GAP_RAD, rel=0.1) and gap["low"] < gap["value"] < gap["high"]
    limb = tmp_path / "first" / "limb.toml"
    assert load_limb(limb).number(GAP_KEY) == pytest.approx(gap["value"], rel=1e-6)
    assert brace("params", "pack", "--model", limb, "--out", tmp_path / "limb.bin").code == 0
    before = _rms_gap(brace, record, paper_limb, tmp_path / "before.csv")
    after = _rms_gap(brace, record, limb, tmp_path / "after.csv")
    assert after < 0.12 < 0.5 < before  # the noise is 0.1 N
    report = (tmp_path / "first" / "report.html").read_text()
    assert "backlash (knee joint)" in report and f"{after:.2g}"[:3] in report
