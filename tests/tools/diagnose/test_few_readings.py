"""Records of a few load-deflection pairs: what they tell is told with its interval, and nothing is made up."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from brace.dataset import load_dataset
from brace.dataset.write import write_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.model import load_limb
from brace.rig.rig import load_rig
from brace.rig.simulate import simulate

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
RIG = """format = 1
seed = 3
[rig]
step_mm = 0.6
steps = 4
repeats = 1
axes = {axes}
[sensor]
noise_n = 0.05
resolution_n = 0.0
[[configuration]]
theta1_rad = 0.6
theta2_rad = 1.2
"""
PAIRS = 5  # of each run's way out
SOFT = {"joint.femur.compliance_rad_per_n_mm": 3e-5}  # three times the believed


def pairs(folder: Path, values: dict[str, float], axes: str) -> Diagnosis:
    """The first readings of each run, with only the force along it."""
    folder.mkdir()
    (folder / "rig.toml").write_text(RIG.format(axes=axes))
    meta, columns = simulate(load_limb(LIMB).with_values(values), load_rig(folder / "rig.toml"))
    first = columns["step"] < PAIRS
    write_dataset(folder, meta, {name: column[first] for name, column in columns.items()})
    if "x" not in axes:
        with (folder / "data.csv").open(newline="") as file:
            rows = [{**row, "fx_n": ""} for row in csv.DictReader(file)]
        with (folder / "data.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return diagnose(load_dataset(folder), load_limb(LIMB), Options())


def test_stiffnesses_alone_name_nothing_for_sure(tmp_path: Path) -> None:
    """One pair at each of four postures, no temperature, nothing that tells the noise: a table of k_zz as a record. No
    limb makes these; whatever is nearest is not sure."""
    rows = [(0.6, 1.2, 0.42), (0.9, 1.6, 0.36), (0.3, 2.0, 0.26), (0.7, 0.8, 0.60)]
    lines = ["run,config,theta1_rad,theta2_rad,axis,rep,step,t_s,dx_mm,dz_mm,fz_n"]
    for number, (theta1, theta2, k_zz) in enumerate(rows, start=1):
        for step in (0, 1):
            t_s = 2 * number + step
            lines.append(f"{number},{number},{theta1},{theta2},z,1,{step},{t_s},0,{step},{step * k_zz}")
    (tmp_path / "meta.toml").write_text('format = 1\nkind = "loading"\ntitle = "k_zz"\n')
    (tmp_path / "data.csv").write_text("\n".join(lines) + "\n")
    found = diagnose(load_dataset(tmp_path), load_limb(LIMB), Options())
    assert all(effect.confidence < 0.5 for effect in found.effects)


@pytest.mark.parametrize("axes", ['["z"]', '["x", "z"]'])
def test_a_sound_limb_lacks_nothing(tmp_path: Path, axes: str) -> None:
    assert pairs(tmp_path / "pairs", {}, axes).verdict == "none"


def test_five_pairs_name_no_one_cause_but_tell_the_slope(tmp_path: Path) -> None:
    """A limb of half the stiffness: several causes give the same five readings, so none of them is sure. The slope
    is told with an interval that leaves the model's out."""
    found = pairs(tmp_path / "pairs", SOFT, '["z"]')
    assert found.verdict == "ambiguous" and max(effect.confidence for effect in found.effects) < 0.5
    assert "joint_compliance@joint.femur" in {effect.label for effect in found.effects}
    (slope,) = [note for note in found.notes if "rises by" in note]
    words = slope.replace("(", " ").replace(")", " ").replace(";", " ").split()
    low, high = float(words[words.index("to") - 1]), float(words[words.index("to") + 1])
    assert low < high < float(words[-1])


def test_the_interval_of_few_readings_is_wide(tmp_path: Path) -> None:
    """Ten readings of both axes: the named spring's interval holds the truth."""
    found = pairs(tmp_path / "pairs", SOFT, '["x", "z"]')
    spring = next(effect for effect in found.effects if effect.label == "joint_compliance@joint.femur")
    held = spring.parameters["joint.femur.compliance_rad_per_n_mm"]
    assert held.low <= 3e-5 <= held.high and held.high - held.low > 0.05 * held.value
