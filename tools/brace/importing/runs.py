"""Where one pass along an axis ends and the next begins, in a record that does not number them."""

from __future__ import annotations

import numpy as np

NEAR_ZERO_RATIO = 0.06  # of the largest displacement: the tip is back where it began
ANGLE_JUMP_RAD = 0.01  # between readings: another pose


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
    known = np.flatnonzero(axis >= 0)
    filled = axis.copy()
    for row in np.flatnonzero(axis < 0):
        after = np.searchsorted(known, row)
        before = axis[known[after - 1]] if after > 0 else -1
        following = axis[known[after]] if after < known.size else -1
        filled[row] = following if before < 0 else before if following < 0 else -1
        if before >= 0 and following >= 0:
            filled[row] = before if before == following else -2
    for row in np.flatnonzero(filled == -2):  # a rest between two axes: its first half belongs to the pass before
        first, last = row, row
        while first > 0 and axis[first - 1] < 0:
            first -= 1
        while last + 1 < axis.size and axis[last + 1] < 0:
            last += 1
        half = first + (last - first + 1) // 2
        filled[row] = axis[first - 1] if row < half else axis[last + 1]
    return filled


def numbers_of_poses(theta1_rad: np.ndarray, theta2_rad: np.ndarray, same_rad: float) -> np.ndarray:
    """From 1, in order of appearance: poses whose angles agree within `same_rad` have one number."""
    seen: list[tuple[float, float]] = []
    numbers = np.empty(len(theta1_rad), np.int32)
    for row, pose in enumerate(zip(theta1_rad.tolist(), theta2_rad.tolist())):
        if row and pose == (theta1_rad[row - 1], theta2_rad[row - 1]):
            numbers[row] = numbers[row - 1]
            continue
        near = [
            at for at, other in enumerate(seen) if max(abs(pose[0] - other[0]), abs(pose[1] - other[1])) <= same_rad
        ]
        if not near:
            seen.append(pose)
        numbers[row] = near[0] + 1 if near else len(seen)
    return numbers
