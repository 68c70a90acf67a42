"""`brace import`: of two columns, units or constants for one of ours, none is taken in silence."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome
from foreign_files import LBF_N, Record, shown, text

from brace.dataset import load_dataset

Brace = Callable[..., Outcome]
NAMES = ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")
HEADER = "t [s],theta1 [deg],theta2 [deg],dx [mm],dz [mm],Fx [N],Fz [N]"


def with_column(folder: Path, name: str, values: np.ndarray, record: Record) -> Path:
    path = folder / "two.csv"
    columns = [*(shown(record[each]) for each in NAMES), shown(values)]
    path.write_text(text([f"{HEADER},{name}"], columns, ","))
    return path


@pytest.mark.parametrize(
    ("name", "first", "second", "target", "one"),
    [("Resultant force [N]", "fx", "fz", "f_n", "fx_n"), ("Displacement [mm]", "dx", "dz", "d_mm", "dx_mm")],
)
def test_a_resultant_beside_its_parts_is_asked(
    brace: Brace, tmp_path: Path, name: str, first: str, second: str, target: str, one: str
) -> None:
    r = Record()
    path = with_column(tmp_path, name, np.hypot(r[first], r[second]), r)
    asked = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert asked.code == 2 and f"{name!r}: what is it? ({target}, along the motion, or a resultant" in asked.err
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('is = "?"', f'is = "{target}"'))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and f"{target} and {one} are both of the motion along x" in refused.err, refused.err


def test_two_columns_for_one_target_are_refused(brace: Brace, tmp_path: Path) -> None:
    """The last one won."""
    r = Record()
    path, mapping = with_column(tmp_path, "Fx2 [N]", 2.0 * r["fx"], r), tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    mapping.write_text(mapping.read_text().replace('is = "?"', 'is = "fx_n"'))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and "2 columns are fx_n: 'Fx [N]', 'Fx2 [N]'" in refused.err, refused.err


def block(axis: str, posture: tuple[float, float], units: str = "", factor_n: float = 1.0) -> str:
    """A run along one axis, of one displacement and one force."""
    r = Record(poses=(posture,), axes=axis, repeats=1)
    said = [f"Femur angle: {posture[0]:g} deg", f"Knee angle: {posture[1]:g} deg"]
    header = [*said, *(["t,d,F", units] if units else ["t [s],d [mm],F [N]"])]
    table: str = text(header, [shown(r["t"]), shown(r["dx"] + r["dz"]), shown(r[f"f{axis}"] / factor_n, "%.6f")], ",")
    return table


def saved(folder: Path, name: str, *blocks: str) -> Path:
    path = folder / name
    path.write_text("\n".join(blocks))
    return path


def test_units_in_a_row_are_each_files_own(brace: Brace, tmp_path: Path) -> None:
    """Newtons in one file, pounds in the next: all was read as newtons, with a kept mapping too."""
    a = saved(tmp_path, "a.csv", block("x", (30, 60), "s,mm,N"))
    b = saved(tmp_path, "b.csv", block("x", (60, 90), "s,mm,lbf", LBF_N))
    done = brace("import", a, b, "--set", "axis=x", "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    data = load_dataset(tmp_path / "out")
    for config, posture in enumerate(((30, 60), (60, 90)), start=1):
        expected = Record(poses=(posture,), axes="x", repeats=1)["fx"]
        assert data["fx_n"][data["config"] == config] == pytest.approx(expected, abs=1e-4)
    mapping = tmp_path / "m.toml"
    brace("import", a, "--set", "axis=x", "--draft", mapping)
    c = saved(tmp_path, "c.csv", block("x", (30, 60), "s,mm,lbf", LBF_N))
    refused = brace("import", c, "--mapping", mapping, "--out", tmp_path / "out2")
    assert refused.code == 3 and "column 'F' is in lbf by the file's row of units, and in N by" in refused.err


def test_each_block_of_a_file_has_its_own_posture_and_axis(brace: Brace, tmp_path: Path) -> None:
    """All blocks had the first one's."""
    path = saved(tmp_path, "blocks.csv", "Axis: x", block("x", (30, 60)), "Axis: z", block("z", (60, 90)))
    done = brace("import", path, "--yes", "--out", tmp_path / "out")
    assert done.code == 0 and "(of blocks.csv#2)  theta1_rad  deg   60.0" in done.err, done.err
    data = load_dataset(tmp_path / "out")
    assert np.degrees(np.unique(data["theta1_rad"])) == pytest.approx([30, 60], abs=1e-6)
    assert np.array_equal(data["axis"] == 1, data["config"] == 2)
    mapping = tmp_path / "m.toml"
    brace("import", path, "--draft", mapping)
    again = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert again.code == 0 and np.array_equal(load_dataset(tmp_path / "out")["theta1_rad"], data["theta1_rad"])


