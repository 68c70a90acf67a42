"""The femur's end is turned by the tip force's moment: the uniform beam's coupling of physics.md."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "moment_transfer"


def variants(setting: Setting) -> Iterator[Variant]:
    """Wholly present, or in part."""
    key = "link.femur.moment_transfer"
    if setting.number(key) == 0.0:
        yield Variant(NAME, "link.femur", (), {key: 1.0})
        yield Variant(NAME, "link.femur", (Freedom(key, 0.0, 1.0, (0.15, 0.5)),))
