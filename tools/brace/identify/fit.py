"""Weighted least squares over a whole record, under priors and bounds, from one start or many."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from brace.ground.errors import BadFileError, UsageError
from brace.identify.parameters import ParameterSet
from brace.model import LimbModel
from brace.native.plant_batch import model_numbers

RIDGE = 1e-3  # pull towards the start, per scale: decides only where neither data nor prior do
REFUSED = 1e7  # whitened residual of a model that cannot be played; a record without noise has up to 1e6 of its own
TOLERANCE = 1e-10
STEP = 1e-4  # of a parameter's scale, for central differences


Nuisances = Mapping[str, np.ndarray]  # of many models: one entry per model


class Problem(Protocol):
    """A record that models are judged by: many at once, as rows of numbers (brace.native.plant_batch)."""

    @property
    def count(self) -> int:
        """Number of readings."""
        ...

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """(model - measured) / sigma, models x readings; NaN for a model that cannot be played."""
        ...

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x configurations x (theta1, theta2) [rad], true angles; no configuration for a joint test."""
        ...


@dataclass(frozen=True)
class Fit:
    """`x` in the parameters' units; `jacobian` of the data's whitened residuals by x / scale; `chi2` of the data
    alone; `readings` and `dof` count the data. `together`: how many readings in a row say the same."""

    parameters: ParameterSet
    x: np.ndarray
    residual: np.ndarray
    jacobian: np.ndarray
    together: float = 1.0

    @property
    def model(self) -> LimbModel:
        return self.parameters.model(self.x)

    @property
    def nuisances(self) -> dict[str, float]:
        return self.parameters.nuisances(self.x)

    @property
    def chi2(self) -> float:
        return float(self.residual @ self.residual)

    @property
    def readings(self) -> int:
        return int(self.residual.size)

    @property
    def dof(self) -> int:
        free = np.count_nonzero(np.isinf(self.parameters.array("prior_sigma")))
        return max(1, self.readings - int(free))

    @property
    def inflation(self) -> float:
        """By what the covariance must grow for the misfit to look like noise of independent readings; at least 1."""
        return max(1.0, self.chi2 / self.dof) * self.together


def fit(
    problem: Problem,
    parameters: ParameterSet,
    starts: Iterable[np.ndarray] = (),
    constraint: Callable[[np.ndarray, Nuisances], np.ndarray] | None = None,
    advance: Callable[[int], None] = lambda _done: None,
    tolerance: float = TOLERANCE,
) -> Fit:
    """The best fit over the parameters' start and further `starts` (vectors). `constraint`, if given, is driven
    to zero hard (a penalty that outweighs the data). `tolerance` as least_squares has it."""
    from scipy.optimize import least_squares

    scale, prior, start = (parameters.array(name) for name in ("scale", "prior_sigma", "start"))
    low, high = parameters.array("low") / scale, parameters.array("high") / scale
    pull = np.where(np.isinf(prior), RIDGE, scale / np.where(np.isinf(prior), 1.0, prior))

    def whole(points: np.ndarray) -> np.ndarray:
        x = points * scale
        parts = [_data(problem, parameters, x), pull * (points - start / scale)]
        if constraint is not None:
            off = constraint(parameters.models(x), parameters.nuisance_columns(x))
            parts.append(1e3 * off[:, np.newaxis])
        return np.concatenate(parts, axis=1)

    def at(u: np.ndarray) -> np.ndarray:
        return np.asarray(whole(u[np.newaxis])[0])

    def slope(u: np.ndarray) -> np.ndarray:
        return _central(whole, u, low, high)

    if not len(parameters):
        raise UsageError(
            "nothing to fit",
            where=parameters.base.where(),
            why="[uncertainty] is missing or 0 there: every number of the limb is trusted exactly",
            next_step="add [uncertainty], as docs/limb-keys.md has it, or give --free",
        )
    best = None
    for number, point in enumerate([start, *starts]):
        inside = np.clip(point / scale, low + 1e-9, high - 1e-9)
        found = least_squares(
            at,
            inside,
            jac=slope,
            bounds=(low, high),
            x_scale=1.0,
            ftol=tolerance,
            xtol=tolerance,
            gtol=tolerance,
            max_nfev=200,
        )
        if best is None or found.cost < best.cost:
            best = found
        advance(number + 1)
    assert best is not None
    near = 1e-7  # of a scale from a bound is at it
    solved = np.where(best.x - low < near, low, np.where(high - best.x < near, high, best.x))
    residual = _data(problem, parameters, solved[np.newaxis] * scale)[0]
    if np.abs(residual).max(initial=0.0) >= REFUSED:
        raise BadFileError(
            "no fit was found",
            where=parameters.base.where(),
            why="the simulated limb cannot be played near the start model",
            next_step="start from a model nearer to the limb",
        )
    jacobian = _central(lambda points: _data(problem, parameters, points * scale), solved, low, high)
    return Fit(parameters, solved * scale, residual, jacobian)


def columns_of(nuisances: Mapping[str, float]) -> Nuisances:
    """One model's nuisances as those of many."""
    return {key: np.array([value]) for key, value in nuisances.items()}


def residual_of(
    problem: Problem, model: LimbModel, nuisances: Mapping[str, float] | None = None
) -> np.ndarray:
    """(model - measured) / sigma of one model, one entry per reading; refuses one that cannot be played."""
    residual = problem.residuals(model_numbers(model)[np.newaxis], columns_of(nuisances or {}))[0]
    if np.isnan(residual).any():
        raise BadFileError(
            "the simulated limb cannot be played",
            where=model.where(),
            why="nothing yields in some direction, or no rest state was found",
            next_step="give link or joint compliances, or check the model's values",
        )
    return np.asarray(residual)


def _data(problem: Problem, parameters: ParameterSet, x: np.ndarray) -> np.ndarray:
    residuals = problem.residuals(parameters.models(x), parameters.nuisance_columns(x))
    return np.asarray(np.where(np.isnan(residuals), REFUSED, np.clip(residuals, -REFUSED, REFUSED)))


def _central(
    function: Callable[[np.ndarray], np.ndarray], u: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Central differences, one-sided at a bound. `function` takes many points at once."""
    up, down = np.minimum(u + STEP, high), np.maximum(u - STEP, low)
    moved = np.tile(u, (2, u.size, 1))
    own = np.arange(u.size)
    moved[0, own, own], moved[1, own, own] = up, down
    rows = function(moved.reshape(2 * u.size, u.size))
    rows = rows.reshape(2, u.size, rows.shape[1])
    return np.ascontiguousarray(((rows[0] - rows[1]) / (up - down)[:, np.newaxis]).T)
