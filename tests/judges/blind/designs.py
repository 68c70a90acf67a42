"""Limbs, what calibration believes of them, and how a loading test goes through poses, steps and time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from plant import INDEX, NEUTRAL, READINGS, Array, play

Rng = np.random.Generator
Play = Callable[[Array, Array], Array]  # parameters, rows -> readings, as plant.play
THETA1_RAD, THETA2_RAD = (-0.3, 1.7), (0.45, 2.75)  # what a rig can hold, not too near the straight or the folded knee


@dataclass(frozen=True)
class Trust:
    """One sigma of what the calibration is trusted to: [uncertainty] of limb.toml."""

    length_mm: float = 0.5
    angle_rad: float = 0.003
    compliance_rel: float = 0.05
    gain_rel: float = 0.005


@dataclass(frozen=True)
class Noise:
    """What a reading scatters by: forces white, plus a share of their size; then rounding to `rounding_n`."""

    force_n: float
    growth: float
    rounding_n: float
    encoder_rad: float
    gauge_mm: float


@dataclass
class Design:
    """A loading test: rows as the plant wants them, what else a row is labelled with, and what is read."""

    rows: Array
    config: Array
    axis: list[str]
    rep: Array
    step: Array
    readings: tuple[str, ...]
    noise: Noise
    step_mm: float
    dwell_s: float
    resolution_n: float
    zeroed: bool = False  # each run's first force is taken off
    held_at_rest: bool = False  # displacements count from where the limb hung under its weight
    columns: list[int] = field(init=False)

    def __post_init__(self) -> None:
        self.columns = [READINGS.index(name) for name in self.readings]

    def seen(self, readings: Array) -> Array:
        """What the record has of readings (columns as `readings`): zeroed where the sensor is."""
        if not self.zeroed:
            return readings
        _, first, back = np.unique(self.rows[:, 0], return_index=True, return_inverse=True)
        out = readings.copy()
        for i, name in enumerate(self.readings):
            if name in ("fx_n", "fz_n"):
                out[:, i] -= readings[first[back.ravel()], i]
        return out

    def sigma(self, clean: Array) -> Array:
        """Standard deviation of each reading (as `clean`'s columns of `readings`), rounding included."""
        out = np.empty((len(self.rows), len(self.columns)))
        for i, name in enumerate(self.readings):
            if name in ("fx_n", "fz_n"):
                white = self.noise.force_n**2 + self.noise.rounding_n**2 / 12.0
                out[:, i] = np.sqrt(white + (self.noise.growth * clean[:, self.columns[i]]) ** 2)
            else:
                out[:, i] = self.noise.encoder_rad if name.startswith("enc") else self.noise.gauge_mm
        return out


# --- limbs ----------------------------------------------------------------------------------------------

_KNOWN = (  # femur, tibia [mm]; axial, bending twice [mm/N]; joints [rad/(N mm)]
    (185.0, 313.5, 0.001, 0.06, 0.002, 0.25, 1.0e-5, 1.6e-5),
    (200.0, 200.0, 0.001, 0.05, 0.001, 0.08, 1.3e-5, 1.3e-5),
)


def believed_limb(rng: Rng) -> Array:
    """A limb as its calibration has it."""
    p = NEUTRAL.copy()
    if rng.random() < 0.2:
        values = _KNOWN[int(rng.integers(len(_KNOWN)))]
    else:
        joint = math.exp(rng.uniform(math.log(4e-6), math.log(4e-5)))
        values = (
            round(rng.uniform(110.0, 260.0), 1),
            round(rng.uniform(130.0, 360.0), 1),
            _log(rng, 5e-4, 4e-3),
            _log(rng, 0.02, 0.2),
            _log(rng, 5e-4, 4e-3),
            _log(rng, 0.03, 0.35),
            joint,
            joint * _log(rng, 0.5, 2.5),
        )
    keys = (
        "geometry.femur_mm",
        "geometry.tibia_mm",
        "link.femur.axial_mm_per_n",
        "link.femur.bending_mm_per_n",
        "link.tibia.axial_mm_per_n",
        "link.tibia.bending_mm_per_n",
        "joint.femur.compliance_rad_per_n_mm",
        "joint.tibia.compliance_rad_per_n_mm",
    )
    for key, value in zip(keys, values, strict=True):
        p[INDEX[key]] = float(f"{value:.4g}")
    if rng.random() < 0.4:
        for link in ("femur", "tibia"):
            p[INDEX[f"link.{link}.tilt_rad"]] = round(rng.uniform(-0.35, 0.35), 3)
    if rng.random() < 0.25:
        p[INDEX["base.x_mm_per_n"]] = float(f"{_log(rng, 5e-4, 6e-3):.3g}")
        p[INDEX["base.z_mm_per_n"]] = float(f"{_log(rng, 5e-4, 6e-3):.3g}")
        if rng.random() < 0.5:
            p[INDEX["base.rotation_rad_per_n_mm"]] = float(f"{_log(rng, 1e-7, 2e-6):.3g}")
    return p


def _log(rng: Rng, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def trust(rng: Rng) -> Trust:
    """Mostly the defaults of limb.toml."""
    if rng.random() < 0.6:
        return Trust()
    return Trust(
        round(rng.uniform(0.2, 1.0), 2),
        round(rng.uniform(0.001, 0.005), 4),
        round(rng.uniform(0.02, 0.08), 3),
        round(rng.uniform(0.002, 0.01), 4),
    )


@dataclass(frozen=True)
class Loose:
    """A parameter that calibration leaves open. One sigma: a length or an angle by addition; a compliance or a
    gain, which cannot be negative, by its logarithm."""

    index: int
    sigma: float
    relative: bool

    def moved(self, p: Array, sigmas: float) -> None:
        """Moves a limb's parameter in place."""
        if self.relative:
            p[self.index] *= math.exp(sigmas * self.sigma)
        else:
            p[self.index] += sigmas * self.sigma

    def away(self, p: Array, believed: Array) -> float:
        """How many sigmas a limb's parameter is from what is believed."""
        at, was = float(p[self.index]), float(believed[self.index])
        return math.log(at / was) / self.sigma if self.relative else (at - was) / self.sigma


def base_parameters(believed: Array, given: Trust) -> list[Loose]:
    """What calibration leaves open."""
    found = [
        Loose(INDEX["geometry.femur_mm"], given.length_mm, False),
        Loose(INDEX["geometry.tibia_mm"], given.length_mm, False),
        Loose(INDEX["joint.femur.zero_offset_rad"], given.angle_rad, False),
        Loose(INDEX["joint.tibia.zero_offset_rad"], given.angle_rad, False),
        Loose(INDEX["sensor.gain"], given.gain_rel, True),
    ]
    for key in (
        "link.femur.axial_mm_per_n",
        "link.femur.bending_mm_per_n",
        "link.tibia.axial_mm_per_n",
        "link.tibia.bending_mm_per_n",
        "joint.femur.compliance_rad_per_n_mm",
        "joint.tibia.compliance_rad_per_n_mm",
        "base.x_mm_per_n",
        "base.z_mm_per_n",
        "base.rotation_rad_per_n_mm",
    ):
        if believed[INDEX[key]] > 0.0:
            found.append(Loose(INDEX[key], given.compliance_rel, True))
    return found


def true_limb(rng: Rng, believed: Array, given: Trust) -> Array:
    """A limb within its calibration's trust."""
    p = believed.copy()
    for loose in base_parameters(believed, given):
        loose.moved(p, float(np.clip(rng.standard_normal(), -3.0, 3.0)))
    return p


# --- loading tests --------------------------------------------------------------------------------------


def temperature(rng: Rng) -> tuple[str, tuple[float, ...]]:
    """A course of temperature, as its kind and numbers."""
    kind = str(rng.choice(["warm_up", "ramp", "day", "step"], p=[0.5, 0.2, 0.15, 0.15]))
    return kind, (
        round(22.0 + rng.uniform(-2.0, 2.0), 2),
        float(rng.choice([-1.0, 1.0], p=[0.2, 0.8])) * rng.uniform(2.0, 7.0),
        rng.uniform(0.15, 0.6),
        rng.uniform(0.0, 2.0 * math.pi),
    )


def temperatures_degc(course: tuple[str, tuple[float, ...]], t_s: Array, whole_s: float) -> Array:
    """Temperature over time [degC]."""
    kind, (start, rise, part, phase) = course
    x = t_s / whole_s
    if kind == "warm_up":
        return start + rise * (1.0 - np.exp(-x / part))
    if kind == "ramp":
        return start + rise * x
    if kind == "day":
        return start + 0.5 * rise * (np.sin(2.0 * math.pi * x / (2.0 * part) + phase) - math.sin(phase))
    return start + rise / (1.0 + np.exp(-(x - part) / 0.03))


def poses(rng: Rng, count: int, knee_rad: tuple[float, float] = THETA2_RAD) -> Array:
    """Postures a rig can hold: theta1, theta2 [rad]."""
    found: list[tuple[float, float]] = []
    while len(found) < count:
        th1, th2 = rng.uniform(*THETA1_RAD), rng.uniform(*knee_rad)
        if all(math.hypot(th1 - a, th2 - b) > 0.12 for a, b in found):
            found.append((round(th1, 6), round(th2, 6)))
    return np.array(found)


@dataclass(frozen=True)
class Plan:
    """What makes a design but its poses."""

    repeats: int
    steps: int
    step_mm: float
    dwell_s: float
    pause_s: float
    order: str
    course: tuple[str, tuple[float, ...]]
    whole_s: float


def cycle(steps: int) -> Array:
    """One pass 0 -> +n -> 0 -> -n -> 0, in steps."""
    up = list(range(steps + 1))
    return np.array(up + up[-2::-1] + [-n for n in up[1:]] + [-n for n in up[-2::-1]], dtype=float)


def lay_out(rng: Rng, at: Array, plan: Plan, readings: tuple[str, ...], noise: Noise, resolution_n: float) -> Design:
    """The rows of a loading test at the given poses."""
    runs = [(c, axis, rep) for c in range(len(at)) for axis in "xz" for rep in range(plan.repeats)]
    if plan.order == "shuffled":
        runs = [runs[i] for i in rng.permutation(len(runs))]
    elif plan.order == "repeats_apart":
        runs.sort(key=lambda run: run[2])
    wave = cycle(plan.steps)
    t = 0.0
    rows, config, axes, reps, steps = [], [], [], [], []
    for number, (c, axis, rep) in enumerate(runs, start=1):
        for i, level in enumerate(wave):
            d = level * plan.step_mm
            rows.append((number, at[c, 0], at[c, 1], t, 0.0, d if axis == "x" else 0.0, d if axis == "z" else 0.0))
            config.append(c + 1)
            axes.append(axis)
            reps.append(rep + 1)
            steps.append(i)
            t += plan.dwell_s
        t += plan.pause_s
    table = np.array(rows)
    table[:, 3] = np.round(table[:, 3], 6)
    table[:, 4] = np.round(temperatures_degc(plan.course, table[:, 3], plan.whole_s), 6)
    return Design(
        table,
        np.array(config),
        axes,
        np.array(reps),
        np.array(steps),
        readings,
        noise,
        plan.step_mm,
        plan.dwell_s,
        resolution_n,
    )


def loading_test(rng: Rng, believed: Array, by: Play = play) -> tuple[Design, Design]:
    """A test as one would plan it for this limb, and one at other poses that nobody shows to the tool."""
    configs, repeats, steps = int(rng.integers(6, 15)), int(rng.integers(1, 4)), int(rng.integers(3, 7))
    while configs * repeats * 2 * (4 * steps + 1) > 1000:
        if repeats > 1 and rng.random() < 0.6:
            repeats -= 1
        else:
            configs, steps = max(6, configs - 1), max(3, steps - 1)
    at = poses(rng, configs + 5)
    step_mm = float(np.clip(rng.uniform(15.0, 60.0) / (stiffest_n_per_mm(believed, at, by) * steps), 0.05, 1.2))
    return tests_at(rng, at, configs, repeats, steps, round(step_mm, 4))


def stiffest_n_per_mm(limb: Array, at: Array, by: Play) -> float:
    """The largest force along an axis that 1 mm along x or z makes at some poses."""
    return max(
        float(np.max(np.abs(by(limb, np.array([[1, a, b, 0, 22, 0, 0], [1, a, b, 1, 22, dx, dz]]))[1, :2])))
        for a, b in at
        for dx, dz in ((1.0, 0.0), (0.0, 1.0))
    )


def tests_at(
    rng: Rng, at: Array, configs: int, repeats: int, steps: int, step_mm: float
) -> tuple[Design, Design]:
    """A test at the first so many poses, and one at the others; time, temperature, noise and columns at random."""
    dwell_s = float(rng.choice([2.0, 3.0, 4.0, 6.0, 10.0]))
    pause_s = float(rng.choice([0.0, 10.0, 20.0, 40.0])) + dwell_s
    whole_s = configs * 2 * repeats * ((4 * steps + 1) * dwell_s + pause_s)
    order = str(rng.choice(["ordered", "shuffled", "repeats_apart"], p=[0.5, 0.3, 0.2]))
    plan = Plan(repeats, steps, step_mm, dwell_s, pause_s, order, temperature(rng), whole_s)
    resolution = float(rng.choice([1 / 16, 1 / 32, 1 / 64]))
    white = round(math.exp(rng.uniform(math.log(0.02), math.log(0.15))), 4)
    rounded = rng.random() < 0.5 and white > 0.5 * resolution  # else the rig gives averages of many readings
    noise = Noise(
        white,
        round(rng.uniform(0.003, 0.01), 4) if rng.random() < 0.2 else 0.0,
        resolution if rounded else 0.0,
        float(f"{_log(rng, 8e-6, 6e-5):.2g}"),
        float(f"{_log(rng, 5e-4, 4e-3):.2g}"),
    )
    readings: tuple[str, ...] = ("fx_n", "fz_n")
    if rng.random() < 0.4:
        readings += ("enc1_rad", "enc2_rad")
    if rng.random() < 0.2:
        readings += ("base_x_mm", "base_z_mm")
    shown = lay_out(rng, at[:configs], plan, readings, noise, resolution)
    runs = 2 * (len(at) - configs)
    spread = max(0.0, whole_s / runs - (4 * steps + 1) * dwell_s)
    hidden = lay_out(
        rng,
        at[configs:],
        Plan(1, steps, plan.step_mm, dwell_s, round(spread, 6), "ordered", plan.course, whole_s),
        readings,
        noise,
        resolution,
    )
    return shown, hidden
