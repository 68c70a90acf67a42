"""The force sensor's gain is off by more than its calibration is trusted to."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_gain"


def variants(setting: Setting) -> Iterator[Variant]:
    """One gain for both axes."""
    yield Variant(NAME, "sensor", (Freedom("sensor.gain", 0.1, 10.0),))
