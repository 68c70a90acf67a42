"""`brace import`: the axis and the pose of each row, of records of any length."""

from __future__ import annotations

import time

import numpy as np
import pytest

from brace.importing.runs import driven_axis, numbers_of_poses, without_turns

SAME_RAD = 1e-3


def test_a_rest_between_two_axes_is_halved() -> None:
    dx, dz = (np.array([float(c == axis) for c in "..x...zz.z..x"]) for axis in "xz")
    axis = driven_axis(dx, dz)
    assert axis is not None and "".join("xz"[n] for n in axis) == "xxxxzzzzzzzxx"


def test_poses_in_order_of_appearance() -> None:
    theta = np.array([0.3, 0.3, 0.3009, 0.7, 0.3005, 0.7, 0.9])
    assert numbers_of_poses(theta, 0.0 * theta, SAME_RAD).tolist() == [1, 1, 1, 2, 1, 2, 3]
    assert numbers_of_poses(0.0 * theta, -theta, SAME_RAD).tolist() == [1, 1, 1, 2, 1, 2, 3]


def test_a_leap_of_a_whole_turn_is_no_motion() -> None:
    """359.98 and 0.01 deg are one posture; -175 to 175 deg is a step of 10 deg; from one pose to another is none."""
    angle, leaps = without_turns(np.radians([359.98, 0.01, 0.0, 359.99]))
    assert leaps == 2 and np.degrees(angle) == pytest.approx([-0.02, 0.01, 0.0, -0.01], abs=1e-9)
    angle, leaps = without_turns(np.radians([179.9, -179.9, -179.8]))
    assert leaps == 1 and np.degrees(np.diff(angle)) == pytest.approx([0.2, 0.1], abs=1e-9)
    for poses in ([10.0, 350.0 - 20.0], [-160.0, 170.0], [355.0, 355.1]):
        assert without_turns(np.radians(poses))[1] == 0


def test_long_records_take_no_longer_than_their_rows() -> None:
    """A rest of 200,000 rows took hours, and as many poses did."""
    rows = 200_000
    started = time.process_time()
    moved = np.zeros(rows)
    moved[:100] = 1.0
    axis = driven_axis(moved, moved[::-1])
    assert axis is not None and np.flatnonzero(np.diff(axis)).tolist() == [rows // 2 - 1]
    theta = np.linspace(0.0, 1.5 * SAME_RAD * rows, rows)
    assert numbers_of_poses(theta, theta, SAME_RAD)[-1] == rows
    assert time.process_time() - started < 20.0
