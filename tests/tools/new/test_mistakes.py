"""Mistakes of somebody's first afternoon: one readable message each, a non-zero exit where a script must stop, never a
traceback (the `brace` fixture looks for it and for internal errors)."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import LIMB, LOADING_META, Outcome, loading_rows, write_loading

Brace = Callable[..., Outcome]
POSTURE = ("--theta1", 1.0, "--theta2", 1.4)
WITHOUT_TRUST = LIMB[: LIMB.index("[uncertainty]")]


def limb(folder: Path, text: str = LIMB) -> Path:
    path = folder / "limb.toml"
    path.write_text(text)
    return path


def readable(outcome: Outcome, code: int, *words: str) -> None:
    """One message: what and where on its first line, then why and what to try."""
    assert outcome.code == code, outcome.err
    for word in words:
        assert word in outcome.err, outcome.err
    told = [line for line in outcome.err.splitlines() if line.startswith("brace: ")]
    assert len(told) == 1 and "\n  why: " in outcome.err and "\n  try: " in outcome.err, outcome.err


# A value of limb.toml -> what is written instead, and the words of the message.
OF_THE_LIMB = [
    ("femur_mm = 185.0", "femur_mm = 0.185", "0.185 m are 185 here"),
    ("femur_mm = 185.0", "femur_mm = 185,0", "the decimal sign is a point"),
    ("femur_mm = 185.0", "femur_mm = 185 mm", "the unit is in the key's name"),
    ("femur_mm = 185.0", 'femur_mm = "185"', "it must be a number, not text"),
    ("femur_mm = 185.0\n", "", "geometry.femur_mm is missing"),
    ("femur_mm", "femur_length", "unknown key geometry.femur_length"),
    ("[joint.femur]\n", "[joint.femur]\nstiffness = 60\n", "try: known here: compliance_rad_per_n_mm, "),
    ("[link.femur]", "[link.fermur]", "did you mean [link.femur]?"),
    ("bending_mm_per_n = 0.06", "bending = 0.06", "did you mean link.femur.bending_mm_per_n?"),
    ("[joint.tibia]", "[joint.knee]", "unknown table [joint.knee]"),
    ("compliance_rel = 0.05", "compliance_rel = 5.0", "5 % are 0.05 here"),
    ("angle_rad = 0.003", "angle_rad = nan", "it is not a number"),
    ("[joint.tibia]", "[joint.tibia]\ngap_rad = 20", "20 arcmin are 0.00581776 here"),
    ("bending_mm_per_n = 0.06", "bending_mm_per_n = -0.06", "it is negative"),
    ("format = 1\n", "", "format is missing"),
]


@pytest.mark.parametrize(("right", "wrong", "words"), OF_THE_LIMB)
def test_of_the_limb(brace: Brace, tmp_path: Path, right: str, wrong: str, words: str) -> None:
    assert right in LIMB
    readable(brace("k", "--model", limb(tmp_path, LIMB.replace(right, wrong, 1)), *POSTURE), 3, words, "limb.toml:")


# Used all the same, and said once: a limb may have it, hardly any has.
SMELLS = [
    ("compliance_rad_per_n_mm = 1.6e-5", "gap_rad = 0.5\ncompliance_rad_per_n_mm = 1.6e-5", "0.5 deg would be 0.00873"),
    ("bending_mm_per_n = 0.25", "bending_mm_per_n = 250.0", "if it was in um/N or mm/kN it is 0.25 here"),
    ("compliance_rad_per_n_mm = 1.6e-5", "compliance_rad_per_n_mm = 0.016", "in rad/(N m) it would be 1.6e-05 here"),
    ("bending_mm_per_n = 0.06", "bending_mm_per_n = 0.00000006", "if it was in m/N it is 6e-05 here"),
]


@pytest.mark.parametrize(("right", "wrong", "words"), SMELLS)
def test_values_that_smell_of_another_unit(brace: Brace, tmp_path: Path, right: str, wrong: str, words: str) -> None:
    outcome = brace("k", "--model", limb(tmp_path, LIMB.replace(right, wrong, 1)), *POSTURE)
    assert outcome.code == 0 and outcome.err.count("\n") == 1
    assert words in outcome.err and "limb.toml:" in outcome.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--theta1", "57", "--theta2", "80"), "not in degrees"),
        (("--theta1", "570deg", "--theta2", "1"), "more than a full turn"),
        (("--theta1", "1,0", "--theta2", "1"), "the decimal sign is a point"),
        (("--theta1", "1"), "alone is half a posture"),
        (("--theta1", "1", "--theta3", "1"), "did you mean --theta"),
        (("--r", "900", "--phi", "0"), "out of reach"),
        (("--theta1", "nan", "--theta2", "1"), "is not a finite number"),
    ],
)
def test_of_a_posture(brace: Brace, tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    readable(brace("k", "--model", limb(tmp_path), *arguments), 2, words)


# Of a dataset: what is written instead in meta.toml or data.csv, the exit code, the words.
OF_THE_RECORD = [
    ("meta.toml", "resolution_n", "resolution", 3, "did you mean sensor.resolution_n?"),
    ("meta.toml", "range_n", "range", 3, "did you mean sensor.range_n?"),
    ("meta.toml", "step_mm", "stepmm", 3, "did you mean rig.step_mm?"),
    ("meta.toml", 'kind = "loading"', 'kind = "load"', 3, '"loading" or "stiffness_table"'),
    ("data.csv", "fx_n,fz_n", "force_x,force_z", 3, "is it column 'force_x'?"),
    ("data.csv", ",", ";", 3, "columns are not separated by commas"),
]


@pytest.mark.parametrize(("file", "right", "wrong", "code", "words"), OF_THE_RECORD)
def test_of_a_record(brace: Brace, tmp_path: Path, file: str, right: str, wrong: str, code: int, words: str) -> None:
    record = write_loading(tmp_path / "record", loading_rows())
    path = record / file
    path.write_text(path.read_text().replace(right, wrong))
    outcome = brace("diagnose", record, "--model", limb(tmp_path), "--out", tmp_path / "out")
    readable(outcome, code, words, file)
    assert not (tmp_path / "out").exists()


def test_data_in_degrees_end_with_a_data_fault(brace: Brace, tmp_path: Path) -> None:
    rows = [[*row[:2], *(f"{float(angle) * 57.29578:.4f}" for angle in row[2:4]), *row[4:]] for row in loading_rows()]
    record = write_loading(tmp_path / "record", rows)
    outcome = brace("diagnose", record, "--model", limb(tmp_path), "--out", tmp_path / "out")
    assert outcome.code == 3 and (tmp_path / "out" / "report.html").is_file()
    assert "nothing is said of the limb: theta1_rad and theta2_rad are in degrees." in outcome.out


def test_an_entry_that_is_no_number_is_named(brace: Brace, tmp_path: Path) -> None:
    rows = loading_rows()
    rows[5][11] = "nan"
    record = write_loading(tmp_path / "record", rows)
    outcome = brace("diagnose", record, "--model", limb(tmp_path), "--out", tmp_path / "out")
    assert outcome.code == 3 and "row 6, fx_n: 'nan' is not a number" in outcome.out


def test_a_limb_without_uncertainty(brace: Brace, tmp_path: Path) -> None:
    record = write_loading(tmp_path / "record", loading_rows())
    model = limb(tmp_path, WITHOUT_TRUST)
    found = brace("diagnose", record, "--model", model, "--out", tmp_path / "out")
    assert found.code == 0 and "write what you know under [uncertainty], length_mm = 0.5" in found.err
    exact = brace("identify", record, "--model", model, "--out", tmp_path / "fitted.toml")
    readable(exact, 2, "every number of the limb is trusted exactly", "or give --free")
    assert brace("identify", record, "--model", model, "--out", tmp_path / "fitted.toml", "--free").code == 0
    assert brace("plan", "--model", model, "--count", 1).code == 0


def test_unknown_remarks_in_meta_are_kept(brace: Brace, tmp_path: Path) -> None:
    meta = LOADING_META + 'load_cell = "s/n 4411"\n[operator]\nname = "Keller"\n'
    record = write_loading(tmp_path / "record", loading_rows(), meta=meta)
    played = brace("predict", record, "--model", limb(tmp_path), "--out", tmp_path / "p.csv")
    assert played.code == 0, played.err


def test_files_in_the_wrong_order(brace: Brace, tmp_path: Path) -> None:
    record = write_loading(tmp_path / "record", loading_rows())
    readable(brace("k", "--model", record / "meta.toml", *POSTURE), 3, "where a limb model is wanted")
    fitted = brace("identify", limb(tmp_path), "--model", limb(tmp_path), "--out", tmp_path / "f.toml")
    readable(fitted, 3, "no such dataset", "name the folder")
    inside = brace("diagnose", record / "data.csv", "--model", limb(tmp_path), "--out", tmp_path / "found")
    readable(inside, 3, f"name its folder: {record}")
    table = tmp_path / "my table.csv"
    (record / "data.csv").rename(table)
    alone = brace("diagnose", table, "--model", limb(tmp_path), "--out", tmp_path / "found")
    readable(alone, 3, f"brace import '{table}' --out DIR")
    readable(brace("k", "--model", tmp_path / "limbs.toml", *POSTURE), 3, "did you mean")
    readable(brace("diagnos", record), 2, "did you mean diagnose?")


def test_a_plan_keeps_the_knee_from_folding_through_itself(brace: Brace, tmp_path: Path) -> None:
    outcome = brace("plan", "--model", limb(tmp_path), "--json")
    assert "no travel of the knee" in outcome.err
    assert all(abs(posture["theta2_rad"]) <= 2.6 for posture in json.loads(outcome.out)["best"])


TYPED = ("--femur", 230, "--tibia", 270, "--femur-joint", 60, "--tibia-joint", 60, "--tibia-link", "rigid")
COMMAS = [
    ("measured 0,06", "measured 0.06"),
    ("tube 30,5 26 alu", "tube 30.5 26 alu"),
    ("tube 30 26,5 alu", "tube 30 26.5 alu"),
    ("rod 12,5 70GPa", "rod 12.5 70GPa"),
]


@pytest.mark.parametrize("link, way", COMMAS, ids=[link for link, _ in COMMAS])
def test_a_decimal_comma_in_a_link(brace: Brace, tmp_path: Path, link: str, way: str) -> None:
    """'measured 0,06' was once a link that yields 6 mm/N along itself and nothing across."""
    refused = brace("new", "--out", tmp_path / "limb.toml", *TYPED, "--femur-link", link)
    readable(refused, 2, "the decimal sign is a point", f"try: {way}")


@pytest.mark.parametrize("link", ["tube 30,26,alu", "tube 30, 26, alu", "rod 12,70GPa", "measured 0.06,0.001"])
def test_commas_between_the_numbers_of_a_link(brace: Brace, tmp_path: Path, link: str) -> None:
    assert brace("new", "--out", tmp_path / "limb.toml", *TYPED, "--femur-link", link).code == 0


def test_a_limb_without_its_option(brace: Brace, tmp_path: Path) -> None:
    way = f"try: brace k --model {tmp_path / 'limb.toml'}"
    readable(brace("k", limb(tmp_path), *POSTURE), 2, "required: --model", way)


def test_a_bus_with_a_single_colon(brace: Brace) -> None:
    readable(brace("query", "--bus", "tcp:localhost:29536"), 2, "try: --bus tcp://localhost:29536")


def test_a_log_without_frames(brace: Brace, tmp_path: Path) -> None:
    log = tmp_path / "bus.log"
    log.write_text("")
    readable(brace("replay", log), 4, "no frames of a controller", "brace record")
