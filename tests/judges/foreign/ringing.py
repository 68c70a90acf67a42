"""Loading records of limbs whose joints ring and whose friction bends before it slides: one effect hidden, or none and
a zero that wanders. ringing.c plays them; the tool's plant and the other judges' simulators have no part in it."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Rng = np.random.Generator

# In the order of ringing.c's enum. A name with a point is a key of limb.toml.
PLAYED = (
    "geometry.femur_mm", "geometry.tibia_mm",
    "link.femur.axial_mm_per_n", "link.femur.bending_mm_per_n", "link.femur.tilt_rad",
    "link.tibia.axial_mm_per_n", "link.tibia.bending_mm_per_n", "link.tibia.tilt_rad",
    "base.x_mm_per_n", "base.z_mm_per_n",
    "joint.femur.compliance_rad_per_n_mm", "joint.tibia.compliance_rad_per_n_mm",
    "joint.femur.gap_rad", "joint.tibia.gap_rad",
    "joint.femur.hardening_n_mm_per_rad3", "joint.tibia.hardening_n_mm_per_rad3",
    "joint.femur.zero_offset_rad", "joint.tibia.zero_offset_rad",
    "change.at_s", "change.link", "change.factor",
    "thermal.joint_compliance_per_degc", "thermal.reference_degc", "contact.play_mm",
    "inertia.femur", "inertia.tibia", "damping.femur", "damping.tibia",
    "level.femur", "level.tibia", "maxwell", "bristle_rad", "peak", "stribeck_rad_per_s", "move_s", "wait_s",
)  # fmt: skip
SENSED = (
    "sensor.bias_x_n", "sensor.bias_z_n", "sensor.gain", "sensor.rotation_rad", "sensor.crosstalk_xz",
    "sensor.crosstalk_zx", "sensor.drift_x_n_per_s", "sensor.drift_z_n_per_s", "sensor.saturation_n",
)  # fmt: skip
NEUTRAL = dict.fromkeys((*PLAYED, *SENSED), 0.0) | {
    "sensor.gain": 1.0, "sensor.saturation_n": math.inf, "thermal.reference_degc": 22.0, "change.at_s": 1e12,
    "change.factor": 1.0, "bristle_rad": 1e-3, "stribeck_rad_per_s": 0.05,
}  # fmt: skip
ROW = ("run", "theta1_rad", "theta2_rad", "t_s", "temp_degc", "dx_mm", "dz_mm")
STEP_S = 3e-4
ALIKE = 0.95  # cosine from which two effects leave one trace
LAWS = ("lugre", "dahl", "maxwell", "coulomb")


@dataclass(frozen=True)
class Test:
    """A loading test: rows of ROW, what else a row is labelled with, and the sensor."""

    __test__ = False  # none of pytest's

    rows: Array
    config: Array
    axis: Array
    rep: Array
    step: Array
    dwell_s: float
    step_mm: float
    resolution_n: float
    noise_n: float


@dataclass(frozen=True)
class Hidden:
    """An effect: `change` puts so much of it into a limb; the size 1 is a sensible one, `most` the largest."""

    name: str
    where: str
    change: Callable[[dict[str, float], float], None]
    most: float = 30.0
    about: dict[str, Any] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """backlash@joint.femur"""
        return f"{self.name}@{self.where}"

    def applied(self, limb: dict[str, float], size: float) -> dict[str, float]:
        """The limb with it."""
        out = dict(limb)
        self.change(out, size)
        return out


_LOADED: list[Any] = []


def play(limb: dict[str, float], test: Test, *, resting: bool = False) -> Array:
    """Forces, rows x 2 [N], before noise. `resting`: without inertia to speak of, for traces of effects."""
    from plant import compiled  # tests/judges/blind: how C of the tests is compiled
    from pathlib import Path

    if not _LOADED:
        _LOADED.append(compiled(Path(__file__).with_name("ringing.c")))
    p = dict(limb)
    if resting:
        for joint in ("femur", "tibia"):
            p[f"inertia.{joint}"], p[f"damping.{joint}"] = 8.0, 2.0 * math.sqrt(8.0 * 6e5)
        p |= {"move_s": 0.02, "wait_s": 0.12}
    numbers = np.array([p[key] for key in PLAYED])
    rows, out = np.ascontiguousarray(test.rows), np.empty((len(test.rows), 2))
    doubles = ctypes.POINTER(ctypes.c_double)
    _LOADED[0].ringing_play(
        numbers.ctypes.data_as(doubles), rows.ctypes.data_as(doubles), len(rows), ctypes.c_double(STEP_S),
        out.ctypes.data_as(doubles),
    )
    return sensed(p, test, out)


def sensed(p: dict[str, float], test: Test, force: Array) -> Array:
    """What the sensor reads of true forces."""
    turn = p["sensor.rotation_rad"]
    talk = np.array([[1.0, p["sensor.crosstalk_xz"]], [p["sensor.crosstalk_zx"], 1.0]])
    turned = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    zero = np.array([[p["sensor.bias_x_n"], p["sensor.bias_z_n"]]]) + test.rows[:, 3:4] * np.array(
        [[p["sensor.drift_x_n_per_s"], p["sensor.drift_z_n_per_s"]]]
    )
    read = p["sensor.gain"] * (force @ talk.T) @ turned.T + zero
    return np.asarray(np.clip(read, -p["sensor.saturation_n"], p["sensor.saturation_n"]))


# --- limbs and tests ------------------------------------------------------------------------------------------


def _log(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


BELIEVED = PLAYED[:12]


def believed_limb(rng: Rng) -> dict[str, float]:
    """A limb as its calibration has it; joints that ring at 8 to 40 Hz, damped by 3 to 12 %."""
    limb = dict(NEUTRAL)
    joint = _log(rng, 6e-6, 3e-5)
    values = (rng.uniform(120, 250), rng.uniform(140, 340), _log(rng, 5e-4, 3e-3), _log(rng, 0.03, 0.15), 0.0,
              _log(rng, 5e-4, 3e-3), _log(rng, 0.05, 0.3), 0.0, 0.0, 0.0, joint,
              joint * _log(rng, 0.6, 2.0))  # fmt: skip
    limb |= {key: float(f"{value:.4g}") for key, value in zip(BELIEVED, values, strict=True)}
    for link in ("femur", "tibia"):
        limb[f"link.{link}.axial_mm_per_n"] = min(
            limb[f"link.{link}.axial_mm_per_n"], 0.2 * limb[f"link.{link}.bending_mm_per_n"]
        )
    for name in ("femur", "tibia"):
        stiffness = 4.0 / limb[f"joint.{name}.compliance_rad_per_n_mm"]  # the held tip stiffens a joint
        rate = 2.0 * math.pi * rng.uniform(8.0, 40.0)
        limb[f"inertia.{name}"] = stiffness / rate**2
        limb[f"damping.{name}"] = 2.0 * rng.uniform(0.03, 0.12) * math.sqrt(stiffness * limb[f"inertia.{name}"])
    return limb | {"move_s": rng.uniform(0.05, 0.4)}


TRUST_REL = 0.05


def trusted() -> list[tuple[str, str, float]]:
    """Keys that a calibration knows within a sigma: key, how it is off, one sigma."""
    compliances = [key for key in BELIEVED if key.endswith(("_per_n", "_per_n_mm")) and not key.startswith("base")]
    return [
        ("geometry.femur_mm", "add", 0.5), ("geometry.tibia_mm", "add", 0.5),
        ("joint.femur.zero_offset_rad", "add", 0.003), ("joint.tibia.zero_offset_rad", "add", 0.003),
        ("sensor.gain", "times", 0.005), *((key, "times", TRUST_REL) for key in compliances),
    ]  # fmt: skip


def _off(limb: dict[str, float], key: str, how: str, by: float) -> dict[str, float]:
    return limb | {key: limb[key] + by if how == "add" else limb[key] * math.exp(by)}


def true_limb(rng: Rng, believed: dict[str, float]) -> dict[str, float]:
    """Off within the calibration's trust."""
    limb = dict(believed)
    for key, how, sigma in trusted():
        limb = _off(limb, key, how, sigma * float(rng.standard_normal()))
    return limb


