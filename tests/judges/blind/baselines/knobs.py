"""Random settings of a baseline: each knob a range to draw from, the same number of draws for every baseline."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Knobs = dict[str, Any]
Draw = Callable[[np.random.Generator], Any]


def between(low: float, high: float) -> Draw:
    """Evenly in the logarithm, to three digits."""
    return lambda rng: float(f"{math.exp(rng.uniform(math.log(low), math.log(high))):.3g}")


def evenly(low: float, high: float) -> Draw:
    """Evenly, to three digits."""
    return lambda rng: float(f"{rng.uniform(low, high):.3g}")


def one_of(*values: Any) -> Draw:
    """Any of these."""
    return lambda rng: values[int(rng.integers(len(values)))]


@dataclass(frozen=True)
class Space:
    """`textbook` is the first trial: what a reader of the method's own documentation would set."""

    textbook: Mapping[str, Any]
    draws: Mapping[str, Draw]

    def trials(self, seed: int, count: int) -> list[Knobs]:
        """The textbook's setting, then random ones."""
        rng = np.random.default_rng(seed)
        drawn = [{name: draw(rng) for name, draw in self.draws.items()} for _ in range(count - 1)]
        return [dict(self.textbook), *drawn]
