"""The gate before a loading record's diagnosis: whatever goes wrong between a rig and a file is named by field, and no
effect of the catalogue is taken for it."""

from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading.data_faults import sides
from brace.diagnose.loading.data_faults.gate import gate
from brace.diagnose.loading.data_faults.judge import Judge
from brace.diagnose.loading.data_faults.readings import _stands_under_load
from brace.diagnose.options import Options
from brace.model import LimbModel
from spoiled import (
    DESIGNS,
    EFFECTS,
    LIMBS,
    SIDES,
    SPOILERS,
    UNREADABLE,
    believed_limb,
    each_once,
    record,
    true_limb,
    write,
    zeroed_and_not_said,
)


def judged(folder: Path, believed: LimbModel) -> Diagnosis | None:
    return gate(load_dataset(folder, keep_unreadable=True), believed, Options())


def has_a_base(kind: str, limb: str) -> bool:
    """A base that does not move is 0 in every unit."""
    return limb == "on a soft base" or not kind.startswith("base")


@pytest.mark.parametrize(("kind", "limb"), each_once(SPOILERS, LIMBS, has_a_base))
def test_a_spoiled_record_is_a_data_fault_at_its_field(kind: str, limb: str, paper_limb: Path, tmp_path: Path) -> None:
    believed = believed_limb(paper_limb, limb)
    seed = 100 * list(SPOILERS).index(kind) + list(LIMBS).index(limb)
    columns, meta = record(tmp_path, true_limb(believed, seed), seed=seed, sensor=SIDES)
    fields = SPOILERS[kind](columns, meta, np.random.default_rng(seed))
    found = judged(write(tmp_path / "d", columns, meta), believed)
    assert found is not None and found.verdict == "data_fault"
    named = {fault.field for fault in found.data_faults if fault.blocking}
    assert named & fields, f"{[fault.sentence(Path('data.csv')) for fault in found.data_faults[:3]]}"
    assert all(fault.why for fault in found.data_faults)


@pytest.mark.parametrize("kind", UNREADABLE)
def test_an_unreadable_entry_is_named_by_row_and_field(kind: str, paper_limb: Path, tmp_path: Path) -> None:
    believed = believed_limb(paper_limb, "paper")
    columns, meta = record(tmp_path, believed)

    def spoil(text: str) -> str:
        lines = text.split("\n")
        fields = lines[41].split(",")
        fields[lines[0].split(",").index("fx_n")] = UNREADABLE[kind]
        return "\n".join([*lines[:41], ",".join(fields), *lines[42:]])

    found = judged(write(tmp_path / "d", columns, meta, spoil), believed)
    assert found is not None and found.verdict == "data_fault"
    assert [(fault.row, fault.field) for fault in found.data_faults] == [(41, "fx_n")]


@pytest.mark.parametrize(("effect", "design"), each_once(EFFECTS, DESIGNS))
def test_an_effect_is_no_data_fault(effect: str, design: str, paper_limb: Path, tmp_path: Path) -> None:
    seed = len(DESIGNS) * list(EFFECTS).index(effect) + list(DESIGNS).index(design)
    believed = believed_limb(paper_limb, list(LIMBS)[seed % len(LIMBS)])
    columns, meta = record(tmp_path, true_limb(believed, seed, values=EFFECTS[effect]), seed=seed, **DESIGNS[design])
    found = judged(write(tmp_path / "d", columns, meta), believed)
    faults = [fault.sentence(Path("data.csv")) for fault in (found.data_faults if found else ())]
    assert found is None or found.verdict != "data_fault", faults[:3]


class _Table(dict[str, np.ndarray]):
    """Columns, and a sensor that reads in steps of 0.05 N."""

    meta = SimpleNamespace(number={"sensor.resolution_n": 0.05}.__getitem__)


