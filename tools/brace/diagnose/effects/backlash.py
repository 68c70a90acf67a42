"""Play at a joint: no torque within half the gap to either side."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "backlash"

JOINTS = ("femur", "tibia")


def variants(setting: Setting) -> Iterator[Variant]:
    """One joint at a time."""
    for joint in JOINTS:
        elastic = max(setting.joint_deflection_rad[joint], 1e-6)
        tries = tuple(elastic * share for share in (0.01, 0.03, 0.1, 0.3, 1.0))
        yield Variant(NAME, f"joint.{joint}", (Freedom(f"joint.{joint}.gap_rad", 0.0, 0.5, tries),))
