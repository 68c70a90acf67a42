"""Rows of a further test behind a record's: instruments that the record did not have are empty in its rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.diagnose.loading.record import NOT_MEASURED, load_record
from brace.errors import BraceError
from brace.model import load_limb
from brace.native.plant_batch import model_numbers, number_index

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


def test_forces_may_not_be_left_out(tmp_path: Path) -> None:
    folder = written(tmp_path, {1: True, 2: True})
    lines = (folder / "data.csv").read_text().splitlines()
    for line in range(1, 10):
        fields = lines[line].split(",")
        fields[12] = ""
        lines[line] = ",".join(fields)
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    assert refused_field(folder) == "fz_n"
