"""Could one effect that changes with time or with the sign of the load do what two effects of the catalogue are said to
do together? The catalogue has no such effect: then what is there is unknown."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.record import Record
from brace.diagnose.loading.screen import Remover

MUST_BEAT = 10.0  # of cost: an extension that is ahead by less may be the same thing by another name


def better_extension(record: Record, sets: Sequence[LabelSet]) -> str:
    """Words for the extension that explains more than the last of several effects does, or nothing."""
    best = sets[0]
    if len(best.labels) < 2:
        return ""
    for label in sorted(best.labels):
        rest = best.labels - {label}
        without = next((item for item in sets if item.labels == rest), None)
        if without is None:
            continue
        gained = without.best.fit.cost - best.best.fit.cost
        for words, gain in _extensions(record, without.best.fit):
            if gain > gained + MUST_BEAT:
                return words
    return ""


def _extensions(record: Record, fitted: Fit) -> list[tuple[str, float]]:
    """Each own key of the fit made to change with time or the load's sign, and what that would gain."""
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    rows = record.rows
    data = record.dataset
    along = np.where(data["axis"] == 1, data["dz_mm"], data["dx_mm"])
    time = (data["t_s"] - data["t_s"][0]) / max(float(np.ptp(data["t_s"])), 1e-9)
    starts = run_starts(data["run"])
    run_time = np.repeat(time[starts[:-1]], np.diff(starts))
    shapes = (
        ("growing with time", run_time - run_time.mean()),
        ("different for either sign of the load", np.sign(along)),
    )
    found = []
    for variant in fitted.space.variants:
        for freedom in variant.freedoms[:1]:
            column = fitted.jacobian[:, fitted.space.keys.index(freedom.key)].reshape(-1, rows)
            for words, shape in shapes:
                changed = remover.columns((column * shape).reshape(-1, 1))[:, 0]
                power = float(changed @ changed)
                gain = float(changed @ left) ** 2 / power if power > 1e-9 else 0.0
                found.append((f"{variant.label} {words}", gain))
    return found
