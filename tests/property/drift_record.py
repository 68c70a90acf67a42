"""Loading records on the simulated limb, and the drift check fed with them; shared by the drift sweeps.

The simulated limb (host_sim, double precision) shares no code with the firmware. It differs from what the controller
believes by what a calibration is trusted to, drawn once per limb: compliances 5 %, lengths 0.5 mm, angles 3 mrad,
sensor gain 0.5 %, thermal rate 20 %. Readings: noise of 0.1 N one sigma, rounded to 1/16 N, as in the practice records.
"""
from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import limbs
from core_library import core_library
from host_library import play

NOISE_N, RESOLUTION_N, STEP_MM = 0.1, 0.0625, 0.635
RUN_STEPS = np.array([0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0])
PRACTICE = np.array([[0.743513, 0.998762], [1.51, 2.23], [1.13, 1.32], [0.28, 0.51], [1.5, 1.55], [0.96, 2.04],
                     [2.15, 2.69], [1.1, 1.81], [1.57, 2.45]])
"""Postures of the practice records' design [theta1, theta2, rad]."""
THERMAL_PER_DEGC = 0.02
CAUSES = ("femur", "tibia or knee", "femur joint or base", "unexplained")
LEARNING, WATCHING, DRIFTED = 0, 1, 2


class Setup(ctypes.Structure):
    _fields_ = [(name, ctypes.c_float) for name in ("noise_n", "model_error_ratio", "joint_compliance_per_degc",
                                                    "joint_compliance_trust_ratio")]


class Drift(ctypes.Structure):
    _fields_ = [("setup", Setup), ("offset", ctypes.c_float * 7), ("covariance", ctypes.c_float * 28),
                ("held", ctypes.c_float * 3), ("held_sigma", ctypes.c_float * 3), ("left", ctypes.c_float * 21),
                ("evidence", ctypes.c_float * 4), ("score", ctypes.c_float * 3), ("information", ctypes.c_float * 3),
                ("run_mean", ctypes.c_float * 4), ("run_theta_rad", ctypes.c_float * 2), ("steps", ctypes.c_uint32),
                ("since", ctypes.c_uint16 * 4), ("run_count", ctypes.c_uint8), ("state", ctypes.c_uint8),
                ("cause", ctypes.c_uint8), ("outliers", ctypes.c_uint8)]


class Report(ctypes.Structure):
    _fields_ = [("state", ctypes.c_int), ("cause", ctypes.c_int), ("could_be", ctypes.c_uint32),
                ("evidence", ctypes.c_float), ("loss_ratio", ctypes.c_float), ("loss_sigma_ratio", ctypes.c_float),
                ("since_steps", ctypes.c_uint32), ("learned_sigma_ratio", ctypes.c_float * 2),
                ("baseline_sigmas", ctypes.c_float), ("steps", ctypes.c_uint32)]


class Outlook(ctypes.Structure):
    _fields_ = [("sigma_of_loss_ratio", ctypes.c_float * 3), ("steps_needed", ctypes.c_uint32 * 3)]


_library: ctypes.CDLL | None = None


def library() -> ctypes.CDLL:
    """The core with the driver, compiled once a process."""
    global _library
    if _library is None:
        _library = core_library()
        _library.drift_watch.restype = ctypes.c_long
    return _library


def limb_floats(keys: dict[str, float]) -> np.ndarray:
    """brace_limb_t of a model, with the trust every calibration has here."""
    def links(name: str) -> list[float]:
        at = f"link.{name}."
        return [keys.get(at + key, 0.0) for key in ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad",
                                                    "lateral_mm_per_n", "torsion_rad_per_n_mm", "moment_transfer")]
    values = [keys.get("geometry.coxa_mm", 57.0), keys.get("geometry.femur_mm", 185.0),
              keys.get("geometry.tibia_mm", 313.5)]
    for name in ("coxa", "femur", "tibia"):
        values += links(name)
    for name in ("coxa", "femur", "tibia"):
        values += [keys.get(f"joint.{name}.compliance_rad_per_n_mm", 0.0), 0.0, 0.0]
    values += [keys.get(f"base.{key}", 0.0) for key in ("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm")]
    return np.array([*values, 0.5, 0.003, 0.05, 0.005], dtype=np.float32)


