"""The femur's end is turned by the tip force's moment: the uniform beam's coupling of physics.md."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Setting, Variant

NAME = "moment_transfer"


def variants(setting: Setting) -> Iterator[Variant]:
    """Present or not."""
    if setting.number("link.femur.moment_transfer") == 0.0:
        yield Variant(NAME, "link.femur", (), {"link.femur.moment_transfer": 1.0})
