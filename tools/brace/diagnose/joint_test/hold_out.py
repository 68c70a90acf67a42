"""What is locked away before anything is fitted: whole tests, or with but one of them whole ramps of it."""

from __future__ import annotations

import numpy as np

from brace.identify.swing import ramps

MIN_RAMPS = 6


def alike(ranges_n_mm: list[float]) -> list[list[int]]:
    """The tests of each amplitude by their places in the list, smallest first: those whose torque reaches about as
    far."""
    groups: list[list[int]] = []
    for place in sorted(range(len(ranges_n_mm)), key=lambda one: ranges_n_mm[one]):
        if groups and ranges_n_mm[place] <= 2.0 * max(ranges_n_mm[groups[-1][0]], 1e-9):
            groups[-1].append(place)
        else:
            groups.append([place])
    return groups


def held_out(
    angle_rad: np.ndarray, torque_n_mm: np.ndarray, test: np.ndarray, position: np.ndarray | None = None
) -> tuple[np.ndarray, str]:
    """Which readings take no part, and what they are in words ("" when nothing can be spared). Of the tests
    that reach about the same torque the last one is held out, so that both small and large loops are
    predicted. Where that would take all tests of a gear position, whose numbers nothing else determines, ramps of every
    position are held out instead."""
    labels = np.unique(test)
    if labels.size >= 3:
        sizes = {label: float(np.ptp(torque_n_mm[test == label])) for label in labels}
        groups = alike(list(sizes.values()))
        chosen = [max(labels[i] for i in group) for group in groups if len(group) >= 2]
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
