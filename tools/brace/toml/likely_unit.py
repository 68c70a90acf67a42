"""A value out of range that lies within in another unit: what was probably meant."""

from __future__ import annotations

import math

# end of a key -> (unit that was perhaps meant, what turns it into ours)
_SLIPS: dict[str, tuple[tuple[str, float], ...]] = {
    "_rad": (("deg", math.pi / 180), ("arcmin", math.pi / 10800)),
    "_mm": (("m", 1e3), ("cm", 10.0)),
    "_rel": (("%", 0.01),),
    "_ratio": (("%", 0.01),),
    "_rad_per_n_mm": (("rad/(N m)", 1e-3),),
    "_mm_per_n": (("um/N", 1e-3),),
    "_degc": (("K", 1.0),),
}


def likely(key: str, value: float, low: float, high: float) -> str:
    """`0.185 m are 185` and the like; empty where no unit explains the value."""
    ends = [end for end in _SLIPS if key.endswith(end)]
    units = _SLIPS[max(ends, key=len)] if ends else ()
    for unit, factor in reversed(units) if key.endswith("gap_rad") else units:  # plays are given in arcmin
        meant = value * factor - (273.15 if unit == "K" else 0.0)
        if low <= meant <= high and meant != 0.0:
            return f"{value:g} {unit} {'is' if value == 1 else 'are'} {meant:.6g} here"
    return ""
