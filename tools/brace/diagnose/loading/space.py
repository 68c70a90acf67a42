"""The numbers that a hypothesis turns: what calibration trusts only so far (under its prior), and its effects' own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from brace.effects import Variant
from brace.identify.parameters import PRIOR_KEYS, prior_parameter, tibia_beam
from brace.model import LimbModel
from brace.model.assumed_trust import with_assumed_trust
from brace.native.plant_batch import model_numbers, number_index

if TYPE_CHECKING:
    from brace.identify.record import Record


@dataclass(frozen=True)
class Trust:
    """What [uncertainty] says of the believed limb: keys, values, sigmas, bounds; `numbers` is the limb itself."""

    numbers: np.ndarray
    keys: tuple[str, ...]
    mean: np.ndarray
    sigma: np.ndarray
    low: np.ndarray
    high: np.ndarray


def trust_of(believed: LimbModel, *, turns: bool) -> Trust:
    """Everything that the calibration knows within a sigma, which is assumed where limb.toml does not say it. `turns`:
    of a limb that turns as it is displaced."""
    said = with_assumed_trust(believed)
    parameters = [item for key in PRIOR_KEYS if (item := prior_parameter(said, key)) is not None]
    if turns and (beam := tibia_beam(believed)) is not None:
        parameters.append(beam)
    return Trust(
        model_numbers(believed),
        tuple(item.key for item in parameters),
        np.array([item.start for item in parameters]),
        np.array([item.prior_sigma for item in parameters]),
        np.array([item.low for item in parameters]),
        np.array([item.high for item in parameters]),
    )


@dataclass(frozen=True)
class Space:
    """Trusted keys first, then the effects' freedoms (`own` of them). `sigma` is inf where no prior holds; `stepwise`
    are places of times at which readings jump. `changing` are places among a model's numbers, of a factor from a change
    on and of what changes by it: the calibration knew that number as it was before the change."""

    numbers: np.ndarray
    keys: tuple[str, ...]
    places: np.ndarray
    mean: np.ndarray
    sigma: np.ndarray
    low: np.ndarray
    high: np.ndarray
    own: int
    stepwise: tuple[int, ...] = ()
    variants: tuple[Variant, ...] = field(default=())
    changing: tuple[tuple[int, int], ...] = ()

    @property
    def size(self) -> int:
        return len(self.keys)

    @property
    def label(self) -> str:
        """`none`, or the effects' labels joined by ' + '."""
        return " + ".join(variant.label for variant in self.variants) or "none"

    def models(self, points: np.ndarray) -> np.ndarray:
        """Points (points x size) to plant models (points x numbers)."""
        models = self.numbers[np.newaxis].repeat(len(points), axis=0)
        models[:, self.places] = points
        return self.of_today(models)

    def of_today(self, models: np.ndarray) -> np.ndarray:
        """The models (points x numbers) with what a fit turns of a change in the terms of limb.toml: the limb after the
        change, and the factor by which it was another one before."""
        for factor, changed in self.changing:
            models[:, changed] *= models[:, factor]
            models[:, factor] = 1.0 / models[:, factor]
        return models

    def residuals(self, record: Record, points: np.ndarray) -> np.ndarray:
        """What points leave of a record, points x readings, whitened."""
        return record.residuals(self.models(points))

    def pull(self, x: np.ndarray) -> np.ndarray:
        """Standardised distance from the prior's middle; 0 where there is no prior."""
        return np.asarray(np.where(np.isinf(self.sigma), 0.0, (x - self.mean) / self.sigma))


def space_of(trust: Trust, variants: Sequence[Variant]) -> Space:
    """The hypothesis that these variants together are what the believed limb lacks. A key that an effect frees has no
    prior any more."""
    index = number_index()
    numbers, mean, sigma, low, high = (values.copy() for values in (
        trust.numbers, trust.mean, trust.sigma, trust.low, trust.high
    ))  # fmt: skip
    changing = tuple(
        (index[factor], index[changed]) for variant in variants for factor, changed in variant.multiplies.items()
    )
    for variant in variants:
        settings = {index[key]: value for key, value in variant.settings.items()}
        for factor, changed in variant.multiplies.items():
            if any(numbers[place] != value for place, value in settings.items()):
                numbers[index[factor]] = 1.0  # another link is believed to have changed
            before = numbers[index[factor]]
            numbers[index[changed]] *= before
            numbers[index[factor]] = 1.0 / before
            for place in (i for i, key in enumerate(trust.keys) if key == changed):
                mean[place], sigma[place], low[place], high[place] = (
                    values[place] * before for values in (trust.mean, trust.sigma, trust.low, trust.high)
                )
        for place, value in settings.items():
            numbers[place] = value
    freed = {freedom.key: freedom for variant in variants for freedom in variant.freedoms}
    kept = [i for i, key in enumerate(trust.keys) if key not in freed]
    keys = (*(trust.keys[i] for i in kept), *freed)
    places = np.array([index[key] for key in keys], dtype=int)
    own = [freed[key] for key in freed]
    return Space(
        numbers,
        keys,
        places,
        np.concatenate([mean[kept], [_start(numbers[index[item.key]], item.low, item.high) for item in own]]),
        np.concatenate([sigma[kept], np.full(len(own), math.inf)]),
        np.concatenate([low[kept], [item.low for item in own]]),
        np.concatenate([high[kept], [item.high for item in own]]),
        len(own),
        tuple(len(kept) + place for place, item in enumerate(own) if item.stepwise),
        tuple(variants),
        changing,
    )


def _start(believed: float, low: float, high: float) -> float:
    return min(max(believed, low), high)


def compatible(variants: Sequence[Variant]) -> bool:
    """Whether no two of them turn or set the same key."""
    keys = [key for variant in variants for key in variant.keys]
    return len(keys) == len(set(keys))
