"""An effect that the model has already is not said to be missing: its size is another one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from handmade import GAP_KEY, by_hand, loading_record

from brace.dataset import Dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.write import contents
from brace.model import LimbModel

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
Made = tuple[Dataset, LimbModel, Diagnosis]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    return by_hand(loading_record(tmp_path_factory.mktemp("record") / "data", LIMB), LIMB)


@pytest.mark.parametrize(("believed_rad", "word"), [(0.02, "less"), (0.001, "more")])
def test_its_two_sizes_are_said(made: Made, believed_rad: float, word: str) -> None:
    dataset, believed, found = made
    has_play = believed.with_values({GAP_KEY: believed_rad})
    written = contents(dataset, has_play, "", found)
    told = f"The model has backlash at joint.tibia already: the record shows {word} of it, {GAP_KEY} = 0.0061 and not"
    assert told in written.diagnosis.sentence and told in written.json_ready["sentence"]
    page = written.files["report.html"].decode()
    assert "What is of another size" in page and "What was missing" not in page
    assert "Something is missing" not in page


def test_a_model_without_it_lacks_it(made: Made) -> None:
    dataset, believed, found = made
    written = contents(dataset, believed, "", found)
    assert written.diagnosis.sentence == found.sentence
    page = written.files["report.html"].decode()
    assert "What was missing" in page and "Something is missing" in page


def test_without_a_model_nothing_was_given(made: Made) -> None:
    dataset, _, found = made
    written = contents(dataset, None, "", replace(found, verdict="none", effects=()))
    page = written.files["report.html"].decode()
    assert "gap of a spring alone, fitted" in page and "odel as given" not in page
    assert "# no model was given: only the tested joint is of the record" in written.files["limb.toml"].decode()
