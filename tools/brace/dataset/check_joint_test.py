"""What can be wrong with a joint test: order of time, a stuck column, a drive at its limit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.columns import FULL_TURN_RAD
from brace.dataset.faults import DataFault
from brace.dataset.unit_slips import slip_of

Columns = Mapping[str, np.ndarray]
MAX_DEFLECTION_RAD = 1.0  # range of deflections; play and spring of a limb's joint together
SOFTEST_N_MM_PER_RAD = 1e3  # a limb of half a metre would yield a metre per newton
LEAST_N_MM = 100.0  # from end to end of a joint test; a limb of 1 N on a lever of 100 mm needs as much
FALLING = -0.3  # correlation of torque and deflection below which the sign is wrong
COARSE_CLOCK_SHARE = 0.01  # of rows, that repeat by chance
# ratio of delivered to commanded torque -> the unit it is written in, the factor that mends it
TORQUE_SLIPS = {1e-3: ("N m", 1e3), 1e3: ("uN m", 1e-3), 1 / 112.98: ("lbf in", 112.98), 1e-6: ("kN m", 1e6)}
SATURATED_SHARE = 0.8  # of the command: a drive that follows delivers more


def faults(columns: Columns) -> list[DataFault]:
    """Every fault found; empty for a sound record. Rows at the drive's limit and repeated rows are noted, not
    refused."""
    found = [*_time(columns), *_stuck(columns), *_angle(columns), *_duplicates(columns)]
    wrong = list(_torque_unit(columns)) or list(_direction(columns))
    return [*found, *(wrong or _saturation(columns))]


def _time(columns: Columns) -> Iterator[DataFault]:
    same_test = np.diff(columns["test"]) == 0 if "test" in columns else True
    for row in np.flatnonzero((np.diff(columns["t_s"]) < 0) & same_test)[:20]:
        yield DataFault(int(row) + 2, "t_s", "time runs backwards within a test")


def _stuck(columns: Columns) -> Iterator[DataFault]:
    for name in ("angle_rad", "torque_n_mm"):
        if columns[name].size > 2 and np.ptp(columns[name]) == 0.0:
            yield DataFault(
                None,
                name,
                f"the column never changes ({columns[name][0]:g}): a sensor was off, or the "
                "same row was written again and again",
            )


def _angle(columns: Columns) -> Iterator[DataFault]:
    """The zero is the encoder's, so the range is what shows the unit; a record in radians stays far below one."""
    angle = columns["angle_rad"]
    range_rad, worst = float(np.ptp(angle)), float(angle[int(np.argmax(np.abs(angle)))])
    if range_rad > MAX_DEFLECTION_RAD or abs(worst) > FULL_TURN_RAD:
        what = f"a range of {range_rad:.3g}" if range_rad > MAX_DEFLECTION_RAD else f"{worst:g}"
        yield DataFault(
            None,
            "angle_rad",
            f"{what} is more than a joint yields or turns: the column fits only in degrees",
            "degrees: multiply by pi/180",
        )


def _duplicates(columns: Columns) -> Iterator[DataFault]:
    """A coarse clock gives equal rows now and then, next to each other; many, or whole stretches again, are a
    copy."""
    table = np.column_stack([values.astype(float) for values in columns.values()])
    same = np.flatnonzero((table[1:] == table[:-1]).all(axis=1)) + 1
    repeats_of_time = np.count_nonzero(np.diff(columns["t_s"]) == 0.0)
    coarse_clock = repeats_of_time > 2 * same.size and same.size <= COARSE_CLOCK_SHARE * len(table)
    if not coarse_clock and same.size:
        yield DataFault(
            int(same[0]) + 1,
            "t_s",
            f"the row repeats the one above entry by entry ({same.size} such row{'s' if same.size > 1 else ''})",
            blocking=False,
        )


def _torque_unit(columns: Columns) -> Iterator[DataFault]:
    """Against the command, or else against what the softest joint of a limb holds."""
    torque, angle = columns["torque_n_mm"], columns["angle_rad"]
    unit, factor, why = "", 1.0, ""
    if "command_n_mm" in columns:
        command_n_mm = float(np.quantile(np.abs(columns["command_n_mm"]), 0.9))
        delivered = float(np.quantile(np.abs(torque), 0.9))
        if command_n_mm > 0.0 and delivered > 0.0:
            unit, factor = slip_of(delivered / command_n_mm, TORQUE_SLIPS, 2.5)
            why = f"{delivered:.3g} where {command_n_mm:.3g} N mm is commanded"
    if not unit and 0.0 < np.ptp(torque) < SOFTEST_N_MM_PER_RAD * np.ptp(angle):
        unit, factor = TORQUE_SLIPS[1e-3]
        why = f"a range of {np.ptp(torque):.3g} N mm over {np.ptp(angle):.3g} rad holds no limb"
    if not unit and 0.0 < np.ptp(torque) < LEAST_N_MM:
        unit, factor = TORQUE_SLIPS[1e-3]
        why = f"a range of {np.ptp(torque):.3g} N mm turns no joint of a limb"
    if unit:
        yield DataFault(
            None, "torque_n_mm", f"{why}: the column fits only in {unit}", f"{unit}: multiply by {factor:g}"
        )


def _direction(columns: Columns) -> Iterator[DataFault]:
    """The torque in a joint rises with its deflection."""
    torque, angle = columns["torque_n_mm"], columns["angle_rad"]
    test = columns["test"] if "test" in columns else np.zeros(torque.size, np.int32)
    _, group, counts = np.unique(test, return_inverse=True, return_counts=True)

    def centred(values: np.ndarray) -> np.ndarray:
        return np.asarray(values - (np.bincount(group, weights=values) / counts)[group])

    t, a = centred(torque), centred(angle)
    size = float(np.sqrt((t @ t) * (a @ a)))
    if size > 0.0 and (t @ a) / size < FALLING:
        yield DataFault(
            None,
            "angle_rad",
            "the torque falls as the deflection grows: a joint pushes back, so one of the two columns has its sign "
            "turned",
            "angle_rad (or torque_n_mm) with its sign turned",
        )


def _saturation(columns: Columns) -> Iterator[DataFault]:
    """The command goes on rising and the torque does not: a row at the drive's limit says nothing of the joint."""
    if "command_n_mm" not in columns:
        return
    command, torque = np.abs(columns["command_n_mm"]), np.abs(columns["torque_n_mm"])
    limit = float(np.quantile(torque, 0.999))
    held = np.flatnonzero((SATURATED_SHARE * command > limit) & (torque > 0.8 * limit))
    if held.size > 10:
        yield DataFault(
            int(held[0]) + 1,
            "torque_n_mm",
            f"the drive stands at its limit of about {limit:.3g} N mm in {held.size} rows while up to "
            f"{command.max():.3g} N mm is commanded: saturated",
            blocking=False,
        )
