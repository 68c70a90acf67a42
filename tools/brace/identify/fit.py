"""Weighted least squares over a whole record, under priors and bounds, from one start or many."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from brace.errors import BadFileError
from brace.identify.parameters import ParameterSet
from brace.model import LimbModel

RIDGE = 1e-3  # pull towards the start, per scale: decides only where neither data nor prior do
REFUSED = 1e4  # whitened residual of a model that cannot be played
TOLERANCE = 1e-10
STEP = 1e-4  # of a parameter's scale, for central differences


class Problem(Protocol):
    """A record that models are judged by."""

    @property
    def count(self) -> int:
        """Number of readings."""
        ...

    def residual(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """(model - measured) / sigma, one entry per reading."""
        ...

    def angles(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """configurations x (theta1, theta2) [rad], true angles; empty for a joint test."""
        ...


@dataclass(frozen=True)
class Fit:
    """`x` in the parameters' units; `jacobian` of the data's whitened residuals by x / scale; `chi2` of the data
    alone; `readings` and `dof` count the data."""

    parameters: ParameterSet
    x: np.ndarray
    residual: np.ndarray
    jacobian: np.ndarray

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
        """By what the covariance must grow for the misfit to look like noise; at least 1."""
        return max(1.0, self.chi2 / self.dof)


def fit(
    problem: Problem,
    parameters: ParameterSet,
    starts: Iterable[np.ndarray] = (),
    constraint: Callable[[LimbModel, dict[str, float]], float] | None = None,
    advance: Callable[[int], None] = lambda _done: None,
) -> Fit:
    """The best fit over the parameters' start and further `starts` (vectors). `constraint`, if given, is driven
    to zero hard (a penalty that outweighs the data)."""
    from scipy.optimize import least_squares

    scale, prior, start = (parameters.array(name) for name in ("scale", "prior_sigma", "start"))
    low, high = parameters.array("low") / scale, parameters.array("high") / scale
    pull = np.where(np.isinf(prior), RIDGE, scale / np.where(np.isinf(prior), 1.0, prior))

    def whole(u: np.ndarray) -> np.ndarray:
        data = _data(problem, parameters, u * scale)
        rows = [data, pull * (u - start / scale)]
        if constraint is not None:
            rows.append(
                np.atleast_1d(1e3 * constraint(parameters.model(u * scale), parameters.nuisances(u * scale)))
            )
        return np.concatenate(rows)

    def slope(u: np.ndarray) -> np.ndarray:
        return _central(whole, u, low, high)

    best = None
    for number, point in enumerate([start, *starts]):
        inside = np.clip(point / scale, low + 1e-9, high - 1e-9)
        found = least_squares(
            whole,
            inside,
            jac=slope,
            bounds=(low, high),
            x_scale=1.0,
            ftol=TOLERANCE,
            xtol=TOLERANCE,
            gtol=TOLERANCE,
            max_nfev=200,
        )
        if best is None or found.cost < best.cost:
            best = found
        advance(number + 1)
    assert best is not None
    near = 1e-7  # of a scale from a bound is at it
    solved = np.where(best.x - low < near, low, np.where(high - best.x < near, high, best.x))
    residual = _data(problem, parameters, solved * scale)
    if np.abs(residual).max(initial=0.0) >= REFUSED:
        raise BadFileError(
            "no fit was found",
            where=parameters.base.where(),
            why="the simulated limb cannot be played near the start model",
            next_step="start from a model nearer to the limb",
        )
    jacobian = _central(lambda u: _data(problem, parameters, u * scale), solved, low, high)
    return Fit(parameters, solved * scale, residual, jacobian)


def _data(problem: Problem, parameters: ParameterSet, x: np.ndarray) -> np.ndarray:
    try:
        residual = problem.residual(parameters.model(x), parameters.nuisances(x))
        return np.asarray(np.clip(residual, -REFUSED, REFUSED))
    except BadFileError:
        return np.full(problem.count, REFUSED)


def _central(
    function: Callable[[np.ndarray], np.ndarray], u: np.ndarray, low: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Central differences, one-sided at a bound."""
    columns = []
    for index in range(u.size):
        up, down = u.copy(), u.copy()
        up[index] = min(u[index] + STEP, high[index])
        down[index] = max(u[index] - STEP, low[index])
        columns.append((function(up) - function(down)) / (up[index] - down[index]))
    return np.column_stack(columns)
