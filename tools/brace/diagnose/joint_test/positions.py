"""A joint tested at several gear positions in one record: what a further position would have.

Play, stiffness and friction of a gear differ from tooth to tooth. What one position tells, another holds only within
that spread. Every position has its own sizes in the fit."""

from __future__ import annotations

import numpy as np
from scipy.stats import t as student

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
        wide = float(student.ppf(0.5 + 0.5 * COVERED, logs.size - 1)) * np.sqrt(1.0 + 1.0 / logs.size)
        half = wide * float(np.std(logs, ddof=1))
        middle = fitted.values[key] * float(np.exp(logs.mean()))
        held[key] = middle * float(np.exp(-half)), middle * float(np.exp(half))
    return held


def _logs(record: JointRecord, fitted: Fitted) -> dict[str, np.ndarray]:
    """Of each number that differs, its logs over that at the first position."""
    at, values = f"joint.{record.joint}.", fitted.values
    return {
        at + leaf: np.array([values.get(spread(leaf, one), 0.0) for one in range(record.position_count)])
        for leaf in SPREAD
        if record.position_count > 1 and at + leaf in values
    }
