"""Where the force on the tip and the loads of the joints lie with 90 %, as a controller reports it: friction in the
gears hides a part of what the motors carry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from brace.wire.layout import Value

_FORCES = ("force_x", "force_y", "force_z")
_LOADS = ("load_coxa", "load_femur", "load_tibia")
_ACROSS = ("force_y", "load_coxa")  # of a limb with a coxa joint
INTERVAL_ENTRIES = tuple(f"{name}_{end}" for name in (*_FORCES, *_LOADS) for end in ("low", "high"))


@dataclass(frozen=True)
class Interval:
    """None: not known. What is across the plane is there of a limb with a coxa joint alone."""

    values: Mapping[str, Value]  # by INTERVAL_ENTRIES: N, loads N mm

    def as_json(self) -> dict[str, object]:
        """Names with units, those across the plane only where they are known."""
        return {
            f"{name}_{end}_{'n' if name in _FORCES else 'n_mm'}": self.values.get(f"{name}_{end}")
            for name in (*_FORCES, *_LOADS)
            if name not in _ACROSS or self.values.get(f"{name}_low") is not None
            for end in ("low", "high")
        }

    def words(self) -> list[str]:
        """The force's, for people; nothing where it is not known."""
        ends = [
            f"{name[-1]} {low:.2f} to {high:.2f}"
            for name in _FORCES
            if (low := self.values.get(f"{name}_low")) is not None
            and (high := self.values.get(f"{name}_high")) is not None
        ]
        return [f"force with 90 % between: {', '.join(ends)} N"] if ends else []


def interval_of(values: Mapping[str, Value]) -> Interval:
    """From values that may be more; a number that is not one is not known."""
    found = {name: values.get(name) for name in INTERVAL_ENTRIES}
    return Interval({name: None if isinstance(v, float) and math.isnan(v) else v for name, v in found.items()})
