"""Rows of a controller's loading tests as a dataset's: where the motors stood at each reading, several
postures as configurations 1..n of one record, one clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

Columns = dict[str, np.ndarray]
SAME_POSTURE_RAD = 0.01
_PAUSE_S = 1.0  # between two tests of which nobody knows how far they were apart


def with_motor_angles(columns: Columns, femur_mm: float, tibia_mm: float) -> Columns:
    """The same rows, each with the angles at which its motors stood and the tip's displacement on its arc.

    A controller presses by moving its motors: the tip stays, and the shape that the unloaded limb would have
    moves away. It tells (dx, dz) by the levers of the posture that the run began at. The same levers give
    the motors' angles back, at which the limb's stiffness is the reading's, and the angles tell where the
    unloaded tip went. Taken as constant, or the arc as straight, they leave an error that grows with the
    stroke's square."""
    theta1, theta2 = columns["theta1_rad"].astype(float), columns["theta2_rad"].astype(float)
    start = _tip(theta1, theta2, femur_mm, tibia_mm)
    shank = theta1 - theta2
    j12, j22 = tibia_mm * np.sin(shank), -tibia_mm * np.cos(shank)
    det = -start[1] * j22 - j12 * start[0]
    if np.any(np.abs(det) < 1e-3 * femur_mm * tibia_mm):
        return columns  # nearly straight: levers hardly tell the angles; the run's own are as good
    dx, dz = columns["dx_mm"].astype(float), columns["dz_mm"].astype(float)
    theta1 = theta1 - (j22 * dx - j12 * dz) / det
    theta2 = theta2 + (start[0] * dx + start[1] * dz) / det
    moved = _tip(theta1, theta2, femur_mm, tibia_mm) - start
    return {**columns, "theta1_rad": theta1, "theta2_rad": theta2, "dx_mm": -moved[0], "dz_mm": -moved[1]}


def on_one_clock(columns: Columns, started_s: Sequence[float]) -> Columns:
    """Each test counts its time from its own start; `started_s` are the starts of the runs, in order. A
    controller whose clock is ahead of ours (a simulation faster than time) still gets one test after the
    other."""
    time_s, end_s = columns["t_s"].astype(float), 0.0
    for run, start_s in zip(np.unique(columns["run"]).tolist(), started_s, strict=True):
        rows = columns["run"] == run
        time_s[rows] += max(start_s - started_s[0], end_s)
        end_s = float(time_s[rows].max())
    return {**columns, "t_s": time_s}


def added(before: Columns, new: Columns, pause_s: float | None) -> Columns:
    """`new` behind `before`: runs counted on, a posture that is there already as a repeat of its
    configuration, any other as the next. `pause_s` lies between the last reading and the new test's start;
    None: unknown."""
    config, rep = _place(before, new)
    moved: Mapping[str, np.ndarray] = {
        **new,
        "run": new["run"] - new["run"].min() + before["run"].max() + 1,
        "config": np.full_like(new["config"], config),
        "rep": np.full_like(new["rep"], rep),
        "t_s": new["t_s"] + before["t_s"].max() + (_PAUSE_S if pause_s is None else max(pause_s, 0.0)),
    }
    return {name: np.concatenate([before[name], moved[name]]) for name in before if name in moved}


def _place(before: Columns, new: Columns) -> tuple[int, int]:
    """(configuration, repeat) of new rows, by the posture of their first one."""
    for config in np.unique(before["config"]):
        rows = before["config"] == config
        first = int(np.flatnonzero(rows)[0])
        away_rad = [abs(before[name][first] - new[name][0]) for name in ("theta1_rad", "theta2_rad")]
        if max(away_rad) < SAME_POSTURE_RAD:
            return int(config), int(before["rep"][rows].max()) + 1
    return int(before["config"].max()) + 1, int(new["rep"].min())


def _tip(theta1_rad: np.ndarray, theta2_rad: np.ndarray, femur_mm: float, tibia_mm: float) -> np.ndarray:
    shank = theta1_rad - theta2_rad
    return np.stack(
        [
            femur_mm * np.cos(theta1_rad) + tibia_mm * np.cos(shank),
            femur_mm * np.sin(theta1_rad) + tibia_mm * np.sin(shank),
        ]
    )
