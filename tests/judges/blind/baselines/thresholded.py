"""PySINDy's sequentially thresholded least squares, alone and as an ensemble over bags of runs."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np

from baselines.answer import Answer, answer
from baselines.knobs import Knobs, Space, between, evenly, one_of
from baselines.signatures import Array, Signatures, triangle

BAGS = 10
MOST_ROUNDS = 20  # PySINDy's own

SPACE = Space(
    {"threshold": 4.0, "alpha": 0.05, "normalize": True, "screened": True, "least_gain": 0.0,
     "signed": True, "unknown_p": 0.0},
    {
        "threshold": between(2.5, 10.0),
        "alpha": between(1e-3, 3.0),
        "least_gain": one_of(0.0, 3.0, 4.0, 5.0, 6.0),
        "normalize": one_of(True, True, False),
        "screened": one_of(True, True, False),
        "signed": one_of(True, True, False),
        "unknown_p": one_of(0.0, 1e-12, 1e-8, 1e-5, 1e-3),
    },
)
ENSEMBLE_SPACE = Space(
    {"threshold": 4.0, "alpha": 0.05, "inclusion": 0.6, "median": True, "least_gain": 0.0,
     "signed": True, "unknown_p": 0.0},
    {
        "threshold": between(2.5, 10.0),
        "alpha": between(1e-3, 3.0),
        "least_gain": one_of(0.0, 3.0, 4.0, 5.0, 6.0),
        "inclusion": evenly(0.4, 0.9),
        "median": one_of(False, True),
        "signed": one_of(True, True, False),
        "unknown_p": one_of(0.0, 1e-12, 1e-8, 1e-5, 1e-3),
    },
)


def _stlsq(columns: Array, left: Array, threshold: float, alpha: float) -> Array:
    """Coefficients of STLSQ; all 0 where it takes everything out."""
    from pysindy.optimizers import STLSQ

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fitted = STLSQ(threshold=threshold, alpha=alpha, unbias=False).fit(columns, left[:, None])
    return np.asarray(fitted.coef_, float).ravel()


def quick_stlsq(columns: Array, left: Array, threshold: float, alpha: float) -> Array:
    """What `_stlsq` finds, without the library's checks, which cost ten times the sums: for bags."""
    gram, along = columns.T @ columns, columns.T @ left
    kept = np.arange(len(along))
    out = np.zeros(len(along))
    for _ in range(MOST_ROUNDS):
        ridge = np.linalg.solve(gram[np.ix_(kept, kept)] + alpha * np.eye(len(kept)), along[kept])
        big = np.abs(ridge) >= threshold
        out[:] = 0.0
        out[kept[big]] = ridge[big]
        if big.all():
            break
        kept = kept[big]
        if not len(kept):
            break
    return out


def stlsq(sig: Signatures, knobs: Knobs) -> Answer:
    """Once. `normalize`: coefficients in sigmas of the record; else in the catalogue's typical sizes, so that the
    threshold is one of size."""
    allowed = sig.screened if knobs["screened"] else np.arange(len(sig.columns))
    columns, threshold = sig.matrix[:, allowed], knobs["threshold"]
    if not knobs["normalize"]:
        lengths = np.array([sig.columns[i].length for i in allowed])
        columns = columns * lengths
        threshold /= float(np.median(lengths))  # the same range of thresholds serves both
    coefficients = _stlsq(columns, sig.left, threshold, knobs["alpha"])
    return answer(sig, _chosen(allowed, coefficients != 0.0), knobs["unknown_p"], knobs["signed"], knobs["least_gain"])


def ensemble(sig: Signatures, knobs: Knobs) -> Answer:
    """Bags of runs, drawn with replacement; a column is kept that is chosen in enough of the bags."""
    rng = np.random.default_rng(0)
    runs, priors = sig.blocks[:-1], sig.blocks[-1]
    found = []
    for _ in range(BAGS):
        weight = np.bincount(rng.integers(len(runs), size=len(runs)), minlength=len(runs))
        stacked = [np.sqrt(w) * root for w, root in zip(weight, runs, strict=True) if w]
        root = triangle(np.vstack([*stacked, priors]))
        found.append(quick_stlsq(root[:, :-1], root[:, -1], knobs["threshold"], knobs["alpha"]))
    coefficients = np.array(found)
    kept = np.mean(coefficients != 0.0, axis=0) >= knobs["inclusion"]
    if knobs["median"]:  # and whose middle coefficient passes the threshold as well
        kept &= np.abs(np.median(coefficients, axis=0)) >= knobs["threshold"]
    return answer(sig, _chosen(sig.screened, kept), knobs["unknown_p"], knobs["signed"], knobs["least_gain"])


def _chosen(allowed: Sequence[int] | np.ndarray, kept: np.ndarray) -> list[int]:
    return [int(i) for i, keep in zip(allowed, kept, strict=True) if keep]
