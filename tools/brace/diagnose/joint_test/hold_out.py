"""What is locked away before anything is fitted: whole tests, or with but one of them whole ramps of it."""

from __future__ import annotations

import numpy as np

from brace.identify.swing import ramps

MIN_RAMPS = 6


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