def test_a_kept_mappings_posture_is_not_the_next_files(brace: Brace, tmp_path: Path) -> None:
    first, second = saved(tmp_path, "p1.csv", block("x", (30, 60))), saved(tmp_path, "p2.csv", block("x", (60, 90)))
    mapping = tmp_path / "m.toml"
    brace("import", first, "--set", "axis=x", "--draft", mapping)
    assert brace("import", first, "--mapping", mapping, "--out", tmp_path / "out").code == 0
    refused = brace("import", second, "--mapping", mapping, "--out", tmp_path / "out2")
    assert refused.code == 3 and "theta1_rad is 30.0 deg by the mapping, and this file has Femur angle: 60 deg" in (
        refused.err
    )
    said = ("--set", "theta1=60deg", "--set", "p2.csv:theta2=91deg")
    done = brace("import", second, "--mapping", mapping, *said, "--out", tmp_path / "out2")
    assert done.code == 0 and "theta2_rad = 91 deg was said, and the file has Knee angle: 90 deg" in done.err, done.err
    assert np.degrees(load_dataset(tmp_path / "out2")["theta1_rad"]) == pytest.approx(60)


def test_what_is_said_of_every_file_closes_the_question(brace: Brace, tmp_path: Path) -> None:
    paths = [saved(tmp_path, f"{name}.csv", block(axis, (30, 60))) for name, axis in (("one", "x"), ("two", "z"))]
    said = ("--set", "one.csv:axis=x", "--set", "two.csv:axis=z")
    done = brace("import", *paths, *said, "--yes", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    half = brace("import", *paths, *said[:2], "--yes", "--out", tmp_path / "out2")
    assert half.code == 2 and "along which axis was the tip moved" in half.err


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("dwell=4s", "a column holds it"), ("two.csv:axis=x", "no file is called two.csv"),
        ("one.cvs:axis=x", "try: --set one.csv:axis=VALUE"),
    ],
)  # fmt: skip
def test_what_would_change_nothing_is_refused(brace: Brace, tmp_path: Path, said: str, words: str) -> None:
    path = saved(tmp_path, "one.csv", block("x", (30, 60)))
    refused = brace("import", path, "--set", "axis=x", "--set", said, "--yes", "--out", tmp_path / "out")
    assert refused.code == 2 and "would change nothing" in refused.err and words in refused.err, refused.err


@pytest.mark.parametrize("table", ["column", "constant"])
def test_a_second_entry_for_the_same_is_refused(brace: Brace, tmp_path: Path, table: str) -> None:
    path, mapping = saved(tmp_path, "one.csv", block("x", (30, 60))), tmp_path / "m.toml"
    brace("import", path, "--set", "axis=x", "--draft", mapping)
    entries = mapping.read_text().split("\n\n")
    again = next(entry for entry in entries if entry.startswith(f"[[{table}]]"))
    mapping.write_text("\n\n".join([*entries, again]))
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and f"a second [[{table}]] for" in refused.err, refused.err


def test_a_mapping_that_gives_all_tables_of_a_file_one_posture_is_refused(brace: Brace, tmp_path: Path) -> None:
    path = saved(tmp_path, "blocks.csv", "Axis: x", block("x", (30, 60)), "Axis: x", block("x", (60, 90)))
    mapping = tmp_path / "m.toml"
    brace("import", path, "--set", "blocks.csv:theta1=30deg", "--draft", mapping)
    refused = brace("import", path, "--mapping", mapping, "--out", tmp_path / "out")
    assert refused.code == 3 and "this file has Femur angle: 60 deg" in refused.err, refused.err
    assert 'file = "blocks.csv#2"' in refused.err