def loading_test(rng: Rng) -> Test:
    """Six to ten postures, both axes, two repeats; a rig that steps, waits and reads."""
    count, steps, repeats = int(rng.integers(6, 11)), 4, 2
    poses = np.column_stack([rng.uniform(-0.2, 1.6, count), rng.uniform(0.5, 2.4, count)])
    step_mm, dwell_s = float(rng.uniform(0.4, 0.9)), float(rng.choice([2.0, 4.0, 8.0]))
    there = np.concatenate([np.arange(steps + 1), np.arange(steps - 1, -steps - 1, -1), np.arange(-steps + 1, 1)])
    rows, labels, t, run = [], [], 0.0, 0
    for config, (theta1, theta2) in enumerate(poses, start=1):
        for axis in (0, 1):
            for rep in range(1, repeats + 1):
                run += 1
                for step, at in enumerate(there):
                    t += dwell_s
                    moved = [at * step_mm, 0.0] if axis == 0 else [0.0, at * step_mm]
                    rows.append([run, theta1, theta2, t, 0.0, *moved])
                    labels.append([config, axis, rep, step])
                t += 20.0
    out = np.array(rows)
    out[:, 4] = np.round(22.0 + rng.uniform(1.0, 6.0) * (1.0 - np.exp(-out[:, 3] / 1200.0)), 3)
    marks = np.array(labels)
    noise_n = float(rng.uniform(0.03, 0.1))
    return Test(out, marks[:, 0], marks[:, 1], marks[:, 2], marks[:, 3], dwell_s, step_mm, 1.0 / 32.0, noise_n)


