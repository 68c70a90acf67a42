"""A force sensor that reads wrong by less than could be named, of a limb that is as believed: K does not follow it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from handmade import loading_record

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading.gain_instead import GAIN
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.diagnose.stiffness_change import apart, k_at, postures
from brace.model import LimbModel, load_limb

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


def _diagnosed(folder: Path, key: str, value: float) -> tuple[Diagnosis, float]:
    """The diagnosis of a record of the paper's limb, and the relative error of the exported model's K."""
    believed = load_limb(LIMB)
    dataset = load_dataset(loading_record(folder / "record", LIMB, values={key: value}, repeats=1))
    found = diagnose(dataset, believed, Options(processes=1))
    truth = believed if key == GAIN else believed.with_values({key: value})
    return found, _off(found.model, truth, postures(dataset))


def _off(limb: LimbModel, truth: LimbModel, at_rad: np.ndarray) -> float:
    return float(np.median(apart(k_at(limb, at_rad), k_at(truth, at_rad))))


@pytest.mark.parametrize(("gain", "words"), [(0.92, "too little"), (1.08, "too much")])
def test_k_keeps_its_scale(gain: float, words: str, tmp_path: Path) -> None:
    """The refit would move K by the sensor's 8 %: the gain is trusted to half a per cent, the compliances to five."""
    found, off = _diagnosed(tmp_path, GAIN, gain)
    assert found.verdict == "none" and not found.effects, found.sentence
    assert off < 0.02
    assert found.model.number("sensor.gain") == 1.0, "what is not named is not exported"
    assert len(found.cautions) == 1
    assert words in found.cautions[0] and "hang a known weight on the tip" in found.cautions[0]


def test_a_sensor_that_reads_right_is_not_doubted(tmp_path: Path) -> None:
    found, off = _diagnosed(tmp_path, GAIN, 1.0)
    assert found.verdict == "none" and found.cautions == () and off < 0.01


@pytest.mark.parametrize("joint", ["femur", "tibia"])
@pytest.mark.parametrize("factor", [0.8, 1.22])
def test_a_gain_does_not_stand_in_for_a_joint(joint: str, factor: float, tmp_path: Path) -> None:
    """A joint is off by four sigma of its trust, too little to be named. A gain takes strain there, too, but less."""
    key = f"joint.{joint}.compliance_rad_per_n_mm"
    found, off = _diagnosed(tmp_path, key, factor * load_limb(LIMB).number(key))
    assert found.verdict == "none" and found.cautions == (), found.cautions
    assert off < 0.01, "K follows the joint"
