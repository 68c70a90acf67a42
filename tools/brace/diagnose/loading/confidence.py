"""How sure a name is: its share of the posterior, less what records with something else in them would make of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from brace.diagnose.loading.choose import label_probability

if TYPE_CHECKING:
    from brace.diagnose.loading.agreement import Agreement
    from brace.diagnose.loading.run import Pass


def of_label(final: Pass, agreed: Agreement, label: str) -> float:
    """Probability [0, 1] that this effect at this place is in the limb."""
    return min(0.99, label_probability(final.sets, label))
