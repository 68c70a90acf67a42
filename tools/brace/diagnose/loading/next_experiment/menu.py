"""Loading tests that could be made next on the same rig: conditions, postures to choose from, instruments,
and what each costs in minutes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import ChannelNoise
from brace.identify.noise import FORCES
from brace.identify.record import Record
from brace.effects.catalogue import TIME_KEYS
from brace.identify.playing import player_of
from brace.native.plant import play_rig

# What it takes, in minutes, besides the readings themselves.
SET_UP_MIN = 3.0  # any further test
POSTURE_MIN = 0.5  # each posture
ENCODERS_MIN = 15.0  # mounting encoders on the joints' output sides
GAUGE_MIN = 5.0  # a dial gauge against the base
PRELOAD_MIN = 2.0
TEMPERATURE_MIN = 20.0  # a heater, and waiting for it
BEFORE_S = 60.0  # between the record's end and the next test

ENCODER_NOISE_RAD = 5e-5  # of instruments that the record does not have: one sigma
GAUGE_NOISE_MM = 3e-3

MOST_STEPS = 4
FURTHER_POSTURES = 16
SAME_POSTURES = 6
REACH_SENSOR_SHARE = 0.7  # of the sensor's range that larger steps may come to
WARMER_DEGC = 10.0
UNREAD_DEGC = 22.0  # of a record that reads no temperature: the same before and after
ENCODERS, GAUGE = ("enc1_rad", "enc2_rad"), ("base_x_mm", "base_z_mm")
CHANNELS = (*FORCES, *ENCODERS, *GAUGE)
GROUPS = ((0, 1), (2, 3), (4, 5))


@dataclass(frozen=True)
class Condition:
    """How a test is made, whatever the postures. `words` say what differs from the record; `extra_min` is
    its set-up."""

    name: str
    words: str
    rig: Mapping[str, Any]
    extra_min: float = 0.0

    def number(self, key: str) -> float:
        return float(self.rig[key])

    @property
    def run_s(self) -> float:
        """One run with the pause after it."""
        return self.number("rig.dwell_s") * (4 * self.number("rig.steps") + 1) + self.number("rig.pause_s")

    def minutes(self, postures: int, repeats: int, encoders: bool, gauge: bool, record: Record) -> float:
        """From now to the last reading."""
        instruments = ENCODERS_MIN * (encoders and ENCODERS[0] not in record.channels)
        instruments += GAUGE_MIN * (gauge and GAUGE[0] not in record.channels)
        runs_min = postures * 2 * repeats * self.run_s / 60.0
        return SET_UP_MIN + self.extra_min + instruments + POSTURE_MIN * postures + runs_min


def conditions(record: Record, fits: list[Fit], *, wanders: bool = False) -> Iterator[Condition]:
    """The record's own way first. `wanders`: the sensor's zero does, so that it is zeroed before each run from now
    on."""
    data = record.dataset
    starts = run_starts(data["run"])
    reach = float(max(np.abs(data["dx_mm"]).max(), np.abs(data["dz_mm"]).max()))
    inside = np.diff(data["run"]) == 0
    steps_s = np.diff(data["t_s"])
    dwell = float(np.median(steps_s[inside])) if inside.any() else 4.0
    between = steps_s[starts[1:-1] - 1] if starts.size > 2 else np.array([20.0])
    pause = float(np.clip(np.median(between) - dwell, 0.0, 60.0))
    steps = int(np.clip(round((np.median(np.diff(starts)) - 1) / 4), 2, MOST_STEPS))
    own: dict[str, Any] = {
        "rig.steps": steps,
        "rig.step_mm": _short(reach / steps),
        "rig.dwell_s": round(max(dwell, 0.1), 3),
        "rig.pause_s": round(pause, 3),
        "rig.preload_x_mm": 0.0,
        "rig.preload_z_mm": 0.0,
        "rig.shuffled": False,
        "rig.zeroed": "per_run" if wanders or data.meta.zeroed_per_run else "never",
        "temperature.rise_degc": 0.0,
        "temperature.time_constant_s": 600.0,
    }
    if "temp_degc" in data:
        own["temperature.start_degc"] = round(float(data["temp_degc"][-1]), 2)

    def other(**changes: Any) -> dict[str, Any]:
        return {**own, **{key.replace("__", "."): value for key, value in changes.items()}}

    yield Condition("again", "as before", own)
    peak = float(np.abs(record.measured[:2]).max())
    limit = data.meta.number("sensor.range_n")
    factor = float(np.clip(REACH_SENSOR_SHARE * limit / max(peak, 1e-9), 0.5, 2.0))
    if factor > 1.15:
        step = _short(factor * reach / steps)
        yield Condition("larger", f"larger steps ({step:g} mm)", other(rig__step_mm=step))
    step = _short(0.3 * reach / steps)
    yield Condition("smaller", f"smaller steps ({step:g} mm)", other(rig__step_mm=step))
    offset = _short(reach)
    for x, z in ((offset, offset), (-offset, offset)):
        yield Condition(
            "preload",
            f"each run starting from a preload ({x:g} mm along x, {z:g} mm along z)",
            other(rig__preload_x_mm=x, rig__preload_z_mm=z),
            PRELOAD_MIN,
        )
    if any(
        key in TIME_KEYS
        for fitted in fits
        for variant in fitted.space.variants
        for key in variant.keys
    ):
        slow = round(max(6.0 * dwell, 20.0), 1)
        yield Condition("dwell", f"a longer wait before each reading ({slow:g} s)", other(rig__dwell_s=slow))
        yield Condition("shuffled", "runs in random order", other(rig__shuffled=True))
        runs_s = 8 * 2 * (dwell * (4 * steps + 1) + pause)
        yield Condition(
            "warmer",
            f"a course of temperature ({_from(own)}up by {WARMER_DEGC:g} degC)",
            other(temperature__rise_degc=WARMER_DEGC, temperature__time_constant_s=round(0.5 * runs_s, 1)),
            TEMPERATURE_MIN,
        )


def _from(own: dict[str, Any]) -> str:
    start_degc = own.get("temperature.start_degc")
    return "" if start_degc is None else f"from {start_degc:g} degC "


def _short(value: float) -> float:
    """Three digits: what a person sets."""
    return float(f"{value:.3g}")


def postures(record: Record, believed: Mapping[str, float]) -> np.ndarray:
    """Angles to choose from, postures x 2 [rad]: some of the record's, and others spread over the range
    about them that the limb's motors reach, neither straight nor folded."""
    data = record.dataset
    _, first = np.unique(data["config"], return_index=True)
    visited = np.column_stack([data["theta1_rad"][first], data["theta2_rad"][first]])
    same = visited[np.unique(np.linspace(0, len(visited) - 1, SAME_POSTURES).round().astype(int))]
    low, high = visited.min(axis=0) - 0.3, visited.max(axis=0) + 0.3
    knee_down = np.median(visited[:, 1]) < 0.0
    bounds = (-2.75, -0.4) if knee_down else (0.4, 2.75)
    low[1], high[1] = max(low[1], bounds[0]), min(high[1], bounds[1])
    for place, joint in enumerate(("femur", "tibia")):
        low[place] = max(low[place], believed.get(f"motor.{joint}.angle_min_rad", -np.inf))
        high[place] = min(high[place], believed.get(f"motor.{joint}.angle_max_rad", np.inf))
    if np.any(low >= high):
        return np.asarray(same)
    # the golden-ratio lattice covers a rectangle evenly, with any number of points
    number = np.arange(FURTHER_POSTURES)
    spread = np.column_stack([(number + 0.5) / FURTHER_POSTURES, (0.5 + 0.6180339887498949 * number) % 1.0])
    return np.vstack([same, np.round(low + spread * (high - low), 3)])


