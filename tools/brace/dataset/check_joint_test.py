"""What can be wrong with a joint test: order of time, a stuck column, a drive at its limit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.columns import FULL_TURN_RAD
from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
SATURATED_SHARE = 0.8  # of the command: a drive that follows delivers more


def faults(columns: Columns) -> list[DataFault]:
    """Every fault found; empty for a sound record. Rows at the drive's limit are noted, not refused."""
    return [*_time(columns), *_stuck(columns), *_angle(columns), *_saturation(columns)]


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
    worst = int(np.argmax(np.abs(columns["angle_rad"])))
    if abs(columns["angle_rad"][worst]) > FULL_TURN_RAD:
        yield DataFault(
            None,
            "angle_rad",
            f"{columns['angle_rad'][worst]:g} is more than a turn: the column fits " "only in degrees",
            "degrees: multiply by pi/180",
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
