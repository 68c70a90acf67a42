"""A joint tested at several gear positions in one record: each has its own zero of the angle, and sizes of its own.

Play, stiffness and friction of a gear differ from tooth to tooth. What one position tells, another holds only within
that spread."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import t as student

from brace.dataset import Dataset
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.record import JointRecord
from brace.errors import BraceError
from brace.identify.parameters import ANGLE_ZERO
from brace.model.keys import KEY_BY_NAME

POSITION = "position"  # the column with each row's gear position, from 0
APART = 0.5  # of a test's swing: nearer ones are the same position, with a zero that moved a little
TURNED = 1e-3  # of the swing: to learn how the torque follows the zero
COVERED = 0.90


def apart(dataset: Dataset) -> Dataset:
    """The record with the angle of each gear position counted from the middle of its own loops, and a column that
    numbers the positions; as it is where all tests stand at one. Tests tell their position only if they load the joint
    both ways."""
    number = _numbers(dataset)
    if number is None:
        return dataset
    angle = dataset["angle_rad"].astype(float)
    reach = _shared_reach_n_mm(dataset, np.unique(dataset["test"]))
    for one in np.unique(number):
        rows = number == one
        angle[rows] -= _middle_rad(dataset, rows, reach)
    return dataset.with_columns({"angle_rad": angle, POSITION: number.astype(float)})


def count(dataset: Dataset) -> int:
    """How many gear positions the record has."""
    return int(dataset[POSITION].max()) + 1 if POSITION in dataset else 1


def zeroed_by(record: JointRecord, fitted: Fitted) -> Dataset:
    """The record with every position's zero moved to where the fitted joint's torque has the least left."""
    dataset = record.dataset
    if POSITION not in dataset:
        return dataset
    turn = TURNED * record.size.angle_rad
    nuisances = fitted.nuisances
    here = record.torque(fitted.model, nuisances)
    slope = (record.torque(fitted.model, nuisances | {ANGLE_ZERO: nuisances[ANGLE_ZERO] + turn}) - here) / turn
    off = record.columns["torque_n_mm"] - here
    angle = dataset["angle_rad"].copy()
    for one in range(count(dataset)):
        rows = np.rint(record.columns[POSITION]) == one
        power = float(slope[rows] @ slope[rows])
        if power > 0.0:
            angle[dataset[POSITION] == one] += float(slope[rows] @ off[rows]) / power
    return dataset.with_columns({"angle_rad": angle})


def spread(fitter: Fitter, fitted: Fitted) -> dict[str, tuple[float, float]]:
    """low, high (90 %) of what a further gear position would have, by the spread between those of the record: of each
    key of limb.toml that was fitted. Nothing where the record has one position, or the others cannot be fitted alone.
    Student's t for one more draw of a normal spread: mean +- t s sqrt(1 + 1/n)."""
    dataset = fitter.record.dataset
    found: list[dict[str, float]] = []
    for one in range(count(dataset)) if POSITION in dataset else ():
        try:
            alone = Fitter(JointRecord(dataset.select(dataset[POSITION] == one)), fitter.base, fitter.trust).by_rows()
            found.append(alone.fit(fitted.terms, fitted).values)
        except BraceError:  # too few readings at this position
            continue
    if len(found) < 2:
        return {}
    wide = float(student.ppf(0.5 + 0.5 * COVERED, len(found) - 1)) * np.sqrt(1.0 + 1.0 / len(found))
    held = {}
    for key in (key for key in fitted.values if key in KEY_BY_NAME):
        sizes = np.array([values[key] for values in found])
        half = wide * float(np.std(sizes, ddof=1))
        entry = KEY_BY_NAME[key]
        held[key] = max(entry.low, float(sizes.mean()) - half), min(entry.high, float(sizes.mean()) + half)
    return held


def _numbers(dataset: Dataset) -> np.ndarray | None:
    """Each row's gear position in the order of the record; None where the tests do not tell, or tell one."""
    if "test" not in dataset:
        return None
    tests = list(dict.fromkeys(dataset["test"].tolist()))
    reach = _shared_reach_n_mm(dataset, tests)
    if len(tests) < 2 or reach <= 0.0:
        return None
    middles = {test: _middle_rad(dataset, dataset["test"] == test, reach) for test in tests}
    inside = _within(dataset, reach)
    swing = max(float(np.ptp(dataset["angle_rad"][(dataset["test"] == test) & inside])) for test in tests)
    known: list[float] = []
    number = np.zeros(dataset.rows, dtype=int)
    for test, middle in middles.items():
        near = [place for place, other in enumerate(known) if abs(other - middle) < APART * swing]
        if not near:
            known.append(middle)
        number[dataset["test"] == test] = near[0] if near else len(known) - 1
    return number if len(known) > 1 else None


def _shared_reach_n_mm(dataset: Dataset, tests: Sequence[int] | np.ndarray) -> float:
    """The torque that every test reaches on both sides."""
    each = [dataset["torque_n_mm"][dataset["test"] == test] for test in tests]
    return min(float(min(torque.max(), -torque.min())) for torque in each)


def _within(dataset: Dataset, reach_n_mm: float) -> np.ndarray:
    return np.asarray(np.abs(dataset["torque_n_mm"]) <= reach_n_mm)


def _middle_rad(dataset: Dataset, rows: np.ndarray, reach_n_mm: float) -> float:
    """The middle of the angles at which these rows carry no more than this torque."""
    angle = dataset["angle_rad"][rows & _within(dataset, reach_n_mm)]
    return float(0.5 * (angle.max() + angle.min()))
