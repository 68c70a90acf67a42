"""Stiffness tables that contradict themselves or the limb they are read with."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.dataset.check_table import _single_repair
from brace.dataset.table_poses import TablePoses
from brace.dataset.unit_slips import STIFFNESS_UNITS
from brace.identify.faults import settle
from command_bench import LIMB, Outcome, physics_k

META = 'format = 1\nkind = "stiffness_table"\n'
POSES = ((0.74, 1.0), (0.2, 1.6), (1.1, 2.2), (0.5, 0.6), (-0.3, 1.9))
ANGLES = ("theta1_rad", "theta2_rad")


def table(
    folder: Path,
    *,
    angles: tuple[str, ...] = ANGLES,
    angle_factor: float = 1.0,
    k_factor: float = 1.0,
    reach_factor: float = 1.0,
    meta: str = META,
) -> Path:
    """The test limb's K and reach at a few poses, by formula."""
    folder.mkdir(exist_ok=True)
    lines = [",".join(["r_mm", "k_xx", "k_xz", "k_zx", "k_zz", *angles])]
    for theta1, theta2 in POSES:
        r_mm = abs(185 + 313.5 * np.exp(1j * theta2)) * reach_factor
        k = physics_k(theta1, theta2).ravel() * k_factor
        turned = [value * angle_factor for value in (theta1, theta2)][: len(angles)]
        lines.append(",".join(f"{value:.5f}" for value in (r_mm, *k, *turned)))
    (folder / "meta.toml").write_text(meta)
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    (folder / "limb.toml").write_text(LIMB)
    return folder


def identified(folder: Path, brace: Callable[..., Outcome]) -> Outcome:
    return brace("identify", folder, "--model", folder / "limb.toml", "--out", folder / "f.toml")


