"""The force sensor reads something at no force."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "sensor_bias"


def variants(setting: Setting) -> Iterator[Variant]:
    """Along x, z, or both; unseen where every run is zeroed."""
    if setting.zeroed:
        return
    x, z = (Freedom(f"sensor.bias_{axis}_n", -1e3, 1e3) for axis in "xz")
    yield Variant(NAME, "sensor", (x,))
    yield Variant(NAME, "sensor", (z,))
    yield Variant(NAME, "sensor", (x, z))
