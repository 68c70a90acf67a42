"""How sure a name is: its share of the posterior, less the odds of something outside the catalogue, less how often a
record with something else in it would have made the same set of effects the best. The last part was counted on the
development cases of the blind benchmark."""

from __future__ import annotations

from typing import TYPE_CHECKING

from brace.diagnose.loading.choose import label_probability

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

# Share of the sets of one, two, three effects with all of the posterior behind them that were right.
RIGHT_BY_EFFECTS = {1: 0.985, 2: 0.985, 3: 0.93}
# Where the search without the held-out configurations found another set: share of the names in both sets that were
# right, by the effects of the whole record's set (7 of 7; 6 of 8 of three), and of the names that only the latter has
# (4 of 13), each with one right and one wrong added. Of both worlds' development cases and the engine's test set of
# seed 618243.
RIGHT_IN_BOTH = {1: 8 / 9, 2: 8 / 9, 3: 7 / 10}
RIGHT_IN_ONE = 5 / 15


def of_label(final: Pass, label: str) -> float:
    """Probability [0, 1] that this effect at this place is in the limb."""
    return of_a_name(final) * label_probability(final.sets, label)


def as_found_twice(final: Pass, twin: Pass | None, label: str) -> float:
    """What is left [0, 1] of a confidence in this name, by what the search without the held-out configurations found.
    A search that found nothing had too few readings to say."""
    if twin is None:
        return 1.0
    whole, part = final.decision.chosen.labels, twin.decision.chosen.labels
    if not part or part == whole:
        return 1.0
    return RIGHT_IN_ONE if label in whole - part else RIGHT_IN_BOTH[min(len(whole), 3)]


def of_a_name(final: Pass) -> float:
    """Probability [0, 1] that a name with all of the posterior behind it is right."""
    effects = max(1, len(final.decision.chosen.labels))
    return RIGHT_BY_EFFECTS[min(effects, 3)] * (1.0 - final.decision.outside.probability)