def true_limb(believed: dict[str, float], rng: np.random.Generator, per_degc: float,
              sigmas: float = 1.0) -> dict[str, float]:
    """What the calibration of `believed` may have missed; `sigmas` times what it is trusted to."""
    keys = dict(believed)
    for key, value in believed.items():
        if "mm_per_n" in key or "rad_per_n_mm" in key:
            keys[key] = value * (1 + sigmas * 0.05 * rng.standard_normal())
    for key, usual in (("geometry.femur_mm", 185.0), ("geometry.tibia_mm", 313.5)):
        keys[key] = believed.get(key, usual) + sigmas * 0.5 * rng.standard_normal()
    for joint in ("femur", "tibia"):
        keys[f"joint.{joint}.zero_offset_rad"] = sigmas * 0.003 * rng.standard_normal()
    keys["sensor.gain"] = 1 + sigmas * 0.005 * rng.standard_normal()
    keys["sensor.bias_x_n"], keys["sensor.bias_z_n"] = rng.uniform(-5, 5, 2)
    keys["thermal.joint_compliance_per_degc"] = per_degc * (1 + sigmas * 0.2 * rng.standard_normal())
    return keys


@dataclass
class Record:
    """Inputs of a loading record, one entry a row."""
    run: np.ndarray
    theta: np.ndarray
    d_mm: np.ndarray
    temp_degc: np.ndarray

    def __len__(self) -> int:
        return len(self.run)

    def part(self, which: slice) -> Record:
        return Record(self.run[which], self.theta[which], self.d_mm[which], self.temp_degc[which])


def runs(theta: np.ndarray, direction: np.ndarray, rng: np.random.Generator, swing_degc: float = 10.0,
         period: float = 20_000.0) -> Record:
    """One run a row of theta, along the unit vector of `direction`: 0 -> +4 -> 0 -> -4 -> 0 steps, every reading kept.
    Temperature: a swing about the reference with a period of 20,000 readings and a random phase, and a slow jitter."""
    count = len(theta) * len(RUN_STEPS)
    d = (STEP_MM * RUN_STEPS)[None, :, None] * direction[:, None, :]
    phase = rng.uniform(0, 2 * np.pi) + np.arange(count) * 2 * np.pi / period
    return Record(np.repeat(np.arange(len(theta), dtype=np.int32), len(RUN_STEPS)),
                  np.repeat(theta, len(RUN_STEPS), axis=0),
                  d.reshape(-1, 2), 22.0 + swing_degc * np.sin(phase))


def mixed(postures: np.ndarray, count: int, rng: np.random.Generator, **how: Any) -> Record:
    """`count` runs in random order of posture and axis."""
    theta = postures[rng.integers(len(postures), size=count)]
    return runs(theta, np.eye(2)[rng.integers(2, size=count)], rng, **how)


def commissioning(postures: np.ndarray, rng: np.random.Generator, repeats: int = 14, period: float = 8568.0,
                  **how: Any) -> Record:
    """Every posture along both axes, as at commissioning; by default the temperature goes through half its swing."""
    theta = np.tile(np.repeat(postures, 2, axis=0), (repeats, 1))
    return runs(theta, np.tile(np.eye(2), (repeats * len(postures), 1)), rng, period=period, **how)


def split_at_reversals(record: Record) -> Record:
    """The same readings, a run for each stretch of motion in one direction: dry friction is constant in it."""
    way = np.sign(np.diff(record.d_mm.sum(axis=1), prepend=0.0))
    starts = np.diff(record.run, prepend=-1) != 0
    begins = starts | (np.diff(way, prepend=0.0) != 0)
    return replace(record, run=np.cumsum(begins).astype(np.int32))


def random_believed(rng: np.random.Generator) -> dict[str, float]:
    """A limb about as slender as those of the practice records: lengths by a third, compliances by a factor of two."""
    def about(value: float, factor: float = 2.0) -> float:
        return value * float(factor ** rng.uniform(-1, 1))
    keys = {"geometry.femur_mm": about(190.0, 1.35), "geometry.tibia_mm": about(260.0, 1.35)}
    for link, bending in (("femur", 0.06), ("tibia", 0.16)):
        keys |= {f"link.{link}.axial_mm_per_n": about(0.001), f"link.{link}.bending_mm_per_n": about(bending)}
    keys["link.femur.moment_transfer"] = rng.choice([0.0, 1.0])
    return keys | {f"joint.{joint}.compliance_rad_per_n_mm": about(1.3e-5) for joint in ("femur", "tibia")}


