"""Weights of the links and the knee load the joints by posture."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "gravity"


def variants(setting: Setting) -> Iterator[Variant]:
    """Femur and knee load the same joint in the same proportion: the knee stands for both here."""
    knee, tibia = (Freedom(f"gravity.{part}_n", 0.0, 1e4) for part in ("knee", "tibia"))
    yield Variant(NAME, "gravity", (knee,))
    yield Variant(NAME, "gravity", (tibia,))
    yield Variant(NAME, "gravity", (knee, tibia))
