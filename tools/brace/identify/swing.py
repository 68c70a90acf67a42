"""The passes of a joint test from one reversal to the next, and what they say of free travel."""

from __future__ import annotations

import numpy as np

RAMP_SHARE = 0.25  # of the range of angles that a turn must be followed by to count as one
MIN_READINGS = 20
LAST_PART = 0.1  # of a test's range of torque, before a reversal
STANDS = 0.75  # of what a spring alone would move there


def ramps(angle_rad: np.ndarray, test: np.ndarray) -> np.ndarray:
    """The number of the monotone pass that each reading belongs to; tests share none."""
    least = RAMP_SHARE * float(np.ptp(angle_rad))
    numbers = np.zeros(angle_rad.size, dtype=int)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(test)) + 1, [test.size]])
    number = -1
    for first, last in zip(starts[:-1], starts[1:]):
        number += 1
        turn, sense = first, 0
        for row in range(first, last):
            away = angle_rad[row] - angle_rad[turn]
            if sense == 0:
                if abs(away) > least:
                    sense, turn = (1 if away > 0 else -1), row
            elif sense * away > 0:
                turn = row
            elif -sense * away > least:
                number += 1
                numbers[turn:row] = number
                sense, turn = -sense, row
            numbers[row] = number
    return numbers


def swing_over_both_flanks_rad(angle_rad: np.ndarray, torque_n_mm: np.ndarray, test: np.ndarray) -> float:
    """The least that the joint swings by in a test that leaves it standing on a flank at both ends: free travel is no
    more. inf where no test shows that: a joint that friction still lets slip at the highest torque may be anywhere in
    its gap."""
    least = np.inf
    for label in np.unique(test):
        angle, torque = angle_rad[test == label], torque_n_mm[test == label]
        swing, span = float(np.ptp(angle)), float(np.ptp(torque))
        if angle.size < MIN_READINGS or torque.max() <= 0.0 or torque.min() >= 0.0 or swing == 0.0:
            continue  # a joint that friction holds where it is shows no travel, free or not
        slipped: dict[int, float] = {}  # by the end that a pass leads to, the most of the swing in its last part
        number = ramps(torque, np.zeros(torque.size))
        for one in np.unique(number):
            rows = np.flatnonzero(number == one)
            way = torque[rows[-1]] - torque[rows[0]]
            side = 1 if way > 0.0 else -1
            if side * torque[rows[-1]] < (1.0 - LAST_PART) * (torque.max() if side > 0 else -torque.min()):
                continue
            before = rows[side * (torque[rows[-1]] - torque[rows]) > LAST_PART * span]
            if before.size:
                last = side * (angle[rows[-1]] - angle[before[-1]]) / max(swing, 1e-30)
                slipped[side] = max(slipped.get(side, 0.0), last)
        if len(slipped) == 2 and max(slipped.values()) < STANDS * LAST_PART:
            least = min(least, swing)
    return least
