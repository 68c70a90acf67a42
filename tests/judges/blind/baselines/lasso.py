"""scikit-learn's LassoLarsIC: the lasso's path, cut where AIC or BIC is least."""

from __future__ import annotations

import math
import warnings

import numpy as np

from baselines.answer import Answer, answer, refitted
from baselines.knobs import Knobs, Space, between, one_of
from baselines.signatures import Signatures

PATH_STEPS = 80

SPACE = Space(
    {"criterion": "bic", "noise": "given", "penalty": 1.0, "positive": False, "screened": False, "least_gain": 0.0,
     "signed": True, "unknown_p": 0.0},
    {
        "criterion": one_of("aic", "bic"),
        "noise": one_of("given", "estimated"),
        "penalty": between(0.7, 8.0),
        "positive": one_of(False, True),
        "screened": one_of(False, True),
        "least_gain": one_of(0.0, 2.0, 3.0, 4.0, 5.0, 6.0),
        "signed": one_of(True, True, False),
        "unknown_p": one_of(0.0, 1e-12, 1e-8, 1e-5, 1e-3),
    },
)  # fmt: skip


def lasso_ic(sig: Signatures, knobs: Knobs) -> Answer:
    """On the triangular root. Its few rows stand for all the readings: BIC's log of their number is put right through
    the noise variance, which leaves the minimum where all the rows have it."""
    from sklearn.linear_model import LassoLarsIC

    allowed = sig.screened if knobs["screened"] else np.arange(len(sig.columns))
    columns = sig.matrix[:, allowed]
    both = [k for k, i in enumerate(allowed) if not sig.columns[i].one_sided]
    if knobs["positive"]:
        columns = np.hstack([columns, -columns[:, both]])
    variance = 1.0
    if knobs["noise"] == "estimated":
        variance = refitted(sig, list(allowed))[1] / max(sig.readings - len(allowed), 1)
    variance *= knobs["penalty"]
    if knobs["criterion"] == "bic":
        variance *= math.log(sig.readings) / math.log(len(columns))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = LassoLarsIC(
            criterion=knobs["criterion"], fit_intercept=False, max_iter=PATH_STEPS, positive=knobs["positive"],
            noise_variance=variance,
        ).fit(columns, sig.left)  # fmt: skip
    back = np.concatenate([np.arange(len(allowed)), np.array(both, dtype=int)])
    chosen = {int(allowed[back[k]]) for k in np.flatnonzero(path.coef_)}
    return answer(sig, sorted(chosen), knobs["unknown_p"], knobs["signed"], knobs["least_gain"])
