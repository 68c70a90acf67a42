"""Where one pass along an axis ends and the next begins, in a record that does not number them."""

from __future__ import annotations

import math

import numpy as np

NEAR_ZERO_RATIO = 0.06  # of the largest displacement: the tip is back where it began
ANGLE_JUMP_RAD = 0.01  # between readings: another pose
LEAP_RAD = 0.1  # from a whole turn: no joint goes round so far from one reading to the next


def without_turns(angle_rad: np.ndarray) -> tuple[np.ndarray, int]:
    """The angles, [rad], without leaps of nearly a whole turn from reading to reading (359.9 deg and 0.1 deg are one
    posture), brought back as a whole so that their middle is the angle nearest to zero; and the number of leaps."""
    steps = np.diff(angle_rad)
    turns = np.where(np.abs(np.abs(steps) - 2.0 * math.pi) < LEAP_RAD, np.sign(steps), 0.0)
    if not turns.any():
        return angle_rad, 0
    going_on = angle_rad - 2.0 * math.pi * np.concatenate([[0.0], np.cumsum(turns)])
    whole = round(float(np.median(going_on)) / (2.0 * math.pi))
    return going_on - 2.0 * math.pi * whole, int(np.count_nonzero(turns))


def boundaries(d_mm: np.ndarray, given: np.ndarray) -> np.ndarray:
    """True where a run begins. given: True where one must begin (another pose, axis, file or number of a run).

    d_mm: displacement along the axis. Within what `given` leaves whole, a run ends where the tip is back at zero after
    having been to both sides, or to the same side again."""
    begins = given.copy()
    begins[0] = True
    starts = [*np.flatnonzero(begins).tolist(), len(d_mm)]
    for first, last in zip(starts[:-1], starts[1:]):
        for row in _returns(d_mm[first:last]):
            begins[first + row] = True
    return begins


def _returns(d_mm: np.ndarray) -> list[int]:
    """Rows at which another pass begins."""
    largest = float(np.abs(d_mm).max()) if d_mm.size else 0.0
    if largest <= 0.0:
        return []
    side = np.where(np.abs(d_mm) <= NEAR_ZERO_RATIO * largest, 0, np.sign(d_mm)).astype(int)
    found: list[int] = []
    been: set[int] = set()
    row = 0
    while row < side.size:
        end = row
        while end < side.size and side[end] == side[row]:
            end += 1
        if side[row] and side[row] in been:
            found.append(_middle_of_rest(side, row))
            been = set()
        if side[row]:
            been.add(int(side[row]))
        row = end
    return found


def _middle_of_rest(side: np.ndarray, row: int) -> int:
    """The row in the rest at zero before `row` at which the next pass begins: its last half."""
    first = row
    while first > 0 and side[first - 1] == 0:
        first -= 1
    return first + (row - first) // 2 if row > first else row


def driven_axis(dx_mm: np.ndarray, dz_mm: np.ndarray) -> np.ndarray | None:
    """0 (x) or 1 (z) a row, by which displacement is away from zero; rows at zero go with what follows. None where both
    are at once in many rows: nobody knows the axis then."""
    largest = float(np.max(np.abs(np.concatenate([dx_mm, dz_mm])))) + 1e-12
    x, z = (np.abs(d) > NEAR_ZERO_RATIO * largest for d in (dx_mm, dz_mm))
    if np.count_nonzero(x & z) > 0.05 * np.count_nonzero(x | z):
        return None
    axis = np.where(x & ~z, 0, np.where(z & ~x, 1, -1))
    if not np.any(axis >= 0):
        return np.zeros(len(axis), int)
    known, rests = np.flatnonzero(axis >= 0), np.flatnonzero(axis < 0)
    after = np.searchsorted(known, rests)
    left, right = known[np.maximum(after - 1, 0)], known[np.minimum(after, known.size - 1)]
    half = left + 1 + (right - left - 1) // 2  # a rest between two axes: its first half belongs to the pass before
    filled = axis.copy()
    filled[rests] = np.where((after > 0) & ((after == known.size) | (rests < half)), axis[left], axis[right])
    return filled


def numbers_of_poses(theta1_rad: np.ndarray, theta2_rad: np.ndarray, same_rad: float) -> np.ndarray:
    """From 1, in order of appearance: poses whose angles agree within `same_rad` have one number."""
    seen: dict[tuple[int, int], list[tuple[int, float, float]]] = {}  # by cells of same_rad: number and angles
    count = 0
    changes = np.flatnonzero(np.diff(theta1_rad, prepend=math.nan) != 0.0)
    changes = np.union1d(changes, np.flatnonzero(np.diff(theta2_rad, prepend=math.nan) != 0.0))
    numbers = np.zeros(len(theta1_rad), np.int32)
    for row in changes.tolist():
        first, second = float(theta1_rad[row]), float(theta2_rad[row])
        at = math.floor(first / same_rad), math.floor(second / same_rad)
        cells = ((at[0] + i, at[1] + j) for i in (-1, 0, 1) for j in (-1, 0, 1))
        near = [
            number
            for cell in cells
            for number, one, two in seen.get(cell, ())
            if max(abs(first - one), abs(second - two)) <= same_rad
        ]
        if not near:
            count += 1
            seen.setdefault(at, []).append((count, first, second))
        numbers[row] = min(near, default=count)
    return numbers[changes[np.searchsorted(changes, np.arange(len(numbers)), "right") - 1]]
