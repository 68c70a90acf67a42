"""What can be wrong with a loading record, before any physics is blamed: order, duplicates, units, signs,
slipped decimals, forces beyond the sensor."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset import check_clock, check_copies, check_poses, check_readings, check_runs, check_slopes
from brace.dataset.check_copies import row_keys
from brace.dataset.check_runs import MAX_LISTED, in_other_runs, run_starts
from brace.dataset.columns import ANGLE_LIMIT_RAD, FULL_TURN_RAD
from brace.dataset.faults import DataFault
from brace.dataset.meta import Meta
from brace.dataset.unit_slips import LENGTH_SLIPS, slip_of

Columns = Mapping[str, np.ndarray]
ANGLE_SLACK_RAD = 1e-6


def faults(columns: Columns, meta: Meta) -> list[DataFault]:
    """Every fault found, file order within each check; empty for a sound record."""
    copied = [*_duplicates(columns)]
    found = [
        *_time(columns),
        *copied,
        *([] if copied else check_clock.faults(columns, meta)),
        *_angles(columns),
        *check_runs.faults(columns, meta.moved_by_motors),
        *_steps(columns, meta),
        *check_readings.faults(columns),
    ]
    if not any(fault.blocking for fault in found) and not meta.moved_by_motors:
        found += check_poses.faults(columns, meta.number("rig.step_mm"))
    if not any(fault.blocking for fault in found):
        found += check_copies.faults(columns)
    beyond = list(_sensor_range(columns, meta))
    if any(fault.blocking for fault in found) or any(fault.row is None for fault in beyond):
        return [*found, *beyond]  # slopes mean nothing while units or order are wrong
    # motors stop where friction lets them: a step that differs from its neighbours' is no slip
    slipped = [] if meta.moved_by_motors else list(_slipped_decimals(columns, meta))
    mended = {(fault.row, fault.field) for fault in slipped}
    beyond = [fault for fault in beyond if (fault.row, fault.field) not in mended]
    return [*found, *beyond, *check_slopes.faults(columns), *slipped]


def _time(columns: Columns) -> Iterator[DataFault]:
    time, starts = columns["t_s"], run_starts(columns["run"])[:-1]
    back = np.flatnonzero(np.diff(time) < 0)
    if starts.size > 2 and np.array_equal(back + 1, starts[1:]) and np.ptp(time[starts]) < np.ptp(time[: starts[1]]):
        back = back[:0]
        yield DataFault(
            None,
            "t_s",
            f"the clock starts again with each of {starts.size} runs: creep, drift and friction follow one clock",
            "the time since the first run began, in every run",
        )
    for row in back[:MAX_LISTED]:
        # the entry before it may be the one that is wrong: then this one goes on after the one before that
        early = row > 0 and row + 2 < time.size and time[row - 1] <= time[row + 1] and time[row] > time[row + 2]
        yield DataFault(
            int(row) + (1 if early else 2), "t_s", "time runs backwards: creep, drift and friction follow the order"
        )
    names, counts = np.unique(columns["run"][starts], return_counts=True)
    if (counts > 1).any():
        run = names[counts > 1][0]
        again = starts[columns["run"][starts] == run][1]
        yield DataFault(
            int(again) + 1,
            "run",
            f"run {run} goes on after another run: rows are out of order or " "a number was used twice",
        )


def _duplicates(columns: Columns) -> Iterator[DataFault]:
    table = np.column_stack([values.astype(float) for values in columns.values()])
    same = np.flatnonzero((table[1:] == table[:-1]).all(axis=1)) + 1
    if not same.size:  # elsewhere than right below each other? A hash per row finds candidates
        keys = row_keys(table)
        _, first, counts = np.unique(keys, return_index=True, return_counts=True)
        if (counts > 1).any():
            repeated = np.flatnonzero(np.isin(keys, keys[first[counts > 1]]))
            same = np.setdiff1d(repeated, first)
    for row in same[:MAX_LISTED]:
        yield DataFault(
            int(row) + 1,
            "t_s",
            f"the row repeats another one entry by entry "
            f"({same.size} such row{'s' if same.size > 1 else ''})",
        )


def _angles(columns: Columns) -> Iterator[DataFault]:
    """A femur turns at most once round, a knee half; a column that is beyond it in many rows is in degrees."""
    for name, limit in ANGLE_LIMIT_RAD.items():
        size = np.abs(columns[name])
        beyond = np.flatnonzero(size > limit + ANGLE_SLACK_RAD)
        what = "more than a turn" if name == "theta1_rad" else "further than a knee can bend"
        if beyond.size > 0.3 * size.size and FULL_TURN_RAD < size.max() <= 360.0:
            worst = columns[name][int(np.argmax(size))]
            yield DataFault(
                None,
                name,
                f"{worst:g} is {what}; the column fits only in degrees",
                "degrees: multiply by pi/180",
            )
            continue
        for row in beyond[:MAX_LISTED]:
            degrees = FULL_TURN_RAD < size[row] <= 360.0
            yield DataFault(
                int(row) + 1,
                name,
                f"{columns[name][row]:g} is {what}" + ("; the entry fits only in degrees" if degrees else ""),
                math.radians(columns[name][row]) if degrees else None,
            )


def _steps(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    step_mm = meta.number("rig.step_mm")
    inside = np.diff(columns["run"]) == 0
    if not any(np.any(np.diff(columns[name])[inside]) for name in ("dx_mm", "dz_mm")):
        yield DataFault(None, "dx_mm", "the tip never moves within a run: there is nothing to learn from")
        return
    if step_mm <= 0:
        return
    for axis, name in enumerate(("dx_mm", "dz_mm")):
        # motors move the tip aside a little, too: only steps along the run's own axis are steps
        own = inside & (columns["axis"][1:] == axis) if meta.moved_by_motors else inside
        moved = np.abs(np.diff(columns[name])[own])
        moved = moved[moved > 1e-6 * np.ptp(columns[name])]
        if not moved.size:
            continue
        typical_mm = float(np.median(moved))
        unit, factor = slip_of(typical_mm / step_mm, LENGTH_SLIPS)
        if 0.5 < typical_mm / step_mm < 2.0 or (meta.moved_by_motors and not unit):
            continue
        why = f"steps of {typical_mm:.4g} in the record, rig.step_mm = {step_mm:g} in meta.toml"
        yield DataFault(
            None,
            name,
            why + (f"; the column fits only in {unit}" if unit else ""),
            f"{unit}: multiply by {factor:g}" if unit else None,
        )


def _sensor_range(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    limit_n = meta.number("sensor.range_n")
    if math.isinf(limit_n):
        return
    slack_n = 0.5 * meta.number("sensor.resolution_n") + 1e-9 * limit_n
    for name in ("fx_n", "fz_n"):
        beyond = np.flatnonzero(np.abs(columns[name]) > limit_n + slack_n)
        if beyond.size > 0.5 * columns[name].size:
            yield DataFault(
                None,
                name,
                f"most readings are beyond the sensor's {limit_n:g} N: the column cannot be " "in N",
                "mN: multiply by 0.001",
            )
            continue
        for row in beyond[:MAX_LISTED]:
            yield DataFault(
                int(row) + 1, name, f"{columns[name][row]:g} N is beyond the sensor's {limit_n:g} N"
            )
        held = np.flatnonzero(np.abs(np.abs(columns[name]) - limit_n) <= 1e-9 * limit_n)
        if held.size > 1:
            yield DataFault(
                int(held[0]) + 1,
                name,
                f"{held.size} readings stand at the sensor's limit of " f"{limit_n:g} N: clipped",
                blocking=False,
            )


def _share(part: np.ndarray, whole: np.ndarray, otherwise: float) -> np.ndarray:
    """part / whole in [0, 2]: where a limb's own motors move the tip, its steps are not even."""
    moves = np.abs(whole) > 1e-9
    return np.clip(np.where(moves, part / np.where(moves, whole, 1.0), otherwise), 0.0, 2.0)


