"""A joint tested at several gear positions in one record: what a further position would have.

Play, stiffness and friction of a gear differ from tooth to tooth. What is measured at one position holds at another
only within that spread. Every position has its own sizes in the fit."""

from __future__ import annotations

import numpy as np
from scipy.special import stdtrit

from brace.diagnose.joint_test.fit import Fitted
from brace.diagnose.joint_test.record import JointRecord
from brace.identify.parameters import SPREAD, spread

COVERED = 0.90


def typical(record: JointRecord, fitted: Fitted) -> dict[str, float]:
    """Fitted values, those that differ between positions as their geometric mean."""
    values = fitted.values
    return values | {key: values[key] * float(np.exp(logs.mean())) for key, logs in _logs(record, fitted).items()}


def further(record: JointRecord, fitted: Fitted) -> dict[str, tuple[float, float]]:
    """low, high (90 %) of what a further gear position would have: Student's t for one more draw of a normal spread of
    the logs, mean +- t s sqrt(1 + 1/n). Nothing where the record has one position."""
    held = {}
    for key, logs in _logs(record, fitted).items():
        wide = float(stdtrit(logs.size - 1, 0.5 + 0.5 * COVERED)) * np.sqrt(1.0 + 1.0 / logs.size)
        half = wide * float(np.std(logs, ddof=1))
        middle = fitted.values[key] * float(np.exp(logs.mean()))
        held[key] = middle * float(np.exp(-half)), middle * float(np.exp(half))
    return held


def together(
    value: float, spread: tuple[float, float], known: tuple[float, float, float]
) -> tuple[float, float]:
    """low, high of a further position, where the fit itself leaves the number open as well: `known` is value, low, high
    of the fit. Both are independent, so their logs add as squares do."""
    fitted, *ends = known
    if fitted <= 0.0 or value <= 0.0:
        return min(spread[0], ends[0]), max(spread[1], ends[1])
    wide = [
        np.hypot(np.log(max(one, 1e-300) / value), np.log(max(end, 1e-300) / fitted))
        for one, end in zip(spread, ends)
    ]
    return value * float(np.exp(-wide[0])), value * float(np.exp(wide[1]))


def _logs(record: JointRecord, fitted: Fitted) -> dict[str, np.ndarray]:
    """Of each number that differs, its logs over that at the first position."""
    at, values = f"joint.{record.joint}.", fitted.values
    return {
        at + leaf: np.array([values.get(spread(leaf, one), 0.0) for one in range(record.position_count)])
        for leaf in SPREAD
        if record.position_count > 1 and at + leaf in values
    }
