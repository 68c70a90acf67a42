"""The tool's own next experiment, played on the true limb: its rig file, the case's noise, rows after the record's."""

from __future__ import annotations

import csv
import json
import math
import shutil
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from designs import Design, Rng, cycle
from files import meta_text, noisy, table_of, write_dataset
from generate import clean_readings, ingredients
from plant import INDEX, Array
from worlds import world_called


SET_UP_S = 60.0  # from the record's last row to the experiment's first


class NotPlayable(Exception):
    """The rig file asks for what this benchmark cannot play."""


def design_of(rng: Rng, text: str, like: Design, limb: Array, start_s: float, runs: int, configs: int) -> Design:
    """The rows of a rig file. Angles are commanded; polar poses are solved on the true limb."""
    rig = tomllib.loads(text)
    test, sensor, warmth = rig.get("rig", {}), rig.get("sensor", {}), rig.get("temperature", {})
    steps, step_mm = int(test.get("steps", 4)), float(test.get("step_mm", 0.635))
    dwell_s, pause_s = float(test.get("dwell_s", 4.0)), float(test.get("pause_s", 20.0))
    at = [_pose(pose, limb) for pose in rig["configuration"]]
    plan = [(c, axis, rep) for c in range(len(at)) for axis in test.get("axes", ["x", "z"])
            for rep in range(int(test.get("repeats", 2)))]  # fmt: skip
    if test.get("shuffled", False):
        plan = [plan[i] for i in rng.permutation(len(plan))]
    wave = cycle(steps)
    if test.get("cyclic", False):  # first to the minus side, then over
        wave = np.concatenate([-cycle(steps)[: 2 * steps + 1], cycle(steps)[1:]])
    x0, z0 = float(test.get("preload_x_mm", 0.0)), float(test.get("preload_z_mm", 0.0))
    start_s = max(start_s, float(test.get("start_s", 0.0)))
    t, rows, labels = 0.0, [], []
    start, rise = float(warmth.get("start_degc", 22.0)), float(warmth.get("rise_degc", 0.0))
    for number, (c, axis, rep) in enumerate(plan, start=1):
        for i, level in enumerate(wave):
            d = level * step_mm
            degc = start + rise * (1.0 - math.exp(-t / float(warmth.get("time_constant_s", 600.0))))
            rows.append((runs + number, *at[c], start_s + t, round(degc, 6),
                         x0 + (d if axis == "x" else 0.0), z0 + (d if axis == "z" else 0.0)))  # fmt: skip
            labels.append((configs + c + 1, axis, rep + 1, i))
            t += dwell_s
        t += pause_s
    readings: tuple[str, ...] = ("fx_n", "fz_n")
    if sensor.get("encoders", False):
        readings += ("enc1_rad", "enc2_rad")
    if sensor.get("base_gauge", False):
        readings += ("base_x_mm", "base_z_mm")
    return Design(
        np.array(rows), np.array([x[0] for x in labels]), [x[1] for x in labels], np.array([x[2] for x in labels]),
        np.array([x[3] for x in labels]), readings, like.noise, step_mm, dwell_s, like.resolution_n,
    )  # fmt: skip


def _pose(pose: dict[str, Any], limb: Array) -> tuple[float, float]:
    if "theta1_rad" in pose:
        return round(float(pose["theta1_rad"]), 6), round(float(pose["theta2_rad"]), 6)
    L1, L2 = float(limb[INDEX["geometry.femur_mm"]]), float(limb[INDEX["geometry.tibia_mm"]])
    r, phi = float(pose["r_mm"]), float(pose["phi_rad"])
    bend = (r * r - L1 * L1 - L2 * L2) / (2 * L1 * L2)
    if abs(bend) > 1.0:
        raise NotPlayable(f"r = {r:g} mm is out of reach")
    th2 = math.acos(bend) * (1.0 if pose.get("knee", "up") == "up" else -1.0)
    th1 = phi + math.atan2(L2 * math.sin(th2), L1 + L2 * math.cos(th2))
    return round(th1, 6), round(th2, 6)


def play(answer: Path, rig_toml: str, record: Path, together: Path, alone: Path) -> None:
    """Writes the experiment twice: its rows after the record's, empty where one of the two reads a column that the
    other does not (an encoder was fitted, a gauge put up), and by itself."""
    truth = json.loads((answer / "truth.json").read_text())
    world, case = world_called(truth["world"]), ingredients(answer)
    shown: Design = case["shown"]
    with (record / "data.csv").open(newline="") as file:
        reader = csv.DictReader(file)
        names, before = list(reader.fieldnames or []), list(reader)
    rng = np.random.default_rng([truth["seed"], 3, truth["index"]])
    start_s = float(before[-1]["t_s"]) + SET_UP_S
    runs, configs = int(before[-1]["run"]), max(int(row["config"]) for row in before)
    design = design_of(rng, rig_toml, shown, case["limb"], start_s, runs, configs)
    fresh = table_of(design, noisy(rng, design, clean_readings(case, design.rows, world)))
    write_dataset(alone, meta_text(design, "next experiment"), fresh)
    shutil.copyfile(record / "limb.toml", alone / "limb.toml")
    with (alone / "data.csv").open(newline="") as file:
        after = list(csv.DictReader(file))
    together.mkdir(parents=True, exist_ok=True)
    for name in ("meta.toml", "limb.toml"):
        shutil.copyfile(record / name, together / name)
    columns = names + [name for name in fresh if name not in names]
    with (together / "data.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows([*before, *after])
