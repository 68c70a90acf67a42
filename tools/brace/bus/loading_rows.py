"""Rows of a controller's loading tests as a dataset's: where the motors stood at each reading, several
postures as configurations 1..n of one record, one clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.model import LimbModel
from brace.stiffness.at_rest import PostureError, yields_across
from brace.stiffness.in_space_under_load import LoadedLimbInSpace
from brace.stiffness.under_load import LoadedLimb

Columns = dict[str, np.ndarray]
SAME_POSTURE_RAD = 0.01
ASIDE_RAD = 0.01  # of the controller's central differences (firmware/app/src/jobs/loading/levers.c)
LEAST_KNEE_SINE = 1e-3
PRELOADS = ("preload_x_n", "preload_z_n")
_PAUSE_S = 1.0  # between two tests of which nobody knows how far they were apart
_ANGLES = ("theta1_rad", "theta2_rad")
_MOVED = ("dx_mm", "dz_mm")
_FORCES = ("fx_n", "fz_n")


def with_motor_angles(columns: Columns, model: LimbModel) -> Columns:
    """The same rows, each with the commanded angles at which its motors stood, and with the tip's displacement on its arc
    from the run's first reading. `model` is the controller's; forces are those on the tip, what it was pressed with
    before the test included.

    A controller presses by moving its motors: the tip stays, and the shape that the limb would have moves away. It
    reports (dx, dz) by the levers of the posture and the load that the run began at. The same levers give the motors'
    angles back, at which the limb's stiffness is the reading's, and the angles show where the unloaded tip is. Taken
    as constant, or the arc as straight, they leave an error that grows with the stroke's square; taken as the straight
    links', levers of a foot that is pressed with 20 N are off by up to a third."""
    starts = run_starts(columns["run"])
    theta = np.stack([columns[name].astype(float) for name in _ANGLES])
    d_mm = np.stack([columns[name].astype(float) for name in _MOVED])
    for first, last in zip(starts[:-1].tolist(), starts[1:].tolist()):
        rows = slice(first, last)
        force_n = np.array([columns[name][first] for name in _FORCES], float)
        begun = theta[:, first].copy()
        lever_mm = levers(model, begun) + _levers_of_load(model, begun, force_n)
        theta[:, rows] += _turned(lever_mm, d_mm[:, rows], model)
        d_mm[:, rows] = _tip(model, begun[:, None]) - _tip(model, theta[:, rows])
    zero = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("femur", "tibia")]
    named = {name: theta[i] - zero[i] for i, name in enumerate(_ANGLES)}
    return {**columns, **named, **{name: d_mm[i] for i, name in enumerate(_MOVED)}}


def counted_from_first(columns: Columns) -> Columns:
    """Forces as what each run's first reading, its preload point, is taken off; and that reading beside them."""
    starts = run_starts(columns["run"])
    first = {name: np.repeat(columns[name][starts[:-1]], np.diff(starts)).astype(float) for name in _FORCES}
    preload = dict(zip(PRELOADS, first.values(), strict=True))
    return {**columns, **preload, **{name: columns[name] - first[name] for name in _FORCES}}


def levers(model: LimbModel, theta_rad: np.ndarray) -> np.ndarray:
    """The straight links' levers: how far the tip goes (rows: x, z) for a unit of each angle (columns) [mm]."""
    femur_mm, tibia_mm = (model.number(f"geometry.{link}_mm") for link in ("femur", "tibia"))
    shank = theta_rad[0] - theta_rad[1]
    tibia = tibia_mm * np.array([-np.sin(shank), np.cos(shank)])
    femur = femur_mm * np.array([-np.sin(theta_rad[0]), np.cos(theta_rad[0])])
    return np.column_stack([femur + tibia, -tibia])


