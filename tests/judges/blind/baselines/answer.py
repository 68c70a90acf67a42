"""From chosen columns to an answer in the form of diagnosis.json, the same way for every baseline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import chi2

from baselines.signatures import Array, Signatures

CLASS_COSINE = 0.9  # of two labels' columns, from which they are printed together


@dataclass(frozen=True)
class Answer:
    """`found` is what a diagnosis.json would hold; `chosen` columns with their `coefficients` in sigmas."""

    found: dict[str, Any]
    chosen: tuple[int, ...] = ()
    coefficients: tuple[float, ...] = ()


def refitted(sig: Signatures, chosen: Sequence[int]) -> tuple[Array, float]:
    """Least squares on the chosen columns: coefficients and the sum of squares left."""
    if not len(chosen):
        return np.empty(0), float(sig.left @ sig.left)
    part = sig.matrix[:, list(chosen)]
    coefficients = np.asarray(np.linalg.lstsq(part, sig.left, rcond=1e-8)[0], float)
    off = sig.left - part @ coefficients
    return coefficients, float(off @ off)


def answer(sig: Signatures, chosen: Sequence[int], unknown_p: float, signed: bool, least_gain: float = 0.0) -> Answer:
    """Refits; drops effects of impossible sign (`signed`) and those that gain less than `least_gain` sigmas; orders by
    what each effect gains; `unknown` where chi squared of what is left has a p below `unknown_p`."""
    kept = sorted(set(int(i) for i in chosen))
    while True:
        coefficients, squares = refitted(sig, kept)
        wrong = [
            k for k, (i, value) in enumerate(zip(kept, coefficients, strict=True))
            if signed and sig.columns[i].one_sided and value < 0.0
        ]  # fmt: skip
        if wrong:
            kept.pop(min(wrong, key=lambda k: coefficients[k]))
            continue
        gains = _gains(sig, kept, squares)
        weakest = min(gains, key=lambda label: gains[label], default=None)
        if weakest is None or gains[weakest] >= least_gain**2:
            break
        kept = [i for i in kept if sig.columns[i].label != weakest]
    freedom = max(sig.readings - len(kept), 1)
    if chi2.sf(squares, freedom) < unknown_p:
        return Answer({"verdict": "unknown", "effects": [], "indistinguishable": []}, tuple(kept), tuple(coefficients))
    order = sorted(gains, key=lambda label: (-gains[label], label))
    effects = [
        {"name": label.split("@")[0], "where": label.split("@")[1], "confidence": 1.0, "parameters": {}}
        for label in order
    ]
    groups = [group for label in order if len(group := _class(sig, kept, label)) > 1]
    verdict = "effect" if effects else "none"
    found = {"verdict": verdict, "effects": effects, "indistinguishable": groups}
    return Answer(found, tuple(kept), tuple(float(x) for x in coefficients))


def _gains(sig: Signatures, kept: Sequence[int], squares: float) -> dict[str, float]:
    """What chi squared rises by without each label."""
    labels = {sig.columns[i].label for i in kept}
    return {
        label: refitted(sig, [i for i in kept if sig.columns[i].label != label])[1] - squares for label in labels
    }


def _class(sig: Signatures, kept: Sequence[int], label: str) -> list[str]:
    """The label and those that have a column much like one of its chosen ones."""
    own = [i for i in kept if sig.columns[i].label == label]
    alike = np.abs(sig.matrix[:, own].T @ sig.matrix).max(axis=0) > CLASS_COSINE
    return sorted({label, *(sig.columns[int(i)].label for i in np.flatnonzero(alike))})
