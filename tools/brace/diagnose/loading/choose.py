"""From scored hypotheses to what may be said: which set of effects, how probable, and what else it could be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.loading.search import Hypothesis
from brace.effects import Variant

WORTH_SAYING = 0.05  # posterior share from which a rival is listed


@dataclass(frozen=True)
class LabelSet:
    """All ways of one set of effects: the best of them, and the set's share of the posterior."""

    labels: frozenset[str]
    best: Hypothesis
    posterior: float

    @property
    def label(self) -> str:
        return self.best.label


def way_prior(variants: Sequence[Variant]) -> dict[tuple[str, tuple[str, ...]], float]:
    """Log prior of each way of an effect, by (label, keys). The principal way is listed first and has half of it; the
    others share the rest."""
    ways: dict[str, list[Variant]] = {}
    for variant in variants:
        ways.setdefault(variant.label, []).append(variant)
    prior: dict[tuple[str, tuple[str, ...]], float] = {}
    for label, all_ways in ways.items():
        for place, variant in enumerate(all_ways):
            part = 1.0 if len(all_ways) == 1 else 0.5 if place == 0 else 0.5 / (len(all_ways) - 1)
            prior[label, _way(variant)] = float(np.log(part))
    return prior


def _way(variant: Variant) -> tuple[str, ...]:
    """Keeps freedoms and settings apart, so that a key that is set and a key that is fitted make two ways."""
    return (*(freedom.key for freedom in variant.freedoms), "set", *variant.settings)


def posterior_of(hypotheses: Sequence[Hypothesis], variants: Sequence[Variant]) -> list[LabelSet]:
    """Sets of effects by falling posterior; the ways of one effect share its prior."""
    prior = way_prior(variants)
    groups: dict[frozenset[str], list[tuple[float, Hypothesis]]] = {}
    for hypothesis in hypotheses:
        share = sum(prior[variant.label, _way(variant)] for variant in hypothesis.variants)
        groups.setdefault(hypothesis.labels, []).append((hypothesis.score + share, hypothesis))
    logs = {labels: _log_sum([value for value, _ in ways]) for labels, ways in groups.items()}
    whole = _log_sum(list(logs.values()))
    found = [
        LabelSet(labels, max(ways, key=lambda way: way[0])[1], float(np.exp(logs[labels] - whole)))
        for labels, ways in groups.items()
    ]
    return sorted(found, key=lambda item: (-item.posterior, item.label))


def _log_sum(values: Sequence[float]) -> float:
    top = max(values)
    return float(top + np.log(np.sum(np.exp(np.array(values) - top))))


def label_probability(sets: Sequence[LabelSet], label: str) -> float:
    """Share of the posterior in which this effect takes part."""
    return float(sum(item.posterior for item in sets if label in item.labels))


def rivals(sets: Sequence[LabelSet], label: str) -> list[str]:
    """Labels that could stand in place of `label` in the best set, itself first, by falling posterior."""
    chosen = sets[0].labels
    rest = chosen - {label}
    stand_in: dict[str, float] = {}
    for item in sets:
        if len(item.labels) == len(chosen) and rest < item.labels or item.labels == chosen:
            (other,) = item.labels - rest
            stand_in[other] = item.posterior
    top = stand_in.get(label, 1.0)
    others = sorted((name for name in stand_in if name != label), key=lambda name: (-stand_in[name], name))
    return [label, *(name for name in others if stand_in[name] >= WORTH_SAYING * top)]