# --- effects --------------------------------------------------------------------------------------------------


def _add(key: str, by: float) -> Callable[[dict[str, float], float], None]:
    def change(limb: dict[str, float], size: float) -> None:
        limb[key] += by * size

    return change


def _times(key: str, power: float) -> Callable[[dict[str, float], float], None]:
    def change(limb: dict[str, float], size: float) -> None:
        limb[key] *= (1.0 + size) ** power

    return change


def _both(*changes: Callable[[dict[str, float], float], None]) -> Callable[[dict[str, float], float], None]:
    def change(limb: dict[str, float], size: float) -> None:
        for one in changes:
            one(limb, size)

    return change


def friction(rng: Rng, joint: str, law: str) -> Hidden:
    """Friction that is strained over 0.3 to 3 mrad before it slides; the sharp one over a hundredth of that."""
    bristle = _log(rng, 3e-4, 3e-3) * (0.03 if law == "coulomb" else 1.0)
    kind = {"maxwell": float(law == "maxwell"), "peak": rng.uniform(0.1, 0.5) if law == "lugre" else 0.0,
            "bristle_rad": bristle}  # fmt: skip

    def change(limb: dict[str, float], size: float) -> None:
        limb.update(kind)
        limb[f"level.{joint}"] = 30.0 * size

    return Hidden("coulomb_friction", f"joint.{joint}", change, 60.0, {"law": law, "bristle_rad": bristle})


def _crack(rng: Rng, link: str, whole_s: float) -> Hidden:
    at_s, power = float(rng.uniform(0.25, 0.75) * whole_s), 1.0 if rng.random() < 0.8 else -1.0

    def change(limb: dict[str, float], size: float) -> None:
        limb |= {"change.at_s": at_s, "change.link": float(link == "tibia"), "change.factor": (1.0 + size) ** power}

    return Hidden("link_change", f"link.{link}", change, 6.0, {"at_s": at_s})


def _saturated(peak_n: float) -> Hidden:
    def change(limb: dict[str, float], size: float) -> None:
        limb["sensor.saturation_n"] = peak_n / (1.0 + size)

    return Hidden("sensor_saturation", "sensor", change, 3.0)


def catalogue(rng: Rng, limb: dict[str, float], test: Test, peak_n: float) -> list[Hidden]:
    """One of each, with directions drawn. Every third is friction, once for each law and joint."""
    sign = [float(rng.choice([-1.0, 1.0])) for _ in range(16)]
    turns = [rng.uniform(0.0, 2.0 * math.pi) for _ in range(2)]
    joints, links = ("femur", "tibia"), ("femur", "tibia")
    whole_s = float(test.rows[-1, 3])
    plain = [
        *(Hidden("joint_compliance", f"joint.{j}", _times(f"joint.{j}.compliance_rad_per_n_mm", s)) for j, s in
          zip(joints, sign)),
        *(Hidden("link_compliance_error", f"link.{n}", _times(f"link.{n}.bending_mm_per_n", s)) for n, s in
          zip(links, sign[2:])),
        Hidden("base_compliance", "base", _both(_add("base.x_mm_per_n", 0.02 * math.cos(turns[0]) ** 2),
                                                 _add("base.z_mm_per_n", 0.02 * math.sin(turns[0]) ** 2))),
        *(_crack(rng, link, whole_s) for link in links),
        *(Hidden("backlash", f"joint.{j}", _add(f"joint.{j}.gap_rad", 1e-3)) for j in joints),
        *(Hidden("joint_hardening", f"joint.{j}", _add(f"joint.{j}.hardening_n_mm_per_rad3", 3e8), 1e3)
          for j in joints),
        *(Hidden("joint_zero_offset", f"joint.{j}", _add(f"joint.{j}.zero_offset_rad", 0.01 * s)) for j, s in
          zip(joints, sign[4:])),
        Hidden("link_length_error", "geometry", _add(f"geometry.{links[int(sign[6] > 0)]}_mm", 2.0 * sign[7])),
        Hidden("thermal_softening", "thermal", _add("thermal.joint_compliance_per_degc", 0.01 * sign[8])),
        Hidden("contact_play", "contact", _add("contact.play_mm", 0.05), 20.0),
        Hidden("sensor_bias", "sensor", _both(_add("sensor.bias_x_n", 0.05 * math.cos(turns[1])),
                                               _add("sensor.bias_z_n", 0.05 * math.sin(turns[1])))),
        Hidden("sensor_drift", "sensor", _add(f"sensor.drift_{'xz'[int(sign[9] > 0)]}_n_per_s", 5e-5 * sign[10])),
        Hidden("sensor_gain", "sensor", _times("sensor.gain", sign[11])),
        Hidden("sensor_rotation", "sensor", _add("sensor.rotation_rad", 0.02 * sign[12]), 15.0),
        Hidden("sensor_crosstalk", "sensor", _add(f"sensor.crosstalk_{('xz', 'zx')[int(sign[13] > 0)]}",
                                                  0.02 * sign[14]), 15.0),
        _saturated(peak_n),
    ]  # fmt: skip
    rubbing = [friction(rng, joint, law) for law in LAWS for joint in joints]
    return [*plain, *rubbing]


