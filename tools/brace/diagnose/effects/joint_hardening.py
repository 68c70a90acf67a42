"""A joint that stiffens with its deflection: a cubic torque beside the spring's."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "joint_hardening"

JOINTS = ("femur", "tibia")


def variants(setting: Setting) -> Iterator[Variant]:
    """One joint at a time."""
    for joint in JOINTS:
        elastic = max(setting.joint_deflection_rad[joint], 1e-6)
        cubic = max(setting.joint_torque_n_mm[joint], 1.0) / elastic**3
        tries = tuple(cubic * share for share in (0.01, 0.05, 0.3, 1.0))
        yield Variant(
            NAME, f"joint.{joint}", (Freedom(f"joint.{joint}.hardening_n_mm_per_rad3", 0.0, 1e3 * cubic, tries),)
        )
