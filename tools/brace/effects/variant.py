"""The ways in which the effects of the catalogue may show in one loading record, ready for a search."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from brace.effects.catalogue import EFFECTS
from brace.effects.record import LoadingPlace, LoadingSize
from brace.effects.row import Effect


@dataclass(frozen=True)
class Freedom:
    """One key of limb.toml that a fit may turn, between `low` and `high`, tried first at each of `tries` (the key's own
    unit). `stepwise` is a time: readings jump as it passes them and stand still between."""

    key: str
    low: float
    high: float
    tries: tuple[float, ...] = ()
    stepwise: bool = False


@dataclass(frozen=True)
class Variant:
    """One way for an effect to show. `settings` are keys that are set and not fitted. `stands_for` maps a fitted key to
    another that the record shows only in sum with it, and how much of the other makes the same readings. `multiplies`
    maps a fitted factor of a change to the key that changes by it."""

    effect: str
    where: str
    freedoms: tuple[Freedom, ...]
    settings: Mapping[str, float] = field(default_factory=dict)
    stands_for: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    multiplies: Mapping[str, str] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """`backlash@joint.tibia`."""
        return f"{self.effect}@{self.where}"

    @property
    def keys(self) -> tuple[str, ...]:
        """What it turns or sets."""
        return (*(freedom.key for freedom in self.freedoms), *self.settings)


def all_variants(size: LoadingSize) -> list[Variant]:
    """Every way in which an effect of the catalogue may show in a record of this size."""
    return [variant for effect in EFFECTS for variant in _variants(effect, size)]


def _variants(effect: Effect, size: LoadingSize) -> Iterator[Variant]:
    for where in effect.places:
        if not effect.loading_seen(size, where):
            continue
        for way in effect.ways:
            if not way.seen(size):
                continue
            yield Variant(
                effect.name,
                where,
                tuple(_freedom(effect, leaf, size, where) for leaf in way.fitted),
                {effect.key(leaf, where): value for leaf, value in way.fixed(where).items()},
                {
                    effect.key(leaf, where): (effect.key(other, where), ratio)
                    for leaf, (other, ratio) in way.stands_for.items()
                },
                {effect.key(leaf, where): f"{where}.{changed}" for leaf, changed in way.multiplies.items()},
            )


def _freedom(effect: Effect, leaf: str, size: LoadingSize, where: str) -> Freedom:
    number = effect.number(leaf)
    at = LoadingPlace(size, where, number.key(where))
    (low, high), (least, most) = number.limits(at), at.range
    return Freedom(at.key, max(low, least), min(high, most), number.tries(at), number.stepwise)
