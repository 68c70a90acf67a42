"""The force sensor's zero runs away with time."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_drift"


def variants(setting: Setting) -> Iterator[Variant]:
    """Along x, z, or both."""
    x, z = (Freedom(f"sensor.drift_{axis}_n_per_s", -10.0, 10.0) for axis in "xz")
    yield Variant(NAME, "sensor", (x,))
    yield Variant(NAME, "sensor", (z,))
    yield Variant(NAME, "sensor", (x, z))
