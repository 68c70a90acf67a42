"""What a plug-in of the catalogue offers: the ways its effect may show, as numbers of limb.toml to be turned."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np


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
    another that the record tells only in sum with it, and how much of the other makes the same readings."""

    effect: str
    where: str
    freedoms: tuple[Freedom, ...]
    settings: Mapping[str, float] = field(default_factory=dict)
    stands_for: Mapping[str, tuple[str, float]] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """`backlash@joint.tibia`."""
        return f"{self.effect}@{self.where}"

    @property
    def keys(self) -> tuple[str, ...]:
        """What it turns or sets."""
        return (*(freedom.key for freedom in self.freedoms), *self.settings)


@dataclass(frozen=True)
class Setting:
    """What a plug-in may know: the believed limb's numbers by key, and the sizes that this record reaches."""

    believed: Mapping[str, float]
    joint_torque_n_mm: Mapping[str, float]  # largest over the record, by joint ("femur", "tibia")
    joint_deflection_rad: Mapping[str, float]  # elastic, at that torque
    displacement_mm: float  # largest imposed
    force_n: np.ndarray  # |reading| of both axes, sorted
    force_sigma_n: float
    run_starts_s: Sequence[float]
    duration_s: float
    dwell_s: float
    temperature_range_degc: float
    zeroed: bool

    def number(self, key: str) -> float:
        """The believed value."""
        return self.believed[key]
