"""Do the locked configurations and resampled runs agree with what the evidence chose?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.identify.record import Record

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

RESAMPLES = 400
RIVALS = 12


@dataclass(frozen=True)
class Agreement:
    """`held_out_nats`: log-likelihood of the locked configurations under the twin's choice, less that under its base
    (None: nothing locked, or nothing chosen). `bootstrap_share`: share of resamplings of the runs in which what was
    chosen stays ahead of every other set and of nothing missing."""

    held_out_nats: float | None
    bootstrap_share: float


def agreement(record: Record, locked: np.ndarray, final: Pass, twin: Pass | None, seed: int) -> Agreement:
    """For the report; neither turns the choice."""
    held_out = None
    if twin is not None and twin.decision.chosen.labels:
        models = np.stack([twin.base.fit.model, twin.decision.chosen.best.fit.model])
        off = record.residuals(models).reshape(2, len(record.channels), -1)[:, :, locked]
        chi2 = np.sum(off**2, axis=(1, 2))
        held_out = float(0.5 * (chi2[0] - chi2[1]))
    return Agreement(held_out, _bootstrap_share(final, seed))


def _bootstrap_share(final: Pass, seed: int) -> float:
    """Runs drawn with replacement; fits stay, their costs are counted anew; what freedoms cost stays as it was."""
    record = final.record
    starts = run_starts(record.dataset["run"])
    shape = record.measured.shape
    sets = final.sets[:RIVALS]
    by_run, fixed = [], []
    for item in sets:
        fitted = item.best.fit
        square = np.sum(fitted.residual.reshape(shape) ** 2, axis=0)
        by_run.append(np.add.reduceat(square, starts[:-1]))
        fixed.append(np.log(max(item.posterior, 1e-300)) + 0.5 * fitted.chi2)
    costs, complexity = np.stack(by_run), np.array(fixed)
    rng = np.random.default_rng([seed, 0xB007])
    weights = rng.multinomial(costs.shape[1], np.full(costs.shape[1], 1.0 / costs.shape[1]), size=RESAMPLES)
    scores = complexity[:, None] - 0.5 * (costs @ weights.T)
    chosen = next(i for i, item in enumerate(sets) if item.labels == final.decision.chosen.labels)
    return float(np.mean(np.argmax(scores, axis=0) == chosen))
