"""From the plant's numbers back to a limb model."""

from __future__ import annotations

from typing import Any

import numpy as np

from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME, LINKS
from brace.native.plant_batch import model_numbers, number_index


def limb_of(believed: LimbModel, numbers: np.ndarray) -> LimbModel:
    """The believed limb with every number that differs replaced; kept within the format's ranges."""
    before = model_numbers(believed)
    changes: dict[str, Any] = {}
    for key, place in number_index().items():
        value = float(numbers[place])
        if value == before[place]:
            continue
        if key == "change.link":
            changes[key] = LINKS[int(value)]
        else:
            changes[key] = min(max(value, KEY_BY_NAME[key].low), KEY_BY_NAME[key].high)
    return believed.with_values(changes)
