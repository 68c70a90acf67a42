"""Plays of the simulated limb that are taken from others, or made beside others: a run that repeats an earlier one,
runs that are played at once, and limbs that differ by their sensor or by the time of a change. Each must read to the
last bit what it reads by itself."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from command_bench import DATA

from brace.ground.errors import BraceError
from brace.model import load_limb
from brace.native.plant_batch import LoadingBatchPlayer, model_numbers, number_index

READINGS = ("fx_n", "fz_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
STEPS = np.array([0, 1, 2, 3, 2, 1, 0, -1, -2, -3, -2, -1, 0])
BEAMS: dict[str, float | str] = {
    "link.femur.moment_transfer": 1.0,
    "link.tibia.moment_transfer": 0.6,
    "base.rotation_rad_per_n_mm": 1e-6,
    "base.x_mm_per_n": 0.002,
    "base.z_mm_per_n": 0.001,
}
WEIGHTS: dict[str, float | str] = {"gravity.femur_n": 5.0, "gravity.knee_n": 3.0, "gravity.tibia_n": 8.0}
LIMBS: dict[str, dict[str, float | str]] = {
    "springs": {},
    "play": {"joint.femur.gap_rad": 0.003, "joint.tibia.gap_rad": 0.002},
    "friction": {"joint.tibia.coulomb_n_mm": 300.0, "joint.femur.coulomb_per_load_ratio": 0.1},
    "creep": {"creep.ratio": 0.1, "creep.time_constant_s": 50.0},
    "warmth": {"thermal.joint_compliance_per_degc": 0.01},
    "clearance": {"contact.play_mm": 0.2},
    "a rigid knee with play": {"joint.tibia.compliance_rad_per_n_mm": 0.0, "joint.tibia.gap_rad": 0.002},
    "hardening": {"joint.femur.hardening_n_mm_per_rad3": 1e9},
    "weight": {"gravity.tibia_n": 8.0},
    "a change": {"change.link": "tibia", "change.bending_factor": 1.5, "change.at_s": 333.0},
    "beams": {**BEAMS, **WEIGHTS},
    "rubbing beams": {**BEAMS, **WEIGHTS, "joint.femur.gap_rad": 0.003, "joint.tibia.coulomb_n_mm": 300.0,
                      "thermal.joint_compliance_per_degc": 0.01},
}  # fmt: skip


def record() -> dict[str, np.ndarray]:
    """Two postures, each axis three times. The third time comes at another pace, and it becomes warmer all the time."""
    names = ("run", "theta1_rad", "theta2_rad", "t_s", "dx_mm", "dz_mm")
    columns: dict[str, list[float]] = {name: [] for name in names}
    clock = 0.0
    for theta1, theta2 in ((0.7, 1.0), (0.2, 1.6)):
        for axis in range(2):
            for repeat in range(3):
                run = columns["run"][-1] + 1 if columns["run"] else 1
                for step in STEPS:
                    row = (run, theta1, theta2, clock, 0.8 * step * (1 - axis), 0.8 * step * axis)
                    for name, value in zip(columns, row, strict=True):
                        columns[name].append(value)
                    clock += 4.0 if repeat < 2 else 6.0
                clock += 20.0
    whole = {name: np.array(values) for name, values in columns.items()}
    return whole | {"temp_degc": 22.0 + 0.01 * whole["t_s"]}


def limb(changes: Mapping[str, float | str]) -> np.ndarray:
    return model_numbers(load_limb(DATA / "paper-limb.toml").with_values(dict(changes)))


@pytest.mark.parametrize("small", [False, True], ids=["finite", "small"])
@pytest.mark.parametrize("name", LIMBS)
def test_a_run_reads_what_it_reads_by_itself(name: str, small: bool) -> None:
    reads_alike(record(), LIMBS[name], small_displacements=small)


@pytest.mark.parametrize("name", LIMBS)
def test_a_run_that_hangs_first_reads_what_it_reads_by_itself(name: str) -> None:
    reads_alike(record(), {**WEIGHTS, **LIMBS[name]}, held_at_rest=True)


@pytest.mark.parametrize("name", ["springs", "friction", "creep", "warmth", "weight", "a change", "beams"])
def test_a_run_with_a_preload_reads_what_it_reads_by_itself(name: str) -> None:
    columns = record()
    preload = {"preload_x_n": np.sin(columns["run"]), "preload_z_n": 2.0 - 0.1 * columns["run"]}
    reads_alike(columns | preload, LIMBS[name])


@pytest.mark.parametrize("runs", [2, 3, 5, 12])
def test_runs_of_different_lengths_read_what_they_read_by_themselves(runs: int) -> None:
    columns = record()
    place = np.concatenate([np.arange(STEPS.size)] * 12)
    lengths = np.array([13, 2, 1, 7, 4, 13, 1, 1, 9, 13, 3, 5])
    keep = (columns["run"] <= runs) & (place < lengths[(columns["run"] - 1).astype(int)])
    reads_alike({key: values[keep] for key, values in columns.items()}, LIMBS["rubbing beams"])


def test_a_run_that_finds_no_rest_disturbs_no_other() -> None:
    """Strokes that are far too long in half of the runs: some rows are found in parts, others never."""
    columns = record()
    for axis in ("dx_mm", "dz_mm"):
        columns[axis] = np.where(columns["run"] % 2 == 0, 300.0, 1.0) * columns[axis]
    assert reads_alike(columns, LIMBS["beams"], all_rest=False) > 0


def test_a_run_without_its_preload_counts_one_row() -> None:
    """Where the tip cannot be pressed as wanted, the run's first row is without rest, and no other row."""
    columns = record()
    columns |= {"preload_x_n": np.full(columns["run"].size, 1e5), "preload_z_n": np.zeros(columns["run"].size)}
    assert reads_alike(columns, LIMBS["beams"], all_rest=False) == np.unique(columns["run"]).size


