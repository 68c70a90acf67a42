"""Which wrong unit turns a quantity into a number that is off by a given factor."""

from __future__ import annotations

import math

# ratio of what is written to what should be -> the unit it is written in, the factor that mends it
LENGTH_SLIPS = {
    1 / 25.4: ("inches", 25.4),
    1e-3: ("m", 1e3),
    0.1: ("cm", 10.0),
    1e3: ("um", 1e-3),
    1 / 25.4e-3: ("thousandths of an inch", 25.4e-3),
}
FORCE_SLIPS = {
    1e-3: ("kN", 1e3),
    1e3: ("mN", 1e-3),
    1 / 9.80665: ("kgf", 9.80665),
    1e3 / 9.80665: ("gf", 9.80665e-3),
    1 / 4.4482216: ("lbf", 4.4482216),
}
STIFFNESS_SLIPS = {1e3: ("N/m", 1e-3), 1e-3: ("N/um", 1e3), 1e6: ("mN/m", 1e-6)}


def slip_of(ratio: float, slips: dict[float, tuple[str, float]], within: float = 1.4) -> tuple[str, float]:
    """The slip whose ratio is nearest, if it is within the factor `within`; else ("", 1.0)."""
    if ratio <= 0 or not math.isfinite(ratio):
        return "", 1.0
    nearest = min(slips, key=lambda known: abs(math.log(ratio / known)))
    return slips[nearest] if abs(math.log(ratio / nearest)) < math.log(within) else ("", 1.0)
