"""`brace import`: a decision that changes a number is a question, which --yes does not answer; what is plain is not
asked."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import POSES_DEG, Record, shown, text, workbook

from brace.dataset import load_dataset
from brace.importing import names
from brace.importing.meaning import target_of
from brace.importing.wraps import wraps

Brace = Callable[..., Outcome]
HEADER = "t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],Fx [N],Fz [N]"


def columns(record: Record) -> dict[str, list[str]]:
    return {name: shown(record[name], "%.6f") for name in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")}


def saved(folder: Path, header: str, cells: list[list[str]], name: str = "a.csv") -> Path:
    path = folder / name
    path.write_text(text([header], cells, ","))
    return path


def answered(brace: Brace, path: Path, folder: Path, *answers: tuple[str, str]) -> Outcome:
    """The drafted mapping with lines replaced, imported to folder/out."""
    mapping = folder / "m.toml"
    mapping.unlink(missing_ok=True)
    assert brace("import", path, "--draft", mapping).code == 0
    draft = mapping.read_text()
    for before, after in answers:
        assert before in draft, draft
        draft = draft.replace(before, after)
    mapping.write_text(draft)
    return brace("import", path, "--mapping", mapping, "--out", folder / "out")


def is_asked(brace: Brace, path: Path, folder: Path, *words: str) -> None:
    asked = brace("import", path, "--yes", "--out", folder / "out")
    assert asked.code == 2 and not (folder / "out").exists(), asked.err
    for each in words:
        assert each in asked.err, asked.err


@pytest.fixture(scope="module")
def record() -> Record:
    return Record(poses=POSES_DEG[:2], repeats=1)


def test_grad_is_the_degree_or_the_gon(brace: Brace, tmp_path: Path, record: Record) -> None:
    of = columns(record)
    header = HEADER.replace("deg", "grad")
    of["theta1"], of["theta2"] = (shown(record[name] / 0.9, "%.6f") for name in ("theta1", "theta2"))
    path = saved(tmp_path, header, list(of.values()))
    is_asked(brace, path, tmp_path, "'grad' has two meanings", 'unit = "deg" or unit = "gon"')
    done = answered(brace, path, tmp_path, ('unit = "?"', 'unit = "gon"'))
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["theta1_rad"] == pytest.approx(np.radians(record["theta1"]), abs=1e-6)
    refused = answered(brace, path, tmp_path, ('unit = "?"', 'unit = "grad"'))
    assert refused.code == 3 and "unit = 'grad' has two meanings" in refused.err, refused.err
    assert 'try: unit = "deg" or "gon"' in refused.err


@pytest.mark.parametrize("said", ["theta1=42grad", "theta1=42Grad"])
def test_a_constant_in_a_unit_of_two_meanings_is_refused(brace: Brace, tmp_path: Path, said: str) -> None:
    refused = brace("import", tmp_path / "none.csv", "--set", said, "--out", tmp_path / "out")
    assert refused.code == 2 and "two meanings: deg and gon" in refused.err and "42deg, or 42gon" in refused.err


@pytest.mark.parametrize(
    ("name", "target", "unit"),
    [
        ("dx [nm]", "dx_mm", "nm"), ("Deflection z [nm]", "dz_mm", "nm"), ("M [nm]", "?", None),
        ("knee [grad]", "?", None), ("Kniewinkel [Grad]", "theta2_rad", "deg"), ("knee angle [gradi]", "theta2_rad", "deg"),
        ("dx ['']", "dx_mm", "in"), ("dx [']", "dx_mm", "ft"), ("knee angle [']", "theta2_rad", "arcmin"),
        ("knee angle [\"]", "theta2_rad", "arcsec"), ("dx [mil]", "dx_mm", "mil"),
        ("Fx_min [N]", "?", "N"), ("Force_min", "?", None), ("Fz peak [N]", "?", "N"), ("mean displacement x [mm]", "?", "mm"),
        ("Time min", "t_s", "min"), ("t_min", "t_s", "min"), ("Force s", "?", "s"), ("Force [mm]", "?", "mm"),
        ("Current position x [mm]", "dx_mm", "mm"), ("Current force z [N]", "fz_n", "N"), ("Current [A]", "ignore", None),
        ("Present Current [mA]", "ignore", None), ("Current position x", "?", None), ("Motor current", "ignore", None),
        ("Fx filtered [N]", "?", "N"), ("Force X raw [N]", "?", "N"), ("position error x [mm]", "ignore", "mm"),
        ("Acceleration x [g]", "ignore", "gf"), ("acc_z [g]", "ignore", "gf"), ("Force x [g]", "fx_n", "gf"),
        ("dx/dt [mm/s]", "ignore", None), ("dz_vel [mm/min]", "ignore", None), ("Indentation depth [mm]", "dz_mm", "mm"),
        ("load [Nm]", "ignore", "N m"), ("position [deg]", "?", "deg"), ("T [\u00b0C]", "temp_degc", "degC"),
    ],
)  # fmt: skip
def test_what_a_name_and_its_unit_say(name: str, target: str, unit: str | None) -> None:
    read = names.read(name)
    found = target_of(read, "loading")[0]
    if name == "knee [grad]":  # the column is known, its unit is not
        assert found == "theta2_rad" and read.unit is None and len(read.meanings) == 2
        return
    assert found == target and (read.unit.text if read.unit else None) == unit


def test_torque_in_nm_is_newton_metres() -> None:
    for name in ("torque [nm]", "Torque [Nm]", "Drehmoment (nm)", "tau_nm"):
        read = names.read(name)
        assert target_of(read, "joint_test")[0] == "torque_n_mm" and read.unit is not None and read.unit.text == "N m"


@pytest.mark.parametrize("numbers", [(1, 2, 3), (0, 1), (2, 3), (11, 12, 13), (4, 5)])
def test_numbered_joints_are_asked(brace: Brace, tmp_path: Path, record: Record, numbers: tuple[int, ...]) -> None:
    of = columns(record)
    angles = [of["theta1"], of["theta2"]]
    cells = [of["t"], *([["0.25"] * record.rows] * (len(numbers) - 2)), *angles, *list(of.values())[3:]]
    labels = ",".join(f"joint_{number} [deg]" for number in numbers)
    path = saved(tmp_path, f"t [s],{labels},dx [mm],dz [mm],Fx [N],Fz [N]", cells)
    is_asked(brace, path, tmp_path, *(f"'joint_{number} [deg]': what is it?" for number in numbers))
    roles = (["ignore"] if len(numbers) == 3 else []) + ["theta1_rad", "theta2_rad"]
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    draft = mapping.read_text()
    for role in roles:
        draft = draft.replace('is = "?"', f'is = "{role}"', 1)
    mapping.write_text(draft)
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["theta2_rad"] == pytest.approx(np.radians(record["theta2"]), abs=1e-6)


@pytest.mark.parametrize("numbers", [(1, 2), (0, 1, 2)])
def test_joints_that_are_numbered_plainly_are_not_asked(
    brace: Brace, tmp_path: Path, record: Record, numbers: tuple[int, ...]
) -> None:
    of = columns(record)
    cells = [of["t"], *([["0.25"] * record.rows] * (len(numbers) - 2)), *list(of.values())[1:]]
    labels = ",".join(f"q{number} [deg]" for number in numbers)
    done = brace(
        "import", saved(tmp_path, f"t [s],{labels},dx [mm],dz [mm],Fx [N],Fz [N]", cells), "--yes", "--out", tmp_path / "out"
    )
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["theta1_rad"] == pytest.approx(np.radians(record["theta1"]), abs=1e-6)


@pytest.mark.parametrize(
    ("cell", "words"),
    [("=H2/1000", "formulas whose results are not stored"), ("3.2 N", "its entries are no numbers ('3.2 N')"),
     ("#VALUE!", "its formulas failed"), ("#DIV/0!", "its formulas failed")],
)  # fmt: skip
def test_a_force_that_cannot_be_read_is_asked(
    brace: Brace, tmp_path: Path, record: Record, cell: str, words: str
) -> None:
    """It was said that the force was not measured."""
    of = columns(record)
    of["fx"] = [cell] * record.rows
    path = saved(tmp_path, HEADER, list(of.values()))
    is_asked(brace, path, tmp_path, "'Fx [N]': what is it?", words, 'is = "ignore"')
    done = answered(brace, path, tmp_path, ('is = "?"', 'is = "ignore"'))
    assert done.code == 0 and "fx_n was not measured" in done.err, done.err


def test_formulas_of_a_workbook_without_results_are_asked(brace: Brace, tmp_path: Path, record: Record) -> None:
    pytest.importorskip("openpyxl")
    rows: list[list[object]] = [list(HEADER.split(","))]
    rows += [list(row) for row in zip(*(record[n].tolist() for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")))]
    path = tmp_path / "a.xlsx"
    path.write_bytes(workbook(rows))
    import openpyxl

    book = openpyxl.load_workbook(path)
    for row in range(2, record.rows + 2):
        book.active[f"F{row}"] = f"=G{row}*2"
    book.save(path)
    is_asked(brace, path, tmp_path, "'Fx [N]': what is it?", "formulas whose results are not stored")


def test_numbers_that_were_read_unsigned_are_asked(brace: Brace, tmp_path: Path) -> None:
    """A torque of 16 bits: -1 is 65535. No sign helps."""
    angle = 0.05 * np.sin(np.linspace(0.0, 4 * np.pi, 400))
    counts = np.round(6000.0 * angle).astype(int)
    cells = [shown(np.arange(400) * 0.02), shown(angle, "%.6f"), [f"{value * 0.01:.2f}" for value in counts % 65536]]
    path = saved(tmp_path, "t [s],angle [rad],torque [N m]", cells)
    is_asked(brace, path, tmp_path, "has it gone round?", "negative numbers that were read unsigned")
    done = answered(brace, path, tmp_path, ('wrap = "?"', "wrap = 655.36"))
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["torque_n_mm"] == pytest.approx(counts * 10.0, abs=1e-3)
    kept = answered(brace, path, tmp_path, ('wrap = "?"', "wrap = 0.0"))
    assert "has it gone round" not in kept.err


def test_other_readings_have_not_gone_round() -> None:
    random = np.random.default_rng(1)
    turned = np.concatenate([np.linspace(0.0, 10.0, 50), np.linspace(10.0, 0.0, 50)])
    for values in (turned, np.tile([0.0, 0.0, 9.0, 9.0], 20), random.standard_normal(200), np.zeros(50), np.array([1.0])):
        assert not wraps(values)
    assert wraps(np.arange(-40, 40) % 360.0)


def test_two_clocks_that_disagree_are_asked(brace: Brace, tmp_path: Path, record: Record) -> None:
    of = columns(record)
    wall = shown(record["t"] * 1e3 + 17e6 + 900.0 * np.random.default_rng(2).random(record.rows) * 4.0, "%.1f")
    is_asked(brace, saved(tmp_path, f"{HEADER},clock [ms]", [*of.values(), wall]), tmp_path, "two clocks that do not agree")
    same = shown(record["t"] * 1e3 + 17e6, "%.1f")
    done = brace(
        "import", saved(tmp_path, f"{HEADER},clock [ms]", [*of.values(), same]), "--yes", "--out", tmp_path / "out"
    )
    assert done.code == 0, done.err


def test_the_stamp_of_a_header_comes_before_other_times(brace: Brace, tmp_path: Path, record: Record) -> None:
    """As rostopic echo -p writes it: %time is when the recorder got the message."""
    of = columns(record)
    late = shown(record["t"] + 3.0 * np.random.default_rng(2).random(record.rows), "%.4f")
    cells = [late, *of.values()]
    header = "rostime [s],field.header.stamp [s]," + HEADER.split(",", 1)[1]
    done = brace("import", saved(tmp_path, header, cells), "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    t = load_dataset(tmp_path / "out")["t_s"]
    assert t - t[0] == pytest.approx(record["t"] - record["t"][0], abs=1e-3)


def test_times_that_are_distances_are_asked(brace: Brace, tmp_path: Path, record: Record) -> None:
    of = columns(record)
    of["t"] = shown(4.0 + 0.3 * np.random.default_rng(4).standard_normal(record.rows))
    path = saved(tmp_path, HEADER, list(of.values()))
    is_asked(brace, path, tmp_path, "distances from reading to reading", "--set dwell=4s")
    refused = answered(brace, path, tmp_path, ('is = "?"', 'is = "t_s"'), ('unit = "?"', 'unit = "s"'))
    assert refused.code in (2, 3) and not (tmp_path / "out").exists(), refused.err


LVM = """LabVIEW Measurement
Writer_Version\t2
Separator\tTab
X_Columns\tOne
Date\t2024/03/11
***End_of_Header***\t