KINDS = 30  # of the catalogue
NEAR_ENOUGH, MOST_CORRECTIONS = 0.1, 6  # of the detectability that is wanted
WANTED = (10.0, 14.0, 25.0, 40.0, 80.0, 200.0)  # sigmas of the record; a geared joint's dry friction has the last


class Bench:
    """What a test tells of effects in a believed limb: readings in sigmas, the base taken out under its priors."""

    def __init__(self, believed: dict[str, float], test: Test) -> None:
        self.believed, self.test = believed, test
        self.sigma = math.hypot(test.noise_n, test.resolution_n / math.sqrt(12.0))
        self.plain, self._still = play(believed, test), play(believed, test, resting=True)
        columns = [
            (play(_off(believed, key, how, 0.3 * sigma), test, resting=True) - self._still).ravel() / 0.3 / self.sigma
            for key, how, sigma in trusted()
        ]
        stacked = np.vstack([np.array(columns).T, np.eye(len(columns))])
        self._basis, _ = np.linalg.qr(stacked)
        self._priors = len(columns)

    def bare(self, limb: dict[str, float], *, resting: bool = False) -> Array:
        """The trace of a limb that the base cannot make up. `resting`: of one that does not ring, in a tenth of the
        time."""
        off = (play(limb, self.test, resting=resting) - (self._still if resting else self.plain)).ravel() / self.sigma
        whole = np.concatenate([off, np.zeros(self._priors)])
        return np.asarray(whole - self._basis @ (self._basis.T @ whole))

    def sized(self, one: Hidden, wanted: float) -> tuple[float, float]:
        """The size that is so detectable, and how detectable it is: by halving in the logarithm on a limb that does
        not ring, then on the one that is played. A joint that rings shakes weak friction off."""

        def seen(size: float, resting: bool = False) -> float:
            return float(np.linalg.norm(self.bare(one.applied(self.believed, size), resting=resting)))

        low, high = 1e-4, one.most
        if seen(high, resting=True) > wanted:
            for _ in range(12):
                middle = math.sqrt(low * high)
                low, high = (middle, high) if seen(middle, resting=True) < wanted else (low, middle)
        size = high
        for _ in range(MOST_CORRECTIONS):
            s = seen(size)
            if abs(s / wanted - 1.0) < NEAR_ENOUGH or (size >= one.most and s < wanted):
                break
            size = min(size * min(max(wanted / max(s, 1e-9), 0.3), 3.0), one.most)
        return size, seen(size)

    def alike(self, hidden: Hidden, size: float, others: list[Hidden]) -> list[str]:
        """Effects that leave the trace of this one."""
        trace = self.bare(hidden.applied(self.believed, size))
        found = {hidden.label}
        for one in others:
            for small in (0.05, 1.0):
                other = self.bare(one.applied(self.believed, small), resting=True)
                length = float(np.linalg.norm(other)) * float(np.linalg.norm(trace))
                if length > 0.0 and abs(float(other @ trace)) > ALIKE * length:
                    found.add(one.label)
        return sorted(found)


