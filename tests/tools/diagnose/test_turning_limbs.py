"""Effects that show otherwise in a limb that turns as it is displaced than in one that does not."""

from __future__ import annotations

from pathlib import Path

import handmade
import numpy as np
import pytest
from handmade import loading_record

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.model import load_limb

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


def told(folder: Path, values: dict[str, float]) -> Diagnosis:
    return diagnose(load_dataset(loading_record(folder, LIMB, values=values)), load_limb(LIMB), Options())


@pytest.mark.minutes
def test_the_weights_of_femur_and_knee_come_apart(tmp_path: Path) -> None:
    """A knee's weight bends the femur by more than twice as much as a femur's own of the same moment about the hip."""
    found = told(tmp_path / "record", {"gravity.femur_n": 60.0, "gravity.tibia_n": 2.0})
    assert [effect.label for effect in found.effects] == ["gravity@gravity"]
    told_n = found.effects[0].parameters["gravity.femur_n"]
    assert told_n.low > 30.0 and told_n.value == pytest.approx(60.0, abs=15.0)


@pytest.mark.parametrize(
    ("step_mm", "level_n"),
    [(0.635, 29.8), *(pytest.param(1.2, level_n, marks=pytest.mark.minutes) for level_n in (78.0, 84.0))],
)
def test_a_saturated_sensor_at_large_strokes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step_mm: float, level_n: float
) -> None:
    monkeypatch.setattr(handmade, "RIG", handmade.RIG.replace("steps = 4", f"steps = 4\nstep_mm = {step_mm}"))
    found = told(tmp_path / "record", {"sensor.saturation_n": level_n})
    assert [effect.label for effect in found.effects] == ["sensor_saturation@sensor"]
    assert found.model.number("sensor.saturation_n") == pytest.approx(level_n, abs=0.1)


def test_one_reading_is_enough_for_a_saturation(tmp_path: Path) -> None:
    """Of all readings the largest one alone is too small, and is still the largest."""
    record = loading_record(tmp_path / "record", LIMB, values={}, repeats=1)
    data = load_dataset(record)
    largest = np.sort(np.abs(np.concatenate([data["fx_n"], data["fz_n"]])))[-2:]
    level_n = float(largest[0] + 0.15 * (largest[1] - largest[0]))
    found = diagnose(
        load_dataset(loading_record(tmp_path / "clipped", LIMB, values={"sensor.saturation_n": level_n}, repeats=1)),
        load_limb(LIMB),
        Options(),
    )
    assert [effect.label for effect in found.effects] == ["sensor_saturation@sensor"], found.sentence
    assert found.model.number("sensor.saturation_n") == pytest.approx(level_n, abs=0.3)
    assert any("one reading alone" in note for note in found.notes)


SHORT_LIMB = """format = 1
name = "short"
[geometry]
femur_mm = 141.2
tibia_mm = 232.4
[link.femur]
axial_mm_per_n = 0.00135
bending_mm_per_n = 0.0568
[link.tibia]
axial_mm_per_n = 0.00074
bending_mm_per_n = 0.1232
[joint.femur]
compliance_rad_per_n_mm = 1.943e-05
[joint.tibia]
compliance_rad_per_n_mm = 1.934e-05
[uncertainty]
length_mm = 0.5
angle_rad = 0.003
compliance_rel = 0.05
gain_rel = 0.005
"""
STRETCHED = (
    (-0.255, 0.897), (0.39, 1.51), (1.018, 0.534), (1.035, 2.694), (1.236, 0.86), (1.583, 1.051), (1.59, 1.437)
)  # fmt: skip


def test_rough_fits_that_lose_their_way_are_fitted_to_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Strokes of 3.5 mm on a short limb near its reach: derivatives of a limb that does not turn lead no rough fit to
    what it promises, so that neither effect was tried beside the other."""
    quiet = "steps = 5\nstep_mm = 0.7056\n[sensor]\nnoise_n = 0.063\nresolution_n = 0.0\n"
    begins = handmade.RIG[: handmade.RIG.index("steps = 4")]
    monkeypatch.setattr(handmade, "RIG", begins + "repeats = {repeats}\n" + quiet)
    monkeypatch.setattr(handmade, "POSES", STRETCHED)
    (tmp_path / "limb.toml").write_text(SHORT_LIMB)
    values = {
        "geometry.femur_mm": 149.16, "geometry.tibia_mm": 241.8, "joint.tibia.gap_rad": 2.566e-4,
        "joint.femur.compliance_rad_per_n_mm": 1.766e-05, "joint.tibia.compliance_rad_per_n_mm": 1.795e-05,
        "joint.femur.zero_offset_rad": -0.00326, "joint.tibia.zero_offset_rad": -0.00487,
    }  # fmt: skip
    record = loading_record(tmp_path / "record", tmp_path / "limb.toml", values=values, repeats=1)
    found = diagnose(load_dataset(record), load_limb(tmp_path / "limb.toml"), Options())
    said = {effect.label for effect in found.effects if effect.confidence > 0.8}
    assert said == {"link_length_error@geometry", "backlash@joint.tibia"}, found.sentence
