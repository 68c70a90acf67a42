"""The engine's loading tests against records that somebody else made with the same engine, of known limbs.

usage: against_records.py FOLDER...     each with data.csv and truth.json: `true` has the limb, `spec` what was done

Their links are ten equal segments. The sensor's gain within its trust is not given: it is fitted. What is left must be
the record's own noise, as repeats of the same run show it."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "blind"))

from engine_chain import Array  # noqa: E402
from engine_limb import equal_segments  # noqa: E402
from engine_plant import play  # noqa: E402
from plant import INDEX, NEUTRAL, ROW  # noqa: E402

SEGMENTS = 10
GRAVITY_M_PER_S2 = 9.81
LINK = {"b": "link.{}.bending_mm_per_n", "ax": "link.{}.axial_mm_per_n", "L": "geometry.{}_mm"}
JOINT = {"c": "compliance_rad_per_n_mm", "off": "zero_offset_rad", "gap": "gap_rad", "fric": "coulomb_n_mm",
         "hard": "hardening_n_mm_per_rad3"}  # fmt: skip
PLAIN = {"base_x": "base.x_mm_per_n", "base_z": "base.z_mm_per_n", "base_rot": "base.rotation_rad_per_n_mm",
         "rig_k": "outside.rig_mm_per_n", "knee_off": "outside.knee_offset_mm"}  # fmt: skip
SENSOR = {"rot": "rotation_rad", "gain": "gain", "bx": "bias_x_n", "bz": "bias_z_n", "dx": "drift_x_n_per_s",
          "dz": "drift_z_n_per_s"}  # fmt: skip
NOT_THE_SAME = ("asym1", "asym2", "cog2", "stop2", "tendon", "taper1", "taper2", "maxwell2", "curve2", "lumped_femur")


def limb_of(truth: dict[str, Any]) -> Array | None:
    """The engine's parameters of a truth.json; None where it has what is built otherwise here."""
    true, spec, p = truth["true"], truth["spec"], NEUTRAL.copy()
    if any(true[name] for name in NOT_THE_SAME):
        return None
    for number, link in enumerate(("femur", "tibia"), start=1):
        p[INDEX[f"link.{link}.moment_transfer"]] = 1.0
        for name, key in LINK.items():
            p[INDEX[key.format(link)]] = true[f"{name}{number}"]
        for name, key in JOINT.items():
            p[INDEX[f"joint.{link}.{key}"]] = true[f"{name}{number}"]
    for name, key in PLAIN.items():
        p[INDEX[key]] = true[name]
    for name, value in spec.get("sensor", {}).items():
        p[INDEX[f"sensor.{SENSOR[name]}"]] = value
    if true["gravity"]:
        for part, name in (("femur", "m1"), ("tibia", "m2"), ("knee", "mk")):
            p[INDEX[f"gravity.{part}_n"]] = GRAVITY_M_PER_S2 * true[name]
    if "change" in spec:
        p[INDEX["change.at_s"]], p[INDEX["change.link"]] = spec["change"]["at"], 1.0
        p[INDEX["change.bending_factor"]] = spec["change"]["set"]["b2"]
    p[INDEX["outside.rig_turn_rad"]] = spec.get("rig", {}).get("turn", 0.0)
    p[INDEX["outside.friction_carried"]] = float("carry" in spec)
    return p


def compared(folder: Path) -> tuple[float, float, float] | None:
    """What is left [N, rms], noise by the repeats [N], and the gain fitted."""
    p = limb_of(json.loads((folder / "truth.json").read_text()))
    if p is None:
        return None
    with (folder / "data.csv").open(newline="") as file:
        record = list(csv.DictReader(file))
    rows = np.array([[float(row[name]) for name in ROW] for row in record])
    read = np.array([[float(row[name]) for name in ("fx_n", "fz_n")] for row in record])
    forces = play(p, rows, equal_segments(SEGMENTS))[:, :2]
    gain = float(np.sum(read * forces) / np.sum(forces * forces))
    runs: dict[tuple[str, ...], list[int]] = {}
    for number, row in enumerate(record):
        runs.setdefault((row["config"], row["axis"], row["step"]), []).append(number)
    apart = [np.var(read[same] - gain * forces[same], axis=0, ddof=1) for same in runs.values() if len(same) > 1]
    return float(np.sqrt(np.mean((read - gain * forces) ** 2))), float(np.sqrt(np.mean(apart))), gain


def main() -> int:
    for folder in sorted(Path(name) for name in sys.argv[1:]):
        found = compared(folder)
        print(folder.name, "built otherwise here" if found is None else
              "left {:.4f} N, noise {:.4f} N, gain {:.4f}".format(*found))  # fmt: skip
    return 0


if __name__ == "__main__":
    sys.exit(main())
