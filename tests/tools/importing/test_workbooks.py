"""`brace import`: what else stands in workbooks."""

from __future__ import annotations

import datetime
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import PATH, POSES_DEG, Record, excel, workbook

from brace.dataset import load_dataset

pytest.importorskip("openpyxl")
Brace = Callable[..., Outcome]
SHEET = "xl/worksheets/sheet1.xml"


def changed(path: Path, change: Callable[[bytes], bytes], name: str = SHEET) -> Path:
    """The workbook with another content of one of its files."""
    out = path.with_name("changed.xlsx")
    with zipfile.ZipFile(path) as before, zipfile.ZipFile(out, "w") as after:
        for each in before.namelist():
            after.writestr(each, change(before.read(each)) if each == name else before.read(each))
    return out


@pytest.mark.parametrize("sign", [",", "."])
def test_numbers_that_are_kept_as_text(brace: Brace, tmp_path: Path, sign: str) -> None:
    """The forces are texts, beside numbers that are numbers; 3,8 was read as 38."""
    r = Record()
    rows: list[list[object]] = [["Time [s]", "Femur [deg]", "Knee [deg]", "dx [mm]", "dz [mm]", "Fx [N]", "Fz [N]"]]
    for row in zip(*(r[n].tolist() for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz"))):
        rows.append([*row[:5], *(f"{value:.2f}".replace(".", sign) for value in row[5:])])
    path = tmp_path / "texts.xlsx"
    path.write_bytes(workbook(rows))
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and ("decimal comma in its texts" in done.err) == (sign == ","), done.err
    data = load_dataset(tmp_path / "out")
    assert data["fx_n"] == pytest.approx(r["fx"], abs=0.006) and data["dx_mm"] == pytest.approx(r["dx"], abs=1e-6)


def test_rows_beyond_what_the_sheet_says_it_has(brace: Brace, tmp_path: Path) -> None:
    said = b'<dimension ref="A1:G9"/><sheetData>'
    path = changed(excel(tmp_path)[0], lambda sheet: sheet.replace(b"<sheetData>", said))
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and load_dataset(tmp_path / "out").rows == Record().rows, done.err


def test_formulas_with_results_beside_an_empty_cell(brace: Brace, tmp_path: Path) -> None:
    """An empty cell makes the formulas be read; they stand for a cell without a result alone."""

    def with_formulas(sheet: bytes) -> bytes:
        return re.sub(rb'(<c r="F[0-9]+">)(<v>)', rb"\1<f>2*3</f>\2", sheet.replace(b'"A1"', b'"B1"'))

    done = brace("import", changed(excel(tmp_path)[0], with_formulas), "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and load_dataset(tmp_path / "out")["fx_n"] == pytest.approx(Record()["fx"], abs=1e-6), (
        done.err
    )


def test_a_sheet_that_is_a_chart(brace: Brace, tmp_path: Path) -> None:
    import openpyxl
    import openpyxl.chart

    book = openpyxl.load_workbook(excel(tmp_path)[0])
    chart = openpyxl.chart.LineChart()
    chart.add_data(openpyxl.chart.Reference(book.active, min_col=7, min_row=3, max_row=35))
    book.create_chartsheet("Diagramm1").add_chart(chart)
    book.save(tmp_path / "chart.xlsx")
    done = brace("import", tmp_path / "chart.xlsx", "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err


def test_damaged_workbooks_are_refused_in_a_sentence(brace: Brace, tmp_path: Path) -> None:
    cut = changed(excel(tmp_path)[0], lambda sheet: sheet[:1500])
    binary = tmp_path / "binary.xlsb"
    with zipfile.ZipFile(binary, "w") as archive:
        archive.writestr("xl/workbook.bin", b"abc")
    for path in (cut, binary):
        refused = brace("import", path, "--yes", "--out", tmp_path / "out")
        assert refused.code == 3 and re.search("try: .*save it as .xlsx", refused.err), refused.err


def _with_dates_and_merged_poses(path: Path, hide: bool = False) -> Path:
    """Pose and axis stand once for each run, in merged cells; the times are dates across midnight."""
    import openpyxl

    r = Record(poses=POSES_DEG[:1])
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Time", "run", "axis", "theta1 [deg]", "theta2 [deg]", "dx [mm]", "dz [mm]", "Fx [N]", "Fz [N]"])
    begun = datetime.datetime(2026, 3, 1, 23, 58, 0)
    for row in range(r.rows):
        run = row // len(PATH)
        first = [run + 1, r["axis"][row], r["theta1"][row], r["theta2"][row]] if row % len(PATH) == 0 else [None] * 4
        clock = begun + datetime.timedelta(seconds=float(r["t"][row]))
        sheet.append([clock, *first, *(float(r[name][row]) for name in ("dx", "dz", "fx", "fz"))])
        if hide and run == 1:
            sheet.row_dimensions[row + 2].hidden = True
    for first_row in range(2, r.rows + 2, len(PATH)):
        for letter in "BCDE":
            sheet.merge_cells(f"{letter}{first_row}:{letter}{first_row + len(PATH) - 1}")
    book.save(path)
    return path


def test_merged_cells_and_dates(brace: Brace, tmp_path: Path) -> None:
    """A merged cell counted for its first row alone; a date was a number of an unknown unit."""
    path = _with_dates_and_merged_poses(tmp_path / "merged.xlsx")
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and "merged cells count for each of their rows" in done.err, done.err
    r, data = Record(poses=POSES_DEG[:1]), load_dataset(tmp_path / "out")
    assert data["t_s"] == pytest.approx(r["t"], abs=1e-6) and data["run"].max() == r.rows // len(PATH)
    assert data["fx_n"] == pytest.approx(r["fx"], abs=1e-6)
    assert data["theta1_rad"] == pytest.approx(np.radians(r["theta1"]), abs=1e-6)


def test_hidden_rows_are_asked(brace: Brace, tmp_path: Path) -> None:
    """A filter's hidden rows counted as readings, without a word."""
    path = _with_dates_and_merged_poses(tmp_path / "hidden.xlsx", hide=True)
    asked = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and f"{len(PATH)} rows with readings are hidden, the first is row 19" in asked.err, asked.err
    assert not (tmp_path / "out").exists()
