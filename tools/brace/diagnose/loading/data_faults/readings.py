"""Single readings and stretches of them: a sign or a decimal point that slipped, a sensor that stood still, seen
against what the refitted limb would read."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from brace.dataset import DataFault
from brace.dataset.check_runs import MAX_LISTED, in_other_runs
from brace.identify.noise import FORCES
from brace.diagnose.loading.data_faults.judge import Judge

LOUD = 12.0  # times the usual step aside between neighbours
QUIET = 4.0
CLEAR = 10.0  # what a reading that is put right must be: near zero, any glitch looks like a slip
ALIKE = 0.5  # of a slip's size
MOST_ALIKE = 2
LEAST_STUCK = 3  # equal readings in a row that can be a sensor standing still
UNLIKELY = 1e-4
LEAST_SIGMA_N = 1e-3
BEYOND_ALL = 3.0  # times the largest other reading: no loading test gives it once


def faults(judge: Judge) -> list[DataFault]:
    """Stuck stretches first: their ends look like slips."""
    stuck = [fault for name in judge.channels for fault in _stuck(judge, name)]
    return stuck or lone(judge, [*_slips(judge)])


def lone(judge: Judge, slips: Sequence[DataFault]) -> list[DataFault]:
    """Those slips that are alone of their size: among many glitches some look like slips by chance."""
    kept = []
    for place, name in enumerate(FORCES):
        rows = [fault.row - 1 for fault in slips if fault.field == name and fault.row is not None]
        if not rows:
            continue
        aside = np.abs(_aside(judge.measured[place] - judge.played[place], judge.dataset["run"])[0])
        others = np.delete(aside, rows)
        for fault in slips:
            if fault.field == name and fault.row is not None:
                alike = int(np.count_nonzero(others > ALIKE * aside[fault.row - 1]))
                kept += [fault] if alike <= max(MOST_ALIKE, len(rows)) else []
    return kept


def _slips(judge: Judge) -> Iterator[DataFault]:
    """A reading that stands aside from its neighbours, and among them once a sign or a decimal point is put right.
    Sudden effects (reversal, play, a slip) shift what follows too, so neighbours on both sides must agree."""
    run = judge.dataset["run"]
    if run.size < 5:
        return
    resolution_n = judge.dataset.meta.number("sensor.resolution_n")
    for place, name in enumerate(FORCES):
        measured, played = judge.measured[place], judge.played[place]
        aside, agree = _aside(measured - played, run)
        # not the record's noise, which a slip may have raised
        typical = max(1.4826 * float(np.median(np.abs(aside))), LEAST_SIGMA_N, 0.3 * resolution_n)
        largest = np.sort(np.abs(measured))[-2:]
        for row in np.flatnonzero(np.abs(aside) > LOUD * typical)[: 10 * MAX_LISTED]:
            value, expected = measured[row], measured[row] - aside[row]
            near = max(QUIET * typical, 0.02 * abs(expected))
            if agree[row] > max(QUIET * typical, 0.25 * abs(aside[row])):
                continue
            if in_other_runs(aside, typical, run, judge.dataset["axis"], int(row)):
                continue
            for factor, what in ((-1.0, "its sign is turned"), (10.0, _DECIMAL), (0.1, _DECIMAL), (0.01, _DECIMAL),
                                 (100.0, _DECIMAL)):  # fmt: skip
                if abs(value * factor - expected) < near and abs(value * factor) > CLEAR * typical:
                    yield DataFault(
                        int(row) + 1,
                        name,
                        f"{value:g} stands out of its run, where {expected:.3g} is due: {what}",
                        float(value * factor),
                    )
                    break
            else:
                if (
                    abs(value) == largest[1]
                    and largest[1] > BEYOND_ALL * largest[0]
                    and abs(aside[row]) > 0.5 * abs(value)
                ):
                    yield DataFault(
                        int(row) + 1,
                        name,
                        f"{value:g} where {expected:.3g} is due, and nothing else in the record reads {largest[0]:.3g} "
                        "or more: not a reading of this test",
                    )


_DECIMAL = "a slipped decimal point"


def _aside(left: np.ndarray, run: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far each row's residual lies from the middle of its neighbours' in the run, and how far these disagree."""
    around = np.full((4, left.size), np.nan)
    for place, by in enumerate((-2, -1, 1, 2)):
        same = np.roll(run, -by) == run
        if by < 0:
            same[:-by] = False
        else:
            same[-by:] = False
        around[place] = np.where(same, np.roll(left, -by), np.nan)
    known = np.sum(np.isfinite(around), axis=0)
    filled = np.where(known >= 2, around, 0.0)
    middle = _middle(filled, known)
    spread = _middle(np.abs(filled - middle), known)
    return np.where(known >= 2, left - middle, 0.0), spread


