"""The refit held to what calibration allows: what a record may explain by the believed limb alone. A plain refit goes
further, because thousands of readings outweigh the few sigmas that a calibration is trusted to."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2

from brace.diagnose.loading.fit import Fit, jacobian, residuals
from brace.diagnose.loading.space import Space
from brace.identify.record import Record

ALLOWED_SHARE = 0.9973  # of calibrations as good as [uncertainty] says, three sigma of one number
ROUNDS = 3  # of linearising anew: the ball is small


def pull_sigma(fitted: Fit) -> float:
    """How far all calibrated numbers of a fit are from their calibration together [sigma]."""
    return float(np.linalg.norm(fitted.space.pull(fitted.x)))


def allowed_sigma(space: Space) -> float:
    """How far they may be."""
    return float(np.sqrt(chi2.ppf(ALLOWED_SHARE, max(1, int(np.isfinite(space.sigma).sum())))))


def within_trust(record: Record, refitted: Fit) -> np.ndarray | None:
    """The best limb's numbers no further off than allowed; None where the refit itself is not."""
    space, allowed = refitted.space, allowed_sigma(refitted.space)
    if pull_sigma(refitted) <= allowed:
        return None
    trusted = np.isfinite(space.sigma)
    x = np.where(trusted, space.mean, refitted.x)
    for _ in range(ROUNDS):
        x = _next(record, refitted, x, trusted, allowed)
    return np.asarray(space.models(x[None])[0])


def _next(record: Record, refitted: Fit, x: np.ndarray, trusted: np.ndarray, allowed: float) -> np.ndarray:
    """One linearised step: the least squares under the bound, by the multiplier that reaches it."""
    space, scale = refitted.space, refitted.scale
    residual = residuals(record, space, x[None])[0]
    columns = jacobian(record, space, x, residual, scale, True)
    unit = np.where(trusted, space.sigma, scale)  # so that a pull is the length of the trusted part
    columns = columns * (unit / scale)
    now = np.where(trusted, (x - space.mean) / unit, 0.0)
    wanted = columns.T @ (residual + columns @ now)
    normal = columns.T @ columns + 1e-9 * np.diag((columns**2).sum(axis=0) + 1e-12)

    def at(multiplier: float) -> np.ndarray:
        return np.asarray(np.linalg.solve(normal + multiplier * np.diag(trusted.astype(float)), wanted))

    def beyond(log_multiplier: float) -> float:
        return float(np.linalg.norm(at(np.exp(log_multiplier))[trusted])) - allowed

    low, high = -20.0, 40.0
    there = at(np.exp(low if beyond(low) <= 0.0 else brentq(beyond, low, high)))
    moved = np.where(trusted, space.mean + unit * there, x + unit * there)
    return np.asarray(np.clip(moved, space.low, space.high))
