"""`brace import`: what is no reading is left out with its count, and cuts no run in two."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import PATH, POSES_DEG, STEP_MM, Record, shown, text

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]
HEADER = "t [s],theta1 [deg],theta2 [deg],d [mm],F [N]"
AXIS = ("--set", "axis=x", "--yes")


def one_run(folder: Path, changed: dict[int, str], place_mm: float = 0.0) -> Path:
    """A run along x; some of its lines (from 0, without the header) are others."""
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    columns = [shown(r["t"]), shown(r["theta1"]), shown(r["theta2"]), shown(r["dx"] + place_mm), shown(r["fx"])]
    lines = text([HEADER], columns, ",").splitlines()
    for at, line in changed.items():
        lines[at + 1] = line
    path = folder / "run.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("mark", ["OL", "OVERLOAD", "ERR"])
def test_rows_of_overloads_are_counted_and_cut_no_run(brace: Brace, tmp_path: Path, mark: str) -> None:
    """Fewer than half of their cells are readings."""
    marks = ",".join([mark] * 4)
    path = one_run(tmp_path, {3: f"12.0,{marks}", 4: f"16.0,{marks}"})
    done = brace("import", path, *AXIS, "--out", tmp_path / "out")
    assert done.code == 0 and f"2 of {len(PATH)} rows left out: 'theta1 [deg]': {mark} (2)" in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert data.rows == len(PATH) - 2 and data["run"].max() == 1 and data["rep"].max() == 1


def test_rows_without_a_force_are_counted(brace: Brace, tmp_path: Path) -> None:
    path = one_run(tmp_path, {})
    lines = path.read_text().splitlines()
    lines[4] = lines[4].rpartition(",")[0] + ","
    path.write_text("\n".join(lines) + "\n")
    done = brace("import", path, *AXIS, "--out", tmp_path / "out")
    assert done.code == 0 and f"1 of {len(PATH)} rows left out: no force in the row (1)" in done.err, done.err
    assert load_dataset(tmp_path / "out").rows == len(PATH) - 1


@pytest.mark.parametrize("column", ["fx", "fz"])
def test_a_row_without_one_of_two_forces_is_counted(brace: Brace, tmp_path: Path, column: str) -> None:
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    cells = {name: shown(r[name]) for name in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")}
    cells[column][5] = ""
    path = tmp_path / "run.csv"
    names = "t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],Fx [N],Fz [N]"
    path.write_text(text([names], list(cells.values()), ","))
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and f"1 row left out: {column}_n is blank there" in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert data.rows == len(PATH) - 1 and data[f"{column}_n"] == pytest.approx(np.delete(r[column], 5), abs=1e-4)


def test_after_an_overload_displacements_count_from_the_same_place(brace: Brace, tmp_path: Path) -> None:
    path = one_run(tmp_path, {3: "12.0,OL,OL,OL,OL"}, place_mm=12.0)
    mapping = tmp_path / "m.toml"
    brace("import", path, "--set", "axis=x", "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('relative = "?"', "relative = true"))
    done = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    expected = STEP_MM * np.delete(np.array(PATH), 3)
    assert load_dataset(tmp_path / "out")["dx_mm"] == pytest.approx(expected, abs=1e-3)


def test_words_and_sums_among_the_readings_are_counted(brace: Brace, tmp_path: Path) -> None:
    path = one_run(tmp_path, {2: "Mean,0,0,0,0", 3: "Max,1,1,1,1", 5: "here somebody came in"})
    done = brace("import", path, *AXIS, "--out", tmp_path / "out")
    assert done.code == 0 and "3 lines among or below the readings left out" in done.err, done.err
    assert load_dataset(tmp_path / "out")["run"].max() == 1


@pytest.mark.parametrize(("mark", "left_out"), [("-99.99", 3), ("88.88", 0), ("99.9", 3), ("-9.9", 0)])
def test_nines_that_are_repeated_far_from_all_others_are_no_readings(
    brace: Brace, tmp_path: Path, mark: str, left_out: int
) -> None:
    """-99.99 was a reading, called a slipped decimal point. Forces of this run stay below 25 N."""
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    assert np.abs(r["fx"]).max() < 25.0
    lines = {
        at: ",".join([shown(r[name])[at] for name in ("t", "theta1", "theta2", "dx")] + [mark]) for at in (3, 6, 11)
    }
    done = brace("import", one_run(tmp_path, lines), *AXIS, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert load_dataset(tmp_path / "out").rows == len(PATH) - left_out
    assert (f"3 of {len(PATH)} rows left out: 'F [N]': {mark} (3)" in done.err) == (left_out > 0), done.err


def test_a_hip_that_passes_zero_cuts_no_run(brace: Brace, tmp_path: Path) -> None:
    """An encoder that reads 359.98 and 0.01 deg by turns made a run of each reading."""
    r = Record(poses=POSES_DEG[:1], axes="x", repeats=1)
    lines = {
        at: ",".join([t, ("359.98", "0.01")[at % 2], *(shown(r[n])[at] for n in ("theta2", "dx", "fx"))])
        for at, t in enumerate(shown(r["t"]))
    }
    done = brace("import", one_run(tmp_path, lines), *AXIS, "--out", tmp_path / "out")
    assert done.code == 0 and "theta1_rad leaps by a whole turn" in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert data["run"].max() == 1 and np.abs(data["theta1_rad"]).max() < 1e-3


def test_a_matrix_as_matlab_shows_it_is_refused(brace: Brace, tmp_path: Path) -> None:
    """Its numbers want a factor that stands in a line of its own; it was passed over without a word."""
    path = one_run(tmp_path, {})
    header, *rows = path.read_text().splitlines()
    path.write_text("\n".join([header, "   1.0e+03 *", "", *rows]) + "\n")
    refused = brace("import", path, *AXIS, "--out", tmp_path / "out")
    assert refused.code == 3 and "a factor of all numbers below it: 1.0e+03 *" in refused.err, refused.err


@pytest.mark.parametrize("above", [[], ["Limb 3, before repair"]])
def test_names_with_line_breaks_in_every_column(brace: Brace, tmp_path: Path, above: list[str]) -> None:
    """A header of ten lines was given up after six, and the file was said to name no columns."""
    path = one_run(tmp_path, {})
    header, *rows = path.read_text().splitlines()
    quoted = ",".join('"' + name.replace(" ", "\n\n") + '"' for name in header.split(","))
    path.write_text("\n".join([*above, quoted, *rows]) + "\n")
    done = brace("import", path, *AXIS, "--out", tmp_path / "out")
    assert done.code == 0 and load_dataset(tmp_path / "out").rows == len(PATH), done.err
