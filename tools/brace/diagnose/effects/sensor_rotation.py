"""The force sensor is turned in the limb's plane."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_rotation"


def variants(setting: Setting) -> Iterator[Variant]:
    """One angle."""
    yield Variant(NAME, "sensor", (Freedom("sensor.rotation_rad", -0.8, 0.8),))
