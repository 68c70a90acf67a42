"""An effect that the model has already is not said to be missing: its size is another one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from handmade import GAP_KEY, by_hand, loading_record

from brace.dataset import Dataset
from brace.diagnose import summary
from brace.diagnose.diagnosis import Diagnosis, GapPair, HeldOut, Interval, NamedEffect
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
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
    told = f"The model has backlash (knee joint) already: the record shows {word} of it, {GAP_KEY} = 0.0061 and not"
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
    assert "A spring alone, fitted, misses" in page and "odel as believed" not in page
    assert "# no model was given: only the tested joint is of the record" in written.files["limb.toml"].decode()


def test_a_number_that_every_limb_has_is_another_one(made: Made) -> None:
    dataset, believed, found = made
    key = "joint.tibia.compliance_rad_per_n_mm"
    softer = NamedEffect("joint_compliance", "joint.tibia", 0.97, {key: Interval(2.0e-5, 1.9e-5, 2.1e-5)}, 0.93)
    written = contents(dataset, believed, "", replace(found, effects=(softer,)), report=False)
    assert written.diagnosis.sentence == found.sentence


def test_parts_that_were_predicted_are_not_denied(made: Made) -> None:
    """Without a configuration to set aside, the record's parts are predicted from its rest all the same."""
    dataset, believed, found = made
    assert found.gap is not None
    gap = replace(found.gap, before=GapPair(0.5, None), after=GapPair(0.1, None))
    part = HeldOut("amplitude", "displacements above 1.5 mm", 0.11, 0.1, 0.4, True, 12.0)
    page = contents(dataset, believed, "", replace(found, gap=gap, held_out=(part,))).files["report.html"].decode()
    assert "No configuration or test could be held out" in page and "othing could be held out" not in page


def test_a_class_is_listed_once(made: Made) -> None:
    _, _, found = made
    shared = replace(found, indistinguishable=(("a@b", "backlash@joint.tibia"),), could_be=("a@b", "c@d"))
    told = list(summary.lines(shared))
    assert "  alike      a@b, backlash@joint.tibia" in told and "  could be   c@d" in told


def test_one_of_several_is_said_only_where_the_name_is_not_sure(made: Made) -> None:
    _, _, found = made
    unsure = tuple(replace(effect, confidence=0.6) for effect in found.effects)
    shared = replace(found, effects=unsure, indistinguishable=(("a@b", "backlash@joint.tibia"),))
    assert "  one of     a@b, backlash@joint.tibia" in list(summary.lines(shared))


@pytest.mark.minutes
def test_a_record_of_more_play_than_the_model_has(made: Made) -> None:
    dataset, believed, _ = made
    found = diagnose(dataset, believed.with_values({GAP_KEY: 0.003}), Options())
    assert [effect.label for effect in found.effects] == ["backlash@joint.tibia"]
    assert found.sentence.startswith("Of another size than in the model: backlash") and "Missing" not in found.sentence
