"""Effects that show otherwise in a limb that turns as it is displaced than in one that does not."""

from __future__ import annotations

from pathlib import Path

import handmade
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


def test_the_weights_of_femur_and_knee_come_apart(tmp_path: Path) -> None:
    """A knee's weight bends the femur by more than twice as much as a femur's own of the same moment about the hip."""
    found = told(tmp_path / "record", {"gravity.femur_n": 60.0, "gravity.tibia_n": 2.0})
    assert [effect.label for effect in found.effects] == ["gravity@gravity"]
    told_n = found.effects[0].parameters["gravity.femur_n"]
    assert told_n.low > 30.0 and told_n.value == pytest.approx(60.0, abs=15.0)


@pytest.mark.parametrize(("step_mm", "level_n"), [(0.635, 29.8), (1.2, 78.0), (1.2, 84.0)])
def test_a_saturated_sensor_at_large_strokes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step_mm: float, level_n: float
) -> None:
    monkeypatch.setattr(handmade, "RIG", handmade.RIG.replace("steps = 4", f"steps = 4\nstep_mm = {step_mm}"))
    found = told(tmp_path / "record", {"sensor.saturation_n": level_n})
    assert [effect.label for effect in found.effects] == ["sensor_saturation@sensor"]
    assert found.model.number("sensor.saturation_n") == pytest.approx(level_n, abs=0.1)
