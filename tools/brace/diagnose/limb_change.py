"""What a named effect means for the limb itself: how it changed during the record, and what to inspect first."""

from __future__ import annotations

import math
from dataclasses import dataclass

from brace.diagnose import plain_words as words
from brace.diagnose.already import already
from brace.diagnose.diagnosis import Diagnosis, Interval, NamedEffect
from brace.diagnose.digits import number
from brace.effects import BY_NAME
from brace.model import LimbModel

SAME = 1e-6  # relative: limb.toml has nine digits


@dataclass(frozen=True)
class LimbChange:
    """A number of the limb that is another one since some moment: `key` has in limb.toml what it is now."""

    key: str
    words: str


def limb_change(model: LimbModel, effect: NamedEffect) -> LimbChange | None:
    """From the model that has the effect in it; None where the effect is no change, or the model is without it."""
    row = BY_NAME.get(effect.name)
    if row is None:
        return None
    for way in row.ways:
        for leaf, changed in way.multiplies.items():
            factor_key = row.key(leaf, effect.where)
            factor = effect.parameters.get(factor_key)
            if factor is None or not math.isclose(model.number(factor_key), factor.value, rel_tol=SAME):
                continue
            key = f"{effect.where}.{changed}"
            now = model.number(key)
            size = f"{_times(factor)} {way.became[factor.value < 1.0]}"
            values = f"{number(now * factor.value)} -> {number(now)} {words.key_unit(key)}"
            return LimbChange(key, f"{size}: {values}{_when(effect)}")
    return None


def in_words(model: LimbModel, found: Diagnosis) -> list[str]:
    """`The tibia became 2.45 times softer in bending ...`, a sentence for each effect that is a change."""
    return [
        f"The {words.place(effect.where)} became {change.words}."
        for effect in found.effects
        if (change := limb_change(model, effect)) is not None
    ]


def inspections(believed: LimbModel | None, found: Diagnosis) -> list[str]:
    """What to look at before the limb is loaded further, without a full stop; empty where nothing named is damage."""
    if found.verdict != "effect":
        return []
    said = []
    for effect in found.effects:
        row = BY_NAME.get(effect.name)
        if row is not None and row.inspect and (not row.wears or _has_grown(believed, effect)):
            said.append(
                f"Inspect the {words.place(effect.where)} for {row.inspect} before loading it further; "
                "limb.toml describes it as it is now"
            )
    return said


def _has_grown(believed: LimbModel | None, effect: NamedEffect) -> bool:
    return any(abs(held.value) > abs(size) for size, held in already(believed, effect).values())


def _times(factor: Interval) -> str:
    """`2.45 times (2.28 to 2.61)`; limb.toml has before over now, which is below one where the number grew."""
    if factor.value >= 1.0:
        return f"{number(factor.value)} times ({words.interval(factor)})"
    low, high = (1.0 / end if end > 0.0 else math.inf for end in (factor.high, factor.low))
    value = 1.0 / factor.value
    return f"{number(value)} times ({words.interval(Interval(value, low, high))})"


def _when(effect: NamedEffect) -> str:
    """The readings that the moment lies between."""
    row = BY_NAME[effect.name]
    moments = [held for one in row.numbers if one.stepwise and (held := effect.parameters.get(one.key(effect.where)))]
    return f", between {number(moments[0].low)} and {number(moments[0].high)} s of the record" if moments else ""
