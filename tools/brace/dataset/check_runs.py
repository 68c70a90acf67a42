"""Does a loading record agree with itself? A run is one pass along one axis at one pose, on a clock that runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
MAX_LISTED = 20  # faults of one sort that are listed singly
ANGLE_SAME_RAD = 1e-3  # a commanded angle is one number for the whole run
ANGLE_PRESSED_RAD = 0.15  # unless the limb presses by its own motors: then it stays near
_AXIS_NAMES = ("x", "z")


def faults(columns: Columns, moved_by_motors: bool = False) -> list[DataFault]:
    """Every contradiction within the runs."""
    same = ANGLE_PRESSED_RAD if moved_by_motors else ANGLE_SAME_RAD
    found = [*_pose(columns, same), *_clock(columns), *_axis_changes(columns)]
    if moved_by_motors:
        return found
    return found or [*_axis_against_motion(columns)]


def run_starts(run: np.ndarray) -> np.ndarray:
    """Index of the first row of every run, and the number of rows at the end."""
    return np.concatenate([[0], np.flatnonzero(np.diff(run)) + 1, [run.size]])


ALIKE, APART = 0.3, 5.0  # of how far a reading stands aside, and of what readings usually do


def in_other_runs(aside: np.ndarray, typical: float, run: np.ndarray, axis: np.ndarray, row: int) -> bool:
    """Whether another run along the same axis stands aside to the same side at the same place of its pass. What comes
    again is of the limb, as a friction's turn after each reversal is, and no slip of one entry. `aside` is how far each
    row stands from what is due there, `typical` how far rows usually do."""
    starts = run_starts(run)[:-1]
    place = row - int(starts[starts <= row][-1])
    rows = starts + place
    rows = rows[rows < run.size]
    same = (run[rows] == run[rows - place]) & (run[rows] != run[row]) & (axis[rows] == axis[row])
    least = max(ALIKE * abs(float(aside[row])), APART * typical)
    return bool(np.any(aside[rows[same]] * np.sign(aside[row]) > least))


def span(values: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Largest less smallest value of each run."""
    return np.asarray(np.maximum.reduceat(values, starts[:-1]) - np.minimum.reduceat(values, starts[:-1]))


def _pose(columns: Columns, same_rad: float) -> Iterator[DataFault]:
    """Angles and the pose's number hold through a run."""
    starts, run = run_starts(columns["run"]), columns["run"]
    for name, same in (("theta1_rad", same_rad), ("theta2_rad", same_rad), ("config", 0.5)):
        values = columns[name].astype(float)
        listed = 0
        for index in np.flatnonzero(span(values, starts) > same):
            rows = np.arange(starts[index], starts[index + 1])
            usual = float(np.median(values[rows]))
            for row in rows[np.abs(values[rows] - usual) > same]:
                listed += 1
                if listed <= MAX_LISTED:
                    yield DataFault(
                        int(row) + 1,
                        name,
                        f"{values[row]:g} in a run (number {run[row]}) that otherwise has {usual:g}: a run is "
                        "one pass at one pose",
                        usual,
                    )


def _clock(columns: Columns) -> Iterator[DataFault]:
    starts, time = run_starts(columns["run"]), columns["t_s"]
    if time.size > 2 and np.ptp(time) == 0.0:
        yield DataFault(None, "t_s", f"the clock stands at {time[0]:g} s through the whole record")
        return
    stands = (np.diff(starts) > 2) & (span(time, starts) == 0.0)
    for index in np.flatnonzero(stands)[:MAX_LISTED]:
        row = int(starts[index])
        yield DataFault(
            row + 1, "t_s", f"the clock stands at {time[row]:g} s through run {columns['run'][row]}"
        )


