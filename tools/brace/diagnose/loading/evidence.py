"""How much a hypothesis is worth: its likelihood after refitting everything, less what its freedoms cost.

The prior of an effect's size is set in the data's own measure: of the record's readings it may move any number of
sigmas, spread evenly over `SPREAD` of them (a g-prior), so that a freedom costs the same whatever its unit."""

from __future__ import annotations

import numpy as np

from brace.diagnose.loading.fit import Fit

SPREAD = 40.0  # sigmas of the whole record: detectabilities of interest are some to some tens
PRIOR_NONE = 0.5
RARE_SIGMAS = 3.0  # of the prior on a size: so far out lies the ratio that the catalogue calls `plausible_times`
WAYS = 30  # effects at their places, about equally likely before the record is seen


def freedoms(fitted: Fit) -> int:
    """Own keys that are not held at a bound."""
    space = fitted.space
    own = slice(space.size - space.own, space.size)
    inside = (fitted.x[own] > space.low[own]) & (fitted.x[own] < space.high[own])
    return int(np.count_nonzero(inside))


def score(fitted: Fit, base: Fit, readings: int, noise_freedom: float) -> float:
    """Log posterior odds of a fit against nothing missing."""
    effects = len(fitted.space.variants)
    return evidence(fitted.cost, base.cost, freedoms(fitted), effects, readings, noise_freedom)


def evidence(cost: float, base: float, own: int, effects: int, readings: int, noise_freedom: float) -> float:
    """Log posterior odds of `effects` with so many freedoms of their `own` that bring the cost down from `base`. The
    noise is known only as well as `noise_freedom` independent readings show it, and integrated out (a Student
    likelihood)."""
    known = max(noise_freedom, 1.0)
    gain = 0.5 * (known + readings) * np.log((known + base) / (known + cost))
    return float(gain - own * np.log(SPREAD) - effects * np.log(WAYS / PRIOR_NONE))


def implausible(times: float, plausible_times: float) -> float:
    """What a size costs in nats if it is `times` the usual one. The prior is normal in the logarithm of that ratio.
    A size up to the usual one costs nothing."""
    return float(0.5 * (RARE_SIGMAS * np.log(max(times, 1.0)) / np.log(plausible_times)) ** 2)


def log_likelihood(fitted: Fit, sigma: np.ndarray, readings: int, noise_freedom: float) -> float:
    """Of the readings themselves, so that noises can be compared as well."""
    known = max(noise_freedom, 1.0)
    return float(
        -0.5 * (known + readings) * np.log1p(fitted.cost / known) - np.sum(np.log(sigma))
    )
