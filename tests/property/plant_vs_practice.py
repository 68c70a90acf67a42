"""The plant against loading records made by another simulator, with its true parameters.

usage: plant_vs_practice.py [FOLDER]     FOLDER (or $BRACE_PRACTICE): p001/, p002/, ... each with data.csv,
truth.json and, mostly, holdout/data.csv. Exits 77 (skipped) without it.

Held-out records carry no noise but angles printed to 1e-6 rad and forces to 1e-6 N, so they must agree to
what that rounding does: about 4e-4 N on the stiffest limb here. Records with noise must leave only noise: the
residual's mean over each of its runs, and its lag-one correlation, are those of white noise.
"""
from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

HELD_OUT_N = 1e-3
# Effects of the other simulator that no key of limb.toml describes.
OUTSIDE = {"encoder_ripple", "asymmetric_joint", "slip", "leadscrew"}
# Its parameter names against the keys of limb.toml; gain and lengths are differences there.
KEYS = {
    "backlash": {"gap1": "joint.femur.gap_rad", "gap2": "joint.tibia.gap_rad"},
    "coulomb_friction": {"tau1": "joint.femur.coulomb_n_mm", "tau2": "joint.tibia.coulomb_n_mm"},
    "joint_hardening": {"c1": "joint.femur.hardening_n_mm_per_rad3",
                        "c2": "joint.tibia.hardening_n_mm_per_rad3"},
    "joint_zero_offset": {"d1": "joint.femur.zero_offset_rad", "d2": "joint.tibia.zero_offset_rad"},
    "creep": {"ratio": "creep.ratio", "T_s": "creep.time_constant_s"},
    "thermal_softening": {"per_degC": "thermal.joint_compliance_per_degc"},
    "gravity": {"femur_N": "gravity.femur_n", "tibia_N": "gravity.tibia_n", "knee_N": "gravity.knee_n"},
    "sensor_bias": {"fx_N": "sensor.bias_x_n", "fz_N": "sensor.bias_z_n"},
    "sensor_drift": {"fx_N_per_s": "sensor.drift_x_n_per_s", "fz_N_per_s": "sensor.drift_z_n_per_s"},
    "sensor_rotation": {"angle_rad": "sensor.rotation_rad"},
    "sensor_crosstalk": {"xz": "sensor.crosstalk_xz", "zx": "sensor.crosstalk_zx"},
    "sensor_saturation": {"limit_N": "sensor.saturation_n"},
    "tip_play": {"play_mm": "contact.play_mm"},
    "link_damage": {"t_s": "change.at_s", "factor": "change.bending_factor"},
}


def model_of(truth: dict[str, Any]) -> Any:
    """The limb that a truth.json describes."""
    from host_library import Model

    limb, applied = truth["true_limb"], truth["applied"]
    model = Model()
    added = applied.get("link_length_error", {})
    model["geometry.femur_mm"] = limb["L1"] + added.get("dL1", 0.0)
    model["geometry.tibia_mm"] = limb["L2"] + added.get("dL2", 0.0)
    for link, ellipsoid, coupled in (("femur", "ell1", 0), ("tibia", "ell2", 1)):
        for key, value in zip(("axial_mm_per_n", "bending_mm_per_n", "tilt_rad"), limb[ellipsoid]):
            model[f"link.{link}.{key}"] = value
        model[f"link.{link}.moment_transfer"] = float(limb.get("mc", [False, False])[coupled])
    for joint, compliance in zip(("femur", "tibia"), limb["joints"]):
        model[f"joint.{joint}.compliance_rad_per_n_mm"] = compliance
    for key, value in zip(("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm"), limb.get("base", [0, 0, 0])):
        model[f"base.{key}"] = value
    model["sensor.gain"] = 1.0 + applied.get("sensor_gain", {}).get("rel", 0.0)
    for effect, parameters in KEYS.items():
        for name, key in parameters.items():
            if name in applied.get(effect, {}):
                model[key] = applied[effect][name]
    if "link_damage" in applied:  # there the link is that of before, and the factor acts from then on
        factor = applied["link_damage"]["factor"]
        model["link.tibia.bending_mm_per_n"] *= factor
        model["change.bending_factor"] = 1.0 / factor
    return model


def residual(folder: Path, model: Any) -> tuple[Any, dict[str, Any]]:
    """The record's columns, and measured less played for each column that is both [N, rad]."""
    from host_library import play

    data: Any = np.genfromtxt(folder / "data.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    played = play(model, data["theta1_rad"], data["theta2_rad"], data["dx_mm"], data["dz_mm"],
                  t_s=data["t_s"], temp_degc=data["temp_degc"], run=data["run"])
    left = {name: data[name] - played[name] for name in ("fx_n", "fz_n", "enc1_rad", "enc2_rad")
            if name in data.dtype.names}
    return data, left


def rms(values: Any) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def main(folder: str) -> int:
    """Play every case; 0 if all agree."""
    failed = 0
    print(f"{'case':5} {'effects':44} {'held-out rms':>12} {'max [N]':>9} {'enc rms':>9} "
          f"{'noise [N]':>9} {'runs chi2':>9} {'lag one':>8}  ms")
    for case in sorted(Path(folder).glob("p[0-9]*")):
        truth = json.loads((case / "truth.json").read_text())
        if truth["kind"] == "data_fault":
            continue
        names = [effect["name"] for effect in truth["effects"]]
        model = model_of(truth)
        _, exact = residual(case / "holdout", model)
        begun = time.perf_counter()
        data, noisy = residual(case, model)
        spent_ms = 1e3 * (time.perf_counter() - begun)
        force = np.stack([exact["fx_n"], exact["fz_n"]], axis=1)
        noise = np.stack([noisy["fx_n"], noisy["fz_n"]], axis=1)
        sigma = rms(noise)
        runs = [noise[data["run"] == run] for run in np.unique(data["run"])]
        # Mean of a run of n readings: chi-squared of one degree each, per degree of freedom.
        chi2 = float(np.mean([len(run) * np.square(run.mean(axis=0)) / sigma**2 for run in runs]))
        lag = float(np.mean([np.mean(run[1:] * run[:-1]) for run in runs])) / sigma**2
        encoder = rms(exact["enc1_rad"]) + rms(exact["enc2_rad"]) if "enc1_rad" in exact else float("nan")
        degrees = 2 * len(runs)
        good = np.abs(force).max() < HELD_OUT_N and not encoder > 1e-6
        good = good and abs(chi2 - 1.0) < 4.0 * np.sqrt(2.0 / \
                            degrees) and abs(lag) < 4.0 / np.sqrt(noise.size)
        expected = not set(names) & OUTSIDE
        verdict = "" if good == expected else "  <- disagrees"
        failed += good != expected
        print(f"{case.name:5} {'+'.join(names) or 'none':44} {rms(force):12.2e} {np.abs(force).max():9.1e} "
              f"{encoder:9.1e} {sigma:9.4f} {chi2:9.2f} {lag:8.3f}  {spent_ms:.1f}{verdict}")
    print(f"{failed} cases disagree")
    return 1 if failed else 0


if __name__ == "__main__":
    given = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("BRACE_PRACTICE", "")
    if not given or not Path(given).is_dir():
        print("skipped: no folder of practice records (argument, or BRACE_PRACTICE)")
        sys.exit(77)
    sys.exit(main(given))
