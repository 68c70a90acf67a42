"""The model that is exported is the limb of now: K of `limb.toml` alone, without [change]."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from handmade import loading_record

from brace.dataset import load_dataset
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.diagnose.loading.space import space_of, trust_of
from brace.effects import all_variants
from brace.identify.parameters import TIBIA_BEAM
from brace.identify.record import load_record, setting_of
from brace.model import load_limb
from brace.native.plant_batch import model_numbers, number_index
from brace.rig.predict import predict

sys.path.append(str(Path(__file__).resolve().parents[2] / "judges" / "exported"))
judge = import_module("exported_k")

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
CRACK: dict[str, Any] = {"change.link": "tibia", "change.at_s": 1000.0, "change.bending_factor": 0.5,
         "link.tibia.bending_mm_per_n": 0.5}  # today's link, twice as soft as it was  # fmt: skip


@pytest.fixture(scope="module")
def cracked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return loading_record(tmp_path_factory.mktemp("crack") / "record", LIMB, values=CRACK)


def test_a_crack_is_in_the_link_and_its_past_in_change(cracked: Path) -> None:
    """K of the exported model is that of the cracked limb; played, it still closes the whole record."""
    dataset, believed = load_dataset(cracked), load_limb(LIMB)
    found = diagnose(dataset, believed, Options())
    assert [effect.label for effect in found.effects] == ["link_change@link.tibia"], found.sentence
    model = found.model
    assert model.number("link.tibia.bending_mm_per_n") == pytest.approx(0.5, rel=0.03)
    assert model.number("change.bending_factor") == pytest.approx(0.5, rel=0.03)
    size = found.effects[0].parameters["change.bending_factor"]
    assert size.low < 0.5 < size.high and size.value == pytest.approx(model.number("change.bending_factor"))
    played = predict(dataset, model).columns
    left = np.concatenate([dataset[name] - played[name] for name in ("fx_n", "fz_n")])
    assert float(np.sqrt(np.mean(left**2))) == pytest.approx(0.1, rel=0.1), "the rig's noise"
    again = diagnose(dataset, model, Options())
    assert again.verdict == "none", again.sentence


def test_a_model_with_a_change_starts_its_fit_at_that_change(cracked: Path) -> None:
    """As a hypothesis of the search, the change that the model has already gives the model's own numbers."""
    model = load_limb(LIMB).with_values(CRACK)
    record = load_record(load_dataset(cracked))
    variants = {one.label: one for one in all_variants(setting_of(record, model)) if one.effect == "link_change"}
    space = space_of(trust_of(model, turns=True), (variants["link_change@link.tibia"],))
    index = number_index()
    start, known = space.models(space.mean[None])[0], model_numbers(model)
    start[index[TIBIA_BEAM]] = known[index[TIBIA_BEAM]]  # what limb.toml leaves open starts half-way
    np.testing.assert_allclose(start, known, rtol=1e-12)
    other = space_of(trust_of(model, turns=True), (variants["link_change@link.femur"],))
    start = other.models(other.mean[None])[0]
    assert start[index["link.tibia.bending_mm_per_n"]] == 0.5, "of another link, it is the link of now"
    assert start[index["change.bending_factor"]] == 1.0


def test_exported_k_is_nearer_to_the_truth(tmp_path: Path) -> None:
    """One case of the judge, which plays every effect, of a seed of its own."""
    one = judge.case("link_change@link.tibia", 1, 5, tmp_path)
    assert one.nearer, one
