"""The simulator against loading records made by another one, noise-free, with their true parameters.

usage: against_practice.py FOLDER [N]     FOLDER: p001/, ... each with truth.json and holdout/data.csv
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from plant import INDEX, NEUTRAL, READINGS, ROW, Array, play

# Its parameters' names against limb.toml's keys.
NAMES = {
    "backlash": {"gap1": "joint.femur.gap_rad", "gap2": "joint.tibia.gap_rad"},
    "coulomb_friction": {"tau1": "joint.femur.coulomb_n_mm", "tau2": "joint.tibia.coulomb_n_mm"},
    "joint_hardening": {
        "c1": "joint.femur.hardening_n_mm_per_rad3",
        "c2": "joint.tibia.hardening_n_mm_per_rad3",
    },
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
    "asymmetric_joint": {"rel": "outside.asymmetry"},
}


def limb_of(truth: dict[str, Any]) -> Array:
    """The simulator's parameters for a truth.json."""
    limb, applied = truth["true_limb"], truth["applied"]
    p = NEUTRAL.copy()
    added = applied.get("link_length_error", {})
    p[INDEX["geometry.femur_mm"]] = limb["L1"] + added.get("dL1", 0.0)
    p[INDEX["geometry.tibia_mm"]] = limb["L2"] + added.get("dL2", 0.0)
    for link, name in (("femur", "ell1"), ("tibia", "ell2")):
        for key, value in zip(("axial_mm_per_n", "bending_mm_per_n", "tilt_rad"), limb[name], strict=True):
            p[INDEX[f"link.{link}.{key}"]] = value
    p[INDEX["link.femur.moment_transfer"]] = float(limb.get("mc", [False])[0])
    for joint, compliance in zip(("femur", "tibia"), limb["joints"], strict=True):
        p[INDEX[f"joint.{joint}.compliance_rad_per_n_mm"]] = compliance
    for key, value in zip(
        ("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm"), limb.get("base", [0] * 3), strict=True
    ):
        p[INDEX[f"base.{key}"]] = value
    p[INDEX["sensor.gain"]] = 1.0 + applied.get("sensor_gain", {}).get("rel", 0.0)
    for effect, names in NAMES.items():
        for name, key in names.items():
            if name in applied.get(effect, {}):
                p[INDEX[key]] = applied[effect][name]
    return p


def differences(case: Path) -> dict[str, float]:
    """Largest difference of each reading of a case's noise-free records."""
    truth = json.loads((case / "truth.json").read_text())
    data: Any = np.genfromtxt(case / "holdout" / "data.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    rows = np.column_stack([np.asarray(data[name], dtype=float) for name in ROW])
    out = play(limb_of(truth), rows)
    return {
        name: float(np.max(np.abs(out[:, i] - data[name])))
        for i, name in enumerate(READINGS)
        if name in data.dtype.names
    }


def main(folder: str) -> int:
    for case in sorted(Path(folder).glob("p[0-9]*")):
        if not (case / "holdout").is_dir():
            continue
        truth = json.loads((case / "truth.json").read_text())
        names = "+".join(f"{e['name']}@{e['where']}" for e in truth["effects"]) or truth["kind"]
        print(f"{case.name} {names:60}", *(f"{k} {v:.1e}" for k, v in differences(case).items()))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
