"""The simulated limb, compiled from simulator.c: parameters named as in limb.toml, rows in, readings out."""

from __future__ import annotations

import ctypes
import hashlib
import math
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

HERE = Path(__file__).resolve().parent
BUILD = HERE.parents[2] / "build" / "blind"

# In the order of simulator.c's enum.
KEYS = (
    "geometry.femur_mm",
    "geometry.tibia_mm",
    "link.femur.axial_mm_per_n",
    "link.femur.bending_mm_per_n",
    "link.femur.tilt_rad",
    "link.femur.moment_transfer",
    "link.tibia.axial_mm_per_n",
    "link.tibia.bending_mm_per_n",
    "link.tibia.tilt_rad",
    "joint.femur.compliance_rad_per_n_mm",
    "joint.tibia.compliance_rad_per_n_mm",
    "joint.femur.gap_rad",
    "joint.tibia.gap_rad",
    "joint.femur.coulomb_n_mm",
    "joint.tibia.coulomb_n_mm",
    "joint.femur.hardening_n_mm_per_rad3",
    "joint.tibia.hardening_n_mm_per_rad3",
    "joint.femur.zero_offset_rad",
    "joint.tibia.zero_offset_rad",
    "base.x_mm_per_n",
    "base.z_mm_per_n",
    "base.rotation_rad_per_n_mm",
    "gravity.femur_n",
    "gravity.tibia_n",
    "gravity.knee_n",
    "sensor.bias_x_n",
    "sensor.bias_z_n",
    "sensor.gain",
    "sensor.rotation_rad",
    "sensor.crosstalk_xz",
    "sensor.crosstalk_zx",
    "sensor.drift_x_n_per_s",
    "sensor.drift_z_n_per_s",
    "sensor.saturation_n",
    "creep.ratio",
    "creep.time_constant_s",
    "thermal.joint_compliance_per_degc",
    "thermal.reference_degc",
    "contact.play_mm",
    "change.at_s",
    "change.link",
    "change.bending_factor",
    # no key of limb.toml: see simulator.c
    "outside.asymmetry",
    "outside.gap_offset",
    "outside.gap_growth_rad_per_s",
    "outside.cogging_n_mm",
    "outside.cogging_period_rad",
    # from here on what simulator.c does not know: a tibia that is a beam is none without load
    "link.tibia.moment_transfer",
    "outside.femur_stop_n_mm_per_rad",
    "outside.femur_stop_rad",
    "outside.tibia_stop_n_mm_per_rad",
    "outside.tibia_stop_rad",
    "outside.femur_bow_mm",
    "outside.tibia_bow_mm",
    "outside.knee_offset_mm",
    "outside.tibia_cable_at",
    "outside.cable_from_x_mm",
    "outside.cable_from_z_mm",
    "outside.cable_mm",
    "outside.cable_n_per_mm",
    "outside.rig_turn_rad",
    "outside.rig_mm_per_n",
    "outside.friction_carried",
    "outside.held_at_rest",
)
INDEX = {key: i for i, key in enumerate(KEYS)}
IN_LIMB_TOML = tuple(key for key in KEYS if not key.startswith("outside."))
LINKS = ("femur", "tibia")
ROW = ("run", "theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm")
READINGS = ("fx_n", "fz_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")

_NEUTRAL = {
    "sensor.gain": 1.0,
    "sensor.saturation_n": math.inf,
    "creep.time_constant_s": 1.0,
    "thermal.reference_degc": 22.0,
    "change.at_s": math.inf,
    "change.link": 1.0,
    "change.bending_factor": 1.0,
    "outside.cogging_period_rad": 1.0,
}
NEUTRAL = np.array([_NEUTRAL.get(key, 0.0) for key in KEYS])


def compiled(source: Path) -> ctypes.CDLL:
    """A C file of the tests as a library, kept by its hash."""
    tag = hashlib.sha256(source.read_bytes()).hexdigest()[:12]
    library = BUILD / f"{source.stem}-{tag}.so"
    if not library.exists():
        BUILD.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=BUILD) as folder:
            fresh = Path(folder) / "fresh.so"
            flags = ("-std=c11", "-D_GNU_SOURCE", "-O2", "-ffp-contract=off", "-shared", "-fPIC")
            command = [os.environ.get("CC", "cc"), *flags, "-o", str(fresh), str(source), "-lm"]
            subprocess.run(command, check=True, timeout=120)
            os.replace(fresh, library)
    return ctypes.CDLL(str(library))


def _simulator() -> ctypes.CDLL:
    loaded = compiled(HERE / "simulator.c")
    doubles = ctypes.POINTER(ctypes.c_double)
    loaded.blind_play.argtypes = [doubles, doubles, ctypes.c_int, doubles]
    loaded.blind_play.restype = None
    return loaded


_LIBRARY: list[ctypes.CDLL] = []


def play(parameters: Array, rows: Array) -> Array:
    """Readings (columns of READINGS) of a limb for rows (columns of ROW), before noise and rounding."""
    if not _LIBRARY:
        _LIBRARY.append(_simulator())
    given = np.ascontiguousarray(parameters, dtype=np.float64)
    loads = np.ascontiguousarray(rows, dtype=np.float64)
    if given.shape != (len(KEYS),) or loads.ndim != 2 or loads.shape[1] != len(ROW):
        raise ValueError(f"parameters {given.shape}, rows {loads.shape}")
    out = np.empty((len(loads), len(READINGS)))
    doubles = ctypes.POINTER(ctypes.c_double)
    _LIBRARY[0].blind_play(
        given.ctypes.data_as(doubles), loads.ctypes.data_as(doubles), len(loads), out.ctypes.data_as(doubles)
    )
    return out
