"""Friction at a joint: its deflection changes only where the torque out of balance exceeds it."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "coulomb_friction"

JOINTS = ("femur", "tibia")


def variants(setting: Setting) -> Iterator[Variant]:
    """One joint at a time."""
    for joint in JOINTS:
        torque = max(setting.joint_torque_n_mm[joint], 1.0)
        tries = tuple(torque * share for share in (0.003, 0.01, 0.03, 0.1, 0.3))
        yield Variant(NAME, f"joint.{joint}", (Freedom(f"joint.{joint}.coulomb_n_mm", 0.0, 1e7, tries),))
