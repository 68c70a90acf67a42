"""A limb.toml that does not say how far it is trusted: what is assumed is said, and K is right even where the
compliances were guesses. A limb that is trusted exactly and wrong is no fault of the record."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import Outcome
from handmade import loading_record

from brace import toml
from brace.dataset import load_dataset
from brace.diagnose.loading.data_faults.gate import gate
from brace.diagnose.options import Options
from brace.identify.turning import settled
from brace.model import LimbModel, load_limb
from brace.model.assumed_trust import ASSUMED, assumption, with_assumed_trust
from brace.model.limb import limb_from_document
from brace.native.plant import reference_planar

Brace = Callable[..., Outcome]
COMPLIANCES = (
    "link.femur.axial_mm_per_n", "link.femur.bending_mm_per_n", "link.tibia.axial_mm_per_n",
    "link.tibia.bending_mm_per_n", "joint.femur.compliance_rad_per_n_mm", "joint.tibia.compliance_rad_per_n_mm",
)  # fmt: skip
SOFTER = 1.35
ANGLES_RAD = np.array([[0.3, 0.9], [1.0, 1.4], [0.6, 2.1]])


def _silent(text: str) -> str:
    return re.sub(r"\[uncertainty\][^\[]*", "", text)


def _limb(text: str) -> LimbModel:
    return limb_from_document(toml.parse(text, Path("limb.toml"), "limb model"))


def _off(limb: LimbModel, truth: LimbModel) -> float:
    """How far K is off, relative (Frobenius), at the worst posture."""
    k, true = (reference_planar(one, *ANGLES_RAD.T)[:, [0, 1, 1, 2]] for one in (limb, truth))
    return float(np.max(np.linalg.norm(k - true, axis=1) / np.linalg.norm(true, axis=1)))


@pytest.fixture(scope="module")
def softer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The record of a sound limb. Its limb.toml has too small compliances, and no [uncertainty]."""
    limb = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
    folder = tmp_path_factory.mktemp("softer")
    true = {key: SOFTER * load_limb(limb).number(key) for key in COMPLIANCES}
    record = loading_record(folder / "record", limb, values=true, repeats=1)
    (record / "limb.toml").write_text(_silent(limb.read_text()))
    return record


def test_k_is_right_where_a_silent_limb_was_guessed(brace: Brace, softer: Path, tmp_path: Path) -> None:
    """With exact or 5 % compliances the force sensor's gain would be named, and K would stay a third off."""
    outcome = brace("diagnose", softer, "--out", tmp_path / "found", "--json")
    assert outcome.code == 0, outcome.err
    found: dict[str, Any] = json.loads(outcome.out)
    believed = load_limb(softer / "limb.toml")
    truth = believed.with_values({key: SOFTER * believed.number(key) for key in COMPLIANCES})
    off = _off(load_limb(tmp_path / "found" / "limb.toml"), truth)
    assert found["verdict"] == "none" and off < 0.1 * _off(believed, truth), (found["sentence"], off)
    sentence = assumption(believed)
    assert f"brace: {sentence}" in outcome.err
    assert found["notes"][0] == sentence
    head = (tmp_path / "found" / "report.html").read_text().partition("</header>")[0]
    assert "compliances (50 %)" in head and "compliance_rel = 0.5" in head
    assert "uncertainty" not in (tmp_path / "found" / "limb.toml").read_text(), "an assumption is not written as known"


def test_what_is_said_is_not_assumed(paper_limb: Path) -> None:
    text = paper_limb.read_text()
    assert assumption(_limb(text)) == ""
    assert assumption(load_limb(paper_limb).with_values(dict.fromkeys(ASSUMED, 0.0))) == "", "0 is exact"
    partly = _limb(_silent(text) + "\n[uncertainty]\nlength_mm = 2.0\ngain_rel = 0.0\n")
    said = assumption(partly)
    assert "joints' zeros (0.01 rad) and compliances (50 %)" in said and "lengths" not in said and "gain" not in said
    trusted = with_assumed_trust(partly)
    assert [trusted.number(key) for key in ASSUMED] == [2.0, 0.01, 0.5, 0.0]


def test_the_lines_that_are_asked_for_can_be_written(paper_limb: Path) -> None:
    silent = _silent(paper_limb.read_text())
    lines = re.findall(r"\w+ = [\d.]+", assumption(_limb(silent)))
    written = _limb(silent + "\n[uncertainty]\n" + "\n".join(lines) + "\n")
    assert {key: written.number(key) for key in ASSUMED} == dict(ASSUMED)
    assert assumption(written) == ""


def test_brace_new_writes_them(brace: Brace, tmp_path: Path) -> None:
    limb = tmp_path / "new.toml"
    links = ("--femur-link", "measured 0.06", "--tibia-link", "measured 0.25")
    joints = ("--femur-joint", "unknown", "--tibia-joint", "unknown")
    outcome = brace("new", "--out", limb, "--femur", "185", "--tibia", "313.5", *links, *joints)
    assert outcome.code == 0, outcome.err
    assert {key: load_limb(limb).number(key) for key in ASSUMED} == dict(ASSUMED)


@pytest.mark.parametrize("off_rad", [-0.08, 0.06, 0.12])
def test_a_knees_zero_is_no_mistyped_angle_of_one_pose(off_rad: float, paper_limb: Path, tmp_path: Path) -> None:
    """Of a limb that is trusted exactly, all poses are wrong; the one that shows it most is no fault of the record."""
    values = {"joint.tibia.zero_offset_rad": off_rad}
    dataset = load_dataset(loading_record(tmp_path / "record", paper_limb, values=values, repeats=1))
    exact = load_limb(paper_limb).with_values(dict.fromkeys(ASSUMED, 0.0))
    assert gate(settled(dataset, exact), exact, Options()) is None


def test_a_mistyped_angle_is_a_fault_of_an_exact_limbs_record_too(paper_limb: Path, tmp_path: Path) -> None:
    dataset = load_dataset(loading_record(tmp_path / "record", paper_limb, values={}, repeats=1))
    mistyped = dataset["theta2_rad"] + np.where(dataset["config"] == dataset["config"][-1], 0.3, 0.0)
    exact = load_limb(paper_limb).with_values(dict.fromkeys(ASSUMED, 0.0))
    stopped = gate(settled(dataset.with_columns({"theta2_rad": mistyped}), exact), exact, Options())
    assert stopped is not None and stopped.verdict == "data_fault"
    assert stopped.data_faults[0].field == "theta2_rad"
