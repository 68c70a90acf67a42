"""One axis of the force sensor answers to the other."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_crosstalk"


def variants(setting: Setting) -> Iterator[Variant]:
    """Either way, or both."""
    xz, zx = (Freedom(f"sensor.crosstalk_{way}", -0.9, 0.9) for way in ("xz", "zx"))
    yield Variant(NAME, "sensor", (xz,))
    yield Variant(NAME, "sensor", (zx,))
    yield Variant(NAME, "sensor", (xz, zx))
