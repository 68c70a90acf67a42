"""What is locked away before anything is fitted: whole tests, or with but one of them whole ramps of it."""

from __future__ import annotations

import numpy as np

MIN_RAMPS = 6
RAMP_SHARE = 0.25  # of the range of angles that a turn must be followed by to count as one


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


def held_out(
    angle_rad: np.ndarray, torque_n_mm: np.ndarray, test: np.ndarray, position: np.ndarray | None = None
) -> tuple[np.ndarray, str]:
    """Which readings take no part, and what they are in words ("" when nothing can be spared). Of the tests
    that reach about the same torque the last one is held out, so that both small and large loops are
    predicted. Where that would take all tests of a gear position, whose numbers nothing else tells, ramps of every
    position are held out instead."""
    labels = np.unique(test)
    if labels.size >= 3:
        sizes = {label: float(np.ptp(torque_n_mm[test == label])) for label in labels}
        chosen = []
        left = sorted(labels, key=lambda label: sizes[label])
        while left:
            alike = [label for label in left if sizes[label] <= 2.0 * max(sizes[left[0]], 1e-9)]
            left = [label for label in left if label not in alike]
            if len(alike) >= 2:
                chosen.append(max(alike))
        where = np.zeros(test.size) if position is None else position
        if chosen and np.unique(where[~np.isin(test, chosen)]).size == np.unique(where).size:
            names = ", ".join(str(label) for label in sorted(chosen))
            return np.isin(test, chosen), f"test{'s' if len(chosen) > 1 else ''} {names}"
    number = ramps(angle_rad, test)
    total = int(number.max()) + 1
    if total < MIN_RAMPS:
        return np.zeros(angle_rad.size, dtype=bool), ""
    chosen_ramps = list(range(3, total, 4)) or [total - 1]
    return np.isin(number, chosen_ramps), f"{len(chosen_ramps)} of {total} ramps"
