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


def of_label(final: Pass, label: str) -> float:
    """Probability [0, 1] that this effect at this place is in the limb."""
    return of_a_name(final) * label_probability(final.sets, label)


def of_a_name(final: Pass) -> float:
    """Probability [0, 1] that a name with all of the posterior behind it is right."""
    effects = max(1, len(final.decision.chosen.labels))
    return RIGHT_BY_EFFECTS[min(effects, 3)] * (1.0 - final.decision.outside.probability)
