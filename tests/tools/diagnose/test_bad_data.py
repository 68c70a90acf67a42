"""What is no record, or says too little: a clear refusal (3) or a clear verdict through the command line, in
time, and never an effect that nobody put there."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from command_bench import LIMB, LOADING_HEADER, loading_rows, write_loading

from brace.model import load_limb
from brace.model.keys import KEY_BY_NAME, LIMB_KEYS

LIMIT_S = 300.0  # nobody waits for ever; generous for a machine that does much else
_TRUSTED = (
    "geometry.",
    "link.",
    "joint.femur.compliance",
    "joint.tibia.compliance",
    "uncertainty.",
    "sensor.gain",
)
EFFECT_KEYS = [
    key.name
    for key in LIMB_KEYS
    if "." in key.name and not key.name.startswith(_TRUSTED) and not key.name.endswith("zero_offset_rad")
]
JOINT_META = 'format = 1\nkind = "joint_test"\ntitle = "made by the tests"\n'
Rows = list[list[str]]


def _diagnosed(folder: Path, model: Path | None, out: Path, limit_s: float = LIMIT_S) -> tuple[int, str, str]:
    arguments = ["diagnose", str(folder), "--out", str(out), *(["--model", str(model)] if model else [])]
    run = subprocess.run(
        [sys.executable, "-m", "brace", *arguments], capture_output=True, text=True, timeout=limit_s
    )
    assert "Traceback" not in run.stderr and "internal error" not in run.stderr, run.stderr
    return run.returncode, run.stdout, run.stderr


def _refused(code: int, said: str, out: Path) -> None:
    assert code == 3, said
    assert "why:" in said and "try:" in said
    assert not out.exists()


def _no_effect(code: int, out: Path) -> str:
    """A verdict that claims nothing; the model that is written has no effect in it: what LIMB gives may be
    refitted within its trust where nothing is missing, else it is as believed."""
    data = json.loads((out / "diagnosis.json").read_text())
    assert data["verdict"] in ("none", "unknown", "data_fault") and data["effects"] == []
    assert code == (3 if data["verdict"] == "data_fault" else 0)
    if data["verdict"] != "none":
        assert "nothing was changed" in (out / "limb.toml").read_text()
    model = load_limb(out / "limb.toml")
    for key in EFFECT_KEYS:
        assert model.values[key] == KEY_BY_NAME[key].default, key
    return str(data["verdict"])


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB)
    return path


def _force(rows: Rows, value: str) -> Rows:
    return [[*row[:11], value, value] for row in rows]


REFUSED: dict[str, Callable[[Rows], tuple[str, Rows]]] = {
    "no_rows": lambda rows: (LOADING_HEADER, []),
    "not_a_number": lambda rows: (LOADING_HEADER, [*rows[:9], [*rows[9][:11], "nan", "0.1"], *rows[10:]]),
    "words": lambda rows: (LOADING_HEADER, [*rows[:9], [*rows[9][:11], "much", "0.1"], *rows[10:]]),
    "other_columns": lambda rows: ("a,b,c", [["1", "2", "3"]] * 20),
    "a_column_lacks": lambda rows: (LOADING_HEADER.replace(",dz_mm", ""), [[*row[:-3], *row[-2:]] for row in rows]),
    "ragged": lambda rows: (LOADING_HEADER, [*rows[:9], rows[9][:7], *rows[10:]]),
    "a_few_rows": lambda rows: (LOADING_HEADER, rows[:3]),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_refused_with_reason_and_way_on(kind: str, limb: Path, tmp_path: Path) -> None:
    header, rows = REFUSED[kind](loading_rows())
    folder = write_loading(tmp_path / "data", rows, header)
    code, out, said = _diagnosed(folder, limb, tmp_path / "out")
    if (tmp_path / "out").exists() and kind in ("not_a_number", "words"):  # one entry of a record that can be read otherwise
        assert _no_effect(code, tmp_path / "out") == "data_fault" and "fx_n" in out and "10" in out
        return
    _refused(code, said, tmp_path / "out")
    assert "data.csv" in said


def test_empty_files_and_no_files(limb: Path, tmp_path: Path) -> None:
    folder = write_loading(tmp_path / "data", loading_rows())
    (folder / "data.csv").write_text("")
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    _refused(code, said, tmp_path / "out")
    (folder / "data.csv").unlink()
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    _refused(code, said, tmp_path / "out")
    (folder / "meta.toml").write_text("")
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    _refused(code, said, tmp_path / "out")
    code, _, said = _diagnosed(tmp_path / "nowhere", limb, tmp_path / "out")
    _refused(code, said, tmp_path / "out")


def test_a_model_that_is_none(limb: Path, tmp_path: Path) -> None:
    folder = write_loading(tmp_path / "data", loading_rows())
    limb.write_text(LIMB.replace("185.0", '"long"'))
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    _refused(code, said, tmp_path / "out")
    assert "limb.toml:5" in said


def test_all_zeros_say_nothing_of_the_limb(limb: Path, tmp_path: Path) -> None:
    folder = write_loading(tmp_path / "data", _force(loading_rows(), "0.000000"))
    code, out, _ = _diagnosed(folder, limb, tmp_path / "out")
    assert _no_effect(code, tmp_path / "out") in ("unknown", "data_fault")


def test_everything_zero(limb: Path, tmp_path: Path) -> None:
    rows = [["0"] * 4 + ["x"] + ["0"] * 8 for _ in range(60)]
    code, _, said = _diagnosed(write_loading(tmp_path / "data", rows), limb, tmp_path / "out")
    if not (tmp_path / "out").exists():
        _refused(code, said, tmp_path / "out")
    else:
        assert _no_effect(code, tmp_path / "out") in ("unknown", "data_fault")


@pytest.mark.minutes
def test_one_configuration_of_a_sound_limb(limb: Path, tmp_path: Path) -> None:
    rows = [row for row in loading_rows() if row[1] == "1"]
    code, _, _ = _diagnosed(write_loading(tmp_path / "data", rows), limb, tmp_path / "out")
    assert _no_effect(code, tmp_path / "out") in ("none", "unknown")
    data = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    assert data["gap"] is None or data["gap"]["after"]["held_out"] is None


def test_noise_alone_is_no_effect(limb: Path, tmp_path: Path) -> None:
    rows = loading_rows()
    random = np.random.default_rng(4)
    noisy = [[*row[:11], *(f"{value:.6f}" for value in random.normal(0.0, 5.0, 2))] for row in rows]
    code, _, _ = _diagnosed(write_loading(tmp_path / "data", noisy), limb, tmp_path / "out")
    assert _no_effect(code, tmp_path / "out") in ("unknown", "data_fault")
    assert "do not follow" in json.loads((tmp_path / "out" / "diagnosis.json").read_text())["sentence"]


@pytest.mark.minutes
def test_a_wholly_other_limb_makes_up_no_play_nor_friction(limb: Path, tmp_path: Path) -> None:
    """Everything about it is another limb's. What may be said is that lengths and compliances are not the
    model's, or that nothing in the catalogue explains it; what the record has no trace of must not be
    claimed."""
    other = loading_rows(lengths=(90.0, 600.0), bending=(0.5, 0.02), joint=(1e-6, 6e-5), axial=(0.05, 0.03))
    folder = write_loading(tmp_path / "data", other)
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    assert code == 0, said
    data = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
    named = {effect["name"] for effect in data["effects"]}
    traceless = {"backlash", "coulomb_friction", "creep", "joint_hardening", "contact_play", "link_change"}
    assert not named & (traceless | {"thermal_softening", "gravity", "sensor_drift", "sensor_bias"})



def test_a_sound_limb_has_nothing_missing(limb: Path, tmp_path: Path) -> None:
    code, _, _ = _diagnosed(write_loading(tmp_path / "data", loading_rows()), limb, tmp_path / "out")
    assert _no_effect(code, tmp_path / "out") == "none"


def _identical(count: int) -> Iterator[str]:
    line = "1,1,0.740000,1.000000,x,1,0,0.000,22.0,0.000000,0.000000,0.100000,0.200000\n"
    yield LOADING_HEADER + "\n"
    for _ in range(count // 1000):
        yield line * 1000


@pytest.mark.minutes
def test_a_million_identical_rows(limb: Path, tmp_path: Path) -> None:
    folder = write_loading(tmp_path / "data", [])
    with (folder / "data.csv").open("w") as file:
        file.writelines(_identical(1_000_000))
    code, _, said = _diagnosed(folder, limb, tmp_path / "out")
    if not (tmp_path / "out").exists():
        _refused(code, said, tmp_path / "out")
    else:
        assert _no_effect(code, tmp_path / "out") in ("unknown", "data_fault")


@pytest.mark.parametrize("kind", ["identical", "zeros", "nan", "empty", "columns"])
def test_joint_tests_that_say_nothing(kind: str, tmp_path: Path) -> None:
    folder = tmp_path / "joint"
    folder.mkdir()
    (folder / "meta.toml").write_text(JOINT_META)
    count = 300_000 if kind == "identical" else 400
    lines = {
        "identical": "0.000,0.010000,100.000\n" * count,
        "zeros": "".join(f"{0.01 * i:.2f},0.0,0.0\n" for i in range(count)),
        "nan": "0.0,0.0,nan\n" * count,
        "empty": "",
        "columns": "1,2,3\n" * count,
    }[kind]
    header = "a,b,c\n" if kind == "columns" else "t_s,angle_rad,torque_n_mm\n"
    (folder / "data.csv").write_text(header + lines)
    code, _, said = _diagnosed(folder, None, tmp_path / "out")
    if kind in ("empty", "columns") or not (tmp_path / "out").exists():
        _refused(code, said, tmp_path / "out")
    else:
        data = json.loads((tmp_path / "out" / "diagnosis.json").read_text())
        assert data["verdict"] in ("none", "unknown", "data_fault") and data["effects"] == []
