"""From posterior and left-over structure to a verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from brace.diagnose.diagnosis import Verdict
from brace.diagnose.loading.choose import LabelSet, label_probability, rivals
from brace.diagnose.loading.extensions import Outside
from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.structure import Structure

NOTHING_STANDS = 0.01  # posterior share of nothing missing from which nothing is claimed: a healthy limb that is called
# faulty costs more trust than a weak effect that a second record would show
HINT = 0.2  # share of nothing missing below which a second record is worth its time
SURE = 0.8  # posterior share from which one member of a class is named alone
SMALL_REST = 0.03  # of what an effect explains: structure left below it does not unname the effect


@dataclass(frozen=True)
class Decision:
    """`labels` are the effects that are named, most probable first; `classes` hold, for each of them that has rivals,
    the labels that the record cannot tell from it; `chosen` is the set whose model is exported."""

    verdict: Verdict
    labels: tuple[str, ...]
    classes: tuple[tuple[str, ...], ...]
    chosen: LabelSet
    structure: Structure
    outside: Outside

    @property
    def hint_odds(self) -> float | None:
        """Of something missing against nothing, where they are worth reporting but not enough to name it."""
        nothing = self.chosen.posterior
        is_reported = self.verdict == "none" and nothing < HINT
        return (1.0 - nothing) / nothing if is_reported else None


def decide(sets: Sequence[LabelSet], structure: Structure, base: Fit, outside: Outside) -> Decision:
    """`structure` is what the best set leaves; `outside` is what speaks for something that is not in the catalogue."""
    best = sets[0]
    if outside.likely or (structure.structured and not _small_rest(best, structure, base)):
        return Decision("unknown", (), (), best, structure, outside)
    nothing = next((item for item in sets if not item.labels), None)
    if nothing is not None and nothing.posterior > NOTHING_STANDS:
        return Decision("none", (), (), nothing, structure, outside)
    ordered = sorted(best.labels, key=lambda label: (-_drop(sets, best, label), label))
    classes = tuple(
        tuple(group) for label in ordered if len(group := rivals(sets, label)) > 1
    )
    if len(ordered) == 1 and classes and label_probability(sets, ordered[0]) < SURE:
        return Decision("ambiguous", classes[0], classes, best, structure, outside)
    return Decision("effect", tuple(ordered), classes, best, structure, outside)


def undecided(decision: Decision, lead: float, words: str) -> Decision:
    """The decision `unknown` in place of this one: something explains the record better by `lead` nats than what was
    chosen, and `words` say what the record looks like."""
    return Decision("unknown", (), (), decision.chosen, decision.structure, Outside(lead, words))


def _small_rest(best: LabelSet, structure: Structure, base: Fit) -> bool:
    """Whether what is left is next to nothing beside what the effects explain."""
    explained = base.cost - best.best.fit.cost
    return bool(best.labels) and structure.strongest.gain < SMALL_REST * explained


def _drop(sets: Sequence[LabelSet], best: LabelSet, label: str) -> float:
    """What the best set loses of its likelihood without this effect."""
    without = best.labels - {label}
    costs = [item.best.fit.cost for item in sets if item.labels == without]
    return min(costs) - best.best.fit.cost if costs else 0.0
