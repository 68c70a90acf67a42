"""Load cells of one axis: the force that was not read is not made up, and the rest is used. The records are those of
two axes with readings taken away."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from handmade import GAP_KEY, GAP_RAD, loading_record

from brace.cli import main
from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.ground.errors import BadFileError
from brace.model import load_limb

Row = dict[str, str]
LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


def without_fz(row: Row) -> Row:
    return {name: value for name, value in row.items() if name != "fz_n"}


def empty_fz(row: Row) -> Row:
    return {**row, "fz_n": ""}


def only_along_the_run(row: Row) -> Row:
    return {**row, ("fz_n" if row["axis"] == "x" else "fx_n"): ""}


WAYS = {"column left out": without_fz, "column empty": empty_fz, "along the run": only_along_the_run}
ONE_ON_EVERY_CHANGE = [  # the commonest one; ./dev judges plays all
    pytest.param(way, marks=() if way == "column empty" else pytest.mark.minutes) for way in WAYS
]


def one_axis(folder: Path, take_away: Callable[[Row], Row], **truth: float) -> Path:
    """The record of a limb with `truth`, after readings were taken away."""
    record = loading_record(folder, LIMB, values={key.replace("__", "."): value for key, value in truth.items()})
    with (record / "data.csv").open(newline="") as file:
        rows = [take_away(row) for row in csv.DictReader(file)]
    with (record / "data.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return record


def diagnosed(record: Path) -> Diagnosis:
    return diagnose(load_dataset(record), load_limb(LIMB), Options())


@pytest.mark.parametrize("way", ONE_ON_EVERY_CHANGE)
def test_an_effect_that_one_axis_shows_is_named(tmp_path: Path, way: str) -> None:
    found = diagnosed(one_axis(tmp_path / "record", WAYS[way], joint__tibia__gap_rad=GAP_RAD))
    (effect,) = found.effects
    assert effect.label == "backlash@joint.tibia"
    assert effect.parameters[GAP_KEY].low < GAP_RAD < effect.parameters[GAP_KEY].high
    assert any("fz_n was read in" in note for note in found.notes)
    assert found.gap is not None and found.gap.after.fitted < 2.0 * found.gap.noise_floor


@pytest.mark.parametrize("way", ONE_ON_EVERY_CHANGE)
def test_a_sound_limb_is_sound(tmp_path: Path, way: str) -> None:
    found = diagnosed(one_axis(tmp_path / "record", WAYS[way]))
    assert found.verdict == "none" and found.data_faults == (), found.sentence


def test_identify_and_predict_use_what_was_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record = one_axis(tmp_path / "record", without_fz, joint__femur__compliance_rad_per_n_mm=2e-5)
    fitted, predicted = tmp_path / "fitted.toml", tmp_path / "predicted.csv"
    key = "joint.femur.compliance_rad_per_n_mm"
    assert main(["identify", str(record), "--model", str(LIMB), "--only", key, "--out", str(fitted)]) == 0
    assert load_limb(fitted).number(key) == pytest.approx(2e-5, rel=0.02)
    capsys.readouterr()
    assert main(["predict", str(record), "--model", str(fitted), "--out", str(predicted), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert "rms_gap_fz_n" not in told and told["rms_gap_fx_n"] < 0.2
    assert "fz_n" in told["columns"] and np.isfinite(np.genfromtxt(predicted, delimiter=",", names=True)["fz_n"]).all()


def test_a_column_by_another_name_is_asked_for(tmp_path: Path) -> None:
    """A force that seems to be there is not left out in silence."""
    for name in ("force_z", "Fz", "f_z_n"):
        names = {"fz_n": name}
        record = one_axis(tmp_path / name, lambda row: {names.get(key, key): value for key, value in row.items()})
        with pytest.raises(BadFileError) as caught:
            load_dataset(record)
        assert "missing column fz_n" in caught.value.render() and name in caught.value.render()


def test_a_row_without_any_force_is_refused(tmp_path: Path) -> None:
    record = one_axis(tmp_path / "record", lambda row: empty_fz(row) | ({"fx_n": ""} if row["run"] == "2" else {}))
    with pytest.raises(BadFileError) as caught:
        load_dataset(record)
    assert "fx_n and fz_n are both empty" in caught.value.render()