@dataclass(frozen=True)
class Made:
    """A record, what is believed of its limb, and the truth."""

    test: Test
    forces: Array
    believed: dict[str, float]
    truth: dict[str, Any]


def on_rig(rng: Rng) -> tuple[dict[str, float], Test]:
    """A limb and its test: it is read when it has come to rest, or when the rig goes on."""
    believed, test = believed_limb(rng), loading_test(rng)
    return believed | {"wait_s": test.dwell_s - believed["move_s"]}, test


def single(seed: int, number: int) -> Made:
    """A limb with the number's effect, at a detectability of 8 or more; drawn again where it cannot be so large."""
    for attempt in range(40):
        rng = np.random.default_rng([seed, 1, number, attempt])
        believed, test = on_rig(rng)
        bench = Bench(believed, test)
        effects = catalogue(rng, believed, test, float(np.abs(bench.plain).max()))
        hidden, wanted = effects[number % KINDS], float(rng.choice(WANTED))
        size, s = bench.sized(hidden, wanted)
        if not 8.0 <= s <= 1.5 * wanted:
            continue
        alike = bench.alike(hidden, size, effects[: KINDS - 8])
        limb = hidden.applied(true_limb(rng, believed), size)
        truth = {"kind": "single", "effect": hidden.label, "alike": alike, "s": s, "size": size, **hidden.about}
        return Made(test, _read(rng, test, play(limb, test)), believed, truth)
    raise RuntimeError(f"no record of {number}")


def sound(seed: int, number: int) -> Made:
    """A limb within its calibration, read by a quiet sensor whose zero wanders by a third of its resolution."""
    rng = np.random.default_rng([seed, 2, number])
    believed, test = on_rig(rng)
    test = replace(test, noise_n=float(rng.uniform(0.01, 0.04)), resolution_n=1.0 / 32.0)
    t = test.rows[:, 3] / test.rows[-1, 3]
    wander = np.zeros((len(t), 2))
    for axis in (0, 1):
        waves = [rng.standard_normal() * np.sin(2.0 * math.pi * (k * t + rng.random())) / k for k in (0.5, 1, 2, 3, 5)]
        wander[:, axis] = 0.01 * np.sum(waves, axis=0) / max(float(np.std(np.sum(waves, axis=0))), 1e-9)
    clean = play(true_limb(rng, believed), test) + wander
    return Made(test, _read(rng, test, clean), believed, {"kind": "sound", "effect": "", "alike": [], "s": 0.0})


def _read(rng: Rng, test: Test, clean: Array) -> Array:
    noisy = clean + test.noise_n * rng.standard_normal(clean.shape)
    return np.asarray(np.round(noisy / test.resolution_n) * test.resolution_n)


def write(made: Made, folder: Any) -> None:
    """data.csv, meta.toml, limb.toml, as a tool may see them."""
    folder.mkdir(parents=True, exist_ok=True)
    test = made.test
    lines = ["run,config,theta1_rad,theta2_rad,axis,rep,step,t_s,temp_degc,dx_mm,dz_mm,fx_n,fz_n"]
    for row, config, axis, rep, step, force in zip(
        test.rows, test.config, test.axis, test.rep, test.step, made.forces, strict=True
    ):
        lines.append(
            f"{int(row[0])},{config},{row[1]!r},{row[2]!r},{'xz'[axis]},{rep},{step},{row[3]!r},{row[4]!r},{row[5]!r},"
            f"{row[6]!r},{force[0]!r},{force[1]!r}".replace("np.float64(", "").replace(")", "")
        )
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    (folder / "meta.toml").write_text(
        f'format = 1\nkind = "loading"\ntitle = "a limb that rings"\n[sensor]\nresolution_n = {test.resolution_n!r}\n'
        f'range_n = 500.0\n[rig]\nstep_mm = {test.step_mm!r}\ndwell_s = {test.dwell_s!r}\nzeroed = "never"\n'
    )
    tables: dict[str, list[str]] = {}
    for key in BELIEVED:
        table, leaf = key.rsplit(".", 1)
        tables.setdefault(table, []).append(f"{leaf} = {made.believed[key]!r}")
    for link in ("femur", "tibia"):
        tables[f"link.{link}"].append("moment_transfer = false")
    text = ["format = 1"] + [line for table, keys in tables.items() for line in (f"[{table}]", *keys)]
    text += ["[uncertainty]", "length_mm = 0.5", "angle_rad = 0.003"]
    text += [f"compliance_rel = {TRUST_REL}", "gain_rel = 0.005"]
    (folder / "limb.toml").write_text("\n".join(text) + "\n")