def _middle(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Median of up to four values, of which `known` are there and the others NaN (all there where fewer than two)."""
    ordered = np.sort(values, axis=0)
    two, three = 0.5 * (ordered[0] + ordered[1]), ordered[1]
    return np.asarray(np.select([known == 2, known == 3], [two, three], 0.5 * (ordered[1] + ordered[2])))


def _stuck(judge: Judge, name: str) -> Iterator[DataFault]:
    """Equal readings in a row, bit by bit. Noise does not repeat itself; and where there is none, a limb's force does
    not stand while its tip moves, unless it is unloaded (play) or the sensor is at its limit."""
    values = judge.dataset[name]
    changes = np.flatnonzero(np.diff(values) != 0.0) + 1
    starts = np.concatenate([[0], changes])
    lengths = np.diff(np.concatenate([starts, [values.size]]))
    long = np.flatnonzero(lengths >= LEAST_STUCK)
    if not long.size:
        return
    alike = _chance_alike(judge, name)
    listed = 0
    place = FORCES.index(name) if name in FORCES else -1
    for index in long:
        begin, count = int(starts[index]), int(lengths[index])
        rows = slice(begin, begin + count)
        by_noise = values.size * alike ** (count - 1) < UNLIKELY
        if place >= 0:
            if _at_limit(judge, place, rows, values[begin]):
                continue
            stands = by_noise or _stands_under_load(judge, place, rows)
        else:
            stands = by_noise
        if not stands or _zero_by_definition(judge, begin, count):
            continue
        listed += 1
        if listed <= MAX_LISTED:
            yield DataFault(
                begin + 1,
                name,
                f"it stands at {values[begin]:g} for {count} readings while the tip goes on: the sensor was stuck, or "
                "a reading was filled in",
            )


def _zero_by_definition(judge: Judge, begin: int, count: int) -> bool:
    """Runs of one reading each, zeroed."""
    zeroed = judge.dataset.meta.zeroed_per_run
    return bool(zeroed and judge.dataset["run"][begin] != judge.dataset["run"][begin + min(count, 2) - 1])


def _chance_alike(judge: Judge, name: str) -> float:
    """How likely a reading equals the one before it where the limb stands still; 1 where no noise was seen."""
    noise = judge.noise[name]
    if "repeats" not in noise.source and "smoothness" not in noise.source:
        return 1.0
    steps = np.diff(np.unique(judge.dataset[name][:20000]))
    quantum = float(steps.min()) if steps.size else 0.0
    if noise.floor <= 0.0:
        return 1.0
    return math.erf(0.5 * quantum / (math.sqrt(2.0) * noise.floor))  # what falls in the quantum around the true value


def _at_limit(judge: Judge, place: int, rows: slice, value: float) -> bool:
    """A clipped reading: hardly any other goes beyond, and the limb pulls that way all along."""
    slack = 0.02 * abs(value) + 4.0 * float(np.median(judge.sigma[place, rows]))
    beyond = np.count_nonzero(np.abs(judge.measured[place]) > abs(value) + slack)
    pulls = np.sign(value) * judge.played[place, rows] > 0.4 * abs(value)
    return bool(value != 0.0 and beyond <= 0.02 * judge.dataset.rows and pulls.all())


def _stands_under_load(judge: Judge, place: int, rows: slice) -> bool:
    """Off the unloaded level, while the limb's force would go a long way."""
    begin, end = rows.start, rows.stop
    driven = judge.dataset["axis"][begin] == place and judge.dataset["axis"][end - 1] == place
    if end - begin < (5 if driven else 8):
        return False
    sigma = float(np.median(judge.sigma[place, rows]))
    resolution = judge.dataset.meta.number("sensor.resolution_n")
    still = (judge.dataset["dx_mm"] == 0.0) & (judge.dataset["dz_mm"] == 0.0)
    still[rows] = False
    unloaded = judge.measured[place][still]
    level = np.abs(unloaded - judge.measured[place, begin]).min() if unloaded.size else np.inf
    way = float(np.ptp(judge.played[place, rows]))
    return bool(level > 3.0 * (sigma + resolution) and way > 10.0 * (sigma + resolution))
