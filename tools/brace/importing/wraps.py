"""Readings that went round: negative numbers that were read unsigned, an angle that begins anew after a turn."""

from __future__ import annotations

import numpy as np

from brace.importing.questions import WRAPPED

LOW, HIGH = 0.25, 0.75  # of the largest: between them a reading that went round has none
FEW = 3


def wraps(values: np.ndarray) -> str:
    """Why a column seems to have gone round, and how the mapping says it; empty where it does not."""
    largest = float(values.max(initial=0.0))
    if values.size < 4 * FEW or largest <= 0.0 or values.min() < 0.0:
        return ""
    low, high = values < LOW * largest, values > HIGH * largest
    if not np.all(low | high) or min(np.unique(values[low]).size, np.unique(values[high]).size) < FEW:
        return ""
    crossed = np.count_nonzero(np.diff(high.astype(int)))
    within = np.abs(np.diff(values))[np.diff(high.astype(int)) == 0]
    if not crossed or (within.size and float(within.max()) > LOW * largest):
        return ""
    return WRAPPED.format(values[low].max(), values[high].min(), largest)


def unwrapped(values: np.ndarray, wrap: float) -> np.ndarray:
    """Readings above half of `wrap` less by it; as they are where it is 0."""
    return np.where(values > 0.5 * wrap, values - wrap, values) if wrap > 0.0 else values
