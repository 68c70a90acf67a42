"""Loading records that contradict themselves: each is refused by row and column, with a way out."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import check_copies, check_poses, load_dataset
from brace.ground.errors import BadFileError
from command_bench import LIMB, LOADING_HEADER, LOADING_META, Outcome, loading_rows, write_loading

Rows = list[list[str]]
ROWS_A_RUN = 17


def place(name: str) -> int:
    return LOADING_HEADER.split(",").index(name)


def scaled(name: str, factor: float, offset: float = 0.0, where: slice = slice(None)) -> Callable[[Rows], None]:
    def change(rows: Rows) -> None:
        for row in rows[where]:
            row[place(name)] = f"{float(row[place(name)]) * factor + offset:.9g}"

    return change


def written(name: str, text: str, where: slice = slice(None)) -> Callable[[Rows], None]:
    def change(rows: Rows) -> None:
        for row in rows[where]:
            row[place(name)] = text

    return change


def exchanged(one: str, other: str, where: slice = slice(None)) -> Callable[[Rows], None]:
    def change(rows: Rows) -> None:
        for row in rows[where]:
            row[place(one)], row[place(other)] = row[place(other)], row[place(one)]

    return change


def turned_axis(where: slice = slice(None)) -> Callable[[Rows], None]:
    def change(rows: Rows) -> None:
        for row in rows[where]:
            row[place("axis")] = "x" if row[place("axis")] == "z" else "z"

    return change


def both(*changes: Callable[[Rows], None]) -> Callable[[Rows], None]:
    def change(rows: Rows) -> None:
        for one in changes:
            one(rows)

    return change


RUN_2 = slice(ROWS_A_RUN, 2 * ROWS_A_RUN)  # along x
ROW_25 = slice(24, 25)  # inside run 2
CASES: dict[str, tuple[Callable[[Rows], None], set[tuple[int | None, str]], str]] = {
    # name: what is done, the faults' places, words of the first suggestion
    "all forces zero": (
        both(written("fx_n", "0.0"), written("fz_n", "0.0")),
        {(None, "fx_n"), (None, "fz_n")},
        "",
    ),
    "fx stuck": (written("fx_n", "3.1"), {(None, "fx_n")}, ""),
    "fz stuck": (written("fz_n", "-0.0625"), {(None, "fz_n")}, ""),
    "fx stuck in a run": (written("fx_n", "1.5", RUN_2), {(18, "fx_n")}, ""),
    "axis exchanged": (turned_axis(), {(None, "axis")}, "x and z exchanged"),
    "dx and dz exchanged": (exchanged("dx_mm", "dz_mm"), {(None, "dx_mm"), (None, "dz_mm")}, "exchanged"),
    "fx and fz exchanged": (exchanged("fx_n", "fz_n"), {(None, "fx_n"), (None, "fz_n")}, "exchanged"),
    "axis of a run": (turned_axis(RUN_2), {(18, "axis")}, "x"),
    "one axis entry": (turned_axis(ROW_25), {(25, "axis")}, "x"),
    "one displacement in the other column": (
        exchanged("dx_mm", "dz_mm", slice(21, 22)),
        {(22, "dz_mm")},
        "dx_mm",
    ),
    "one displacement along both": (written("dz_mm", "0.635", ROW_25), {(25, "dz_mm")}, "0.0"),
    "theta1 changes": (written("theta1_rad", "0.80", ROW_25), {(25, "theta1_rad")}, "0.74"),
    "theta2 changes": (written("theta2_rad", "0.10", ROW_25), {(25, "theta2_rad")}, "1.0"),
    "config changes": (written("config", "4", ROW_25), {(25, "config")}, "1.0"),
    "the clock stands": (written("t_s", "12.0"), {(None, "t_s")}, ""),
    "the clock in ms": (scaled("t_s", 1e3), {(None, "t_s")}, "ms: multiply by 0.001"),
    "the clock in us": (scaled("t_s", 1e6), {(None, "t_s")}, "us: multiply by 1e-06"),
    "the clock in minutes": (scaled("t_s", 1 / 60), {(None, "t_s")}, "min: multiply by 60"),
    "the clock in hours": (scaled("t_s", 1 / 3600), {(None, "t_s")}, "h: multiply by 3600"),
    "the clock stands in a run": (written("t_s", "88.0", RUN_2), {(18, "t_s")}, ""),
    "below absolute zero": (written("temp_degc", "-500.0", ROW_25), {(25, "temp_degc")}, ""),
    "too hot": (written("temp_degc", "400.0", ROW_25), {(25, "temp_degc")}, "126.85"),
    "kelvin": (scaled("temp_degc", 1.0, 273.15), {(None, "temp_degc")}, "subtract 273.15"),
    "one in kelvin": (scaled("temp_degc", 1.0, 273.15, ROW_25), {(25, "temp_degc")}, "22"),
    "fx in kN": (scaled("fx_n", 1e-3), {(None, "fx_n")}, "kN: multiply by 1000"),
    "fz in kN": (scaled("fz_n", 1e-3), {(None, "fz_n")}, "kN: multiply by 1000"),
    "both in kN": (both(scaled("fx_n", 1e-3), scaled("fz_n", 1e-3)), {(None, "fx_n"), (None, "fz_n")}, "kN"),
    "fx in kgf": (scaled("fx_n", 1 / 9.80665), {(None, "fx_n")}, "kgf: multiply by 9.80665"),
    "fz in kgf": (scaled("fz_n", 1 / 9.80665), {(None, "fz_n")}, "kgf: multiply by 9.80665"),
    "fz in lbf": (scaled("fz_n", 1 / 4.4482216), {(None, "fz_n")}, "lbf"),
    "knee beyond half a turn": (
        written("theta2_rad", "3.5", slice(0, 68)),
        {(r, "theta2_rad") for r in range(1, 21)},
        "",
    ),
    "theta1 in degrees": (scaled("theta1_rad", 180 / math.pi), {(None, "theta1_rad")}, "degrees"),
    "theta2 in degrees": (scaled("theta2_rad", 180 / math.pi), {(None, "theta2_rad")}, "degrees"),
}


@pytest.mark.parametrize("case", CASES)
def test_a_contradiction_is_located(case: str, tmp_path: Path) -> None:
    change, places, words = CASES[case]
    rows = loading_rows(noise_n=0.02)
    change(rows)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        faults = load_dataset(write_loading(tmp_path, rows)).faults
    assert {(fault.row, fault.field) for fault in faults} == places
    assert all(fault.blocking and fault.why for fault in faults)
    assert words in str(faults[0].suggestion)


@pytest.mark.parametrize("case", ["all forces zero", "axis exchanged", "one axis entry", "fx in kgf", "kelvin"])
def test_a_contradictory_record_is_not_fitted(case: str, tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    rows = loading_rows()
    CASES[case][0](rows)
    (tmp_path / "limb.toml").write_text(LIMB)
    folder, out = write_loading(tmp_path / "d", rows), tmp_path / "f.toml"
    outcome = brace("identify", folder, "--model", tmp_path / "limb.toml", "--out", out)
    assert outcome.code == 3 and "data.csv" in outcome.err and "Warning" not in outcome.err
    assert not out.exists()


def test_one_axis_alone_and_a_limb_without_cross_stiffness_are_sound(tmp_path: Path) -> None:
    """Nothing drives fx when only z is pushed, and a sensor may then read nothing at all along x."""
    rows = [row for row in loading_rows(noise_n=0.0) if row[place("axis")] == "z"]
    written("fx_n", "0.0")(rows)
    assert not load_dataset(write_loading(tmp_path, rows)).faults


@pytest.mark.parametrize("seed", range(4))
def test_a_sensor_out_of_true_is_no_wrong_unit(seed: int, tmp_path: Path) -> None:
    """Cross-talk, a turned sensor and a gain of a few per cent are effects to be found, not faults."""
    random = np.random.default_rng(seed)
    rows = loading_rows(seed=seed)
    mix = np.eye(2) + 0.06 * random.standard_normal((2, 2))
    for row in rows:
        fx, fz = mix @ [float(row[place("fx_n")]), float(row[place("fz_n")])]
        row[place("fx_n")], row[place("fz_n")] = f"{fx:.6f}", f"{fz:.6f}"
    assert not load_dataset(write_loading(tmp_path, rows)).faults


def test_zeroed_counts_at_the_top_and_under_rig(tmp_path: Path) -> None:
    rows = loading_rows()
    bare = LOADING_META.replace('zeroed = "never"\n', "")
    for top, rig, expected in (
        ("", "", False),
        ("", "per_run", True),
        ("per_run", "", True),
        ("never", "", False),
        ("per_run", "per_run", True),
    ):
        meta = bare.replace("[sensor]", f'zeroed = "{top}"\n[sensor]') if top else bare
        meta += f'zeroed = "{rig}"\n' if rig else ""
        assert load_dataset(write_loading(tmp_path, rows, meta=meta)).meta.zeroed_per_run is expected
    for meta, line in (
        (LOADING_META + 'zeroed = "per_run"\n', 12),
        (bare + 'zeroed = "sometimes"\n', 11),
        (bare + "zeroed = true\n", 11),
    ):
        with pytest.raises(BadFileError) as caught:
            load_dataset(write_loading(tmp_path, rows, meta=meta))
        assert f"meta.toml:{line}" in caught.value.render() and "zeroed" in caught.value.render()


@pytest.mark.parametrize(("copied", "is_told"), [((4,), True), ((4, 7), False)])
def test_more_than_a_fifth_of_a_poses_repeats_alike_is_a_record_without_noise(
    copied: tuple[int, ...], is_told: bool
) -> None:
    """Ten runs of one pose are nine repeats; some have the readings of the run before, bit by bit."""
    runs, length = 10, 17
    random = np.random.default_rng(2)
    columns = {name: np.zeros(runs * length) for name in ("theta1_rad", "theta2_rad", "axis")}
    columns |= {"run": np.repeat(np.arange(1, runs + 1), length), "config": np.ones(runs * length)}
    for name in ("fx_n", "fz_n"):
        force = np.tile(np.linspace(0.0, 9.0, length), (runs, 1)) + np.round(random.normal(0, 0.1, (runs, length)), 6)
        for run in copied:
            force[run - 1] = force[run - 2]
        columns[name] = force.ravel()
    rows = [fault.row for fault in check_copies.faults(columns)]
    assert rows == ([(copied[0] - 1) * length + 1] * 2 if is_told else [])


@pytest.mark.parametrize("slips", [1, 3, 4])
def test_a_few_entries_off_the_path_of_all_runs_are_slips(slips: int) -> None:
    """Up to three of a run; more are another plan."""
    runs, path_mm = 12, np.array([0.0, 0.5, 1.0, 0.5, 0.0, -0.5, -1.0, -0.5])
    length = path_mm.size
    columns = {name: np.zeros(runs * length) for name in ("theta1_rad", "theta2_rad", "dz_mm")}
    columns |= {
        name: np.repeat(values, length) for name, values in (("run", np.arange(runs)), ("axis", np.zeros(runs)))
    }
    columns |= {"config": np.ones(runs * length), "step": np.tile(np.arange(length), runs)}
    columns["dx_mm"] = np.tile(path_mm, runs)
    rows = 5 * length + np.arange(slips) + 1
    columns["dx_mm"][rows] += 0.3
    found = check_poses.faults(columns, 0.5)
    slipped = rows if slips <= 3 else rows[:0]
    assert [(fault.row, fault.field) for fault in found] == [(int(row) + 1, "dx_mm") for row in slipped]
    assert [fault.suggestion for fault in found] == path_mm[slipped % length].tolist()