def test_a_limb_that_yields_nowhere_disturbs_no_other() -> None:
    """In the fifth run it is straight, and only its joints yield: it cannot be played. The limbs beside it can."""
    rigid = {f"link.{link}.{kind}_mm_per_n": 0.0 for link in ("femur", "tibia") for kind in ("axial", "bending")}
    columns = record()
    columns["theta2_rad"][columns["run"] == 5] = 0.0
    player = LoadingBatchPlayer(columns, READINGS)
    models = np.array([limb({}), limb(rigid), limb({"sensor.gain": 1.1}), limb(rigid), limb({})])
    together = player.play_numbers(models)
    assert np.isnan(together[[1, 3]]).all()
    assert np.isfinite(together[[0, 2, 4]]).all()
    for model, reading in zip(models, together, strict=True):
        alone = LoadingBatchPlayer(columns, READINGS).play_numbers(model[None])[0]
        assert np.array_equal(reading, alone, equal_nan=True)


def reads_alike(
    columns: Mapping[str, np.ndarray], changes: Mapping[str, float | str], *, all_rest: bool = True, **options: bool
) -> int:
    """How many rows have no rest, in the whole record as in its runs by themselves."""
    believed = load_limb(DATA / "paper-limb.toml").with_values(dict(changes))

    def played(some: Mapping[str, np.ndarray]) -> tuple[np.ndarray, int]:
        player = LoadingBatchPlayer(some, READINGS, **options)
        try:
            player.play(believed)
            unsolved = 0
        except BraceError as error:
            unsolved = int(str(error).split(" rows unsolved")[0].rsplit("(", 1)[-1])
        return np.asarray(player.play_numbers(model_numbers(believed)[None])[0]), unsolved

    whole, unsolved = played(columns)
    assert np.isfinite(whole).all()
    assert not (all_rest and unsolved)
    by_themselves = 0
    for run in np.unique(columns["run"]):
        rows = columns["run"] == run
        alone, more = played({key: values[rows] for key, values in columns.items()})
        assert np.array_equal(whole[:, rows], alone), run
        by_themselves += more
    assert unsolved == by_themselves
    return unsolved


@pytest.mark.parametrize("small", [False, True], ids=["finite", "small"])
def test_a_limb_of_many_reads_what_it_reads_by_itself(small: bool) -> None:
    index, models = number_index(), []
    softens: dict[str, float | str] = {"change.link": "femur", "change.bending_factor": 1.3, "change.at_s": 70.0}
    for changes in LIMBS.values():
        for key, values in (("change.at_s", (100.0, 101.0, 340.0, 900.0, 50.0)), ("sensor.gain", (1.1,)),
                            ("sensor.rotation_rad", (0.02,)), ("geometry.tibia_mm", (300.0,))):  # fmt: skip
            for value in values:
                models.append(limb({**softens, **changes}))
                models[-1][index[key]] = value
    refused = limb({})
    refused[index["sensor.gain"]] = np.nan
    player = LoadingBatchPlayer(record(), READINGS, small_displacements=small)
    together = player.play_numbers(np.array([*models, refused]))
    assert np.isnan(together[-1]).all()
    for model, reading in zip(models, together[:-1], strict=True):
        assert np.array_equal(reading, player.play_numbers(model[None])[0])
