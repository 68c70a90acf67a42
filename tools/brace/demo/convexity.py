"""Where a sequence of eigenvalues over r is convex, and where it is only quasi-convex."""

from __future__ import annotations

import numpy as np


def bent_rows(r_mm: np.ndarray, value: np.ndarray) -> np.ndarray:
    """True at each inner row that lies above the chord of its neighbours: there the sequence is not convex.
    r_mm rising."""
    bent = np.zeros(len(r_mm), dtype=bool)
    share = (r_mm[1:-1] - r_mm[:-2]) / (r_mm[2:] - r_mm[:-2])
    bent[1:-1] = value[1:-1] > (1 - share) * value[:-2] + share * value[2:]
    return bent


def quasi_convex_breaks(value: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """True at each row that rises before the minimum, or falls after it, by more than its interval allows."""
    lowest = int(np.argmin(value))
    breaks = np.zeros(len(value), dtype=bool)
    for row in range(1, len(value)):
        if row <= lowest:
            breaks[row] = low[row] > high[row - 1]
        else:
            breaks[row] = high[row] < low[row - 1]
    return breaks
