"""Searches the catalogue for hypotheses: every single effect, then pairs and triples from the best. Each is fitted on
the plant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from brace.diagnose.loading.evidence import evidence, score
from brace.diagnose.loading.fit import KEPT_PROMISE, Fit, fit
from brace.identify.record import Record
from brace.diagnose.loading.screen import Promise, screen
from brace.diagnose.loading.space import Trust, space_of
from brace.diagnose.options import Advance, silent
from brace.effects import Variant

MOST_EFFECTS = 3
PARENTS = {1: 5, 2: 3}  # hypotheses of so many effects that the next are grown from
CHILDREN = 5  # labels that are fitted beside each parent
LEAST_GAIN = 1.0  # of cost: what gains less is no hypothesis of its own
READINGS_EACH = 3  # of a tip that was moved, that every freedom of a hypothesis must have: with fewer all would fit
NEAR_BEST = 5.0  # nats: a promise that would come so near to the best so far is worth a fit to the end
GROW_GAIN = 9.0  # of promised cost: a child that promises less is not fitted


@dataclass(frozen=True)
class Hypothesis:
    """A set of effects with its fit; `score` is its log evidence over nothing missing, priors included."""

    fit: Fit
    score: float

    @property
    def variants(self) -> tuple[Variant, ...]:
        return self.fit.space.variants

    @property
    def labels(self) -> frozenset[str]:
        return frozenset(variant.label for variant in self.variants)

    @property
    def label(self) -> str:
        return " + ".join(sorted(self.labels)) or "none"


@dataclass
class Search:
    """What was tried, by the set of variants."""

    record: Record
    trust: Trust
    variants: Sequence[Variant]
    advance: Advance = silent
    base: Hypothesis = field(init=False)
    tried: dict[frozenset[tuple[str, tuple[str, ...]]], Hypothesis] = field(default_factory=dict)

    def __post_init__(self) -> None:
        space = space_of(self.trust, ())
        fitted = fit(self.record, space, space.mean)
        self.base = Hypothesis(fitted, 0.0)
        self.tried[frozenset()] = self.base

    def run(self) -> list[Hypothesis]:
        """All hypotheses, best first."""
        singles = screen(self.record, self.trust, self.base.fit, self.variants)
        for number, promise in enumerate(singles):
            self.advance(0.4 * number / len(singles), f"trying {promise.space.label}")
            self._fit(promise, self.base)
        for size in range(1, MOST_EFFECTS):
            parents = [self._finished(parent) for parent in self._best(size)[: PARENTS[size]]]
            for number, parent in enumerate(parents):
                share = 0.4 + 0.3 * (size - 1 + number / len(parents))
                self.advance(share, f"trying {parent.label} and one more")
                self._grow(parent)
        self._parts_of(self.ranked()[0])
        return self.ranked()

    def ranked(self) -> list[Hypothesis]:
        return sorted(self.tried.values(), key=lambda item: (-item.score, item.label))

    def _parts_of(self, best: Hypothesis) -> None:
        """The sets that are left of the best one without some of its effects, where no search came that way. They show
        what an effect is worth, and a trouble of the instruments may stand in the place of the others."""
        parts = [part for size in range(1, len(best.variants)) for part in combinations(best.variants, size)]
        for part in parts:
            if any(item.labels == {variant.label for variant in part} for item in self.tried.values()):
                continue
            space = space_of(self.trust, part)
            known = dict(zip(best.fit.space.keys, best.fit.x))
            start = np.array([known.get(key, middle) for key, middle in zip(space.keys, space.mean)])
            self._keep(fit(self.record, space, np.clip(start, space.low, space.high), final=False))

    def _best(self, size: int) -> list[Hypothesis]:
        """The best hypothesis of each set of labels with this many effects."""
        best: dict[frozenset[str], Hypothesis] = {}
        for hypothesis in self.ranked():
            if len(hypothesis.variants) == size and hypothesis.labels not in best:
                best[hypothesis.labels] = hypothesis
        return list(best.values())

    def _grow(self, parent: Hypothesis) -> None:
        seen: list[str] = []
        for promise in screen(self.record, self.trust, parent.fit, self.variants):
            label = promise.space.variants[-1].label
            if parent.fit.cost - promise.cost < GROW_GAIN or (label not in seen and len(seen) >= CHILDREN):
                continue
            if label not in seen:
                seen.append(label)
            self._fit(promise, parent)

    def _fit(self, promise: Promise, parent: Hypothesis) -> None:
        too_many = READINGS_EACH * promise.space.own > self.record.moved_readings
        if _name(promise.space.variants) in self.tried or too_many:
            return
        fitted = fit(self.record, promise.space, promise.start, final=False)
        if self._fell_short(promise, fitted, parent):
            start = fitted.x if fitted.cost < parent.fit.cost else promise.start
            fitted = min(fitted, fit(self.record, promise.space, start), key=lambda one: one.cost)
        if parent.fit.cost - fitted.cost > LEAST_GAIN:
            self._keep(fitted)

    def _fell_short(self, promise: Promise, fitted: Fit, parent: Hypothesis) -> bool:
        """Whether a rough fit kept little of a promise that would make it one of the best. Its derivatives are those of
        a limb that does not turn, and in a record of large displacements they may lead nowhere."""
        kept, promised = parent.fit.cost - fitted.cost, parent.fit.cost - promise.cost
        if kept > KEPT_PROMISE * promised:
            return False
        own, effects, base = promise.space.own, len(promise.space.variants), self.base.fit
        hoped = evidence(promise.cost, base.cost, own, effects, self.record.readings, self.record.noise_freedom)
        return hoped > max(one.score for one in self.tried.values()) - NEAR_BEST

    def _finished(self, rough: Hypothesis) -> Hypothesis:
        """Fitted to the end: the rough fit of an effect that turns the limb may stop far from it, and further effects
        would make up for that."""
        fitted = fit(self.record, rough.fit.space, rough.fit.x)
        return self._keep(fitted) if fitted.cost < rough.fit.cost else rough

    def _keep(self, fitted: Fit) -> Hypothesis:
        worth = score(fitted, self.base.fit, self.record.readings, self.record.noise_freedom)
        kept = self.tried[_name(fitted.space.variants)] = Hypothesis(fitted, worth)
        return kept


def _name(variants: Sequence[Variant]) -> frozenset[tuple[str, tuple[str, ...]]]:
    return frozenset((variant.label, variant.keys) for variant in variants)
