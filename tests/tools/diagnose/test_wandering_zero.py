"""A sensor's zero within a step of its resolution is no finding; one that goes further is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from brace.dataset import Dataset, load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading.run import diagnose_loading
from brace.diagnose.loading.wandering_zero import with_wandering_zero, zero_sigma_n
from brace.diagnose.options import Options, silent
from brace.identify.record import load_record
from brace.model import load_limb
from handmade import loading_record

STEP_N = 0.0625  # resolution_n of the hand-made record; its noise is 0.1 N


def wandering(data: Dataset, rms_n: float) -> Dataset:
    """The record with a zero that wanders slowly, rounded to the sensor's steps again."""
    share = data["t_s"] / data["t_s"].max()
    wave = np.sin(2.0 * np.pi * 1.3 * share) + 0.6 * np.cos(2.0 * np.pi * 2.4 * share + 1.0)
    wave *= rms_n / np.sqrt(np.mean(wave**2))
    return data.with_columns({
        name: np.round((data[name] + way * wave) / STEP_N) * STEP_N for name, way in (("fx_n", 1.0), ("fz_n", -0.8))
    })  # fmt: skip


def diagnosed(folder: Path, paper_limb: Path, rms_n: float) -> Diagnosis:
    """A sound limb whose sensor's zero wanders by so much."""
    data = wandering(load_dataset(loading_record(folder, paper_limb, values={})), rms_n)
    return diagnose_loading(data, load_limb(paper_limb), Options(processes=1), silent)


def test_a_zero_within_the_resolution_is_seen_and_not_named(tmp_path: Path, paper_limb: Path) -> None:
    """A third of a step: noise of 1.6 steps would show it at more than ten sigma."""
    found = diagnosed(tmp_path / "record", paper_limb, STEP_N / 3.0)
    assert found.verdict == "none" and not found.effects and not found.data_faults
    (note,) = [one for one in found.notes if one.startswith("also seen")]
    wanders_n = float(note.split("wanders by about ")[1].split(" N")[0])
    assert 0.4 < wanders_n / (STEP_N / 3.0) < 1.2  # noise of five times its size leaves a part of it open


def test_a_zero_that_stands_is_not_mentioned(tmp_path: Path, paper_limb: Path) -> None:
    found = diagnosed(tmp_path / "record", paper_limb, 0.0)
    assert found.verdict == "none"
    assert not [one for one in found.notes if one.startswith("also seen")]


@pytest.mark.minutes
def test_a_zero_that_goes_far_is_a_finding(tmp_path: Path, paper_limb: Path) -> None:
    assert diagnosed(tmp_path / "record", paper_limb, 5.0 * STEP_N).verdict != "none"


def test_the_spread_is_that_of_rounding(tmp_path: Path, paper_limb: Path) -> None:
    """Each reading's variance grows by a step's square over twelve, two readings of one run by nearly the same."""
    record = load_record(load_dataset(loading_record(tmp_path / "record", paper_limb, values={})))
    assert zero_sigma_n(record) == pytest.approx(STEP_N / np.sqrt(12.0))
    columns = with_wandering_zero(record).beside_model
    assert columns is not None
    assert np.all(columns[0] @ columns[1].T == 0.0)  # the axes wander apart
    for axis in (0, 1):
        covariance = columns[axis] @ columns[axis].T
        assert np.diag(covariance) == pytest.approx(np.full(record.rows, STEP_N**2 / 12.0), rel=0.02)
        assert covariance[0, 1] == pytest.approx(STEP_N**2 / 12.0, rel=0.02)
        assert 0.3 < covariance[0, -1] * 12.0 / STEP_N**2 < 0.6  # far apart only the constant third, and half the slow


def test_averages_and_zeroed_runs_have_no_such_spread(tmp_path: Path, paper_limb: Path) -> None:
    """Readings finer than the step are averages of many; and a zero that is taken off cannot wander."""
    plain = load_dataset(loading_record(tmp_path / "plain", paper_limb, values={}))
    finer = plain.with_columns({"fx_n": plain["fx_n"] + 0.3 * STEP_N * np.sin(np.arange(plain.rows))})
    zeroed = load_dataset(loading_record(tmp_path / "zeroed", paper_limb, values={}, rig='zeroed = "per_run"\n'))
    for data in (finer, zeroed):
        record = load_record(data)
        assert zero_sigma_n(record) == 0.0
        assert with_wandering_zero(record) is record
