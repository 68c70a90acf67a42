"""A link that cracks, or is swapped, during the record: its bending is multiplied from some time on."""

from __future__ import annotations

from collections.abc import Iterator

from brace.diagnose.effects.variant import Freedom, Setting, Variant

NAME = "link_change"

MOST_TIMES = 40
LINK_INDEX = {"femur": 1.0, "tibia": 2.0}


def variants(setting: Setting) -> Iterator[Variant]:
    """Each link, at the starts of the runs and anywhere between."""
    starts = setting.run_starts_s[1:]
    if not starts:
        return
    times = tuple(starts[:: max(1, len(starts) // MOST_TIMES)])
    for link in ("femur", "tibia"):
        if setting.number(f"link.{link}.bending_mm_per_n") <= 0.0:
            continue
        yield Variant(
            NAME,
            f"link.{link}",
            (
                Freedom("change.bending_factor", 0.05, 50.0, (1.05,)),
                Freedom("change.at_s", starts[0] - 0.5 * setting.dwell_s, starts[-1], times, stepwise=True),
            ),
            {"change.link": LINK_INDEX[link]},
        )
