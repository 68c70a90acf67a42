"""Datasets: faults are named by row and column; healthy records pass untouched."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import Dataset, load_dataset
from brace.ground.errors import BadFileError
from command_bench import LOADING_HEADER, LOADING_META, Outcome, loading_rows, write_loading


def fields(dataset: Dataset) -> set[tuple[int | None, str]]:
    return {(fault.row, fault.field) for fault in dataset.faults}


@pytest.mark.parametrize("seed", range(5))
def test_a_healthy_record_has_no_faults(seed: int, tmp_path: Path) -> None:
    dataset = load_dataset(write_loading(tmp_path, loading_rows(seed=seed, moment_transfer=float(seed % 2))))
    assert not dataset.faults
    assert dataset.rows == 5 * 4 * 17
    assert dataset["axis"][0] == 0 and dataset["axis"][40] == 1


def test_values_are_read_exactly(tmp_path: Path) -> None:
    rows = loading_rows()
    dataset = load_dataset(write_loading(tmp_path, rows))
    for position, name in enumerate(LOADING_HEADER.split(",")):
        if name != "axis":
            assert dataset[name].tolist() == [float(row[position]) for row in rows]


def column(name: str) -> int:
    return LOADING_HEADER.split(",").index(name)


REFUSED = {  # what is done to row 30 (1-based) -> words in the message
    "text": (("fx_n", "abc"), "'abc' is not a number"),
    "empty": (("fx_n", ""), "empty"),
    "nan": (("fx_n", "nan"), "not a number"),
    "infinite": (("fz_n", "-inf"), "not allowed"),
    "decimal comma": (("fz_n", "1,5"), "14 fields"),
    "typographic minus": (("fz_n", "\u22121.5"), "write -1.5"),
    "underscore": (("fz_n", "1_000"), "not a number"),
    "axis": (("axis", "y"), "x or z"),
    "half a run": (("run", "1.5"), "whole number"),
    "absurd": (("dx_mm", "1e300"), "no record"),
    "hex": (("fx_n", "0x1p3"), "not a number"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_a_record_is_refused_by_row_and_column(case: str, tmp_path: Path) -> None:
    (name, text), words = REFUSED[case]
    rows = loading_rows()
    rows[29][column(name)] = text
    with pytest.raises(BadFileError) as caught:
        load_dataset(write_loading(tmp_path, rows))
    message = caught.value.render()
    assert words in message and "data.csv:31" in message and "try:" in message
    if case != "decimal comma":
        assert name in message and "row 30" in message


# What a whole column reads -> words that say what is wrong with it
ALL_WRONG: dict[str, tuple[str, Callable[[str], str], str]] = {
    "decimal comma": ("theta1_rad", lambda text: '"' + text.replace(".", ",") + '"', "write 0.740000"),
    "upper case": ("axis", str.upper, "write x or z"),
    "milliseconds since 1970": ("t_s", lambda text: f"{1e3 * float(text) + 1.795e12:.0f}", "divide all by 1000"),
    "date": ("t_s", lambda text: f"2026-01-01T00:00:{float(text):06.3f}", "time from any origin in s"),
}


def test_a_calendar_s_clock_counts_from_the_first_reading(tmp_path: Path) -> None:
    rows = loading_rows()
    own = [float(row[column("t_s")]) for row in rows]
    for row in rows:
        row[column("t_s")] = f"{float(row[column('t_s')]) + 1.795e9:.3f}"
    dataset = load_dataset(write_loading(tmp_path, rows))
    assert not dataset.faults
    assert np.allclose(dataset["t_s"], np.array(own) - own[0], atol=1e-3)


@pytest.mark.parametrize("case", ALL_WRONG)
def test_a_column_that_cannot_be_read_is_told_once_and_with_the_way_out(case: str, tmp_path: Path) -> None:
    name, change, words = ALL_WRONG[case]
    rows = loading_rows()
    for row in rows:
        row[column(name)] = change(row[column(name)])
    with pytest.raises(BadFileError) as caught:
        load_dataset(write_loading(tmp_path, rows))
    assert words in caught.value.render()
    (fault,) = load_dataset(tmp_path, keep_unreadable=True).faults
    assert (fault.row, fault.field) == (None, name)
    assert words.removeprefix("write ") in fault.sentence(tmp_path)


def test_a_clock_that_starts_again_with_each_run(tmp_path: Path) -> None:
    rows = loading_rows()
    began = {row[0]: float(row[column("t_s")]) for row in reversed(rows)}
    for row in rows:
        row[column("t_s")] = f"{float(row[column('t_s')]) - began[row[0]]:.3f}"
    (fault,) = load_dataset(write_loading(tmp_path, rows)).faults
    assert fault.field == "t_s" and fault.blocking and "starts again with each of 20 runs" in fault.why


def test_remarks_above_the_column_names(tmp_path: Path) -> None:
    write_loading(tmp_path, loading_rows())
    whole = (tmp_path / "data.csv").read_text()
    (tmp_path / "data.csv").write_text("# limb 3, Anna\n# second day\n" + whole)
    with pytest.raises(BadFileError) as caught:
        load_dataset(tmp_path)
    assert "the column names stand in line 3" in caught.value.render()
    assert "take the 2 lines above away" in caught.value.render()


def _set(rows: list[list[str]], name: str, change: Callable[[float], float], where: slice = slice(None)) -> None:
    for row in rows[where]:
        row[column(name)] = f"{change(float(row[column(name)])):.9g}"


def test_units_are_recognised(tmp_path: Path) -> None:
    for factor, unit in ((1 / 25.4, "inches"), (1e-3, "m"), (1e3, "um")):
        rows = loading_rows()
        _set(rows, "dx_mm", factor.__mul__)
        _set(rows, "dz_mm", factor.__mul__)
        faults = load_dataset(write_loading(tmp_path, rows)).faults
        assert {fault.field for fault in faults} == {"dx_mm", "dz_mm"}
        assert all(str(fault.suggestion).startswith(unit + ":") for fault in faults)
    rows = loading_rows()
    for name in ("theta1_rad", "theta2_rad"):
        _set(rows, name, math.degrees)
    assert fields(load_dataset(write_loading(tmp_path, rows))) == {(None, "theta1_rad"), (None, "theta2_rad")}


def test_order_duplicates_sensor_and_sign(tmp_path: Path) -> None:
    rows = loading_rows()
    _set(rows, "t_s", lambda value: value - 30.0, slice(99, 100))
    assert (100, "t_s") in fields(load_dataset(write_loading(tmp_path, rows)))
    rows = loading_rows()
    rows.insert(50, list(rows[49]))
    assert (51, "t_s") in fields(load_dataset(write_loading(tmp_path, rows)))
    rows = loading_rows()
    rows[70][column("fz_n")] = "150.0"
    assert (71, "fz_n") in fields(load_dataset(write_loading(tmp_path, rows)))
    rows = loading_rows()
    _set(rows, "fx_n", lambda value: -value, slice(0, 17))  # the first run, along x: falls as it is pushed
    assert (1, "fx_n") in fields(load_dataset(write_loading(tmp_path, rows)))
    rows = loading_rows(noise_n=0.02)
    _set(rows, "fx_n", lambda value: -value, slice(34, 51))  # the first run along z: against its reciprocals
    assert fields(load_dataset(write_loading(tmp_path, rows))) == {(35, "fx_n")}


def test_a_slipped_decimal_is_found_and_mended(tmp_path: Path) -> None:
    for row in (4, 38, 140):
        for factor in (10.0, 0.1):
            rows = loading_rows(noise_n=0.02)
            name = "fx_n" if rows[row][column("axis")] == "x" else "fz_n"
            right = float(rows[row][column(name)])
            if abs(right) < 4.0:
                continue
            _set(rows, name, factor.__mul__, slice(row, row + 1))
            faults = load_dataset(write_loading(tmp_path, rows)).faults
            assert [(fault.row, fault.field) for fault in faults] == [(row + 1, name)]
            assert faults[0].suggestion == pytest.approx(right) and faults[0].repair
            assert faults[0].doubtful  # a limb that yields suddenly reads alike


@pytest.mark.minutes
def test_a_wild_reading_is_no_slipped_decimal_of_the_next_one(tmp_path: Path) -> None:
    """Beside a wild reading the line through the neighbours is half as far off: just where a decimal point would be."""
    for row in range(3, 200):
        rows = loading_rows(noise_n=0.02)
        for name in ("fx_n", "fz_n"):
            here = float(rows[row][column(name)])
            for by in (-1, 1):
                beside = float(rows[row + by][column(name)])
                if rows[row][column("run")] != rows[row + by][column("run")]:
                    continue
                # as wild as makes ten times the reading beside it due there
                spoiled = [list(line) for line in rows]
                spoiled[row][column(name)] = f"{here + 18.0 * beside:.6f}"
                faults = load_dataset(write_loading(tmp_path, spoiled)).faults
                assert row + 1 + by not in {fault.row for fault in faults if "decimal" in fault.why}


def test_the_papers_table_as_printed(paper_table: Path) -> None:
    dataset = load_dataset(paper_table)
    by_place = {(fault.row, fault.field): fault for fault in dataset.faults}
    assert by_place[1, "k_zz"].suggestion == 11.0 and by_place[1, "k_zz"].repair
    assert by_place[None, "unit"].suggestion == "N/mm"
    assert {row for row, field in by_place if field == "lambda_min"} == {6, 7, 11}
    assert len(by_place) == 5
    assert [fault.row for fault in dataset.faults if fault.blocking] == [1]


def test_each_misprint_of_a_table_is_located(paper_table: Path, tmp_path: Path) -> None:
    """One entry of one row changed: its row is named; where one repair alone fits, it is the printed entry."""
    lines = (paper_table / "data.csv").read_text().split("\n")
    (tmp_path / "meta.toml").write_text((paper_table / "meta.toml").read_text())
    named = mended = 0
    for row in range(2, 13):
        for place, name in ((2, "k_xx"), (5, "k_zz")):
            spoiled = lines[row].split(",")
            right = float(spoiled[place])
            spoiled[place] = f"{right + 3.0:.1f}"
            (tmp_path / "data.csv").write_text("\n".join([*lines[:row], ",".join(spoiled), *lines[row + 1 :]]))
            faults = [fault for fault in load_dataset(tmp_path).faults if fault.row == row and fault.blocking]
            named += bool(faults)
            mended += any(
                fault.field == name and fault.suggestion == pytest.approx(right, abs=0.051) for fault in faults
            )
    assert named == 22
    assert mended >= 20


def test_wrong_headers(tmp_path: Path) -> None:
    rows = loading_rows()
    for header, words in (
        (LOADING_HEADER.replace("fx_n", "fx_kn"), "fx_kn"),
        (LOADING_HEADER.replace("theta1_rad", "theta1_deg"), "theta1_deg"),
        (LOADING_HEADER.replace("fz_n", "fx_n"), "twice"),
        (LOADING_HEADER.replace(",", ";"), "separated by commas"),
        ("a,b,c", "missing columns"),
        ("1,2,x,3.5", "no column names"),
    ):
        with pytest.raises(BadFileError) as caught:
            load_dataset(write_loading(tmp_path, rows, header))
        assert words in caught.value.render() and "data.csv:1" in caught.value.render()


def test_extra_columns_quotes_and_line_ends_are_taken(tmp_path: Path) -> None:
    rows = [[*row, "a remark"] for row in loading_rows()]
    dataset = load_dataset(write_loading(tmp_path, rows, LOADING_HEADER + ",remark"))
    plain = {name: values.copy() for name, values in dataset.columns.items()}
    data = (tmp_path / "data.csv").read_text().replace("a remark", '"a, remark"').replace("\n", "\r\n")
    (tmp_path / "data.csv").write_bytes(b"\xef\xbb\xbf" + data.replace("22.0", '"22.0"').encode())
    again = load_dataset(tmp_path)
    assert not again.faults
    for name, values in plain.items():
        assert np.array_equal(values, again[name])


@pytest.mark.parametrize("header", ["remark,remark", ","])
def test_columns_that_are_none_of_ours_may_share_a_name(tmp_path: Path, header: str) -> None:
    plain = load_dataset(write_loading(tmp_path, loading_rows()))
    rows = [[*row, "7", "8"] for row in loading_rows()]
    again = load_dataset(write_loading(tmp_path, rows, f"{LOADING_HEADER},{header}"))
    assert not again.faults
    assert all(np.array_equal(values, again[name]) for name, values in plain.columns.items())


def test_blanks_beside_entries_are_taken(tmp_path: Path) -> None:
    rows = loading_rows()
    plain = load_dataset(write_loading(tmp_path, rows))
    spaced = [[f" {text} " for text in row] for row in rows]
    again = load_dataset(write_loading(tmp_path, spaced, LOADING_HEADER.replace(",", ", ")))
    assert not again.faults
    assert all(np.array_equal(values, again[name]) for name, values in plain.columns.items())


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty"),
        (b"\n\n", "empty"),
        (b"\x00\x01", "zero byte"),
        (LOADING_HEADER.encode() + b"\n", "no rows"),
        (b"\xff\xff,\xfe\n1,2\n", "not text"),
    ],
)
def test_files_without_a_record(content: bytes, words: str, tmp_path: Path) -> None:
    write_loading(tmp_path, [])
    (tmp_path / "data.csv").write_bytes(content)
    with pytest.raises(BadFileError) as caught:
        load_dataset(tmp_path)
    assert words in caught.value.render()


def test_wrong_meta(tmp_path: Path) -> None:
    for meta, words in (
        (LOADING_META.replace('"loading"', '"lodaing"'), "meta.toml:2"),
        (LOADING_META.replace("145.0", "-1.0"), "meta.toml:8"),
        (LOADING_META.replace('"never"', "3"), "meta.toml:4"),
        ("kind = 1\n", "format is missing"),
        ("kind", "not valid TOML"),
    ):
        with pytest.raises(BadFileError) as caught:
            load_dataset(write_loading(tmp_path, loading_rows(), meta=meta))
        assert words in caught.value.render()
    unknown = LOADING_META + '[weather]\nwind = "none"\n'
    assert load_dataset(write_loading(tmp_path, loading_rows(), meta=unknown)).meta.document.content["weather"]


def test_a_folder_that_is_none(tmp_path: Path, brace: Callable[..., Outcome], paper_limb: Path) -> None:
    for folder in (tmp_path / "none", paper_limb):
        outcome = brace("predict", folder, "--model", paper_limb, "--out", tmp_path / "p.csv")
        assert outcome.code == 3 and "dataset" in outcome.err and not (tmp_path / "p.csv").exists()
    for name, words in (("other.txt", "no dataset in this folder"), ("data.csv", "no meta.toml in this folder")):
        (tmp_path / "folder").mkdir(exist_ok=True)
        (tmp_path / "folder" / name).write_text("")
        outcome = brace("predict", tmp_path / "folder", "--model", paper_limb, "--out", tmp_path / "p.csv")
        assert outcome.code == 3 and words in outcome.err, outcome.err


def test_mutated_records_never_break_the_reader(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    write_loading(tmp_path, loading_rows()[:60])
    whole = (tmp_path / "data.csv").read_bytes()
    for _ in range(300):
        data = bytearray(whole)
        for _ in range(int(random.integers(1, 5))):
            place = int(random.integers(len(data)))
            match random.integers(3):
                case 0:
                    data[place] = int(random.integers(256))
                case 1:
                    del data[place : place + int(random.integers(1, 200))]
                case _:
                    data[place:place] = bytes(random.choice(list(b",.\n-e9x\"'"), 4).astype(np.uint8))
        (tmp_path / "data.csv").write_bytes(bytes(data))
        try:
            load_dataset(tmp_path)
        except BadFileError as error:
            assert "data.csv" in error.where and error.why and error.next_step
