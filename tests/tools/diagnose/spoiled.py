"""Healthy loading records of several limbs, and everything that goes wrong between a rig and a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from brace.dataset.write import csv_text, meta_text
from brace.model import LimbModel, load_limb
from brace.rig.rig import load_rig
from brace.rig.simulate import MetaTables, simulate

Rng = np.random.Generator
Columns = dict[str, np.ndarray]
Meta = MetaTables
Spoiler = Callable[[Columns, Meta, Rng], set[str]]

LIMBS: dict[str, dict[str, float]] = {  # what differs from the paper's limb
    "paper": {},
    "stubby": {
        "geometry.femur_mm": 140.0,
        "geometry.tibia_mm": 160.0,
        "link.femur.bending_mm_per_n": 0.03,
        "link.tibia.bending_mm_per_n": 0.06,
        "joint.femur.compliance_rad_per_n_mm": 2.4e-5,
        "joint.tibia.compliance_rad_per_n_mm": 1.8e-5,
    },
    "on a soft base": {
        "geometry.femur_mm": 230.0,
        "geometry.tibia_mm": 260.0,
        "link.femur.tilt_rad": 0.2,
        "base.x_mm_per_n": 0.004,
        "base.z_mm_per_n": 0.003,
        "joint.tibia.compliance_rad_per_n_mm": 1.1e-5,
    },
}
POSES = ((0.74, 1.0), (0.2, 1.6), (1.1, 2.2), (0.5, 0.6), (-0.2, 1.9), (0.9, 1.4), (1.5, 0.8))
RIG = """format = 1
seed = {seed}
[rig]
step_mm = {step_mm}
steps = 4
repeats = 2
dwell_s = 4.0
{rig}
[sensor]
noise_n = {noise_n}
resolution_n = {resolution_n}
{sensor}
[temperature]
start_degc = 22.5
rise_degc = 4.0
"""
SIDES = "encoders = true\nencoder_noise_rad = 2e-5\nbase_gauge = true\nbase_noise_mm = 0.001\n"
DECIMALS = {"t_s": 6, "temp_degc": 6}


def each_once(
    rows: Iterable[str], columns: Iterable[str], makes_sense: Callable[[str, str], bool] = lambda row, column: True
) -> list[Any]:
    """All pairs that make sense, as parameters of a test. ./dev test plays each row with one column, the columns in
    turn; ./dev judges plays the other pairs."""
    pairs: list[Any] = []
    for place, row in enumerate(rows):
        those = [column for column in columns if makes_sense(row, column)]
        now = those[place % len(those)]
        pairs += [pytest.param(row, one, marks=() if one == now else pytest.mark.minutes) for one in those]
    return pairs


def believed_limb(paper: Path, name: str) -> LimbModel:
    """What the calibration says."""
    return load_limb(paper).with_values(LIMBS[name])


def true_limb(believed: LimbModel, seed: int, **effects: Any) -> LimbModel:
    """Off the calibration by about one sigma of its trust, and with effects (dotted keys in `values`)."""
    random = np.random.default_rng(seed)
    values: dict[str, Any] = {}
    for link in ("femur", "tibia"):
        values[f"geometry.{link}_mm"] = believed.number(f"geometry.{link}_mm") + 0.5 * random.standard_normal()
        values[f"joint.{link}.zero_offset_rad"] = 0.003 * random.standard_normal()
        for key in (f"link.{link}.bending_mm_per_n", f"joint.{link}.compliance_rad_per_n_mm"):
            values[key] = believed.number(key) * np.exp(0.05 * random.standard_normal())
    return believed.with_values({**values, **effects.get("values", {})})


def record(
    folder: Path,
    limb: LimbModel,
    *,
    seed: int = 0,
    noise_n: float = 0.06,
    resolution_n: float = 0.03125,
    step_mm: float = 0.5,
    rig: str = "",
    sensor: str = "",
) -> tuple[Columns, Meta]:
    """A loading test on the limb."""
    path = folder / "rig.toml"
    poses = "".join(f"[[configuration]]\ntheta1_rad = {a}\ntheta2_rad = {b}\n" for a, b in POSES)
    text = RIG.format(seed=seed, noise_n=noise_n, resolution_n=resolution_n, step_mm=step_mm, rig=rig, sensor=sensor)
    path.write_text(text + poses)
    meta, columns = simulate(limb, load_rig(path))
    return {name: np.array(values) for name, values in columns.items()}, meta


def write(folder: Path, columns: Columns, meta: Meta, text: Callable[[str], str] = str) -> Path:
    """As files; `text` may spoil the CSV."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "meta.toml").write_text(meta_text(meta))
    (folder / "data.csv").write_text(text(csv_text(columns, DECIMALS)))
    return folder