def random_postures(rng: np.random.Generator, count: int = 9) -> np.ndarray:
    return np.stack([rng.uniform(-0.5, 2.2, count), rng.uniform(0.4, 2.6, count)], 1)


def measured(keys: dict[str, float], record: Record, rng: np.random.Generator, noise_n: float = NOISE_N) -> np.ndarray:
    """What the sensor reads of this limb, shape (n, 2) [N]."""
    reading = play(limbs.limb(keys), record.theta[:, 0], record.theta[:, 1], record.d_mm[:, 0], record.d_mm[:, 1],
                   temp_degc=record.temp_degc, run=record.run)
    force = np.stack([reading["fx_n"], reading["fz_n"]], 1) + noise_n * rng.standard_normal((len(record), 2))
    return np.rint(force / RESOLUTION_N) * RESOLUTION_N


@dataclass
class Check:
    """A drift check of one believed limb."""
    believed: dict[str, float]
    per_degc: float = THERMAL_PER_DEGC
    noise_n: float = float(np.hypot(NOISE_N, RESOLUTION_N / np.sqrt(12)))
    model_error: float = 0.0005

    def __post_init__(self) -> None:
        self.state = Drift()
        self.limb = limb_floats(self.believed)
        self.learn()

    def learn(self) -> None:
        setup = Setup(self.noise_n, self.model_error, self.per_degc, 0.2)
        status = library().brace_drift_learn(ctypes.byref(self.state), self.limb.ctypes.data_as(ctypes.c_void_p),
                                             ctypes.byref(setup))
        assert status == 0, status

    def copy(self) -> Check:
        other = replace(self)
        other.state = Drift.from_buffer_copy(self.state)
        return other

    def watch(self, record: Record, force: np.ndarray, stop: bool = True, reports: bool = False) -> tuple[int, Any]:
        """Feeds a record; readings taken in, and every reading's report if asked for."""
        rows = np.ascontiguousarray(np.column_stack([record.theta, record.d_mm, force, record.temp_degc - 22.0]),
                                    dtype=np.float32)
        run = np.ascontiguousarray(record.run, dtype=np.int32)
        out = (Report * len(record))() if reports else None
        taken = library().drift_watch(ctypes.byref(self.state), self.limb.ctypes.data_as(ctypes.c_void_p),
                                      ctypes.c_size_t(len(rows)), rows.ctypes.data_as(ctypes.c_void_p),
                                      run.ctypes.data_as(ctypes.c_void_p), int(stop), out)
        assert taken >= 0, f"status {taken}"
        return taken, out

    def outlook(self, theta: np.ndarray, direction: np.ndarray, warmer_degc: float = 0.0) -> Outlook:
        """For readings of a run like those of `runs`."""
        size = STEP_MM * float(np.sqrt(np.mean(RUN_STEPS[1:] ** 2.0)))
        reading = np.array([*theta, *(size * direction), 0, 0, warmer_degc], dtype=np.float32)
        out = Outlook()
        status = library().drift_outlook_at(ctypes.byref(self.state), self.limb.ctypes.data_as(ctypes.c_void_p),
                                            reading.ctypes.data_as(ctypes.c_void_p), ctypes.byref(out))
        assert status == 0, status
        return out

    def report(self) -> Report:
        out = Report()
        assert library().brace_drift_report(ctypes.byref(self.state), self.limb.ctypes.data_as(ctypes.c_void_p),
                                            ctypes.byref(out)) == 0
        return out


def with_loss(keys: dict[str, float], link: str, loss: float, axial_too: bool = False) -> dict[str, float]:
    """The limb with this share of a link's stiffness lost."""
    out = dict(keys)
    for which in ("bending", "axial")[:2 if axial_too else 1]:
        out[f"link.{link}.{which}_mm_per_n"] /= 1 - loss
    return out
