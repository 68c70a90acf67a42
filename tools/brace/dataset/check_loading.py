"""What can be wrong with a loading record, before any physics is blamed: order, duplicates, units, signs,
slipped decimals, forces beyond the sensor."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.columns import FULL_TURN_RAD
from brace.dataset.faults import DataFault
from brace.dataset.meta import Meta
from brace.dataset.unit_slips import LENGTH_SLIPS, slip_of

Columns = Mapping[str, np.ndarray]
MAX_LISTED = 20  # faults of one sort that are listed singly
ANGLE_SLACK_RAD = 1e-6


def faults(columns: Columns, meta: Meta) -> list[DataFault]:
    """Every fault found, file order within each check; empty for a sound record."""
    found = [*_time(columns), *_duplicates(columns), *_angles(columns), *_steps(columns, meta),
             *_sensor_range(columns, meta)]
    if any(fault.blocking for fault in found):
        return found  # slopes mean nothing while units or order are wrong
    return [*found, *_signs(columns), *_slipped_decimals(columns, meta)]


def run_starts(run: np.ndarray) -> np.ndarray:
    """Index of the first row of every run, and the number of rows at the end."""
    return np.concatenate([[0], np.flatnonzero(np.diff(run)) + 1, [run.size]])


def _time(columns: Columns) -> Iterator[DataFault]:
    back = np.flatnonzero(np.diff(columns["t_s"]) < 0)
    for row in back[:MAX_LISTED]:
        yield DataFault(int(row) + 2, "t_s", "time runs backwards: creep, drift and friction follow the order")
    starts = run_starts(columns["run"])[:-1]
    names, counts = np.unique(columns["run"][starts], return_counts=True)
    if (counts > 1).any():
        run = names[counts > 1][0]
        again = starts[columns["run"][starts] == run][1]
        yield DataFault(int(again) + 1, "run", f"run {run} goes on after another run: rows are out of order or "
                                               "a number was used twice")


def _duplicates(columns: Columns) -> Iterator[DataFault]:
    table = np.column_stack([values.astype(float) for values in columns.values()])
    same = np.flatnonzero((table[1:] == table[:-1]).all(axis=1)) + 1
    if not same.size:  # elsewhere than right below each other? A hash per row finds candidates
        keys = _row_keys(table)
        _, first, counts = np.unique(keys, return_index=True, return_counts=True)
        if (counts > 1).any():
            repeated = np.flatnonzero(np.isin(keys, keys[first[counts > 1]]))
            same = np.setdiff1d(repeated, first)
    for row in same[:MAX_LISTED]:
        yield DataFault(int(row) + 1, "t_s", f"the row repeats another one entry by entry "
                                             f"({same.size} such row{'s' if same.size > 1 else ''})")


def _row_keys(table: np.ndarray) -> np.ndarray:
    """A 64-bit key for each row; equal rows have equal keys."""
    words = (table + 0.0).view(np.uint64)
    keys = np.zeros(table.shape[0], dtype=np.uint64)
    for column in range(table.shape[1]):
        keys ^= words[:, column] + np.uint64(0x9E3779B97F4A7C15) + (keys << np.uint64(6)) + (keys >> np.uint64(2))
        keys *= np.uint64(0xBF58476D1CE4E5B9)
    return keys


def _angles(columns: Columns) -> Iterator[DataFault]:
    theta = {name: columns[name] for name in ("theta1_rad", "theta2_rad")}
    if not any((np.abs(values) > FULL_TURN_RAD + ANGLE_SLACK_RAD).any() for values in theta.values()):
        return
    in_degrees = all((np.abs(values) <= 360.0).all() for values in theta.values())
    for name, values in theta.items():
        row = int(np.argmax(np.abs(values)))
        why = f"{values[row]:g} is more than a turn"
        if in_degrees:
            why += "; both angle columns fit only in degrees"
        yield DataFault(None if in_degrees else row + 1, name, why,
                        "degrees: multiply by pi/180" if in_degrees else None)


def _steps(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    step_mm = meta.number("rig.step_mm")
    inside = np.diff(columns["run"]) == 0
    moved = np.hypot(np.diff(columns["dx_mm"]), np.diff(columns["dz_mm"]))[inside]
    moved = moved[moved > 0]
    if not moved.size:
        yield DataFault(None, "dx_mm", "the tip never moves within a run: there is nothing to learn from")
        return
    typical_mm = float(np.median(moved))
    if step_mm <= 0 or 0.5 < typical_mm / step_mm < 2.0:
        return
    unit, factor = slip_of(typical_mm / step_mm, LENGTH_SLIPS)
    why = f"steps of {typical_mm:.4g} in the record, rig.step_mm = {step_mm:g} in meta.toml"
    for name in ("dx_mm", "dz_mm"):
        if np.any(columns[name]):
            yield DataFault(None, name, why + (f"; the column fits only in {unit}" if unit else ""),
                            f"{unit}: multiply by {factor:g}" if unit else None)


def _sensor_range(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    limit_n = meta.number("sensor.range_n")
    if math.isinf(limit_n):
        return
    slack_n = 0.5 * meta.number("sensor.resolution_n") + 1e-9 * limit_n
    for name in ("fx_n", "fz_n"):
        beyond = np.flatnonzero(np.abs(columns[name]) > limit_n + slack_n)
        if beyond.size > 0.5 * columns[name].size:
            yield DataFault(None, name, f"most readings are beyond the sensor's {limit_n:g} N: the column cannot be "
                                        "in N", "mN: multiply by 0.001")
            continue
        for row in beyond[:MAX_LISTED]:
            yield DataFault(int(row) + 1, name, f"{columns[name][row]:g} N is beyond the sensor's {limit_n:g} N")
        held = np.flatnonzero(np.abs(np.abs(columns[name]) - limit_n) <= 1e-9 * limit_n)
        if held.size > 1:
            yield DataFault(int(held[0]) + 1, name, f"{held.size} readings stand at the sensor's limit of "
                                                    f"{limit_n:g} N: clipped", blocking=False)


def _slopes(columns: Columns) -> Iterator[tuple[int, int, int, np.ndarray, np.ndarray, np.ndarray]]:
    """For each run: first row, config, axis, slopes (fx, fz) [N/mm] over the driven displacement, residual rms
    (fx, fz) [N], standard errors of the slopes."""
    starts = run_starts(columns["run"])
    force = np.column_stack([columns["fx_n"], columns["fz_n"]])
    tip = np.column_stack([columns["dx_mm"], columns["dz_mm"]])
    for first, last in zip(starts[:-1], starts[1:]):
        axis = int(columns["axis"][first])
        d = tip[first:last, axis] - tip[first:last, axis].mean()
        power = float(d @ d)
        if last - first < 4 or power == 0.0:
            continue
        f = force[first:last] - force[first:last].mean(axis=0)
        slope = d @ f / power
        rms = np.sqrt(np.mean((f - np.outer(d, slope)) ** 2, axis=0))
        yield int(first), int(columns["config"][first]), axis, slope, rms, rms / math.sqrt(power) + 1e-12


def _signs(columns: Columns) -> Iterator[DataFault]:
    """A driven force that falls as the tip is pushed on, or a cross force that no other run of its pose (nor its
    reciprocal) agrees with in sign."""
    runs = list(_slopes(columns))
    cross: dict[int, list[float]] = {}
    for _, config, axis, slope, _, _ in runs:
        cross.setdefault(config, []).append(float(slope[1 - axis]))
    falling = {name: [run for run in runs if run[2] == axis and run[3][axis] < -5 * run[5][axis]]
               for axis, name in enumerate(("fx_n", "fz_n"))}
    for axis, name in enumerate(("fx_n", "fz_n")):
        driven = [run for run in runs if run[2] == axis]
        if driven and len(falling[name]) == len(driven):
            yield DataFault(None, name, "the force falls in every run that pushes along its axis: no limb does",
                            "the column with its sign turned")
            return
        for first, *_ in falling[name][:MAX_LISTED]:
            yield DataFault(first + 1, name, f"run {columns['run'][first]}: the force falls as the tip is pushed "
                                             "along its axis: no limb does", "the run with this sign turned")
    for first, config, axis, slope, _, error in runs:
        others = cross[config]
        middle = float(np.median(others))
        own = float(slope[1 - axis])
        if len(others) >= 3 and own * middle < 0 and abs(own + middle) < 0.3 * abs(middle) \
                and abs(own) > 5 * error[1 - axis]:
            name = ("fx_n", "fz_n")[1 - axis]
            yield DataFault(first + 1, name, f"run {columns['run'][first]}: slope {own:+.3g} N/mm where the pose's "
                                             f"other runs have {middle:+.3g}", "the run with this sign turned")


def _slipped_decimals(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    """A single reading far off both its repeats and the straight line between its neighbours, and in place once
    its decimal point is moved."""
    starts = run_starts(columns["run"])
    floor_n = max(meta.number("sensor.resolution_n"), 1e-3)
    for name in ("fx_n", "fz_n"):
        force = columns[name]
        expected = np.empty_like(force)
        expected[1:-1] = 0.5 * (force[:-2] + force[2:])
        for first, last in zip(starts[:-1], starts[1:]):
            if last - first < 3:
                expected[first:last] = force[first:last]
                continue
            expected[first], expected[last - 1] = force[first], force[last - 1]
            turns = first + 1 + np.flatnonzero(_turning(columns, first, last))
            expected[turns] = 2 * force[turns - 1] - np.where(turns - 2 >= first, force[turns - 2], force[turns - 1])
        off = np.abs(force - expected)
        span = np.ptp(force) or 1.0
        typical = max(float(np.median(off)), floor_n)
        suspects = np.flatnonzero((off > 12 * typical) & (np.abs(force) > 12 * typical))
        for row in suspects[:200]:
            for factor in (0.1, 10.0, 0.01, 100.0):
                if abs(force[row] * factor - expected[row]) < max(4 * typical, 0.02 * abs(expected[row])) \
                        and off[row] > 0.1 * min(span, abs(expected[row]) * 10):
                    yield DataFault(int(row) + 1, name, f"{force[row]:g} stands out of its run; its neighbours lead to "
                                    f"{expected[row]:.3g}: a slipped decimal point", float(force[row] * factor),
                                    repair=True)
                    break


def _turning(columns: Columns, first: int, last: int) -> np.ndarray:
    """Inner rows of a run at which the displacement turns back."""
    d = columns["dx_mm"][first:last] + columns["dz_mm"][first:last]
    steps = np.diff(d)
    return steps[:-1] * steps[1:] < 0
