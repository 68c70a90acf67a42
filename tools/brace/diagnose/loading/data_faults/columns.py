"""Whole columns in another unit, with a turned sign, exchanged or a row late: the believed limb explains the record far
better once one of them is put right."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.dataset.unit_slips import FORCE_SLIPS, LENGTH_SLIPS
from brace.diagnose.loading.data_faults.judge import Judge, alike, misfit
from brace.identify.noise import FORCES

Columns = Mapping[str, np.ndarray]
Change = Callable[[Columns], dict[str, np.ndarray]]

SUSPECT = 0.1  # misfit below which no whole column is wrong
SHORTLISTED = 0.6  # of the misfit before, with the limb as it is believed
MOST_REFITTED = 4
LEAST_EXCESS = 1.5  # per reading, that a fault of a whole column makes
REMOVED = 0.95  # of the excess, by a repair that is believed
NEAR_NOISE = 0.5  # excess per reading that a repaired record may keep
TIED = 1.5  # a repair that leaves no more than this factor of the best's is as likely
SAME_SHAPE = 0.8  # correlation with the believed limb's forces, from which a unit can be recognized
UNITS = {**FORCE_SLIPS, 0.1: ("daN", 10.0), 1 / 0.27801385: ("ozf", 0.27801385)}
SHIFTS: tuple[str, ...] = ("dx_mm", "dz_mm")
ANGLES: tuple[str, ...] = ("theta1_rad", "theta2_rad")


@dataclass(frozen=True)
class Repair:
    """What would put the record right: fields at fault, in words, and the factors on both forces."""

    fields: tuple[str, ...]
    what: str
    suggestion: str
    change: Change
    scale: tuple[float, float] = (1.0, 1.0)


def faults(judge: Judge) -> list[DataFault]:
    """The repairs that explain the record, best first; empty where none is needed or none helps."""
    data = judge.dataset.select(_mask(judge))
    measured = np.stack([data[name] for name in FORCES])
    played = judge.play(data, judge.trust.numbers)
    before = misfit(measured, played)
    if before < SUSPECT or judge.as_it_is.excess < LEAST_EXCESS:
        return []
    tried = []
    shaped = [abs(alike(measured[place], played[place])) > SAME_SHAPE for place in (0, 1)]
    for repair in repairs(judge.dataset):
        if any(factor > 1.0 and not same for factor, same in zip(repair.scale, shaped)):
            continue  # noise fits in any unit that is large enough
        mended = data.with_columns(repair.change(data.columns))
        after = misfit(np.stack([mended[name] for name in FORCES]), judge.play(mended, judge.trust.numbers))
        if after < SHORTLISTED * before:
            tried.append((after, repair))
    tried.sort(key=lambda item: item[0])
    accepted = []
    most = max(NEAR_NOISE, (1.0 - REMOVED) * judge.as_it_is.excess)
    for _, repair in tried[:MOST_REFITTED]:
        mended = judge.dataset.with_columns(repair.change(judge.dataset.columns))
        left = judge.agreement(mended, judge.few, np.array(repair.scale)).excess
        if left <= most:
            accepted.append((left, repair))
    return list(_column_faults(judge, accepted))


def _column_faults(judge: Judge, accepted: list[tuple[float, Repair]]) -> Iterator[DataFault]:
    if not accepted:
        return
    accepted.sort(key=lambda item: item[0])
    best = accepted[0][0]
    for left, repair in accepted:
        if left > TIED * best + 0.1:
            continue
        before, after = np.sqrt(1.0 + judge.as_it_is.excess), np.sqrt(1.0 + left)
        for name in repair.fields:
            yield DataFault(
                None,
                name,
                f"{repair.what}: the believed limb misses the record by {before:.3g} times its noise, and by "
                f"{after:.3g} times once that is put right",
                repair.suggestion,
            )


def _mask(judge: Judge) -> np.ndarray:
    mask = np.zeros(judge.dataset.rows, dtype=bool)
    mask[judge.few] = True
    return mask


def repairs(dataset: Dataset) -> Iterator[Repair]:
    """Everything that goes wrong with whole columns between a rig and a file."""
    yield from _units(dataset)
    yield from _signs()
    yield from _exchanges()
    yield from _angle_conventions()
    for late, what in ((-1, "late"), (1, "early")):
        yield Repair(FORCES, f"the forces stand one row {what}", "the forces moved by one row", _shifted(late))


def _units(dataset: Dataset) -> Iterator[Repair]:
    for unit, factor in UNITS.values():
        for names in (FORCES, FORCES[:1], FORCES[1:]):
            scale = (factor if FORCES[0] in names else 1.0, factor if FORCES[1] in names else 1.0)
            yield Repair(
                names, f"fits only in {unit}", f"{unit}: multiply by {factor:g}", _scaled(names, factor), scale
            )
    if dataset.meta.number("rig.step_mm") > 0.0:
        return  # the step shows the unit of displacements
    for unit, factor in LENGTH_SLIPS.values():
        for names in (SHIFTS, SHIFTS[:1], SHIFTS[1:]):
            yield Repair(names, f"fits only in {unit}", f"{unit}: multiply by {factor:g}", _scaled(names, factor))
    for names in (ANGLES, ANGLES[:1], ANGLES[1:]):
        yield Repair(names, "fits only in degrees", "degrees: multiply by pi/180", _scaled(names, np.pi / 180.0))


def _signs() -> Iterator[Repair]:
    turned = "the sign is turned"
    for names in (("fx_n",), ("fz_n",), FORCES, ("dx_mm",), ("dz_mm",), ("dx_mm", "fx_n"), ("dz_mm", "fz_n")):
        yield Repair(names, turned, "the column with its sign turned", _scaled(names, -1.0))
    for names in (("theta1_rad",), ("theta2_rad",), ANGLES):
        yield Repair(names, turned, "the column with its sign turned", _scaled(names, -1.0))


def _exchanges() -> Iterator[Repair]:
    for one, other in (FORCES, ANGLES):
        yield Repair((one, other), f"{one} and {other} are exchanged", f"the columns {one} and {other} exchanged",
                     _exchanged(one, other))  # fmt: skip
    yield Repair(SHIFTS, "dx_mm and dz_mm are exchanged", "the columns dx_mm and dz_mm exchanged",
                 _exchanged(*SHIFTS))  # fmt: skip


def _angle_conventions() -> Iterator[Repair]:
    def absolute(columns: Columns) -> dict[str, np.ndarray]:
        return {"theta2_rad": columns["theta1_rad"] - columns["theta2_rad"]}

    def inner(columns: Columns) -> dict[str, np.ndarray]:
        return {"theta2_rad": np.pi - columns["theta2_rad"]}

    yield Repair(("theta2_rad",), "it is the shank's own angle, not the knee's", "theta1_rad less it", absolute)
    yield Repair(("theta2_rad",), "it is counted from the folded knee", "pi less it", inner)
    for turn, words in ((np.pi / 2, "pi/2 added"), (-np.pi / 2, "pi/2 taken off"), (np.pi, "pi added")):
        yield Repair(("theta1_rad",), "its zero is a quarter or half turn off", words, _moved("theta1_rad", turn))


def _scaled(names: tuple[str, ...], factor: float) -> Change:
    return lambda columns: {name: columns[name] * factor for name in names}


def _moved(name: str, by: float) -> Change:
    return lambda columns: {name: columns[name] + by}


def _exchanged(one: str, other: str) -> Change:
    return lambda columns: {one: columns[other], other: columns[one]}


def _shifted(by: int) -> Change:
    """Forces moved along the whole record; the end that is left without keeps its own."""

    def change(columns: Columns) -> dict[str, np.ndarray]:
        mended = {}
        for name in FORCES:
            mended[name] = np.roll(columns[name], by)
            end = -1 if by < 0 else 0
            mended[name][end] = columns[name][end]
        return mended

    return change
