"""What the limb stands on yields: along x, along z, in rotation."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "base_compliance"

HIGH = {"x_mm_per_n": 10.0, "z_mm_per_n": 10.0, "rotation_rad_per_n_mm": 1e-2}


def variants(setting: Setting) -> Iterator[Variant]:
    """One direction, both translations, or all three."""
    def free(*leaves: str) -> tuple[Freedom, ...]:
        return tuple(Freedom(f"base.{leaf}", 0.0, HIGH[leaf]) for leaf in leaves)

    yield Variant(NAME, "base", free("rotation_rad_per_n_mm"))
    yield Variant(NAME, "base", free("x_mm_per_n"))
    yield Variant(NAME, "base", free("z_mm_per_n"))
    yield Variant(NAME, "base", free("x_mm_per_n", "z_mm_per_n"))
    yield Variant(NAME, "base", free("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm"))