def test_a_table_with_angles_is_taken(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = table(tmp_path)
    assert not load_dataset(folder).faults
    assert identified(folder, brace).code == 0


def test_angles_in_degrees_or_alone(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    folder = table(tmp_path / "degrees", angle_factor=180 / np.pi)
    faults = load_dataset(folder).faults
    assert [(fault.row, fault.field) for fault in faults] == [(None, name) for name in ANGLES]
    assert all("degrees" in str(fault.suggestion) for fault in faults)
    assert identified(folder, brace).code == 3 and not (folder / "f.toml").exists()
    folder = table(tmp_path / "alone", angles=ANGLES[:1])
    assert [(fault.row, fault.field) for fault in load_dataset(folder).faults] == [(None, "theta1_rad")]
    assert identified(folder, brace).code == 3


def test_angles_must_reach_as_far_as_r_says(tmp_path: Path, brace: Callable[..., Outcome]) -> None:
    outcome = identified(table(tmp_path / "far", reach_factor=1.06), brace)
    assert outcome.code == 3 and "data.csv:2 (row 1), r_mm" in outcome.err and "theta2" in outcome.err
    # within the trust of [uncertainty] in lengths (0.5 mm) and angles (0.003 rad) it is no contradiction
    assert identified(table(tmp_path / "near", reach_factor=1.005), brace).code == 0
    tiny = table(tmp_path / "tiny", angle_factor=180 / np.pi)
    lines = (tiny / "data.csv").read_text().split("\n")[:1]
    for theta2 in (1.5, 2.0, 2.5):  # degrees, and yet angles that a knee can have in radians
        r_mm = abs(185 + 313.5 * np.exp(1j * np.radians(theta2)))
        k = physics_k(np.radians(1.0), np.radians(theta2)).ravel()
        lines.append(",".join(f"{value:.5f}" for value in (r_mm, *k, 1.0, theta2)))
    (tiny / "data.csv").write_text("\n".join(lines) + "\n")
    outcome = identified(tiny, brace)
    assert outcome.code == 3 and "degrees" in outcome.err


@pytest.mark.parametrize(
    ("unit", "factor", "words"),
    [
        ("furlong", 1.0, "no unit of stiffness"),
        ("lb/in", 1 / 0.17512685, "multiply k and lambda by 0.175127"),
        ("N/m", 1e3, "multiply k and lambda by 0.001"),
        ("kgf/mm", 1 / 9.80665, "9.80665"),
    ],
)
def test_units_of_the_source(
    unit: str, factor: float, words: str, tmp_path: Path, brace: Callable[..., Outcome]
) -> None:
    folder = table(tmp_path, k_factor=factor, meta=META + f'[source]\nunit_as_printed = "{unit}"\n')
    outcome = identified(folder, brace)
    assert outcome.code == 3 and words in outcome.err and not (folder / "f.toml").exists()


def test_every_unit_of_stiffness_has_its_factor() -> None:
    """A force over a length, each by its definition."""
    force_n = {"N": 1.0, "kN": 1e3, "mN": 1e-3, "MN": 1e6, "kgf": 9.80665, "gf": 9.80665e-3}
    force_n |= dict.fromkeys(("lb", "lbf"), 4.4482216152605)
    length_mm = {"mm": 1.0, "um": 1e-3, "cm": 10.0, "in": 25.4} | dict.fromkeys(("m", "metre", "meter"), 1e3)
    for unit, factor in STIFFNESS_UNITS.items():
        force, _, length = unit.replace("mm^-1", "/mm").replace("m^-1", "/m").partition("/")
        assert factor == pytest.approx(force_n[force] / length_mm[length], rel=1e-6), unit


@pytest.mark.parametrize(("z_mm", "angles", "asks"), [(None, False, True), (100.0, False, False), (None, True, False)])
def test_a_table_whose_tip_has_a_direction_needs_no_height(z_mm: float | None, angles: bool, asks: bool) -> None:
    heights = None if z_mm is None else np.full(2, z_mm)
    assert TablePoses(np.full(2, 300.0), heights, np.zeros((2, 2)) if angles else None).needs_height is asks


@pytest.mark.parametrize("unit", ["N/mm", "kN/m", ""])
def test_units_that_are_the_formats(unit: str, tmp_path: Path) -> None:
    folder = table(tmp_path, meta=META + f'[source]\nunit_as_printed = "{unit}"\n')
    assert not load_dataset(folder).faults


@pytest.mark.parametrize("field", ["k_xz", "k_zx"])
@pytest.mark.parametrize("value", [5.0, 1.8, -3.1])
def test_the_wrong_cross_entry_is_named(field: str, value: float, paper_table: Path, tmp_path: Path) -> None:
    """Row 4 of the paper's table has -1.8 in both places."""
    lines = (paper_table / "data.csv").read_text().split("\n")
    row = lines[4].split(",")
    assert row[3] == row[4] == "-1.8"
    row[{"k_xz": 3, "k_zx": 4}[field]] = f"{value:.1f}"
    (tmp_path / "meta.toml").write_text((paper_table / "meta.toml").read_text())
    (tmp_path / "data.csv").write_text("\n".join([*lines[:4], ",".join(row), *lines[5:]]))
    dataset = load_dataset(tmp_path)
    faults = [fault for fault in dataset.faults if fault.row == 4]
    assert [(fault.field, fault.suggestion) for fault in faults] == [(field, -1.8)]
    assert faults[0].blocking
    if value != 1.8:  # the eigenvalues prove it; they do not know the sign
        assert settle(dataset, "repair")[0][field][3] == -1.8


def test_cross_entries_without_printed_eigenvalues(tmp_path: Path) -> None:
    folder = table(tmp_path)
    lines = (folder / "data.csv").read_text().split("\n")
    row = lines[2].split(",")
    right, row[3] = float(row[3]), "40.0"
    (folder / "data.csv").write_text("\n".join([*lines[:2], ",".join(row), *lines[3:]]))
    faults = load_dataset(folder).faults
    assert [(fault.row, fault.field, fault.suggestion) for fault in faults] == [(2, "k_zx", right)]


@pytest.mark.parametrize(
    ("place", "wrong", "field", "right"),
    [
        (0, 50.0, "k_xx", 5.0),
        (2, 0.4, "k_zz", 4.0),
        (1, -15.0, "k_xz", -1.5),
        (1, 0.15, "k_xz", 1.5),
    ],
)
def test_the_one_entry_that_the_eigenvalues_mend(place: int, wrong: float, field: str, right: float) -> None:
    """Trace and determinant name the entry and its value; the cross entry keeps its sign."""
    decimals = dict.fromkeys(("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max"), 2)
    stated = np.round(np.linalg.eigvalsh([[5.0, 1.5], [1.5, 4.0]]), 2)
    k = np.array([5.0, 1.5, 4.0])
    k[place] = wrong
    named, value = _single_repair(k, stated, decimals)
    assert named == field and value == pytest.approx(right, abs=0.02)
