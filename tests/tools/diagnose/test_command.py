"""`brace diagnose` around the diagnosis itself: what is written, what is printed, what a failure leaves
alone.

The diagnosis is one written by hand."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from command_bench import Outcome
from handmade import FAULT, GAP_KEY, by_hand, loading_record

from brace.diagnose import one
from brace.diagnose.diagnosis import Diagnosis
from brace.ground.errors import BadFileError
from brace.model import load_limb

FILES = ("diagnosis.json", "limb.toml", "report.html")


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    data = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data"
    return loading_record(tmp_path_factory.mktemp("record") / "data", data / "paper-limb.toml")


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch, record: Path, paper_limb: Path) -> Callable[..., None]:
    """Lets the command come to a diagnosis of ours."""

    def let(**changes: Any) -> None:
        found: Diagnosis = by_hand(record, paper_limb, **changes)[2]
        monkeypatch.setattr(one, "diagnose", lambda *_arguments: found)

    let()
    return let


def _hash(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def test_three_files_and_nothing_else(
    brace: Callable[..., Outcome], said: Any, record: Path, paper_limb: Path, tmp_path: Path
) -> None:
    outcome = brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted(FILES)
    first = outcome.out.splitlines()[0]
    assert first == "The knee has play of 0.0061 rad (21 arcmin): the tip moves before it meets force."
    assert f"{GAP_KEY} = 0.0061 rad (21 arcmin), 90 %: 0.0057 to 0.0065" in outcome.out
    assert "  next       Repeat configuration 2 with a preload of 3 mm along z.\n" in outcome.out


def test_json_is_as_the_contract_has_it(
    brace: Callable[..., Outcome], said: Any, record: Path, paper_limb: Path, tmp_path: Path
) -> None:
    outcome = brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / "out", "--json")
    data = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert {**data, "out": str(tmp_path / "out")} == json.loads(outcome.out)
    assert data["format"] == 1 and data["verdict"] == "effect" and data["seed"] == 0
    effect = data["effects"][0]
    assert (effect["name"], effect["where"], effect["confidence"]) == ("backlash", "joint.tibia", 0.97)
    assert effect["parameters"] == {GAP_KEY: {"value": 0.0061, "low": 0.0057, "high": 0.0065}}
    assert data["localised"][0] == {"where": "only near zero force", "p": 0.0001, "size_n": 0.42}
    assert set(data["unexplained"]) == {"rms_n", "structured", "description"}
    assert set(data["gap"]) == {"unit", "noise_floor", "before", "after", "steps"}
    assert set(data["next_experiment"]) >= {"action", "separates", "power"}
    assert set(data["versions"]) >= {"brace", "numpy", "scipy", "core"}
    digest = hashlib.sha256((record / "meta.toml").read_bytes() + (record / "data.csv").read_bytes())
    assert data["data_sha256"] == digest.hexdigest()


def test_same_input_same_bytes_wherever_it_lies(
    brace: Callable[..., Outcome], said: Any, record: Path, paper_limb: Path, tmp_path: Path
) -> None:
    other = tmp_path / "elsewhere"
    other.mkdir()
    for name in ("meta.toml", "data.csv"):
        (other / name).write_bytes((record / name).read_bytes())
    (other / "limb.toml").write_bytes(paper_limb.read_bytes())  # the folder's own model, no --model
    assert brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / "a").code == 0
    assert brace("diagnose", other, "--out", tmp_path / "b").code == 0
    assert _hash(tmp_path / "a") == _hash(tmp_path / "b")
    for name in FILES:
        assert str(tmp_path) not in (tmp_path / "a" / name).read_text()


def test_a_failure_leaves_the_folder_as_it_was(
    brace: Callable[..., Outcome],
    said: Any,
    record: Path,
    paper_limb: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    out = tmp_path / "out"
    assert brace("diagnose", record, "--model", paper_limb, "--out", out).code == 0
    before = _hash(out)

    def refuse(*_arguments: object) -> None:
        raise BadFileError("made to fail")

    monkeypatch.setattr(one, "diagnose", refuse)
    assert brace("diagnose", record, "--model", paper_limb, "--out", out, "--seed", 5).code == 3
    assert _hash(out) == before
    assert brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / "new").code == 3
    assert not (tmp_path / "new").exists()


def test_inputs_are_not_written_over(
    brace: Callable[..., Outcome], said: Any, record: Path, paper_limb: Path, tmp_path: Path
) -> None:
    (tmp_path / "limb.toml").write_bytes(paper_limb.read_bytes())
    outcome = brace("diagnose", record, "--model", tmp_path / "limb.toml", "--out", tmp_path)
    assert outcome.code == 2 and "replace an input" in outcome.err
    outcome = brace("diagnose", record, "--model", paper_limb, "--out", paper_limb)
    assert outcome.code == 2 and "in the way" in outcome.err


def test_only_a_joint_test_can_do_without_a_model(
    brace: Callable[..., Outcome], said: Any, record: Path, tmp_path: Path
) -> None:
    outcome = brace("diagnose", record, "--out", tmp_path / "out")
    assert outcome.code == 2 and "no model" in outcome.err and "--model" in outcome.err


@pytest.mark.parametrize("verdict", ["none", "unknown", "ambiguous", "data_fault"])
def test_a_data_fault_alone_of_all_verdicts_is_exit_code_3(
    verdict: str, brace: Callable[..., Outcome], said: Any, record: Path, paper_limb: Path, tmp_path: Path
) -> None:
    changes: dict[str, Any] = {"verdict": verdict, "data_faults": (FAULT,)}
    if verdict != "ambiguous":
        changes |= {"effects": (), "model": load_limb(paper_limb)}
    if verdict == "data_fault":
        changes |= {name: None for name in ("gap", "residuals", "unexplained", "next_experiment")} | {
            "localised": (),
            "candidates": (),
        }
    said(**changes)
    outcome = brace("diagnose", record, "--model", paper_limb, "--out", tmp_path / "out")
    assert outcome.code == (3 if verdict == "data_fault" else 0), outcome.err
    data = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert data["verdict"] == verdict and data["data_faults"][0]["row"] == 12
    assert bool(data["effects"]) == (verdict == "ambiguous")
    assert load_limb(tmp_path / "out" / "limb.toml").values == load_limb(paper_limb).values or data["effects"]