# --- spoilers: change a record in place, return the fields that a person would look at -----------------------


def scaled(names: tuple[str, ...], factor: float, plus: float = 0.0) -> Spoiler:
    def change(columns: Columns, _meta: Meta, _random: Rng) -> set[str]:
        for name in names:
            columns[name] = columns[name] * factor + plus
        return set(names)

    return change


def exchanged(one: str, other: str) -> Spoiler:
    def change(columns: Columns, _meta: Meta, _random: Rng) -> set[str]:
        columns[one], columns[other] = columns[other], columns[one]
        return {one, other}

    return change


def _loudest(columns: Columns) -> str:
    return max(("fx_n", "fz_n"), key=lambda name: float(np.abs(columns[name]).max()))


def _loud_row(columns: Columns, name: str, random: Rng) -> int:
    values = np.abs(columns[name])
    return int(random.choice(np.flatnonzero(values > 0.4 * values.max())))


def one_reading(factor: float) -> Spoiler:
    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        name = _loudest(columns)
        columns[name][_loud_row(columns, name, random)] *= factor
        return {name}

    return change


def one_run(factor: float, names: tuple[str, ...]) -> Spoiler:
    """In a run along each name's axis at least, so that the column says something."""

    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        along = 0 if names[0] == "fx_n" else 1
        run = random.choice(np.unique(columns["run"][columns["axis"] == along]))
        for name in names:
            columns[name][columns["run"] == run] *= factor
        return {*names, "dx_mm", "dz_mm"} if len(names) == 2 else set(names)

    return change


def one_pose(factor: float) -> Spoiler:
    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        pose = random.choice(np.unique(columns["config"]))
        for name in ("fx_n", "fz_n"):
            columns[name][columns["config"] == pose] *= factor
        return {"fx_n", "fz_n"}

    return change


def mistyped(name: str, by: float) -> Spoiler:
    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        pose = random.choice(np.unique(columns["config"]))
        columns[name][columns["config"] == pose] += by
        return {"theta1_rad", "theta2_rad", "config"}

    return change


