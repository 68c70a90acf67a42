"""A sensor that is quieter than what it rounds: its error comes again in every repeat, and is nothing of the limb."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import LIMB, loading_rows, write_loading

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.model import load_limb

STEP_N = 0.0625
FORCES = slice(11, 13)
WITHIN_TRUST: dict[str, Any] = {"joint": (1.04e-5, 1.65e-5), "lengths": (185.4, 313.2)}  # less than one sigma of LIMB's


def rounded(rows: list[list[str]]) -> list[list[str]]:
    """As read by a sensor of that step."""
    for row in rows:
        row[FORCES] = [f"{round(float(text) / STEP_N) * STEP_N:.6f}" for text in row[FORCES]]
    return rows


def diagnosed(folder: Path, rows: list[list[str]]) -> Diagnosis:
    (folder / "limb.toml").write_text(LIMB)
    believed = load_limb(folder / "limb.toml")
    return diagnose(load_dataset(write_loading(folder / "record", rows)), believed, Options())


@pytest.mark.parametrize("noise_n", (0.0, 0.005, 0.01))
def test_a_quiet_sensor_on_a_sound_limb(noise_n: float, tmp_path: Path) -> None:
    found = diagnosed(tmp_path, rounded(loading_rows(noise_n, **WITHIN_TRUST)))
    assert found.verdict == "none", found.sentence


def test_an_effect_larger_than_the_step_is_still_found(tmp_path: Path) -> None:
    """Weights are no catalogue member that rounding looks like: 0.2 N on fx at every posture, three steps."""
    rows = loading_rows(0.004, **WITHIN_TRUST)
    for row in rows:
        row[FORCES.start] = f"{float(row[FORCES.start]) + 0.2:.6f}"
    found = diagnosed(tmp_path, rounded(rows))
    assert [effect.label for effect in found.effects] == ["sensor_bias@sensor"], found.sentence
    assert found.effects[0].parameters["sensor.bias_x_n"].value == pytest.approx(0.2, abs=STEP_N / 4)


def test_readings_off_the_steps_are_judged_by_their_noise(tmp_path: Path) -> None:
    """A wave of a third of the step is structure where the sensor does not round, whatever is said of its steps."""
    rows = loading_rows(0.004, **WITHIN_TRUST)
    for row in rows:
        wave = 0.02 * np.sin(2.0 * np.pi * (float(row[9]) + float(row[10])) / 0.9)
        row[FORCES] = [f"{float(text) + wave:.6f}" for text in row[FORCES]]
    found = diagnosed(tmp_path, rows)
    assert found.verdict == "unknown" and not found.held_out, "what has no model predicts nothing"