def test_a_force_that_stands_under_load_was_stuck() -> None:
    """It lies off the unloaded level by more than 3 times noise and resolution together, and the limb's force goes by
    more than 10 times that. 5 readings say so along the force's own axis, 8 across it."""

    def stands(level_n: float, way_n: float, count: int = 8, axis: int = 1) -> bool:
        rows, stretch = 20, slice(6, 6 + count)
        force_n, played_n, moved_mm = np.zeros((2, rows)), np.zeros((2, rows)), np.full(rows, 0.5)
        force_n[0, stretch], played_n[0, stretch], moved_mm[:3] = level_n, np.linspace(0.0, way_n, count), 0.0
        force_n[0, 3:6] = level_n  # loaded as well: the unloaded level is that of the rows that are not moved
        columns = {"axis": np.full(rows, axis), "dx_mm": moved_mm, "dz_mm": moved_mm}
        table, sigma_n = _Table(columns), np.full((2, rows), 0.1)
        judge = SimpleNamespace(dataset=table, measured=force_n, played=played_n, sigma=sigma_n)
        return _stands_under_load(cast(Judge, judge), 0, stretch)

    assert stands(0.5, 1.6) and stands(-0.5, 1.6)
    assert not stands(0.4, 1.6) and not stands(0.5, 1.4)
    assert not stands(0.5, 1.6, 7) and stands(0.5, 1.6, 5, axis=0) and not stands(0.5, 1.6, 4, axis=0)


@pytest.mark.parametrize(("runs", "is_told"), [(3, False), (14, True)])
def test_first_readings_of_nothing_in_a_few_runs_are_no_zeroing(
    runs: int, is_told: bool, paper_limb: Path, tmp_path: Path
) -> None:
    believed = believed_limb(paper_limb, "paper")
    columns, meta = record(tmp_path, believed, seed=8)
    zeroed_and_not_said(columns, meta, np.random.default_rng(8))
    few = {name: values[columns["run"] <= runs] for name, values in columns.items()}
    judge = Judge(load_dataset(write(tmp_path / "d", few, meta)), believed)
    assert [fault.field for fault in sides.faults(judge)] == ["zeroed"] * is_told


def test_the_row_and_the_reading_of_a_slip(paper_limb: Path, tmp_path: Path) -> None:
    believed = believed_limb(paper_limb, "paper")
    columns, meta = record(tmp_path, true_limb(believed, 3), seed=3)
    row = int(np.argmax(columns["fx_n"]))
    right = float(columns["fx_n"][row])
    columns["fx_n"][row] *= -1.0
    found = judged(write(tmp_path / "d", columns, meta), believed)
    assert found is not None
    assert [(f.row, f.field) for f in found.data_faults] == [(row + 1, "fx_n")]
    assert found.data_faults[0].suggestion == pytest.approx(right, abs=1e-5)


def test_the_angle_that_was_meant(paper_limb: Path, tmp_path: Path) -> None:
    believed = believed_limb(paper_limb, "paper")
    columns, meta = record(tmp_path, true_limb(believed, 4), seed=4)
    here = columns["config"] == 3
    columns["theta2_rad"][here] -= 0.7
    found = judged(write(tmp_path / "d", columns, meta), believed)
    assert found is not None
    first = found.data_faults[0]
    assert (first.row, first.field) == (int(np.argmax(here)) + 1, "theta2_rad")
    assert first.suggestion == pytest.approx(2.2, abs=0.02)


def test_the_wrong_limb_is_no_data_fault(paper_limb: Path, tmp_path: Path) -> None:
    """No single repair makes one limb another: that is for physics to be unable to say."""
    columns, meta = record(tmp_path, believed_limb(paper_limb, "stubby"), seed=5)
    found = judged(write(tmp_path / "d", columns, meta), believed_limb(paper_limb, "on a soft base"))
    assert found is None or found.verdict != "data_fault"


def test_the_time_it_takes(paper_limb: Path, tmp_path: Path) -> None:
    """Of the processor, so that others on the machine do not count."""
    believed = believed_limb(paper_limb, "paper")
    columns, meta = record(tmp_path, true_limb(believed, 6, values=EFFECTS["moment transfer"]), seed=6)
    dataset = load_dataset(write(tmp_path / "d", columns, meta))
    gate(dataset, believed, Options())
    begun = time.process_time()
    gate(dataset, believed, Options())
    assert time.process_time() - begun < 0.6
