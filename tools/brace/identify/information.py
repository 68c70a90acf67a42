"""What the data say about each parameter: intervals (infinite where they say nothing) and correlations."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from brace.identify.fit import Fit

Z90 = 1.6448536269514722  # half-width of a 90 % interval in sigmas
MANY = 200  # readings from which Student's t is a normal variable, to half a per cent
NULL_TOLERANCE = 1e-6  # singular values below this share of the largest: no information
NULL_SHARE = 1e-3  # component of a direction without information that makes a parameter unknown


def half_width_90(freedom: float) -> float:
    """Half-width of a 90 % interval in sigmas, where sigma itself is known from so many independent readings only."""
    from scipy.special import stdtrit

    return Z90 if freedom > MANY else float(stdtrit(max(freedom, 1.0), 0.95))


@dataclass(frozen=True)
class Estimate:
    """A number with its 90 % interval. Where the record says nothing sigma is inf, and the interval is what the
    signs of the parameters alone leave (no compliance is negative)."""

    value: float
    sigma: float
    low: float
    high: float
    at_bound: str = ""  # "low", "high" or empty

    @property
    def identifiable(self) -> bool:
        """Do data and prior determine it?"""
        return math.isfinite(self.sigma)


@dataclass(frozen=True)
class Information:
    """Covariance in units of the parameters' scales, and the directions about which nothing is known."""

    fit: Fit
    covariance: np.ndarray
    null_directions: np.ndarray  # parameters x directions, unit columns
    condition: float

    def estimates(self) -> list[Estimate]:
        """One per parameter, misfit included: the covariance grows with chi2 per degree of freedom."""
        fit = self.fit
        scale, low, high = (fit.parameters.array(name) for name in ("scale", "low", "high"))
        unknown = self.unknown()
        result = []
        for index, value in enumerate(fit.x):
            sigma = scale[index] * math.sqrt(self.covariance[index, index] * fit.inflation)
            bound = (
                "low"
                if value - low[index] <= 1e-6 * scale[index]
                else "high" if high[index] - value <= 1e-6 * scale[index] else ""
            )
            lower, upper = value - self.half_width * sigma, value + self.half_width * sigma
            if unknown[index]:
                down, up = self._slack(np.eye(len(fit.x))[index])
                lower, upper, sigma = lower + down * scale[index], upper + up * scale[index], math.inf
            if bound and not unknown[index]:
                reach = self._reach_from_bound(index) * scale[index]
                lower, upper = (value, value + reach) if bound == "low" else (value - reach, value)
            bound = "" if unknown[index] else bound
            result.append(
                Estimate(
                    float(value), sigma, float(max(lower, low[index])), float(min(upper, high[index])), bound
                )
            )
        return result

    @property
    def half_width(self) -> float:
        """Of a 90 % interval, in sigmas."""
        return half_width_90(self.fit.dof)

    def unknown(self) -> np.ndarray:
        """For each parameter: does it take part in a direction about which nothing is known?"""
        if not self.null_directions.size:
            return np.zeros(len(self.fit.x), dtype=bool)
        return np.asarray(np.linalg.norm(self.null_directions, axis=1) > NULL_SHARE)

    def correlations(self, above: float = 0.9) -> list[tuple[str, str, float]]:
        """Pairs of parameters whose errors go together, strongest first; unknown ones are in the classes."""
        keys, unknown = self.fit.parameters.keys, self.unknown()
        spread = np.sqrt(np.diag(self.covariance))
        pairs = []
        for one in range(len(keys)):
            for other in range(one + 1, len(keys)):
                if unknown[one] or unknown[other] or not spread[one] * spread[other]:
                    continue
                value = self.covariance[one, other] / (spread[one] * spread[other])
                if abs(value) >= above:
                    pairs.append((keys[one], keys[other], float(value)))
        return sorted(pairs, key=lambda pair: -abs(pair[2]))

    def of_function(self, gradient: np.ndarray, value: float) -> Estimate:
        """A function of the parameters, to first order; `gradient` by x / scale."""
        norm = float(np.linalg.norm(gradient))
        if (
            self.null_directions.size
            and norm
            and np.linalg.norm(self.null_directions.T @ gradient) > 1e-2 * norm
        ):
            down, up = self._slack(gradient)
            spread = self.half_width * math.sqrt(
                max(0.0, float(gradient @ self.covariance @ gradient)) * self.fit.inflation
            )
            return Estimate(value, math.inf, value + down - spread, value + up + spread)
        sigma = math.sqrt(max(0.0, float(gradient @ self.covariance @ gradient)) * self.fit.inflation)
        return Estimate(value, sigma, value - self.half_width * sigma, value + self.half_width * sigma)

    def _slack(self, gradient: np.ndarray) -> tuple[float, float]:
        """How far down and up a linear function can go along the directions about which nothing is known, until a
        parameter meets its bound; by x / scale."""
        from scipy.optimize import linprog

        parameters = self.fit.parameters
        scale, low, high = (parameters.array(name) for name in ("scale", "low", "high"))
        directions = self.null_directions
        room = np.concatenate([(high - self.fit.x) / scale, (self.fit.x - low) / scale])
        limits = np.vstack([directions, -directions])
        finite = np.isfinite(room)
        ends = []
        for sign in (1.0, -1.0):
            found = linprog(
                sign * (gradient @ directions),
                A_ub=limits[finite],
                b_ub=np.maximum(room[finite], 0.0),
                bounds=(None, None),
            )
            ends.append(float(sign * found.fun) if found.success else -sign * math.inf)
        return ends[0], ends[1]

    def _reach_from_bound(self, index: int) -> float:
        """How far from its bound a parameter can go before chi2 has risen by 2.71, the others following."""
        fit = self.fit
        slope = abs(float(fit.jacobian[:, index] @ fit.residual)) / fit.inflation
        curvature = 1.0 / max(self.covariance[index, index] * fit.inflation, 1e-300)
        return float((-slope + math.sqrt(slope**2 + curvature * self.half_width**2)) / curvature)


def information(fit: Fit) -> Information:
    """From the Jacobian and the priors at the fit."""
    scale, prior = fit.parameters.array("scale"), fit.parameters.array("prior_sigma")
    rows = np.diag(np.where(np.isinf(prior), 0.0, scale / np.where(np.isinf(prior), 1.0, prior)))
    whole = np.vstack([fit.jacobian, rows])
    size = np.linalg.norm(whole, axis=0)
    silent = size == 0.0
    safe = np.where(silent, 1.0, size)
    _, singular, rotated = np.linalg.svd(whole / safe, full_matrices=False)
    known = singular > NULL_TOLERANCE * singular.max(initial=1e-300)
    inverse = rotated[known].T / singular[known]
    covariance = (inverse @ inverse.T) / np.outer(safe, safe)
    directions = rotated[~known].T / safe[:, None]  # back to units of the scales
    lengths = np.linalg.norm(directions, axis=0) if directions.size else np.ones(0)
    directions = directions / lengths if directions.size else np.zeros((len(fit.x), 0))
    if silent.any():
        directions = np.hstack([directions, np.eye(len(fit.x))[:, silent]])
    smallest = singular[known].min(initial=math.inf)
    return Information(fit, covariance, directions, float(singular.max(initial=0.0) / smallest))
