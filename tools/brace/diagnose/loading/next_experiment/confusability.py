"""Which effects of the catalogue look alike in this record: signatures at their fitted sizes, with what
calibration leaves open taken out, compared by principal angles and by the power to tell one from the
other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.next_experiment.separation import chance_to_win

TOLD_APART = 0.95  # power from which a look-alike is no member of the class
SAME_COSINE = 0.95  # above it two effects are one class: what they differ by is a tenth of either's square
DEPENDENT = 1e-6  # of a span's columns: shorter than this share after the others are taken out


@dataclass(frozen=True)
class Confusability:
    """Of `labels` (single effects that explain some of the record, most probable first): `cosine[a, b]`
    the share of a's signature, at its fitted size, that b's ways of showing can make; `angle_rad[a, b]`
    the smallest principal angle between the two spans; `detectability[a]` the length of a's signature in
    sigmas; `power[a, b]` the probability that a, if it is the truth, leads b by 3 nats on a record like
    this."""

    labels: tuple[str, ...]
    detectability: np.ndarray
    cosine: np.ndarray
    angle_rad: np.ndarray
    power: np.ndarray

    def look_alikes(self, label: str) -> tuple[str, ...]:
        """Labels that could make what `label` makes, itself first, most alike first."""
        if label not in self.labels:
            return (label,)
        row = self.cosine[self.labels.index(label)]
        found = [place for place in np.argsort(-row, kind="stable") if row[place] > SAME_COSINE]
        return (label, *(self.labels[place] for place in found if self.labels[place] != label))

    @property
    def classes(self) -> tuple[tuple[str, ...], ...]:
        """Groups of two and more in which each can make what another one makes."""
        alike = np.maximum(self.cosine, self.cosine.T) > SAME_COSINE
        left = list(range(len(self.labels)))
        groups = []
        while left:
            group, edge = [left[0]], [left.pop(0)]
            while edge:
                near = [place for place in left if alike[edge[0], place]]
                left = [place for place in left if place not in near]
                group += near
                edge = edge[1:] + near
            if len(group) > 1:
                groups.append(tuple(self.labels[place] for place in sorted(group)))
        return tuple(groups)


def confusability(base: Fit, sets: Sequence[LabelSet]) -> Confusability:
    """`base` is the fit without effects, `sets` what the search found, best first. A label that explains
    nothing of the record has no fitted size and is left out."""
    singles: dict[str, Fit] = {}
    for item in sets:
        if len(item.labels) == 1:
            singles.setdefault(next(iter(item.labels)), item.best.fit)
    base_left = _Removal(base)
    signatures, spans, labels = [], [], []
    for label, fitted in singles.items():
        signature = base_left.taken_out(_explained(base, fitted))
        own = slice(fitted.space.size - fitted.space.own, fitted.space.size)
        ways = [base_left.taken_out(column) for column in fitted.jacobian[:, own].T]
        span = _orthonormal(np.column_stack([signature, *ways]))
        if span.shape[1]:
            labels.append(label)
            signatures.append(signature)
            spans.append(span)
    lengths = np.array([float(np.linalg.norm(signature)) for signature in signatures])
    count = len(labels)
    cosine, angle = np.eye(count), np.zeros((count, count))
    for a in range(count):
        for b in range(count):
            if a == b:
                continue
            made = float(np.linalg.norm(spans[b].T @ signatures[a]))
            cosine[a, b] = min(1.0, made / lengths[a]) if lengths[a] > 0.0 else 0.0
            largest = np.linalg.svd(spans[a].T @ spans[b], compute_uv=False)[0]
            angle[a, b] = float(np.arccos(min(1.0, largest)))
    power = chance_to_win(lengths[:, None] ** 2 * (1.0 - cosine**2))
    return Confusability(tuple(labels), lengths, cosine, angle, power)


class _Removal:
    """Takes out of whitened readings, with the priors' pulls behind them, what the base's parameters can
    make up."""

    def __init__(self, base: Fit) -> None:
        weight = np.where(np.isinf(base.space.sigma), 1e-9, base.scale / base.space.sigma)
        self._basis, _ = np.linalg.qr(np.vstack([base.jacobian, np.diag(weight)]))

    def taken_out(self, readings: np.ndarray) -> np.ndarray:
        """Readings without pulls behind them have none."""
        whole = np.zeros(len(self._basis))
        whole[: readings.size] = readings
        return np.asarray(whole - self._basis @ (self._basis.T @ whole))


def _explained(base: Fit, fitted: Fit) -> np.ndarray:
    """What the effect takes off the base's residuals and pulls, each fitted to the end. The plain change
    of the readings with the effect would be right for small effects only; this holds at the fitted size."""
    pulls = dict(zip(fitted.space.keys, fitted.space.pull(fitted.x)))
    there = np.array([pulls.get(key, 0.0) for key in base.space.keys])
    return np.concatenate([base.residual - fitted.residual, there - base.space.pull(base.x)])


def _orthonormal(columns: np.ndarray) -> np.ndarray:
    """A basis of the columns' span; columns of no length, and what depends on others, left out."""
    lengths = np.linalg.norm(columns, axis=0)
    kept = columns[:, lengths > 0.0] / lengths[lengths > 0.0]
    if not kept.shape[1]:
        return np.empty((len(columns), 0))
    basis, sizes, _ = np.linalg.svd(kept, full_matrices=False)
    return np.asarray(basis[:, sizes > DEPENDENT * sizes[0]])


def in_words(found: Confusability, labels: Sequence[str]) -> tuple[str, ...]:
    """Sentences for a report. Each names one of `labels` and the labels that this record may not tell from it; a label
    that the record tells from all others has no sentence. Two labels that look like each other share the sentence of
    the first."""
    named: set[tuple[str, str]] = set()
    sentences = []
    for label in labels:
        row = found.labels.index(label) if label in found.labels else 0
        chance = {other: found.power[row, found.labels.index(other)] for other in found.look_alikes(label)[1:]}
        alike = [other for other, won in chance.items() if won <= TOLD_APART and (other, label) not in named]
        if alike:
            listed = ", ".join(
                f"{other} (of 100 such records {100.0 * chance[other]:.0f} would tell the two apart)" for other in alike
            )
            sentences.append(f"in this record {label} looks like {listed}")
        named |= {(label, other) for other in alike}
    return tuple(sentences)