def exchanged_poses(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    one, other = random.choice(np.unique(columns["config"]), 2, replace=False)
    first, second = columns["config"] == one, columns["config"] == other
    for name in ("theta1_rad", "theta2_rad"):
        a, b = columns[name][first][0], columns[name][second][0]
        columns[name][first], columns[name][second] = b, a
    return {"theta1_rad", "theta2_rad", "config"}


def run_of_another_pose(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    """Only its number is wrong: its angles are its own."""
    run = random.choice(np.unique(columns["run"]))
    here = columns["run"] == run
    columns["config"][here] = columns["config"][here] % len(POSES) + 1
    return {"config", "theta1_rad", "theta2_rad"}


def copied(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    here, there = random.choice(np.unique(columns["config"]), 2, replace=False)
    for name in ("fx_n", "fz_n"):
        columns[name][columns["config"] == here] = columns[name][columns["config"] == there]
    return {"fx_n", "fz_n", "config", "theta1_rad", "theta2_rad"}


def copied_repeat(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    pose = random.choice(np.unique(columns["config"]))
    place = (columns["config"] == pose) & (columns["axis"] == 0)
    runs = np.unique(columns["run"][place])
    for name in ("fx_n", "fz_n"):
        columns[name][columns["run"] == runs[1]] = columns[name][columns["run"] == runs[0]]
    return {"fx_n", "fz_n"}


def row_again(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    row = int(random.integers(5, columns["run"].size - 5))
    for name, values in columns.items():
        columns[name] = np.insert(values, row + 1, values[row])
    return {"t_s", "step", "run"}


def rows_exchanged(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    row = int(random.integers(5, columns["run"].size - 25)) // 17 * 17 + 5
    for name, values in columns.items():
        if name != "t_s":
            values[[row, row + 1]] = values[[row + 1, row]]
    return {"step", "t_s"}


def clock(kind: str) -> Spoiler:
    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        time = columns["t_s"]
        row = int(random.integers(20, time.size - 20)) // 17 * 17 + 6
        if kind == "back":
            time[[row, row + 1]] = time[[row + 1, row]]
        elif kind == "stands":
            time[row + 1] = time[row]
        elif kind == "starts again":
            time[row:] -= time[row]
        else:
            time[:] = 17.0
        return {"t_s"}

    return change


def stuck(name: str | None, readings: int) -> Spoiler:
    def change(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
        field = name or _loudest(columns)
        row = int(random.integers(5, columns["run"].size - readings - 5))
        columns[field][row : row + readings] = columns[field][row]
        return {field}

    return change


def flat(name: str) -> Spoiler:
    def change(columns: Columns, _meta: Meta, _random: Rng) -> set[str]:
        columns[name][:] = 1.25
        return {name}

    return change


def one_row_late(columns: Columns, _meta: Meta, _random: Rng) -> set[str]:
    for name in ("fx_n", "fz_n"):
        columns[name] = np.roll(columns[name], 1)
    return {"fx_n", "fz_n"}


def displacement_slip(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    row = int(random.choice(np.flatnonzero((columns["axis"] == 1) & (np.abs(columns["dz_mm"]) > 0.7))))
    columns["dz_mm"][row] *= -1.0
    return {"dz_mm"}


def axis_of_a_run(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    here = columns["run"] == random.choice(np.unique(columns["run"]))
    columns["axis"][here] = 1 - columns["axis"][here]
    return {"axis", "dx_mm", "dz_mm"}


def temperature_slip(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    columns["temp_degc"][int(random.integers(5, columns["run"].size - 5))] *= 0.1
    return {"temp_degc"}


def beyond_range(columns: Columns, _meta: Meta, random: Rng) -> set[str]:
    columns["fz_n"][int(random.integers(columns["run"].size))] = -9999.0
    return {"fz_n"}


def zeroed_and_not_said(columns: Columns, meta: Meta, _random: Rng) -> set[str]:
    first = np.concatenate([[0], np.flatnonzero(np.diff(columns["run"])) + 1])
    for name in ("fx_n", "fz_n"):
        zero = np.repeat(columns[name][first], np.diff(np.append(first, columns["run"].size)))
        columns[name] = columns[name] - zero
    return {"zeroed"}


def said_zeroed_and_not(columns: Columns, meta: Meta, _random: Rng) -> set[str]:
    meta["rig"]["zeroed"] = "per_run"
    columns["fx_n"] = columns["fx_n"] + 3.0
    return {"zeroed"}


FORCES = ("fx_n", "fz_n")
SHIFTS = ("dx_mm", "dz_mm")
ANGLES = ("theta1_rad", "theta2_rad")
DEGREES = 180.0 / np.pi
SPOILERS: dict[str, Spoiler] = {
    "displacement in inches": scaled(SHIFTS, 1 / 25.4),
    "displacement in m": scaled(SHIFTS, 1e-3),
    "displacement in um": scaled(SHIFTS, 1e3),
    "dx in cm": scaled(("dx_mm",), 0.1),
    "angles in degrees": scaled(ANGLES, DEGREES),
    "theta1 in degrees": scaled(("theta1_rad",), DEGREES),
    "theta2 in degrees": scaled(("theta2_rad",), DEGREES),
    "forces in kgf": scaled(FORCES, 1 / 9.80665),
    "forces in lbf": scaled(FORCES, 1 / 4.4482216),
    "forces in daN": scaled(FORCES, 0.1),
    "forces in mN": scaled(FORCES, 1e3),
    "forces in kN": scaled(FORCES, 1e-3),
    "fx in kgf": scaled(("fx_n",), 1 / 9.80665),
    "fz in lbf": scaled(("fz_n",), 1 / 4.4482216),
    "time in ms": scaled(("t_s",), 1e3),
    "time in minutes": scaled(("t_s",), 1 / 60),
    "temperature in kelvin": scaled(("temp_degc",), 1.0, 273.15),
    "temperature in fahrenheit": scaled(("temp_degc",), 1.8, 32.0),
    "a temperature's decimal point": temperature_slip,
    "a decimal point to the right": one_reading(10.0),
    "a decimal point to the left": one_reading(0.1),
    "a sign": one_reading(-1.0),
    "fx turned": scaled(("fx_n",), -1.0),
    "fz turned": scaled(("fz_n",), -1.0),
    "both forces turned": scaled(FORCES, -1.0),
    "dx turned": scaled(("dx_mm",), -1.0),
    "theta2 turned": scaled(("theta2_rad",), -1.0),
    "theta1 turned": scaled(("theta1_rad",), -1.0),
    "a run turned": one_run(-1.0, FORCES),
    "fz of a run turned": one_run(-1.0, ("fz_n",)),
    "a run in kgf": one_run(1 / 9.80665, FORCES),
    "a pose in lbf": one_pose(1 / 4.4482216),
    "fx and fz exchanged": exchanged("fx_n", "fz_n"),
    "dx and dz exchanged": exchanged("dx_mm", "dz_mm"),
    "angles exchanged": exchanged("theta1_rad", "theta2_rad"),
    "encoders exchanged": exchanged("enc1_rad", "enc2_rad"),
    "encoder in degrees": scaled(("enc1_rad",), DEGREES),
    "encoder turned": scaled(("enc2_rad",), -1.0),
    "encoder stuck": stuck("enc2_rad", 12),
    "base gauge in um": scaled(("base_x_mm",), 1e3),
    "a row twice": row_again,
    "two rows exchanged": rows_exchanged,
    "clock runs back": clock("back"),
    "clock stands once": clock("stands"),
    "clock starts again": clock("starts again"),
    "clock stands": clock("stands for good"),
    "force stuck": stuck(None, 20),
    "fx flat": flat("fx_n"),
    "a pose's readings copied": copied,
    "a repeat copied": copied_repeat,
    "theta1 mistyped by 1": mistyped("theta1_rad", 1.0),
    "theta2 mistyped by -0.2": mistyped("theta2_rad", -0.2),
    "two poses' angles exchanged": exchanged_poses,
    "a run under another pose's number": run_of_another_pose,
    "forces one row late": one_row_late,
    "a displacement's sign": displacement_slip,
    "axis of a run": axis_of_a_run,
    "beyond the sensor": beyond_range,
    "zeroed and not said": zeroed_and_not_said,
    "said zeroed and not": said_zeroed_and_not,
}
UNREADABLE = {"empty": "", "nan": "nan", "infinite": "inf", "text": "n/a", "absurd": "1e300"}
EFFECTS: dict[str, dict[str, Any]] = {  # hidden, and no fault of the record
    "nothing": {},
    "softer knee": {"joint.tibia.compliance_rad_per_n_mm": 3.2e-5},
    "moment transfer": {"link.femur.moment_transfer": True},
    "base": {"base.x_mm_per_n": 0.02, "base.z_mm_per_n": 0.015, "base.rotation_rad_per_n_mm": 1e-6},
    "link error": {"link.tibia.bending_mm_per_n": 0.4, "link.tibia.tilt_rad": 0.2},
    "link change": {"change.at_s": 1500.0, "change.link": "tibia", "change.bending_factor": 2.5},
    "backlash": {"joint.tibia.gap_rad": 0.006},
    "much backlash": {"joint.femur.gap_rad": 0.02, "joint.tibia.gap_rad": 0.02},
    "friction": {"joint.femur.coulomb_n_mm": 400.0},
    "hardening": {"joint.tibia.hardening_n_mm_per_rad3": 3e8},
    "creep": {"creep.ratio": 0.2, "creep.time_constant_s": 40.0},
    "thermal": {"thermal.joint_compliance_per_degc": 0.03},
    "gravity": {"gravity.femur_n": 4.0, "gravity.tibia_n": 3.0, "gravity.knee_n": 5.0},
    "zero offset": {"joint.tibia.zero_offset_rad": 0.08},
    "length error": {"geometry.femur_mm": 150.0},
    "bias": {"sensor.bias_x_n": 2.0, "sensor.bias_z_n": -1.0},
    "drift": {"sensor.drift_x_n_per_s": 5e-4},
    "gain": {"sensor.gain": 1.15},
    "rotation": {"sensor.rotation_rad": 0.1},
    "crosstalk": {"sensor.crosstalk_xz": 0.08},
    "saturation": {"sensor.saturation_n": 12.0},
    "contact play": {"contact.play_mm": 0.8},
}
DESIGNS: dict[str, dict[str, Any]] = {
    "noisy": {},
    "without noise": {"noise_n": 0.0, "resolution_n": 0.0},
    "coarse": {"noise_n": 0.02, "resolution_n": 0.125},
    "zeroed, shuffled": {"rig": 'zeroed = "per_run"\nshuffled = true'},
    "with encoders and gauge": {"sensor": SIDES},
}
