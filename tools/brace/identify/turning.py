"""Whether a loading record's limb turned as it was displaced.

A real limb turns, so force is not proportional to displacement even where every spring is linear. Some simulations
leave that out. A record may say so in its meta.toml (`displacements`). Where it does not, the readings show it. The
believed limb is refitted both ways, within what its calibration leaves open. The limb is taken for one that does not
turn only where two things say so:

- The fit without turning is far more likely. Both fits turn the same numbers, so the ratio of their likelihoods is the
  odds; the noise's size is not known beforehand, which makes it n/2 times the logarithm of the ratio of the costs.
- The curve is not there. Each configuration's forces are freed of a constant and a stiffness of their own, which takes
  out whatever is linear and wrong in the limb. What is left is compared with the same of the fitted limb that turns.
  Their ratio is 1 for a limb that turns and 0 for one that does not, whatever else bends the readings.

An effect that nobody knows of yet can disturb either, seldom both. In doubt the limb turned.

Most limbs turn, and most believed limbs are not far off: where the curve is there by the believed limb alone, nothing is
fitted."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from brace.dataset import Dataset
from brace.dataset.enough import enough_rows
from brace.ground.errors import BraceError
from brace.identify.fit import Fit, fit
from brace.identify.loading import LoadingProblem
from brace.identify.parameters import with_priors
from brace.identify.playing import player_of
from brace.model import LimbModel
from brace.native.plant_batch import model_numbers

FORCES = ("fx_n", "fz_n")
ROWS = 1000  # are enough
MUST_BE_LIKELIER = math.log(1e4)  # nats; of ten thousand records that say nothing about it, one may not turn
NOT_TURNED = 0.5  # of the ratio: nearer to 0 than to 1, on either side
AS_BELIEVED = 0.75  # of the ratio by the believed limb: half-way from NOT_TURNED to what turns as believed
MUST_DIFFER = 3.0  # sigmas of the ratio that it has to lie below 1
AT_THE_TOP = 0.98  # of the largest reading
ENOUGH = 1e-6  # of a fit's cost: what it could still gain


def settled(dataset: Dataset, believed: LimbModel) -> Dataset:
    """The record, with `small_displacements` as its meta.toml says or its readings show. In doubt the limb turned, as
    where a force of some rows was not read."""
    if dataset.meta.displacements or not dataset.reads_both_forces:
        return dataset
    return replace(dataset, small_displacements=_never_turned(dataset, believed))


def _never_turned(dataset: Dataset, believed: LimbModel) -> bool:
    some = dataset.select(enough_rows(dataset, ROWS))
    some = some.select(np.all([np.isfinite(values) for values in some.columns.values()], axis=0))
    some = some.select(~_cut_off(some.columns))
    if _curve(some, believed)[0] > AS_BELIEVED:
        return False
    try:
        linear, turning = (_refitted(some, believed, small=small) for small in (True, False))
    except BraceError:  # nothing to fit, or nothing that can be fitted
        return False
    likelier = 0.5 * turning.readings * (math.log(_cost(turning)) - math.log(_cost(linear)))
    return likelier > MUST_BE_LIKELIER and _shows_no_curve(some, turning.model)


def _cut_off(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Rows that a saturated sensor may have cut off, which bends readings more than turning does: those at the largest
    reading, where several displacements share it."""
    size = np.max(np.abs(np.stack([columns[name] for name in FORCES])), axis=0)
    top = size >= AT_THE_TOP * size.max()
    places = np.column_stack([columns[name][top] for name in ("config", "dx_mm", "dz_mm")])
    side = np.unique(np.column_stack([places[:, :1], np.abs(places[:, 1:])]), axis=0)
    return np.asarray(top & (len(side) > 1))


def _refitted(dataset: Dataset, believed: LimbModel, *, small: bool) -> Fit:
    problem = LoadingProblem(replace(dataset, small_displacements=small))
    return fit(problem, with_priors(believed, turns=not small), tolerance=ENOUGH)


def _cost(fitted: Fit) -> float:
    """Chi squared with the priors' share."""
    start, prior = fitted.parameters.array("start"), fitted.parameters.array("prior_sigma")
    cost = fitted.chi2 + float(np.sum(((fitted.x - start) / prior) ** 2))
    return max(cost, sys.float_info.min)  # a record without noise may leave nothing


def _shows_no_curve(dataset: Dataset, turning: LimbModel) -> bool:
    ratio, sigma = _curve(dataset, turning)
    return abs(ratio) <= NOT_TURNED and 1.0 - ratio > MUST_DIFFER * sigma


def _curve(dataset: Dataset, turning: LimbModel) -> tuple[float, float]:
    """How much of the curve of a limb that turns the readings have, and its sigma; NaN where that limb has none."""
    played = player_of(replace(dataset, small_displacements=False), FORCES).play_numbers(model_numbers(turning)[None])
    measured = np.stack([np.asarray(dataset[name], float) for name in FORCES])
    expected, found = (_curved(dataset.columns, forces).ravel() for forces in (played[0], measured))
    power = float(expected @ expected)
    if not power > 0.0:
        return math.nan, math.nan
    ratio = float(expected @ found) / power
    left = found - ratio * expected
    return ratio, float(np.sqrt(left @ left / left.size / power))


def _curved(columns: Mapping[str, np.ndarray], forces: np.ndarray) -> np.ndarray:
    """What a constant force and a stiffness of each configuration leave of the forces (forces x rows)."""
    left = np.empty_like(forces)
    for config in np.unique(columns["config"]):
        rows = columns["config"] == config
        linear = np.column_stack([np.ones(np.count_nonzero(rows)), columns["dx_mm"][rows], columns["dz_mm"][rows]])
        fitted, *_ = np.linalg.lstsq(linear, forces[:, rows].T, rcond=None)
        left[:, rows] = forces[:, rows] - (linear @ fitted).T
    return left
