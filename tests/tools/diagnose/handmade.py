"""A record whose hidden effect we put there ourselves, and a diagnosis written by hand: what report and files
are tested with. No diagnosing is done here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from brace.dataset import DataFault, Dataset, load_dataset
from brace.dataset.write import write_dataset
from brace.diagnose.diagnosis import (
    Candidate,
    Diagnosis,
    Gap,
    GapPair,
    GapStep,
    Interval,
    Localised,
    NamedEffect,
    NextExperiment,
    Residuals,
    Unexplained,
)
from brace.model import LimbModel, load_limb
from brace.native.plant import LoadingPlayer
from brace.rig.rig import load_rig
from brace.rig.simulate import simulate

GAP_RAD = 0.0061
GAP_KEY = "joint.tibia.gap_rad"
RIG = """format = 1
title = '{title}'
seed = 3
[rig]
steps = 4
repeats = {repeats}
[sensor]
noise_n = 0.1
resolution_n = 0.0625
"""
POSES = ((0.74, 1.0), (0.2, 1.6), (1.1, 2.2), (0.5, 0.6), (-0.3, 1.9), (0.9, 1.4))
HELD_OUT = (3, 5)


def loading_record(folder: Path, limb: Path, title: str = "hidden backlash", **truth: Any) -> Path:
    """A loading test on the limb with `truth` (dotted keys with _ for nothing: a mapping in `values`; `rig` and
    `sensor` are further lines of these tables of the rig's file; `repeats` of each run)."""
    folder.mkdir(parents=True, exist_ok=True)
    rig = folder.parent / f"{folder.name}-rig.toml"
    poses = "".join(f"[[configuration]]\ntheta1_rad = {a}\ntheta2_rad = {b}\n" for a, b in POSES)
    text = RIG.format(title=title, repeats=truth.get("repeats", 2)).replace("[rig]\n", "[rig]\n" + truth.get("rig", ""))
    rig.write_text(text + truth.get("sensor", "") + poses)
    values = truth.get("values", {GAP_KEY: GAP_RAD})
    meta, columns = simulate(load_limb(limb).with_values(values), load_rig(rig))
    write_dataset(folder, meta, columns)
    return folder


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def by_hand(folder: Path, limb: Path, **changes: Any) -> tuple[Dataset, LimbModel, Diagnosis]:
    """The diagnosis that a perfect tool would make of `loading_record`."""
    dataset, believed = load_dataset(folder), load_limb(limb)
    model = believed.with_values({GAP_KEY: GAP_RAD + 1e-13, "geometry.femur_mm": 185.0123456789})
    player = LoadingPlayer(dataset.columns)
    measured = np.column_stack([dataset["fx_n"], dataset["fz_n"]])
    before, after = (
        measured - np.column_stack([played["fx_n"], played["fz_n"]])
        for played in (player.play(believed), player.play(model))
    )
    held_out = np.isin(dataset["config"], HELD_OUT)
    pairs = [GapPair(_rms(part[~held_out]), _rms(part[held_out])) for part in (before, after)]
    values: dict[str, Any] = {
        "verdict": "effect",
        "sentence": "The knee has play of 0.0061 rad (21 arcmin): the tip moves before it meets force.",
        "model": model,
        "gap": Gap("n", 0.1, pairs[0], pairs[1], (GapStep("backlash@joint.tibia", pairs[1]),)),
        "effects": (
            NamedEffect("backlash", "joint.tibia", 0.97, {GAP_KEY: Interval(GAP_RAD, 0.0057, 0.0065)}, 0.93),
        ),
        "could_be": ("backlash@joint.tibia",),
        "localised": (
            Localised("only near zero force", 0.0001, 0.42),
            Localised("only when unloading, and only near zero force", 0.002, 0.21),
        ),
        "unexplained": Unexplained(pairs[1].fitted, False, "No contrast stands out any more."),
        "next_experiment": NextExperiment(
            "Repeat configuration 2 with a preload of 3 mm along z.",
            ("backlash@joint.tibia", "contact_play@contact"),
            0.98,
            6.0,
            RIG.format(title="preloaded", repeats=2) + "[[configuration]]\ntheta1_rad = 0.2\ntheta2_rad = 1.6\n",
        ),
        "candidates": (
            Candidate("backlash@joint.tibia", 412.0, 0.97),
            Candidate("contact_play@contact", 390.0, 0.02),
            Candidate("joint_hardening@joint.tibia", 120.0, 1e-9),
        ),
        "residuals": Residuals(("fx_n", "fz_n"), before, after, held_out),
        "seed": 0,
    }
    values |= changes
    return dataset, believed, Diagnosis(**values)


FAULT = DataFault(12, "fx_n", "three times its neighbours <b>", 4.2)
