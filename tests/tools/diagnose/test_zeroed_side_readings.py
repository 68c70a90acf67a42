"""Encoders that count from each run's start, as a controller's do: by the true limb only white noise is left."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_bench import LIMB

from brace.dataset import load_dataset
from brace.dataset.check_runs import run_starts
from brace.dataset.write import write_dataset
from brace.identify.record import load_record
from brace.model import load_limb
from brace.native.plant_batch import model_numbers
from brace.rig.rig import load_rig
from brace.rig.simulate import simulate

ENCODER_NOISE_RAD = 2e-5
ENCODERS = ("enc1_rad", "enc2_rad")
RIG = """format = 1
title = "encoders"
seed = 7
[rig]
steps = 5
repeats = 6
zeroed = "{zeroed}"
[sensor]
noise_n = 0.02
encoders = true
encoder_noise_rad = 2e-5
"""
POSES = ((0.74, 1.0), (0.2, 1.6), (1.1, 2.2), (0.5, 0.6), (-0.3, 1.9), (0.9, 1.4))
TRUTH = {"gravity.femur_n": 6.0, "gravity.tibia_n": 4.0}  # a link that hangs is deflected before any run


@pytest.mark.parametrize("zeroed", ["per_run", "never"])
def test_what_is_left_of_counted_encoders_is_white(tmp_path: Path, zeroed: str) -> None:
    limb, rig = tmp_path / "limb.toml", tmp_path / "rig.toml"
    limb.write_text(LIMB)
    rig.write_text(
        RIG.format(zeroed=zeroed)
        + "".join(f"[[configuration]]\ntheta1_rad = {a}\ntheta2_rad = {b}\n" for a, b in POSES)
    )
    true = load_limb(limb).with_values(TRUTH)
    meta, columns = simulate(true, load_rig(rig))
    starts = run_starts(columns["run"])
    if zeroed == "per_run":
        for name in ENCODERS:
            columns[name] = columns[name] - np.repeat(columns[name][starts[:-1]], np.diff(starts))
    (tmp_path / "record").mkdir()
    write_dataset(tmp_path / "record", meta, columns)
    record = load_record(load_dataset(tmp_path / "record"))
    left = record.residuals(model_numbers(true)[None])[0].reshape(len(record.channels), -1)
    for name in ENCODERS:
        own = left[record.channels.index(name)]
        inner = np.ones(len(own), bool)
        inner[starts[:-1]] = zeroed == "never"  # a first reading that was taken off is nothing
        own = own * record.sigma[record.channels.index(name)] / ENCODER_NOISE_RAD
        readings = np.add.reduceat(inner.astype(float), starts[:-1])
        runs = np.add.reduceat(own * inner, starts[:-1]) / np.sqrt(readings)
        # the mean of n squares of normal numbers is within 5 sqrt(2/n) of 1, for sums over runs as for readings
        for values in (own[inner], runs):
            assert abs(np.mean(values**2) - 1.0) < 5.0 * np.sqrt(2.0 / values.size), (name, values.size)