def as_record(record: Record, condition: Condition, angles: np.ndarray, readings_of: np.ndarray) -> Record:
    """The test as a record, after `record` in time, not measured yet: all six readings, each with the
    noise that it has in `record`, or a stated one where it is not read there. `readings_of` is the limb
    that the noise's growth with load is judged by."""
    rig = condition.rig
    columns = play_rig(
        None,
        {
            "theta1_rad": angles[:, 0].copy(),
            "theta2_rad": angles[:, 1].copy(),
            "axes": 3,
            "repeats": 1,
            "steps_per_side": rig["rig.steps"],
            "shuffled": int(rig["rig.shuffled"]),
            "step_mm": rig["rig.step_mm"],
            "preload_x_mm": rig["rig.preload_x_mm"],
            "preload_z_mm": rig["rig.preload_z_mm"],
            "dwell_s": rig["rig.dwell_s"],
            "pause_s": rig["rig.pause_s"],
            "temp_start_degc": rig.get("temperature.start_degc", UNREAD_DEGC),
            "temp_rise_degc": rig["temperature.rise_degc"],
            "temp_time_constant_s": rig["temperature.time_constant_s"],
        },
    )
    columns["t_s"] = columns["t_s"] + float(record.dataset["t_s"][-1]) + BEFORE_S
    noise = {name: record.noise.get(name, _stated(name)) for name in CHANNELS}
    zeroed = rig["rig.zeroed"] == "per_run"
    dataset = replace(record.dataset, columns=columns, faults=())
    player = player_of(dataset, CHANNELS, zeroed=zeroed)
    expected = np.nan_to_num(player.play_numbers(readings_of[None])[0])
    sigma = np.stack([noise[name].sigma(values) for name, values in zip(CHANNELS, expected)])
    return Record(dataset, CHANNELS, noise, np.zeros_like(expected), sigma, player)


def _stated(channel: str) -> ChannelNoise:
    return ChannelNoise(ENCODER_NOISE_RAD if channel in ENCODERS else GAUGE_NOISE_MM, 0.0, "stated")
