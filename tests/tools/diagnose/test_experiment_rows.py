"""Rows of a further test behind a record's; instruments that the record lacked are empty in its rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brace.dataset import Dataset, load_dataset
from brace.dataset.write import write_dataset
from brace.ground.errors import BraceError
from brace.identify.record import NOT_MEASURED, load_record
from brace.model import LimbModel, load_limb
from brace.native.plant_batch import model_numbers, number_index
from brace.rig.rig import load_rig
from brace.rig.simulate import behind, joined, simulate

META = (
    'format = 1\nkind = "loading"\ntitle = "two"\n[sensor]\nresolution_n = 0.01\nrange_n = 145.0\n'
    '[rig]\nstep_mm = 1.0\ndwell_s = 4.0\nzeroed = "never"\n'
)
HEADER = (
    "run,config,theta1_rad,theta2_rad,axis,rep,step,t_s,temp_degc,dx_mm,dz_mm,fx_n,fz_n,enc1_rad,enc2_rad"
)
RAMP = (0, 1, 2, 1, 0, -1, -2, -1, 0)


def written(folder: Path, encoders: dict[int, bool]) -> Path:
    """Runs at one posture each; `encoders` says in which they are read."""
    lines = [HEADER]
    for run, read in encoders.items():
        for step, d in enumerate(RAMP):
            force = 3.0 * d + 0.01 * np.sin(7.0 * step + run)
            joint = f"{1e-3 * d:.6f},{2e-3 * d:.6f}" if read else ","
            lines.append(
                f"{run},{run},0.5,{0.8 + 0.2 * run},x,1,{step},{100 * run + 4 * step},22,{d},0,{force:.4f},"
                f"{0.4 * force:.4f},{joint}"
            )
    folder.mkdir(exist_ok=True)
    (folder / "meta.toml").write_text(META)
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    return folder


def test_runs_without_an_instrument_are_not_measured_there(tmp_path: Path) -> None:
    dataset = load_dataset(written(tmp_path, {1: False, 2: False, 3: True, 4: True}))
    assert not dataset.faults
    assert np.isnan(dataset["enc1_rad"][:18]).all() and np.isfinite(dataset["enc1_rad"][18:]).all()
    assert dataset["enc2_rad"][20] == 4e-3
    record = load_record(dataset)
    place = record.channels.index("enc2_rad")
    assert (record.sigma[place, :18] == NOT_MEASURED).all() and (record.sigma[place, 18:] < 1.0).all()
    assert record.readings == 2 * 36 + 2 * 18


def test_their_readings_weigh_nothing(tmp_path: Path) -> None:
    """What a limb makes of readings that were not taken changes no residual."""
    (tmp_path / "limb.toml").write_text(
        "format = 1\n[geometry]\nfemur_mm = 185.0\ntibia_mm = 313.5\n[link.femur]\naxial_mm_per_n = 0.001\n"
        "bending_mm_per_n = 0.06\n[link.tibia]\naxial_mm_per_n = 0.002\nbending_mm_per_n = 0.25\n"
        "[joint.tibia]\ncompliance_rad_per_n_mm = 1.6e-5\n"
    )
    numbers = model_numbers(load_limb(tmp_path / "limb.toml"))
    other = numbers.copy()
    other[number_index()["joint.tibia.compliance_rad_per_n_mm"]] *= 2.0
    record = load_record(load_dataset(written(tmp_path / "data", {1: False, 2: True})))
    residual = record.residuals(np.stack([numbers, other])).reshape(2, len(record.channels), -1)
    place = record.channels.index("enc2_rad")
    assert np.abs(residual[:, place, :9]).max() < 1e-20
    assert np.abs(residual[0] - residual[1])[place, 9:].max() > 1.0


def refused_field(folder: Path) -> str:
    """Where a record is refused, outright or by a fault that blocks."""
    try:
        return next(fault.field for fault in load_dataset(folder).faults if fault.blocking)
    except BraceError as error:
        return str(error.where).rsplit(", ", 1)[-1]


@pytest.mark.parametrize("line", [3, 12])
def test_a_single_empty_entry_is_still_a_fault(tmp_path: Path, line: int) -> None:
    folder = written(tmp_path, {1: True, 2: True})
    lines = (folder / "data.csv").read_text().splitlines()
    lines[line] = lines[line].rsplit(",", 1)[0] + ","
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    assert refused_field(folder) == "enc2_rad"


def test_forces_may_not_be_left_out_within_a_run(tmp_path: Path) -> None:
    folder = written(tmp_path, {1: True, 2: True})
    lines = (folder / "data.csv").read_text().splitlines()
    for line in range(3, 10):
        fields = lines[line].split(",")
        fields[12] = ""
        lines[line] = ",".join(fields)
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    assert refused_field(folder) == "fz_n"


def test_a_simulated_test_after_a_record(tmp_path: Path) -> None:
    """Rows counted on, on one clock; a preload is no fault, nor is an encoder that only the second test has."""
    limb = tmp_path / "limb.toml"
    limb.write_text(
        "format = 1\n[geometry]\nfemur_mm = 185.0\ntibia_mm = 313.5\n[link.femur]\naxial_mm_per_n = 0.001\n"
        "bending_mm_per_n = 0.06\n[link.tibia]\naxial_mm_per_n = 0.002\nbending_mm_per_n = 0.25\n"
        "[joint.tibia]\ncompliance_rad_per_n_mm = 1.6e-5\n[sensor]\ndrift_x_n_per_s = 0.01\n"
    )
    pose = "[[configuration]]\ntheta1_rad = 0.5\ntheta2_rad = 1.5\n"
    (tmp_path / "first.toml").write_text(f"format = 1\n[sensor]\nresolution_n = 0.0\n{pose}")
    (tmp_path / "next.toml").write_text(
        "format = 1\n[rig]\npreload_x_mm = 1.0\npreload_z_mm = 2.0\n[temperature]\nrise_degc = 5.0\n"
        f"[sensor]\nresolution_n = 0.0\nencoders = true\n{pose}"
    )
    model = load_limb(limb)
    write_dataset(tmp_path / "a", *simulate(model, load_rig(tmp_path / "first.toml")))
    before = load_dataset(tmp_path / "a")
    write_dataset(
        tmp_path / "b", *joined(before, *simulate(model, behind(before, load_rig(tmp_path / "next.toml"))))
    )
    both, rows = load_dataset(tmp_path / "b"), before.rows
    assert not both.faults and both.rows == 2 * rows
    assert both["run"][rows] == before["run"][-1] + 1 and both["config"][rows] == 2
    assert both["t_s"][rows] == before["t_s"][-1] + 60.0
    assert both["temp_degc"][rows] == 22.0 and both["temp_degc"][-1] > 22.5
    assert np.isnan(both["enc1_rad"][:rows]).all() and np.isfinite(both["enc1_rad"][rows:]).all()
    # drift goes on by the clock: the same displacement reads more by the time between
    alone = load_dataset_of(tmp_path / "c", model, tmp_path / "next.toml")
    later = both["fx_n"][rows:] - alone["fx_n"]
    np.testing.assert_allclose(later, 0.01 * both["t_s"][rows], atol=2e-5)


def load_dataset_of(folder: Path, model: LimbModel, rig: Path) -> Dataset:
    write_dataset(folder, *simulate(model, load_rig(rig)))
    return load_dataset(folder)