def _axis_changes(columns: Columns) -> Iterator[DataFault]:
    starts, axis = run_starts(columns["run"]), columns["axis"]
    for index in np.flatnonzero(span(axis, starts) > 0)[:MAX_LISTED]:
        rows = np.arange(starts[index], starts[index + 1])
        moved = [float(np.ptp(columns[name][rows])) for name in ("dx_mm", "dz_mm")]
        usual = int(moved[1] > moved[0]) if moved[0] != moved[1] else int(np.mean(axis[rows]) > 0.5)
        for row in rows[axis[rows] != usual][:MAX_LISTED]:
            yield DataFault(
                int(row) + 1,
                "axis",
                f"{_AXIS_NAMES[axis[row]]} in run {columns['run'][row]}, which moves along {_AXIS_NAMES[usual]}",
                _AXIS_NAMES[usual],
            )


def _axis_against_motion(columns: Columns) -> Iterator[DataFault]:
    """`axis` names the column that moves; a preload holds both columns off 0 through a whole run."""
    along_z, starts = columns["axis"] == 1, run_starts(columns["run"])
    x, z = (_from_middle(columns[name], starts) for name in ("dx_mm", "dz_mm"))
    named = np.abs(np.where(along_z, z, x))
    other = np.abs(np.where(along_z, x, z))
    steps = np.hypot(np.diff(columns["dx_mm"]), np.diff(columns["dz_mm"]))
    steps = steps[steps > 0.0]
    if not steps.size:
        return
    still_mm = 0.4 * float(np.median(steps))
    moves = np.maximum.reduceat(np.maximum(named, other), starts[:-1]) > still_mm
    across = moves & (np.maximum.reduceat(named, starts[:-1]) <= still_mm)
    if across.any() and across[moves].all():
        yield from _exchanged(columns)
        return
    for index in np.flatnonzero(across)[:MAX_LISTED]:
        row = int(starts[index])
        says = _AXIS_NAMES[columns["axis"][row]]
        moving = _AXIS_NAMES[1 - columns["axis"][row]]
        yield DataFault(
            row + 1,
            "axis",
            f"run {columns['run'][row]} is said to go along {says}, and d{moving}_mm moves",
            moving,
        )
    across_rows = np.repeat(across, np.diff(starts))
    for row in np.flatnonzero((other > still_mm) & ~across_rows)[:MAX_LISTED]:
        says, moving = _AXIS_NAMES[columns["axis"][row]], _AXIS_NAMES[1 - columns["axis"][row]]
        yield DataFault(
            int(row) + 1,
            f"d{moving}_mm",
            f"{columns[f'd{moving}_mm'][row]:g} in run {columns['run'][row]}, which goes along {says}",
            f"0, and the entry in d{says}_mm" if named[row] <= still_mm else 0.0,
        )


def _from_middle(values: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Less each run's median."""
    middle = [float(np.median(values[begin:end])) for begin, end in zip(starts[:-1], starts[1:])]
    return np.asarray(values - np.repeat(middle, np.diff(starts)))


def _exchanged(columns: Columns) -> Iterator[DataFault]:
    """Axis and motion disagree in every run. K is positive definite, so its determinant shows which of the two is
    wrong: exchanging the displacement columns turns its sign."""
    why = "the axis column names the direction that does not move, in every run"
    sign = _determinant_sign(columns)
    if sign >= 0:
        yield DataFault(None, "axis", why, "x and z exchanged")
    if sign <= 0:
        for name in ("dx_mm", "dz_mm"):
            yield DataFault(None, name, why, "the columns dx_mm and dz_mm exchanged")


def _determinant_sign(columns: Columns) -> int:
    """Of the forces' slopes over the displacement columns as they are labelled; 0 when it is not known."""
    signs = []
    for config in np.unique(columns["config"])[:500]:
        rows = columns["config"] == config
        d = np.column_stack([columns["dx_mm"][rows], columns["dz_mm"][rows]])
        f = np.column_stack([columns["fx_n"][rows], columns["fz_n"][rows]])
        slopes, _, rank, _ = np.linalg.lstsq(d - d.mean(axis=0), f - f.mean(axis=0), rcond=1e-9)
        if rank == 2:
            signs.append(np.sign(np.linalg.det(slopes)))
    mean = float(np.mean(signs)) if signs else 0.0
    return int(np.sign(mean)) if abs(mean) > 0.5 else 0
