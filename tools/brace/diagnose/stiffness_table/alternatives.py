"""Kinds of limb beside the believed one, each fitted to the table and judged on rows that were left out."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from brace.effects import BY_NAME, EFFECTS
from brace.ground.errors import BadFileError
from brace.identify.families import scattered_starts
from brace.identify.fit import Fit, Nuisances, Problem, fit, residual_of
from brace.identify.parameters import (
    JOINT_COMPLIANCES,
    LINK_COMPLIANCES,
    ParameterSet,
    free_parameter,
)
from brace.identify.table import TableProblem
from brace.model import LimbModel

FOLDS = 4
STARTS = 4
_TILTS = ("link.femur.tilt_rad", "link.tibia.tilt_rad")
_TRANSFER = "link.femur.moment_transfer"
_BASE = ("base.x_mm_per_n", "base.z_mm_per_n")

SPRINGS = BY_NAME["joint_compliance"].labels
LINKS = BY_NAME["link_compliance_error"].labels
TRANSFER = BY_NAME["moment_transfer"].labels
BASE = BY_NAME["base_compliance"].labels


@dataclass(frozen=True)
class Alternative:
    """A kind of limb: what is free beside the believed limb, what is set, and which effects this amounts to. Links are
    free in all but the first, because a table that holds them to their calibration can show nothing else."""

    name: str
    labels: tuple[str, ...]
    keys: tuple[str, ...]
    transfer: float | None = None


BELIEVED = Alternative("the believed limb", (), ())
_COMBINED = (
    Alternative("other links", LINKS, LINK_COMPLIANCES),
    Alternative("tilted links", LINKS, LINK_COMPLIANCES + _TILTS),
    Alternative("joint springs", SPRINGS, LINK_COMPLIANCES + JOINT_COMPLIANCES),
    Alternative("moment transfer", TRANSFER, LINK_COMPLIANCES, 1.0),
    Alternative(
        "joint springs and moment transfer", SPRINGS + TRANSFER, LINK_COMPLIANCES + JOINT_COMPLIANCES, 1.0
    ),
    Alternative("a yielding base", BASE, LINK_COMPLIANCES + _BASE),
)
# Any further effect of the catalogue that a table can show is an alternative by itself.
ALTERNATIVES = _COMBINED + tuple(
    Alternative(effect.words, effect.labels, LINK_COMPLIANCES + effect.keys)
    for effect in EFFECTS
    if effect.in_tables and not any(label in one.labels for one in _COMBINED for label in effect.labels)
)


@dataclass(frozen=True)
class Judged:
    """`off_n_per_mm` is measured less model, rows x 3; `left_out_n_per_mm` the same with each row predicted
    by a fit that did not see it; `folds` are those fits."""

    alternative: Alternative
    fit: Fit
    off_n_per_mm: np.ndarray
    left_out_n_per_mm: np.ndarray
    folds: tuple[Fit, ...]
    left_out_misfit: float  # mean square of left_out over the weight of an entry

    @property
    def rms(self) -> float:
        return float(np.sqrt(np.mean(self.off_n_per_mm**2)))

    @property
    def left_out_rms(self) -> float:
        return float(np.sqrt(np.mean(self.left_out_n_per_mm**2)))


class _Part:
    """A table without some of its rows, as a fit's problem."""

    def __init__(self, whole: TableProblem, keep: np.ndarray) -> None:
        self.whole, self._keep = whole, np.repeat(keep, 3)

    @property
    def count(self) -> int:
        return int(np.count_nonzero(self._keep))

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        return np.asarray(self.whole.residuals(models, nuisances)[:, self._keep])

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        return self.whole.angles(models, nuisances)


def missing_from(believed: LimbModel) -> tuple[Alternative, ...]:
    """The alternatives that the believed limb is not already."""
    found = []
    for one in ALTERNATIVES:
        if one.transfer is not None and believed.number(_TRANSFER) > 0.0:
            continue
        if one.labels == SPRINGS and all(believed.number(key) > 0.0 for key in JOINT_COMPLIANCES):
            continue
        found.append(one)
    return tuple(found)


def judge(
    problem: TableProblem, believed: LimbModel, alternative: Alternative, advance: Callable[[], None]
) -> Judged | None:
    """One alternative fitted, then fitted anew without each quarter of the rows; None where it cannot be such
    a limb."""
    with contextlib.suppress(BadFileError):
        chosen = _parameters(problem, believed, alternative)
        best = _fit(problem, chosen, scattered_starts(chosen, STARTS) if alternative.keys else ())
        advance()
        rows = len(problem.k)
        fold = np.arange(rows) % min(FOLDS, rows)
        left_out = np.zeros_like(problem.k)
        folds = []
        for number in range(int(fold.max()) + 1):
            part = _fit(_Part(problem, fold != number), chosen, [best.x])
            folds.append(part)
            predicted = problem.predicted(part.model, part.nuisances)
            left_out[fold == number] = (problem.k - predicted)[fold == number]
            advance()
        off = problem.k - problem.predicted(best.model, best.nuisances)
        misfit = float(np.mean((left_out / problem.sigma) ** 2))
        return Judged(alternative, best, off, left_out, tuple(folds), misfit)
    return None


def _fit(problem: Problem, chosen: ParameterSet, starts: Sequence[np.ndarray]) -> Fit:
    """Does the same as `fit`, also where nothing is free."""
    if len(chosen):
        return fit(problem, chosen, starts)
    return Fit(chosen, np.empty(0), residual_of(problem, chosen.base), np.empty((problem.count, 0)))


def _parameters(problem: TableProblem, believed: LimbModel, alternative: Alternative) -> ParameterSet:
    """Holds the believed limb as it is, since within its trust it would only bend towards the table. A free number
    starts from its believed value, or from its natural size where that value is zero."""
    start = believed
    if alternative.transfer is not None:
        start = start.with_values({_TRANSFER: alternative.transfer})
    fresh = {
        key: free_parameter(start, key).scale
        for key in alternative.keys
        if key not in _TILTS and start.number(key) == 0.0
    }
    start = start.with_values(fresh)
    parameters = [free_parameter(start, key) for key in alternative.keys]
    if problem.poses.needs_height:
        parameters.append(problem.height_parameter())
    return ParameterSet(start, tuple(parameters))
