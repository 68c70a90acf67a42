"""The baselines that name effects, by the name that the table prints."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from baselines import forward, gaussian_process, lasso, thresholded
from baselines.answer import Answer
from baselines.knobs import Knobs, Space
from baselines.signatures import Signatures

PROCESS = "Gaussian process"
TUNED = Path(__file__).with_name("tuned.json")


@dataclass(frozen=True)
class Method:
    """How it chooses, and what can be set."""

    choose: Callable[[Signatures, Knobs], Answer]
    space: Space


NAMING = {
    "forward selection, BIC": Method(forward.forward_bic, forward.SPACE),
    "LassoLarsIC": Method(lasso.lasso_ic, lasso.SPACE),
    "STLSQ": Method(thresholded.stlsq, thresholded.SPACE),
    "ensemble SINDy": Method(thresholded.ensemble, thresholded.ENSEMBLE_SPACE),
}


def tuned() -> dict[str, Any]:
    """What tune.py has written: per method its knobs, and how they came about."""
    found: dict[str, Any] = json.loads(TUNED.read_text())
    return found


def tuned_knobs(name: str) -> Knobs:
    """A method's knobs; the textbook's where it has not been tuned."""
    entry = tuned()["methods"].get(name)
    return dict(entry["knobs"] if entry else spaces()[name].textbook)


def spaces() -> dict[str, Space]:
    """What can be set, the process included."""
    return {**{name: method.space for name, method in NAMING.items()}, PROCESS: gaussian_process.SPACE}
