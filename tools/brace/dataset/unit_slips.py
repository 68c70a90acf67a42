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
# unit that a table's source may print -> what turns it into N/mm
STIFFNESS_UNITS = {
    "N/mm": 1.0,
    "Nmm^-1": 1.0,
    "kN/m": 1.0,
    "N/m": 1e-3,
    "Nm^-1": 1e-3,
    "N/metre": 1e-3,
    "N/meter": 1e-3,
    "mN/m": 1e-6,
    "N/cm": 0.1,
    "N/um": 1e3,
    "kN/mm": 1e3,
    "MN/m": 1e3,
    "kgf/mm": 9.80665,
    "kgf/cm": 0.980665,
    "gf/mm": 9.80665e-3,
    "lb/in": 0.17512685,
    "lbf/in": 0.17512685,
}


def slip_of(ratio: float, slips: dict[float, tuple[str, float]], within: float = 1.4) -> tuple[str, float]:
    """The slip whose ratio is nearest, if it is within the factor `within`; else ("", 1.0)."""
    if ratio <= 0 or not math.isfinite(ratio):
        return "", 1.0
    nearest = min(slips, key=lambda known: abs(math.log(ratio / known)))
    return slips[nearest] if abs(math.log(ratio / nearest)) < math.log(within) else ("", 1.0)
