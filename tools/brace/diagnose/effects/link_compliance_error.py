"""A link's ellipsoid is off by more than its calibration is trusted to."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "link_compliance_error"

WAYS = (("bending",), ("axial",), ("tilt",), ("bending", "axial"), ("bending", "axial", "tilt"))


def variants(setting: Setting) -> Iterator[Variant]:
    """Bending, axial, tilt alone, or together."""
    for link in ("femur", "tibia"):
        axial, bending = f"link.{link}.axial_mm_per_n", f"link.{link}.bending_mm_per_n"
        freedoms = {
            "bending": Freedom(bending, 0.02 * setting.number(bending), max(50.0 * setting.number(bending), 1.0)),
            "axial": Freedom(axial, 0.0, max(50.0 * setting.number(axial), 1.0)),
            "tilt": Freedom(f"link.{link}.tilt_rad", -1.5, 1.5),
        }
        for chosen in WAYS:
            yield Variant(NAME, f"link.{link}", tuple(freedoms[name] for name in chosen))
