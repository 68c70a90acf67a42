"""The gear positions of a joint test: between them the joint was turned on, so each has an encoder zero of its own."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from brace.dataset import Dataset

POSITION = "position"  # the column with each row's gear position, from 0
APART = 0.05  # of a test's swing: nearer ones are the same position, with a zero that moved a little


def apart(dataset: Dataset) -> Dataset:
    """The record with the angle of each gear position counted from the middle of its own loops, and a column that
    numbers the positions; as it is where all tests stand at one. Tests show their position only if they load the joint
    both ways."""
    number = None if POSITION in dataset else _numbers(dataset)
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


def _numbers(dataset: Dataset) -> np.ndarray | None:
    """Each row's gear position in the order of the record; None where the tests show none, or one."""
    if "test" not in dataset:
        return None
    tests = list(dict.fromkeys(dataset["test"].tolist()))
    reach = _shared_reach_n_mm(dataset, tests)
    if len(tests) < 2 or reach <= 0.0:
        return None
    inside = _within(dataset, reach)
    if not all((inside & (dataset["test"] == test)).any() for test in tests):
        return None  # a test has no reading at so small a torque, so it has no middle
    middles = {test: _middle_rad(dataset, dataset["test"] == test, reach) for test in tests}
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
