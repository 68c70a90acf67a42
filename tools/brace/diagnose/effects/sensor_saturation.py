"""The force sensor clips what it reads."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_saturation"

COUNTS = (4, 8, 16, 32, 64, 128, 256)


def variants(setting: Setting) -> Iterator[Variant]:
    """Tried a few sigmas below the largest reading, and where the largest few lie."""
    if not setting.force_n.size:
        return
    highest = float(setting.force_n[-1])
    below = (highest - count * setting.force_sigma_n for count in range(7))
    counted = (float(setting.force_n[-count]) for count in COUNTS if count < setting.force_n.size)
    tries = tuple(sorted({level for level in (*below, *counted) if level > 0.05 * highest}))
    yield Variant(NAME, "sensor", (Freedom("sensor.saturation_n", 0.05 * highest, 1.02 * highest, tries),))
