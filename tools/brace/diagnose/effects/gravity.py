"""Weights of the links and the knee load the joints by posture."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "gravity"


def variants(setting: Setting) -> Iterator[Variant]:
    """Femur and knee load the same joint in the same proportion: the knee stands for both."""
    knee, tibia = (Freedom(f"gravity.{part}_n", 0.0, 1e4) for part in ("knee", "tibia"))
    # the femur's weight hangs at half its length
    yield Variant(NAME, "gravity", (knee, tibia), stands_for={"gravity.knee_n": ("gravity.femur_n", 2.0)})
