"""A joint softer or stiffer than its calibration is trusted to be."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "joint_compliance"

JOINTS = ("femur", "tibia")


def variants(setting: Setting) -> Iterator[Variant]:
    """One joint at a time."""
    for joint in JOINTS:
        key = f"joint.{joint}.compliance_rad_per_n_mm"
        start = setting.number(key)
        yield Variant(NAME, f"joint.{joint}", (Freedom(key, 0.02 * start, max(50.0 * start, 1e-3)),))
