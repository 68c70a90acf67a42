"""A Gaussian process over posture, displacement and branch for what the refitted limb leaves of the forces. It names
nothing; it may close the gap on unseen configurations."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import minimize

from baselines.knobs import Knobs, Space, between, one_of
from baselines.play import FORCES, Unseen
from baselines.signatures import Array

MOST_ROWS = 600  # that it is conditioned on
ROWS_TO_LEARN = 150  # that its length scales are learned from
MOST_STEPS = 15

SPACE = Space(
    {"kernel": "rbf", "angle_rad": 1.0, "displacement": 1.0, "branch": 2.0, "amplitude": 1.0, "nugget": 1.0,
     "learn": True},
    {
        "kernel": one_of("rbf", "matern32"),
        "angle_rad": between(0.15, 5.0),
        "displacement": between(0.2, 5.0),
        "branch": between(0.5, 20.0),
        "amplitude": between(0.3, 10.0),
        "nugget": between(0.5, 5.0),
        "learn": one_of(False, True),
    },
)  # fmt: skip


@dataclass(frozen=True)
class Discrepancy:
    """Inputs (rows x 5) of the record and of the hold-out; what is left of the record, in sigmas (rows x 2); sigmas of
    the forces [N]; forces of the refitted limb and of the true one on the hold-out (rows x 2) [N]; the believed limb's
    gap there [N]."""

    inputs: Array
    left: Array
    sigma_n: Array
    unseen: Array
    unseen_base_n: Array
    unseen_true_n: Array
    before_n: float


def discrepancy_of(ready: Any, unseen: Unseen) -> Discrepancy:
    """From a prepared record and its hold-out."""
    _, record, trust, base = ready
    reach = max(float(np.abs(record.dataset["dx_mm"]).max()), float(np.abs(record.dataset["dz_mm"]).max()), 1e-9)
    left = base.residual.reshape(len(record.channels), -1)[: len(FORCES)]
    return Discrepancy(
        _inputs(record.dataset, reach),
        left.T.copy(),
        record.sigma[: len(FORCES)].T.copy(),
        _inputs(unseen.data, reach),
        unseen.played(base.model).T.copy(),
        unseen.forces.T.copy(),
        unseen.gap_n(unseen.played(trust.numbers)),
    )


def _inputs(data: Any, reach_mm: float) -> Array:
    """Angles [rad], displacements as shares of the record's reach, branch: +1 away from the start, -1 back."""
    along = np.where(data["axis"] == 1, data["dz_mm"], data["dx_mm"])
    way = np.sign(np.diff(np.abs(along), prepend=0.0))
    return np.stack(
        [data["theta1_rad"], data["theta2_rad"], data["dx_mm"] / reach_mm, data["dz_mm"] / reach_mm, way], axis=1
    ).astype(float)


def closed(case: Discrepancy, knobs: Knobs) -> float:
    """Share of the gap on the hold-out that the refitted limb and the process together close."""
    after_n = case.unseen_base_n + predicted(case, knobs) * np.median(case.sigma_n, axis=0)
    rms = float(np.sqrt(np.mean((after_n - case.unseen_true_n) ** 2)))
    return 1.0 - rms / case.before_n


def predicted(case: Discrepancy, knobs: Knobs) -> Array:
    """The process' mean on the hold-out, in sigmas."""
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, Matern

    rng = np.random.default_rng(0)
    rows = rng.permutation(len(case.inputs))[:MOST_ROWS]
    rms = max(float(np.sqrt(np.mean(case.left**2))), 1e-6)
    lengths = [knobs["angle_rad"]] * 2 + [knobs["displacement"]] * 2 + [knobs["branch"]]
    bounds = (0.05, 50.0)
    shape = RBF(lengths, bounds) if knobs["kernel"] == "rbf" else Matern(lengths, bounds, nu=1.5)
    kernel = ConstantKernel((knobs["amplitude"] * rms) ** 2, (1e-3, 1e8)) * shape
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if knobs["learn"]:
            few = rows[:ROWS_TO_LEARN]
            learned = GaussianProcessRegressor(kernel, alpha=knobs["nugget"], optimizer=_briefly)
            kernel = learned.fit(case.inputs[few], case.left[few]).kernel_
        process = GaussianProcessRegressor(kernel, alpha=knobs["nugget"], optimizer=None)
        process.fit(case.inputs[rows], case.left[rows])
        return np.asarray(process.predict(case.unseen), float)


def _briefly(objective: Any, start: Array, bounds: Array) -> tuple[Array, float]:
    """L-BFGS-B, a few steps."""
    found = minimize(objective, start, method="L-BFGS-B", jac=True, bounds=bounds, options={"maxiter": MOST_STEPS})
    return found.x, float(found.fun)