def _wild_beside(columns: Columns, moved: np.ndarray, force: np.ndarray) -> np.ndarray:
    """How far the worse of a row's two neighbours lies off a line that neither of the two rows is on; 0: not known.
    A wild reading throws the line through its neighbours' neighbours off by half as much, where they are sound."""
    run = columns["run"]
    rows = np.arange(run.size)

    def off_line(at: int, one: int, two: int) -> np.ndarray:
        known = np.ones(run.size, dtype=bool)
        for step in (at, one, two):
            inside = (rows + step >= 0) & (rows + step < run.size)
            known &= inside & (np.roll(run, -step) == run)
        there, first, second = (np.roll(moved, -step) for step in (at, one, two))
        share = _share(there - first, first - second, abs(at - one))
        due = np.roll(force, -one) + share * (np.roll(force, -one) - np.roll(force, -two))
        return np.where(known, np.abs(np.roll(force, -at) - due), np.nan)

    worst = np.zeros(run.size)
    for at, lines in ((1, ((2, 3), (-1, -2))), (-1, ((-2, -3), (1, 2)))):
        near, across = (off_line(at, one, two) for one, two in lines)
        worst = np.fmax(worst, np.where(np.isnan(near), across, near))
    return worst


def _slipped_decimals(columns: Columns, meta: Meta) -> Iterator[DataFault]:
    """A single reading far off the line through its neighbours, and in place once its decimal point is moved."""
    run, floor_n = columns["run"], max(meta.number("sensor.resolution_n"), 1e-3)
    moved = columns["dx_mm"] + columns["dz_mm"]
    if run.size < 5:
        return
    inner = np.zeros(run.size, dtype=bool)
    inner[1:-1] = run[:-2] == run[2:]
    turning = np.zeros(run.size, dtype=bool)
    turning[1:-1] = (moved[1:-1] - moved[:-2]) * (moved[2:] - moved[1:-1]) < 0
    between = _share(moved - np.roll(moved, 1), np.roll(moved, -1) - np.roll(moved, 1), 0.5)
    beyond = _share(moved - np.roll(moved, 1), np.roll(moved, 1) - np.roll(moved, 2), 1.0)
    for name in ("fx_n", "fz_n"):
        force = columns[name]
        before, after = np.roll(force, 1), np.roll(force, -1)
        expected = np.where(inner, before + between * (after - before), force)
        back = inner & turning & (np.roll(run, 2) == run)
        expected = np.where(back, before + beyond * (before - np.roll(force, 2)), expected)
        expected = np.where(inner & turning & ~back, force, expected)
        off = np.abs(force - expected)
        typical = max(float(np.median(off[~np.isnan(off)])) if not np.isnan(off).all() else 0.0, floor_n)
        large = np.maximum(np.abs(force), np.abs(expected)) > 12 * typical
        for row in np.flatnonzero((off > 12 * typical) & large & (off > _wild_beside(columns, moved, force)))[:200]:
            if in_other_runs(np.nan_to_num(force - expected), typical, run, columns["axis"], int(row)):
                continue
            near = max(4 * typical, 0.02 * abs(expected[row]))
            for factor in (0.1, 10.0, 0.01, 100.0):
                if abs(force[row] * factor - expected[row]) < near and abs(force[row] * factor) > 8 * typical:
                    yield DataFault(
                        int(row) + 1,
                        name,
                        f"{force[row]:g} stands out of its run; its neighbours lead to "
                        f"{expected[row]:.3g}: a slipped decimal point",
                        float(force[row] * factor),
                        repair=True,
                        doubtful=True,
                    )
                    break