def _levers_of_load(model: LimbModel, theta_rad: np.ndarray, force_n: np.ndarray) -> np.ndarray:
    """What force and weight add to the levers [mm]: the bent limb turns with its motors, and they do not. Nothing where
    the controller has no rest under the load either."""
    aside = np.array([[ASIDE_RAD, 0.0], [-ASIDE_RAD, 0.0], [0.0, ASIDE_RAD], [0.0, -ASIDE_RAD]])
    try:
        moved = _moved_mm(model, theta_rad + aside, force_n)
    except PostureError:
        return np.zeros((2, 2))
    added = np.column_stack([moved[0] - moved[1], moved[2] - moved[3]]) / (2.0 * ASIDE_RAD)
    return added if np.isfinite(added).all() else np.zeros((2, 2))


def _moved_mm(model: LimbModel, theta_rad: np.ndarray, force_n: np.ndarray) -> np.ndarray:
    """How far force and weight move the tip in the plane at true angles, places x 2 (x, z) [mm]."""
    if not yields_across(model):
        forces = [np.full(len(theta_rad), value) for value in force_n]
        found = LoadedLimb(model).stiffness(theta_rad[:, 0], theta_rad[:, 1], *forces)
    else:
        zero = [model.number(f"joint.{joint}.zero_offset_rad") for joint in ("femur", "tibia")]
        angles = np.column_stack([np.zeros(len(theta_rad)), theta_rad - zero])
        found = LoadedLimbInSpace(model).stiffness(angles, np.tile([force_n[0], 0.0, force_n[1]], (len(angles), 1)))
    return np.column_stack([found["tip_dx_mm"], found["tip_dz_mm"]]).astype(float)


def _turned(lever_mm: np.ndarray, d_mm: np.ndarray, model: LimbModel) -> np.ndarray:
    """The motors' turns (2 x rows) of which the controller reports (dx, dz)."""
    least = LEAST_KNEE_SINE * model.number("geometry.femur_mm") * model.number("geometry.tibia_mm")
    if abs(np.linalg.det(lever_mm)) < least:
        return np.zeros_like(d_mm)  # nearly straight: levers hardly determine the angles; the run's own are as good
    return -np.linalg.solve(lever_mm, d_mm)


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
    None: unknown. A record begun before preloads were reported is one of limbs that began at rest."""
    config, rep = _place(before, new)
    moved: Mapping[str, np.ndarray] = {
        **new,
        "run": new["run"] - new["run"].min() + before["run"].max() + 1,
        "config": np.full_like(new["config"], config),
        "rep": np.full_like(new["rep"], rep),
        "t_s": new["t_s"] + before["t_s"].max() + (_PAUSE_S if pause_s is None else max(pause_s, 0.0)),
    }
    at_rest = {name: np.zeros(len(before["run"])) for name in PRELOADS}
    return {name: np.concatenate([rows, moved[name]]) for name, rows in {**at_rest, **before}.items() if name in moved}


def _place(before: Columns, new: Columns) -> tuple[int, int]:
    """(configuration, repeat) of new rows, by the posture of their first one."""
    for config in np.unique(before["config"]):
        rows = before["config"] == config
        first = int(np.flatnonzero(rows)[0])
        away_rad = [abs(before[name][first] - new[name][0]) for name in ("theta1_rad", "theta2_rad")]
        if max(away_rad) < SAME_POSTURE_RAD:
            return int(config), int(before["rep"][rows].max()) + 1
    return int(before["config"].max()) + 1, int(new["rep"].min())


def _tip(model: LimbModel, theta_rad: np.ndarray) -> np.ndarray:
    """Of straight links, 2 x rows [mm]."""
    femur_mm, tibia_mm = (model.number(f"geometry.{link}_mm") for link in ("femur", "tibia"))
    shank = theta_rad[0] - theta_rad[1]
    return np.stack(
        [
            femur_mm * np.cos(theta_rad[0]) + tibia_mm * np.cos(shank),
            femur_mm * np.sin(theta_rad[0]) + tibia_mm * np.sin(shank),
        ]
    )
