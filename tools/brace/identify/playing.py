"""Loading records on the plant."""

from __future__ import annotations

from collections.abc import Sequence

from brace.dataset import Dataset
from brace.native.plant_batch import LoadingBatchPlayer


def player_of(dataset: Dataset, readings: Sequence[str], *, zeroed: bool = False) -> LoadingBatchPlayer:
    """Plays the record's displacements as its limb made them."""
    return LoadingBatchPlayer(
        dataset.columns,
        readings,
        zeroed=zeroed,
        small_displacements=dataset.small_displacements,
        held_at_rest=dataset.meta.held_at_rest,
    )