Channels\t2
Samples\t40\t40
Date\t2024/03/11\t2024/03/11
Time\t14:37:48.5\t14:37:48.5
%sX_Dimension\t%s\t%s
X0\t0.0E+0\t0.0E+0
Delta_X\t0.050000\t0.050000
***End_of_Header***\t\t
X_Value\t%s\t%s\tComment
"""


@pytest.mark.parametrize("labels", [True, False])
@pytest.mark.parametrize("sign", [".", ","])
def test_an_lvm_as_labview_writes_it(brace: Brace, tmp_path: Path, labels: bool, sign: str) -> None:
    """The channels' keys stood for names, and X0 and Delta_X for readings."""
    dz = [2.0 * math.sin(math.pi * n / 20) for n in range(40)]
    channels = ("Displacement z", "Force z") if labels else ("Displacement z [mm]", "Force z [N]")
    head = LVM % ("Y_Unit_Label\tmm\tN\n" if labels else "", "Time", "Time", *channels)
    rows = "".join(f"{0.05 * n:.6f}\t{d:.6f}\t{2.5 * d:.6f}\n" for n, d in enumerate(dz))
    path = tmp_path / "a.lvm"
    path.write_text((head + rows).replace(".", sign))
    said = ("--set", "axis=z", "--set", "theta1=1rad", "--set", "theta2=1.4rad", "--yes")
    done = brace("import", path, *said, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    assert data.rows == 40 and data["fz_n"] == pytest.approx(2.5 * np.array(dz), abs=1e-5)
    assert data["t_s"][-1] == pytest.approx(1.95)
    path.write_text((head.replace("X_Dimension\tTime", "X_Dimension\tFrequency") + rows).replace(".", sign))
    other = brace("import", path, *said, "--out", tmp_path / "other")
    assert other.code == 3 and "X_Value of this .lvm is no time" in other.err, other.err


def test_the_table_of_kinds_is_what_the_questions_say() -> None:
    """Every text of the table is used where columns are judged, and its key is one of a mapping."""
    from brace.importing import constants, guess, meaning, questions, wraps as of_wraps
    from brace.importing.mapping import COLUMN_KEYS

    used = {
        value for module in (constants, guess, meaning, of_wraps) for value in vars(module).values() if isinstance(value, str)
    }
    for kind, (said, key) in questions.KINDS.items():
        assert said in used and key in COLUMN_KEYS, kind


@pytest.mark.parametrize("in_a_row", [False, True])
def test_a_name_and_a_bracket_that_contradict_are_asked(brace: Brace, tmp_path: Path, in_a_row: bool) -> None:
    """The bracket was taken without a word: a factor of a thousand, if the name is right."""
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    head = ["t_s,theta1_deg,theta2_deg,dx_um,Fx", "s,deg,deg,mm,N"] if in_a_row else [
        "t [s],theta1 [deg],theta2 [deg],dx_um [mm],Fx [N]"
    ]  # fmt: skip
    cells = [shown(r[name]) for name in ("t", "theta1", "theta2")]
    cells += [shown(1e3 * r["dx"]), shown(r["fx"])]
    path, mapping = tmp_path / "a.csv", tmp_path / "m.toml"
    path.write_text(text(head, cells, ","), encoding="utf-8")
    asked = brace("import", path, "--set", "axis=x", "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and not (tmp_path / "out").exists(), asked.err
    assert "in which unit? 'um [mm]' has two meanings: unit = \"um\" or unit = \"mm\"" in asked.err, asked.err
    assert re.search(r"has 1 open question\b", asked.err), asked.err
    brace("import", path, "--set", "axis=x", "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('unit = "?"', 'unit = "um"'))
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["dx_mm"] == pytest.approx(r["dx"], abs=1e-5)


@pytest.mark.parametrize("gaps", [(), (3,), (0, 7, 8)])
def test_a_turned_sign_is_asked_also_where_entries_are_missing(
    brace: Brace, tmp_path: Path, record: Record, gaps: tuple[int, ...]
) -> None:
    of = columns(record)
    of["fx"], of["fz"] = (shown(-record[name], "%.6f") for name in ("fx", "fz"))
    for row in gaps:
        of["fx"][row] = of["fz"][row] = ""
    path = saved(tmp_path, HEADER, list(of.values()))
    is_asked(brace, path, tmp_path, "'Fx [N]': must its sign be turned?", "'Fz [N]': must its sign be turned?")
