"""Link lengths are off by more than their calibration is trusted to."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "link_length_error"


def variants(setting: Setting) -> Iterator[Variant]:
    """Femur, tibia, or both."""
    femur, tibia = (
        Freedom(key, 0.5 * setting.number(key), 2.0 * setting.number(key))
        for key in ("geometry.femur_mm", "geometry.tibia_mm")
    )
    yield Variant(NAME, "geometry", (femur,))
    yield Variant(NAME, "geometry", (tibia,))
    yield Variant(NAME, "geometry", (femur, tibia))
