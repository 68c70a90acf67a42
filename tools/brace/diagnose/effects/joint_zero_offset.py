"""A joint's encoder zero is off by more than its calibration is trusted to."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "joint_zero_offset"

JOINTS = ("femur", "tibia")


def variants(setting: Setting) -> Iterator[Variant]:
    """One joint at a time."""
    for joint in JOINTS:
        yield Variant(NAME, f"joint.{joint}", (Freedom(f"joint.{joint}.zero_offset_rad", -0.4, 0.4),))
