"""Does a pose's number stand for one pose, and a step's number for one displacement?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.check_runs import ANGLE_SAME_RAD, MAX_LISTED, run_starts
from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
ANGLES = ("theta1_rad", "theta2_rad")
SHARED = 0.9  # of the runs that go through the same displacements
FEW = 3  # entries of a run that may be slips; more are another plan


def faults(columns: Columns, step_mm: float) -> list[DataFault]:
    """Both checks; for records whose angles and displacements a rig holds."""
    return [*_one_pose(columns), *_one_path(columns, step_mm)]


def _one_pose(columns: Columns) -> Iterator[DataFault]:
    """A run whose angles are not those of its pose's other runs; if another pose has them, the number is wrong."""
    first = run_starts(columns["run"])[:-1]
    config = columns["config"][first]
    angles = np.column_stack([columns[name][first] for name in ANGLES])
    configs, group = np.unique(config, return_inverse=True)
    order = np.argsort(group, kind="stable")
    ends = np.cumsum(np.bincount(group))
    begins = np.concatenate([[0], ends[:-1]])
    ordered = angles[order]
    spread = np.maximum.reduceat(ordered, begins) - np.minimum.reduceat(ordered, begins)
    wrong = np.flatnonzero((spread > ANGLE_SAME_RAD).any(axis=1))
    usual = {
        int(c): np.median(angles[order[b:e]], axis=0) for c, b, e in zip(configs[wrong], begins[wrong], ends[wrong])
    }
    listed = 0
    for place in wrong:
        members = order[begins[place] : ends[place]]
        middle = usual[int(configs[place])]
        for index in members:
            off = np.abs(angles[index] - middle)
            if not (off > ANGLE_SAME_RAD).any() or listed >= MAX_LISTED:
                continue
            listed += 1
            row, run = int(first[index]) + 1, columns["run"][first[index]]
            others = np.flatnonzero(
                (config != config[index]) & (np.abs(angles - angles[index]) <= ANGLE_SAME_RAD).all(axis=1)
            )
            if others.size:
                yield DataFault(
                    row,
                    "config",
                    f"run {run} is said to be at pose {config[index]} and has the angles of pose {config[others[0]]}",
                    float(config[others[0]]),
                )
                continue
            for name, value, normal, far in zip(ANGLES, angles[index], middle, off):
                if far > ANGLE_SAME_RAD:
                    yield DataFault(
                        row,
                        name,
                        f"{value:g} in run {run}; the other runs of pose {config[index]} have {normal:g}",
                        float(normal),
                    )


def _one_path(columns: Columns, step_mm: float) -> Iterator[DataFault]:
    """Where all runs go through the same displacements, step by step, an entry that differs is a slip."""
    starts = run_starts(columns["run"])
    lengths = np.diff(starts)
    length = int(np.median(lengths))
    whole = np.flatnonzero(lengths == length)
    if whole.size < 5 or length < 4:
        return
    rows = starts[:-1][whole][:, None] + np.arange(length)
    if not (columns["step"][rows] == columns["step"][rows[0]]).all():
        return
    along_z = columns["axis"][rows[:, 0]] == 1
    path = np.where(along_z[:, None], columns["dz_mm"][rows], columns["dx_mm"][rows])
    usual = np.median(path, axis=0)
    step = step_mm if step_mm > 0.0 else float(np.median(np.abs(np.diff(usual))))
    off = np.abs(path - usual) > 0.4 * step
    count = off.sum(axis=1)
    if step <= 0.0 or np.mean(count == 0) < SHARED:
        return
    for run in np.flatnonzero((count > 0) & (count <= FEW))[:MAX_LISTED]:
        name = "dz_mm" if along_z[run] else "dx_mm"
        for place in np.flatnonzero(off[run]):
            row = int(rows[run, place])
            yield DataFault(
                row + 1,
                name,
                f"{path[run, place]:g} at step {columns['step'][row]} of run {columns['run'][row]}; the other runs "
                f"have {usual[place]:g} there",
                float(usual[place]),
            )
