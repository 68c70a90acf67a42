"""Twelve files of other people: imported to the numbers that were measured, or refused until somebody has said what
they do not say."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

import foreign_files as foreign
import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import PATH, POSES_DEG, Record

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]


def matches(folder: Path, record: Record, kept: np.ndarray | None = None, **within: float) -> None:
    """The dataset has the record's rows, in our units."""
    data = load_dataset(folder)
    assert not [fault for fault in data.faults if fault.blocking]
    keep = np.ones(record.rows, bool) if kept is None else kept
    assert data.rows == keep.sum()
    for ours, theirs, factor in (
        ("theta1_rad", "theta1", math.pi / 180), ("theta2_rad", "theta2", math.pi / 180),
        ("dx_mm", "dx", 1.0), ("dz_mm", "dz", 1.0), ("t_s", "t", 1.0),
    ):  # fmt: skip
        assert data[ours] == pytest.approx(record[theirs][keep] * factor, abs=within.get(ours, 1.1e-3)), ours
    for ours, theirs in (("fx_n", "fx"), ("fz_n", "fz")):
        read = ~np.isnan(data[ours])
        assert data[ours][read] == pytest.approx(record[theirs][keep][read], abs=within.get(ours, 1.1e-3)), ours
    assert np.array_equal(data["axis"] == 1, record["axis"][keep] == "z")
    runs = np.cumsum(np.array(record["step"]) == 0)[keep]
    assert np.array_equal(data["run"], runs)
    assert len(np.unique(data["config"])) == len(set(record["theta1"]))
    assert data["rep"].max() == record["rep"].max()


