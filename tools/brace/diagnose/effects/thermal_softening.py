"""Joints that soften as they warm."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "thermal_softening"


def variants(setting: Setting) -> Iterator[Variant]:
    """Only where the temperature moves."""
    if setting.temperature_range_degc > 0.1:
        limit = 0.9 / setting.temperature_range_degc
        yield Variant(NAME, "thermal", (Freedom("thermal.joint_compliance_per_degc", -limit, max(limit, 1.0)),))
