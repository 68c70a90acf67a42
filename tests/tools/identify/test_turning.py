"""Whether a record's limb turned as it was displaced: its meta.toml says so, or its readings do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_bench import LOADING_META, Outcome, loading_rows, write_loading

from brace.dataset import Dataset, load_dataset
from brace.identify.turning import settled
from brace.model import LimbModel, load_limb

Brace = Callable[..., Outcome]
UNSAID = LOADING_META.replace('displacements = "small"\n', "")


@pytest.fixture
def believed(paper_limb: Path) -> LimbModel:
    return load_limb(paper_limb)


def simulated(brace: Brace, limb: Path, rig: Path, out: Path) -> Dataset:
    assert brace("simulate", "--model", limb, "--rig", rig, "--out", out).code == 0
    return load_dataset(out)


def test_a_linear_record_is_told_from_one_of_a_limb_that_turns(
    brace: Brace, believed: LimbModel, paper_limb: Path, paper_rig: Path, tmp_path: Path
) -> None:
    linear = load_dataset(write_loading(tmp_path / "linear", loading_rows(), meta=UNSAID))
    assert settled(linear, believed).small_displacements
    assert not settled(simulated(brace, paper_limb, paper_rig, tmp_path / "real"), believed).small_displacements


@pytest.mark.parametrize("softer", [0.6, 1.7])
def test_the_believed_limb_may_be_wrong(
    brace: Brace, believed: LimbModel, paper_limb: Path, paper_rig: Path, tmp_path: Path, softer: float
) -> None:
    keys = ("joint.tibia.compliance_rad_per_n_mm", "link.tibia.bending_mm_per_n")
    wrong = believed.with_values({key: softer * believed.number(key) for key in keys})
    linear = load_dataset(write_loading(tmp_path / "linear", loading_rows(), meta=UNSAID))
    assert settled(linear, wrong).small_displacements
    assert not settled(simulated(brace, paper_limb, paper_rig, tmp_path / "real"), wrong).small_displacements


HIDDEN: dict[str, dict[str, float]] = {
    "a beam for a tibia": {"link.tibia.moment_transfer": 1.0},
    "friction": {"joint.tibia.coulomb_n_mm": 300.0},
    "play": {"joint.femur.gap_rad": 0.004},
    "hardening": {"joint.tibia.hardening_n_mm_per_rad3": 1e8},
    "a sensor that ends early": {"sensor.saturation_n": 4.0},
    "another knee": {"joint.tibia.compliance_rad_per_n_mm": 6e-5},
    "weight": {"gravity.tibia_n": 8.0},
}


@pytest.mark.parametrize("effect", sorted(HIDDEN))
def test_whatever_is_hidden_a_limb_that_turns_is_not_taken_for_one_that_does_not(
    brace: Brace, believed: LimbModel, paper_rig: Path, tmp_path: Path, effect: str
) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(believed.with_values(HIDDEN[effect]).to_toml())
    assert not settled(simulated(brace, limb, paper_rig, tmp_path / "real"), believed).small_displacements


def test_too_small_strokes_tell_nothing_and_the_limb_turned(believed: LimbModel, tmp_path: Path) -> None:
    record = load_dataset(write_loading(tmp_path / "linear", loading_rows(), meta=UNSAID))
    short = {name: 1e-3 * record[name] for name in ("dx_mm", "dz_mm")}
    random = np.random.default_rng(5)
    forces = {name: 1e-3 * record[name] + 0.1 * random.standard_normal(record.rows) for name in ("fx_n", "fz_n")}
    assert not settled(record.with_columns(short | forces), believed).small_displacements


def test_what_the_record_says_holds(believed: LimbModel, tmp_path: Path) -> None:
    said = UNSAID.replace('zeroed = "never"', 'zeroed = "never"\ndisplacements = "finite"')
    record = load_dataset(write_loading(tmp_path / "said", loading_rows(), meta=said))
    assert not settled(record, believed).small_displacements
    small = load_dataset(write_loading(tmp_path / "small", loading_rows()))
    assert settled(replace(small, columns=small.columns), believed).small_displacements
