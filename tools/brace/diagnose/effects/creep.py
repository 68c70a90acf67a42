"""The joints' delayed deflection: a share of the elastic one, with one time constant."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "creep"


def variants(setting: Setting) -> Iterator[Variant]:
    """Both joints at once, as limb.toml has it."""
    dwell = max(setting.dwell_s, 1e-3)
    tries = tuple(dwell * factor for factor in (0.7, 2.5, 8.0, 25.0, 80.0))
    yield Variant(
        NAME,
        "creep",
        (
            Freedom("creep.ratio", 0.0, 10.0, (0.01, 0.1)),
            Freedom("creep.time_constant_s", 0.2 * dwell, 1e3 * dwell, tries),
        ),
    )