@pytest.mark.parametrize("name", ["own_headers", "german", "semicolons", "matlab", "units_row", "excel"])
def test_files_that_say_all_are_imported_at_a_word(brace: Brace, tmp_path: Path, name: str) -> None:
    if name == "excel":
        pytest.importorskip("openpyxl")
    paths = getattr(foreign, name)(tmp_path)
    asked = brace("import", *paths, "--out", tmp_path / "out")
    assert asked.code == 2 and "nobody has confirmed" in asked.err and not (tmp_path / "out").exists()
    done = brace("import", *paths, "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record())


def test_the_table_shows_every_column_with_its_reading(brace: Brace, tmp_path: Path) -> None:
    err = brace("import", *foreign.german(tmp_path), "--out", tmp_path / "out").err
    assert "Windows-1252, semicolons between columns, decimal comma" in err
    for column, target, unit in (("Kraft X [kN]", "fx_n", "kN"), ("Kniewinkel [\u00b0]", "theta2_rad", "deg")):
        assert re.search(rf"{re.escape(column)} +{target} +{unit} ", err), err


def test_pounds_inches_and_a_turned_sign(brace: Brace, tmp_path: Path) -> None:
    """The sign is asked, never turned in silence; the mapping file is kept and holds for the next file."""
    paths = foreign.pounds_and_inches(tmp_path)
    refused = brace("import", *paths, "--out", tmp_path / "out", "--yes")
    assert refused.code == 2 and "'load_x_lbf': must its sign be turned?" in refused.err
    mapping = tmp_path / "mapping.toml"
    assert brace("import", *paths, "--draft", mapping).code == 0
    still = brace("import", *paths, "--mapping", mapping, "--out", tmp_path / "out")
    assert still.code == 2 and "2 open questions" in still.err
    mapping.write_text(mapping.read_text().replace('sign = "?"', "sign = -1"))
    done = brace("import", *paths, "--mapping", mapping, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record())
    meta = tomllib.loads((tmp_path / "out" / "meta.toml").read_text())
    assert meta["conversion"]["fx_n"] == "column 'load_x_lbf' in lbf, times -4.44822161526"
    assert meta["source"]["files"] == ["rig.csv"]


def test_a_sign_that_is_wrongly_said_is_refused(brace: Brace, tmp_path: Path) -> None:
    paths, mapping = foreign.pounds_and_inches(tmp_path), tmp_path / "mapping.toml"
    brace("import", *paths, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('sign = "?"', "sign = 1"))
    refused = brace("import", *paths, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and "cannot be right" in refused.err and not (tmp_path / "out").exists()


def test_units_that_nobody_says_are_asked(brace: Brace, tmp_path: Path) -> None:
    paths, mapping = foreign.degrees_without_unit(tmp_path), tmp_path / "mapping.toml"
    refused = brace("import", *paths, "--out", tmp_path / "out", "--yes")
    assert refused.code == 2
    for column in ("t", "dx", "dz", "fx", "fz"):
        assert f"'{column}': in which unit?" in refused.err
    assert "deg from the size of its entries" in refused.err
    brace("import", *paths, "--draft", mapping)
    text = mapping.read_text()
    for column, unit in (("t", "s"), ("dx", "mm"), ("dz", "mm"), ("fx", "N"), ("fz", "N")):
        at = text.index(f'name = "{column}"')
        text = text[:at] + text[at:].replace('unit = "?"', f'unit = "{unit}"', 1)
    mapping.write_text(text)
    assert brace("import", *paths, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    matches(tmp_path / "out", Record())
    wrong = mapping.read_text().replace('unit = "N"', 'unit = "kN"')
    mapping.write_text(wrong)
    refused = brace("import", *paths, "--mapping", mapping, "--out", tmp_path / "other")
    assert refused.code == 3 and "cannot be right" in refused.err


def test_a_load_cell_of_one_axis(brace: Brace, tmp_path: Path) -> None:
    done = brace("import", *foreign.one_axis(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    for words in ("no temperature was recorded", "no run was repeated", "fx_n was not measured in 3 of 6 runs"):
        assert words in done.err
    matches(tmp_path / "out", Record(repeats=1))
    data = load_dataset(tmp_path / "out")
    assert np.array_equal(np.isnan(data["fx_n"]), data["axis"] == 1) and "temp_degc" not in data


def test_rows_without_readings_are_left_out_and_counted(brace: Brace, tmp_path: Path) -> None:
    done = brace("import", *foreign.gaps(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "1 of 204 rows left out: 'Fx [N]': OVL" in done.err
    assert "2 rows left out: fx_n is blank" in done.err
    kept = np.ones(204, bool)
    kept[[5, 40, 41]] = False
    matches(tmp_path / "out", Record(), kept)


def test_a_file_for_each_axis(brace: Brace, tmp_path: Path) -> None:
    done = brace("import", *foreign.two_files(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0 and "the clock begins anew once" in done.err
    data = load_dataset(tmp_path / "out")
    assert data.rows == 2 * 2 * len(PATH) and np.all(np.diff(data["t_s"]) > 0)
    assert data["theta2_rad"] == pytest.approx(math.radians(POSES_DEG[0][1]))
    assert np.array_equal(np.unique(data["run"][data["axis"] == 1]), [3, 4])


def test_free_text_above_and_between(brace: Brace, tmp_path: Path) -> None:
    done = brace("import", *foreign.free_text(tmp_path), "--out", tmp_path / "out", "--yes")
    assert done.code == 0, done.err
    matches(tmp_path / "out", Record(poses=POSES_DEG[:1]))
    assert load_dataset(tmp_path / "out")["temp_degc"] == pytest.approx(21.5)


def test_what_was_imported_is_read_by_the_other_commands(brace: Brace, tmp_path: Path, paper_limb: Path) -> None:
    """Without temperature, one axis a run."""
    brace("import", *foreign.one_axis(tmp_path), "--out", tmp_path / "out", "--yes")
    meta = tmp_path / "out" / "meta.toml"
    meta.write_text('displacements = "small"\n' + meta.read_text())  # as the record was made
    fitted = brace("identify", tmp_path / "out", "--model", paper_limb, "--out", tmp_path / "fitted.toml")
    assert fitted.code == 0, fitted.err
    played = brace("predict", tmp_path / "out", "--model", paper_limb, "--out", tmp_path / "p.csv")
    assert played.code == 0, played.err
    found = brace("diagnose", tmp_path / "out", "--model", paper_limb, "--out", tmp_path / "found", "--json")
    assert found.code == 0, found.err
