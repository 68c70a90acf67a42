"""The force sensor clips what it reads."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_saturation"

SHARES = (0.6, 0.8, 0.9, 0.95, 0.98, 0.995)


def variants(setting: Setting) -> Iterator[Variant]:
    """Tried where the largest readings lie."""
    if not setting.force_n.size:
        return
    tries = tuple(float(np.quantile(setting.force_n, share)) for share in SHARES)
    highest = float(setting.force_n[-1])
    yield Variant(NAME, "sensor", (Freedom("sensor.saturation_n", 0.05 * highest, 1.02 * highest, tries),))
