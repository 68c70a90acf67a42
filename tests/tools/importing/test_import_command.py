"""`brace import`: other kinds of record, what it refuses, what it asks, what it never does in silence."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome, physics_k
from foreign_files import Record, shown, text

from brace.cli import import_questions
from brace.dataset import load_dataset

Brace = Callable[..., Outcome]


def saved(folder: Path, content: str | bytes, name: str = "file.csv") -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


LOADING = "t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],Fx [N],Fz [N]"


def loading(header: str = LOADING, record: Record | None = None, **changed: list[str]) -> str:
    r = Record() if record is None else record
    names = ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")
    written: str = text([header], [changed.get(name, shown(r[name])) for name in names], ",")
    return written


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"\xd0\xcf\x11\xe0" + b"\0" * 600, "an old Excel workbook (.xls)"),
        (b"MATLAB 5.0 MAT-file" + b"\0" * 100, "writetable"),
        (b"PK\x03\x04", "workbook"),
        (b"\0\1\2" * 50, "zero bytes"),
        (b"", "an empty file"),
        (b"no numbers\nin here\n", "no table of readings"),
        (b"a,b,c\n1,5,2,5,0,1\n2,5,3,5,0,2\n", "commas are both decimal signs and separators"),
        (b"t;f\n1.5;2\n2,5;3\n", "two decimal signs: 1.5 and 2,5"),
        (b"t;f\n1,234;5,678\n2,345;6,789\n", "may be a decimal number or one of thousands"),
        (b"t;f;d\n1;2;3\n2;3;4\n3;4\n4;5;6\n", "this row has 2 cells, the table 3"),
        (b"time,0,1,2,3,4,5\nforce,1,2,3,4,5,6\nweg,2,3,4,5,6,7\n", "rows and columns are exchanged"),
    ],
)
def test_what_is_no_table_is_refused_in_a_sentence(brace: Brace, tmp_path: Path, content: bytes, words: str) -> None:
    path = saved(tmp_path, content)
    outcome = brace("import", path, "--out", tmp_path / "out", "--yes")
    assert outcome.code in (2, 3) and words in outcome.err and "try:" in outcome.err, outcome.err
    assert not (tmp_path / "out").exists()


def test_a_file_without_names_is_asked_for_all_of_them(brace: Brace, tmp_path: Path) -> None:
    path = saved(tmp_path, "\n".join(loading().splitlines()[1:]))
    outcome = brace("import", path, "--out", tmp_path / "out", "--yes")
    assert outcome.code == 2 and "'#1': what is it? (the file names no columns)" in outcome.err


@pytest.mark.parametrize(
    ("header", "words"),
    [
        (LOADING.replace("Fx [N]", "Fx [V]"), "V is what the instrument gives"),
        (LOADING.replace("Fx [N]", "Fx [dyn]"), "the unit 'dyn' is not known"),
        (LOADING.replace("Fz [N]", "Fx [N]"), "'Fx [N]': what is it? (it may be fx_n, and so may 'Fx [N]' (column"),
        (LOADING.replace("dz [mm]", "dy [mm]"), "x outwards and z up"),
        (LOADING.replace("theta2 [deg]", "angle [deg]"), "which joint's angle?"),
        (LOADING.replace("theta2 [deg]", "note"), "'note': what is it? (an angle of the posture?"),
        (LOADING.replace("t [s]", "sample"), "dwell_s: the file has no time"),
        (LOADING.replace("theta2", "interior knee angle"), "180 deg for a straight leg"),
        (LOADING.replace("theta1", "femur from vertical"), "an angle from the vertical"),
        (LOADING.replace("dz [mm]", "deflection down z [mm]"), "its name says down, and z is up"),
        (LOADING.replace("Fz [N]", "Load down [N]"), "'Load down [N]': must its sign be turned? its name says down"),
        (LOADING.replace("theta2", "shank angle"), "the knee's angle, or the shank's own?"),
    ],
)
def test_what_a_header_leaves_open_is_asked(brace: Brace, tmp_path: Path, header: str, words: str) -> None:
    outcome = brace("import", saved(tmp_path, loading(header)), "--out", tmp_path / "out", "--yes")
    assert outcome.code == 2 and words in outcome.err, outcome.err


def test_what_no_column_says_is_said_on_the_command_line(brace: Brace, tmp_path: Path) -> None:
    r = Record(poses=((42.5, 57.25),), axes="z")
    path = saved(
        tmp_path, text(["n,way [mm],force [N]"], [[str(n) for n in range(r.rows)], shown(r["dz"]), shown(r["fz"])], ",")
    )
    path = path.rename(tmp_path / "way.csv")
    said = ("--set", "theta1=42.5deg", "--set", "theta2_rad=0.9992", "--set", "axis=z", "--set", "dwell=4s")
    path.write_text(path.read_text().replace("way [mm]", "Weg [mm]"))
    assert brace("import", path, "--out", tmp_path / "out", "--yes").code == 2
    done = brace("import", path, *said, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    assert data["theta1_rad"][0] == pytest.approx(math.radians(42.5)) and data["t_s"][2] == 8.0
    assert np.all(data["axis"] == 1) and "fx_n" in data and np.isnan(data["fx_n"]).all()
    bad = brace("import", path, "--set", "theta1=42", "--out", tmp_path / "out2", "--yes")
    assert bad.code == 2 and "in which unit?" in bad.err


def test_displacements_that_begin_elsewhere_are_asked_and_taken_off(brace: Brace, tmp_path: Path) -> None:
    r = Record()
    path = saved(tmp_path, loading(dx=shown(r["dx"] + 12.5)))
    outcome = brace("import", path, "--out", tmp_path / "out", "--yes")
    assert outcome.code == 2 and "does 0 mean unloaded?" in outcome.err
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('relative = "?"', "relative = true"))
    assert brace("import", path, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    assert load_dataset(tmp_path / "out")["dx_mm"] == pytest.approx(r["dx"], abs=1e-3)


def test_a_draft_never_replaces_answers(brace: Brace, tmp_path: Path) -> None:
    r = Record()
    path, mapping = saved(tmp_path, loading(dx=shown(r["dx"] + 12.5))), tmp_path / "m.toml"
    assert brace("import", path, "--draft", mapping).code == 0
    assert brace("import", path, "--draft", mapping).code == 0, "nothing was written into it"
    answered = mapping.read_text().replace('relative = "?"', "relative = true")
    mapping.write_text(answered)
    refused = brace("import", path, "--draft", mapping)
    assert refused.code == 2 and f"--mapping {mapping} to use it" in refused.err, refused.err
    assert mapping.read_text() == answered


def test_places_of_the_tip_at_several_postures(brace: Brace, tmp_path: Path) -> None:
    """Places differ from posture to posture by more than the tip is displaced: each posture has a zero of its own."""
    r = Record()
    place = 100.0 + 7.0 * r["pose"]
    path = saved(tmp_path, loading(dx=shown(r["dx"] + place), dz=shown(r["dz"] - 2.0 * place)))
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('relative = "?"', "relative = true"))
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    assert data["dx_mm"] == pytest.approx(r["dx"], abs=1e-3) and data["dz_mm"] == pytest.approx(r["dz"], abs=1e-3)
    assert np.array_equal(data["axis"] == 1, r["axis"] == "z") and data["run"].max() == 12
    assert not data.meta.moved_by_motors


def test_an_axis_that_the_readings_contradict_is_refused(brace: Brace, tmp_path: Path) -> None:
    """x and z by turns, all said to be x; the tip held sideways, and the tip free under a force along one axis."""
    r = Record(poses=((42.5, 57.25),))
    words = "loaded rows are loaded along z"
    refused = brace("import", saved(tmp_path, loading(record=r)), "--set", "axis=x", "--out", tmp_path / "out", "--yes")
    assert refused.code == 3 and words in refused.err, refused.err
    compliance = np.linalg.inv(physics_k(math.radians(42.5), math.radians(57.25)))
    force = 0.5 * np.array([r["dx"], r["dz"]])
    moved = compliance @ force
    (dx, dz), (fx, fz) = map(shown, moved), map(shown, force)
    free = saved(tmp_path, loading(record=r, dx=dx, dz=dz, fx=fx, fz=fz), "free.csv")
    refused = brace("import", free, "--set", "axis=x", "--out", tmp_path / "out", "--yes")
    assert refused.code == 3 and words in refused.err, refused.err
    only_x = r["axis"] == "x"
    held = "\n".join(line for line, keep in zip(free.read_text().splitlines(), [True, *only_x]) if keep) + "\n"
    taken = brace("import", saved(tmp_path, held), "--set", "axis=x", "--out", tmp_path / "out", "--yes")
    assert taken.code == 0, taken.err
    data = load_dataset(tmp_path / "out")
    assert np.all(data["axis"] == 0) and data.meta.moved_by_motors  # it went sideways, too


def test_a_knee_that_is_negative_throughout_is_asked(brace: Brace, tmp_path: Path) -> None:
    """Its sign is another posture's, of another K."""
    r = Record()
    path = saved(tmp_path, loading(theta2=shown(-r["theta2"])))
    asked = brace("import", path, "--out", tmp_path / "out", "--yes")
    assert asked.code == 2 and "'theta2 [deg]': must its sign be turned? all its entries are negative" in asked.err
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('sign = "?"', "sign = -1"))
    assert brace("import", path, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    assert load_dataset(tmp_path / "out")["theta2_rad"] == pytest.approx(np.radians(r["theta2"]), abs=1e-6)


def test_what_stands_open_in_a_mapping_is_named_without_empty_words(brace: Brace, tmp_path: Path) -> None:
    path = saved(tmp_path, loading(LOADING.replace("theta2 [deg]", "inner knee angle [deg]").replace(" [N]", "")))
    mapping = tmp_path / "m.toml"
    draft = brace("import", path, "--draft", mapping)
    assert "theta2_rad" not in draft.err.split("open question")[1].replace("is = theta2_rad", ""), "asked once"
    asked = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert asked.code == 2 and "()" not in asked.err and "go from \n" not in asked.err, asked.err


def test_hung_weights(brace: Brace, tmp_path: Path) -> None:
    """The force is the weights', downwards; along x nothing was measured. One displacement is not enough."""
    compliance = np.linalg.inv(physics_k(math.radians(40), math.radians(70)))
    mass = np.array([0, 0.2, 0.4, 0.6, 0.4, 0.2, 0, 0.2, 0.4, 0.6, 0.4, 0.2, 0])
    moved = compliance @ np.array([0 * mass, -9.80665 * mass])
    columns = [shown(10.0 * np.arange(13.0)), shown(mass), shown(moved[0]), shown(moved[1])]
    path = saved(tmp_path, text(["t [s],Mass [kg],dx [mm],dz [mm]"], columns, ","))
    posture = ("--set", "theta1=40deg", "--set", "theta2=70deg")
    done = brace("import", path, *posture, "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "hung weights" in done.err and "it was not measured" in done.err
    data = load_dataset(tmp_path / "out")
    assert data["fz_n"] == pytest.approx(-9.80665 * mass, abs=1e-6) and np.isnan(data["fx_n"]).all()
    assert data["dx_mm"] == pytest.approx(moved[0], abs=1e-3) and data.meta.moved_by_motors
    one = saved(tmp_path, text(["t [s],Mass [kg],dz [mm]"], [columns[0], columns[1], columns[3]], ","), "one.csv")
    refused = brace("import", one, *posture, "--set", "axis=z", "--out", tmp_path / "out2", "--yes")
    assert refused.code == 3 and "along one axis only" in refused.err
    turned = saved(
        tmp_path, text(["t [s],Mass [kg],dx [mm],dz [mm]"], [*columns[:3], shown(-moved[1])], ","), "down.csv"
    )
    asked = brace("import", turned, *posture, "--out", tmp_path / "out3", "--yes")
    assert asked.code == 2 and "it grows with the weight" in asked.err


def test_a_joint_test(brace: Brace, tmp_path: Path) -> None:
    angle = np.concatenate([np.linspace(0, 2, 40), np.linspace(2, -2, 80), np.linspace(-2, 0, 40)])
    torque = angle * 1.1
    columns = [shown(0.01 * np.arange(160.0)), shown(angle, comma=False), shown(torque)]
    path = saved(tmp_path, text(["Zeit [s];Winkel [\u00b0];Drehmoment [Nm]"], columns, ";"))
    assert brace("import", path, "--out", tmp_path / "out", "--yes").code == 0
    data = load_dataset(tmp_path / "out")
    assert data.kind == "joint_test" and data["torque_n_mm"] == pytest.approx(torque * 1e3, abs=0.1)
    assert data["angle_rad"] == pytest.approx(np.radians(angle), abs=1e-5)
    turned = saved(
        tmp_path, text(["Zeit [s];Winkel [\u00b0];Drehmoment [Nm]"], [*columns[:2], shown(-torque)], ";"), "t.csv"
    )
    asked = brace("import", turned, "--out", tmp_path / "out2", "--yes")
    assert asked.code == 2 and "must its sign be turned?" in asked.err


def test_a_table_of_k(brace: Brace, tmp_path: Path) -> None:
    rows = "r [m];Kxx [N/m];Kxz [N/m];Kzx [N/m];Kzz [N/m]\n0,3;4000;-600;-600;900\n0,35;3900;-650;-650;800\n"
    assert brace("import", saved(tmp_path, rows), "--out", tmp_path / "out", "--yes").code == 0
    data = load_dataset(tmp_path / "out")
    assert data["k_xx"] == pytest.approx([4.0, 3.9]) and data["r_mm"] == pytest.approx([300.0, 350.0])
    without = rows.replace(";Kzx [N/m]", "").replace(";-600;-600", ";-600").replace(";-650;-650", ";-650")
    refused = brace("import", saved(tmp_path, without), "--out", tmp_path / "out2", "--yes")
    assert refused.code == 3 and "no column is k_zx" in refused.err and "symmetric" in refused.err


def test_force_and_displacement_in_two_files(brace: Brace, tmp_path: Path) -> None:
    """Joined where their clocks agree, refused where they do not."""
    r = Record()
    moved = saved(
        tmp_path,
        text(
            ["t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm]"],
            [shown(r[n]) for n in ("t", "theta1", "theta2", "dx", "dz")],
            ",",
        ),
        "rig.csv",
    )
    for shift, code in ((0.0, 0), (1.7, 3)):
        pushed = saved(
            tmp_path,
            text(["t [s],Fx [N],Fz [N]"], [shown(r["t"] + shift), shown(r["fx"]), shown(r["fz"])], ","),
            "cell.csv",
        )
        table = tmp_path / "m.toml"
        brace("import", moved, pushed, "--draft", table)
        done = brace("import", moved, pushed, "--out", tmp_path / f"out{code}", "--yes")
        assert done.code == code, done.err
    assert "join the tables by time" in done.err
    assert load_dataset(tmp_path / "out0")["fz_n"] == pytest.approx(r["fz"], abs=1e-3)


def test_questions_at_a_terminal(brace: Brace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_questions, "has_terminal", lambda: True)
    path = saved(tmp_path, loading(LOADING.replace("Fx [N]", "Fx").replace("dz [mm]", "dy [mm]")))
    answers = io.StringIO("down\ndz_mm\nmm\npounds?\nN\ny\n")
    monkeypatch.setattr("sys.stdin", answers)
    done = brace("import", path, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert "'down' is not one of them" in done.err and "'pounds?' is not one of them" in done.err
    monkeypatch.setattr("sys.stdin", io.StringIO("dz_mm\nmm\nN\nn\n"))
    left = brace("import", path, "--out", tmp_path / "other")
    assert left.code == 2 and "nothing was written" in left.err and not (tmp_path / "other").exists()


def test_a_mapping_of_other_files_is_refused(brace: Brace, tmp_path: Path) -> None:
    path, mapping = saved(tmp_path, loading()), tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    assert brace("import", path, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    other = saved(tmp_path, loading(LOADING.replace("Fx [N]", "Fx1 [N]")), "other.csv")
    refused = brace("import", other, "--mapping", mapping, "--out", tmp_path / "out2")
    assert refused.code == 3 and "no file has a column 'Fx [N]'" in refused.err and "'Fx1 [N]'" in refused.err
    for wrong, words in (
        ('is = "fx_n"', 'is = "fx"|did you mean fx_n'),
        ('unit = "N"', 'unit = "mm"|is no unit of a force'),
        ("sign = 1", "sgin = 1|did you mean sign"),
        ("sign = 1", "sign = 2|1 or -1"),
    ):
        new, _, told = words.partition("|")
        slip = tmp_path / "slip.toml"
        slip.write_text(mapping.read_text().replace(wrong, new, 1))
        outcome = brace("import", path, "--mapping", slip, "--out", tmp_path / "out3")
        assert outcome.code == 3 and told in outcome.err and "slip.toml:" in outcome.err, outcome.err


def test_a_measured_dataset_is_never_replaced(brace: Brace, tmp_path: Path) -> None:
    path, out = saved(tmp_path, loading()), tmp_path / "out"
    assert brace("import", path, "--out", out, "--yes", "--json").code == 0
    told = json.loads(brace("import", path, "--out", out, "--yes", "--json").out)  # its own may be
    assert told["rows"] == 204 and told["runs"] == 12 and told["configurations"] == 3
    (out / "meta.toml").write_text('format = 1\nkind = "loading"\n')
    refused = brace("import", path, "--out", out, "--yes")
    assert refused.code == 2 and "was not imported" in refused.err


def test_rows_that_sum_up_are_no_readings(brace: Brace, tmp_path: Path) -> None:
    """Whether the word stands in a column that is used or in one that is not."""
    for name, content in (
        ("first.csv", loading() + "Mean,40,90,0.1,0.1,1.2,3.4\n"),
        ("own.csv", "\n".join("note," * (not n) + "," * bool(n) + line for n, line in enumerate(loading().splitlines()))
         + "\nMax,988,63,126,2.54,2.54,16,8\n"),
    ):  # fmt: skip
        done = brace("import", saved(tmp_path, content, name), "--out", tmp_path / name[:3], "--yes")
        assert done.code == 0 and "1 line among or below the readings left out" in done.err, done.err
        assert load_dataset(tmp_path / name[:3]).rows == 204


def test_a_posture_under_a_foreign_name_is_asked(brace: Brace, tmp_path: Path) -> None:
    """Left out in silence, it would let one angle be said for a record of several postures."""
    table = tmp_path / "rig.csv"
    rows = [f"{5 * p},{40 + p},{n},{0.1 * n},{0.2 * n}" for p in range(3) for n in range(4)]
    table.write_text("angolo anca,vinkel,pressure,fz (N),dz (mm)\n" + "\n".join(rows) + "\n")
    asked = brace("import", table, "--out", tmp_path / "out", "--set", "theta1=5deg", "--set", "theta2=40deg")
    assert asked.code == 2 and "'vinkel': what is it? (an angle of the posture?" in asked.err + asked.out
    assert "'pressure': what is it?" not in asked.err + asked.out  # it changes from row to row


def test_a_displacement_that_was_not_measured_is_told_as_a_guess(brace: Brace, tmp_path: Path) -> None:
    """Under a weight on a free tip the guess is wrong, and nothing in the record shows it."""
    table = tmp_path / "rig.csv"
    rows = "\n".join(f"{n},-40,80,{n},{0.2 * n:.1f}" for n in range(6))
    table.write_text(f"t (s),hip (deg),knee (deg),fz (N),dz (mm)\n{rows}\n")
    done = brace("import", table, "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "dx_mm was not measured" in done.err
    assert "If the tip was free to move that way, this record gives a wrong K" in done.err
    assert "wrong K" in (tmp_path / "out" / "meta.toml").read_text()


def test_hip_and_knee_without_a_unit_are_asked_once(brace: Brace, tmp_path: Path) -> None:
    table = tmp_path / "rig.csv"
    table.write_text("hip,knee,fz (N),dz (mm)\n" + "\n".join(f"-40,80,{n},{0.2 * n}" for n in range(4)) + "\n")
    asked = brace("import", table, "--out", tmp_path / "out")
    said = asked.err + asked.out
    assert asked.code == 2 and "'hip': what is it?" in said and "'knee': what is it?" in said
    assert "theta1_rad: at which" not in said and "theta2_rad: at which" not in said


@pytest.mark.parametrize("unit", ["gradi", "grados", "graus", "grader"])
def test_degrees_in_other_languages(brace: Brace, tmp_path: Path, unit: str) -> None:
    table = tmp_path / "rig.csv"
    rows = "\n".join(f"-40;80;{n};{0.2 * n:.1f};{n}" for n in range(6))
    table.write_text(f"hip ({unit});knee ({unit});fz (N);dz (mm);t (s)\n{rows}\n")
    done = brace("import", table, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["theta1_rad"] == pytest.approx(math.radians(-40))


def test_a_column_of_remarks_that_labview_names_alone(brace: Brace, tmp_path: Path) -> None:
    table = tmp_path / "run.lvm"
    rows = "\n".join(f"{n}.0\t-40.0\t80.0\t{n}.0\t{0.2 * n:.2f}" for n in range(6))
    head = "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\n"
    table.write_text(f"{head}time (s)\thip (deg)\tknee (deg)\tfz (N)\tdz (mm)\tComment\n{rows}\n")
    done = brace("import", table, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out")["fz_n"] == pytest.approx(range(6))


def test_a_column_that_is_no_known_one_is_asked_for_its_unit_at_once(brace: Brace, tmp_path: Path) -> None:
    """Whoever answers every ? of the draft is asked nothing more."""
    twice = loading("t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],F [N],F")
    path, mapping = saved(tmp_path, twice), tmp_path / "m.toml"
    assert brace("import", path, "--draft", mapping).code == 0
    draft = mapping.read_text()
    assert 'unit = "N"  # it counts unless' in draft and 'unit = "?"  # it counts unless' in draft
    for answer in ("fx_n", "fz_n"):
        draft = draft.replace('is = "?"', f'is = "{answer}"', 1)
    mapping.write_text(draft.replace('unit = "?"', 'unit = "N"'))
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err


def test_an_ignored_column_or_one_without_a_unit_is_not_asked_for_one(brace: Brace, tmp_path: Path) -> None:
    rows, mapping = loading(LOADING + ",Fy").splitlines(), tmp_path / "m.toml"
    path = saved(tmp_path, "\n".join([rows[0], *(row + ",0.01" for row in rows[1:])]))
    assert brace("import", path, "--draft", mapping).code == 0
    mapping.write_text(mapping.read_text().replace('is = "?"', 'is = "ignore"'))
    assert 'unit = "?"' in mapping.read_text()
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err


def test_rows_that_could_not_be_read_are_named_where_the_rest_is_refused(brace: Brace, tmp_path: Path) -> None:
    """Every second time is written in another way: what is left of the runs moves along no axis."""
    r = Record()
    mixed = [cell if row % 2 else f"10:00:{row:02d}" for row, cell in enumerate(shown(r["t"]))]
    path = saved(tmp_path, loading(t=mixed))
    refused = brace("import", path, "--out", tmp_path / "out", "--yes")
    assert refused.code in (0, 3), refused.err
    assert "rows left out: 't [s]': 10:00:00 (1)" in refused.err, refused.err
