"""Clearance of the tip's ball joint, which drags the tip along."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "contact_play"


def variants(setting: Setting) -> Iterator[Variant]:
    """One clearance for both axes."""
    tries = tuple(setting.displacement_mm * share for share in (0.001, 0.003, 0.01, 0.03, 0.1, 0.3))
    yield Variant(NAME, "contact", (Freedom("contact.play_mm", 0.0, 2.0 * setting.displacement_mm, tries),))
