"""Diagnosis of stiffness tables: faults with their corrections, and a class instead of a culprit."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.ground.errors import BadFileError
from brace.model import LimbModel, load_limb
from brace.native.plant import reference_planar

TIBIA = "link.tibia.bending_mm_per_n"
POSES = [(0.2 + 0.05 * i, 0.5 + 0.15 * i) for i in range(12)]


def ellipsoids_only(path: Path) -> LimbModel:
    """The limb with its links alone."""
    return load_limb(path).with_values(
        {"joint.femur.compliance_rad_per_n_mm": 0.0, "joint.tibia.compliance_rad_per_n_mm": 0.0}
    )


def found_in(folder: Path, model: LimbModel) -> Diagnosis:
    return diagnose(load_dataset(folder), model, Options())


def table(folder: Path, model: LimbModel, scale: float = 1.0) -> Path:
    """K of a limb at a dozen postures, printed to one decimal more than the paper."""
    folder.mkdir()
    (folder / "meta.toml").write_text('format = 1\nkind = "stiffness_table"\n')
    theta = np.array(POSES)
    k = scale * reference_planar(model, theta[:, 0], theta[:, 1])[:, :3]
    lines = [
        f"{a:.6f},{b:.6f},{np.sqrt(185.0**2 + 313.5**2 + 2 * 185.0 * 313.5 * np.cos(b)):.2f},"
        f"{x:.2f},{c:.2f},{c:.2f},{z:.2f}"
        for (a, b), (x, c, z) in zip(POSES, k)
    ]
    (folder / "data.csv").write_text("theta1_rad,theta2_rad,r_mm,k_xx,k_xz,k_zx,k_zz\n" + "\n".join(lines) + "\n")
    return folder


def test_the_papers_table(paper_table: Path, paper_limb: Path) -> None:
    found = found_in(paper_table, ellipsoids_only(paper_limb))
    again = found_in(paper_table, ellipsoids_only(paper_limb))
    assert found.effects == again.effects and found.gap == again.gap and found.localised == again.localised
    corrected = {(fault.row, fault.field): fault.suggestion for fault in found.data_faults}
    assert corrected[(1, "k_zz")] == 11.0 and corrected[(None, "unit")] == "N/mm"
    assert found.verdict in ("ambiguous", "unknown")
    could_be = {label.partition("@")[0] for label in found.could_be}
    assert {"joint_compliance", "moment_transfer"} <= could_be
    assert all(effect.confidence < 0.85 for effect in found.effects) and len(found.effects) != 1
    assert found.gap is not None and found.gap.unit == "n_per_mm"
    assert found.gap.before.held_out is not None and found.gap.after.held_out is not None
    assert found.gap.after.fitted < 0.2 * found.gap.before.fitted
    assert found.gap.after.held_out < 0.2 * found.gap.before.held_out
    assert found.next_experiment is not None
    rig = tomllib.loads(found.next_experiment.rig_toml)
    assert rig["sensor"]["encoders"] and rig["sensor"]["base_gauge"], "as the action asks for"


def test_a_table_that_the_limb_explains(tmp_path: Path, paper_limb: Path) -> None:
    model = load_limb(paper_limb)
    found = found_in(table(tmp_path / "d", model), model)
    assert found.verdict == "none" and found.effects == () and found.model.values == model.values


def test_what_differs_by_less_than_a_table_is_trusted_is_no_effect(tmp_path: Path, paper_limb: Path) -> None:
    """However exactly an alternative fits it: entries are trusted to 10 %, and this link bends 5 % more."""
    model = load_limb(paper_limb)
    bent = model.with_values({TIBIA: 1.05 * model.number(TIBIA)})
    found = found_in(table(tmp_path / "d", bent), model)
    assert found.verdict == "none" and found.effects == ()


def test_a_missing_spring_is_one_of_a_class(tmp_path: Path, paper_limb: Path) -> None:
    found = found_in(table(tmp_path / "d", load_limb(paper_limb)), ellipsoids_only(paper_limb))
    assert found.verdict == "ambiguous"
    assert any(label.startswith("joint_compliance") for label in found.could_be) and len(found.could_be) > 2
    assert found.gap is not None and found.gap.after.held_out is not None
    assert found.gap.after.held_out < 0.3 * (found.gap.before.held_out or 0.0)


def test_a_table_that_cannot_be_a_limbs(tmp_path: Path, paper_limb: Path) -> None:
    found = found_in(table(tmp_path / "d", load_limb(paper_limb), 1e6), ellipsoids_only(paper_limb))
    assert found.verdict == "data_fault" and not found.effects


def test_one_row_says_nothing(tmp_path: Path, paper_limb: Path) -> None:
    folder = table(tmp_path / "d", load_limb(paper_limb))
    lines = (folder / "data.csv").read_text().splitlines()
    (folder / "data.csv").write_text("\n".join(lines[:2]) + "\n")
    with pytest.raises(BadFileError):
        found_in(folder, ellipsoids_only(paper_limb))
