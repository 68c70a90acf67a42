"""Numbers, shares and units as a person writes them."""

from __future__ import annotations

import math

_UNITS = {"n": "N", "n_mm": "N mm", "n_per_mm": "N/mm"}


def unit(gap_unit: str) -> str:
    """`n_mm` as N mm."""
    return _UNITS.get(gap_unit, gap_unit)


def number(value: float) -> str:
    """Three or four digits, as a person writes them."""
    if not math.isfinite(value):
        return "any" if math.isnan(value) else ("-∞" if value < 0 else "∞")
    if value == 0.0:
        return "0"
    if abs(value) >= 1e4 or abs(value) < 1e-3:
        mantissa, _, exponent = f"{value:.2e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.4g}" if abs(value) >= 1000 else f"{value:.3g}"


def with_sigma(value: float, sigma: float) -> str:
    """`10.92 ± 0.40`: two digits of the uncertainty, and the value to the same place. `sigma` is above 0."""
    two = float(f"{sigma:.1e}")  # 0.0996 has the place of 0.10
    places = max(0, 1 - math.floor(math.log10(two)))
    return f"{value:.{places}f} ± {sigma:.{places}f}"


def percent(share: float) -> str:
    """The share in percent, as `97 %`. A share below 1 is at most `over 99 %`: only 1 gives `100 %`."""
    if not math.isfinite(share):
        return "unknown"
    if 0.995 <= share < 1.0:
        return "over 99 %"
    if 0.0 < share < 0.005:
        return "under 1 %"
    return f"{100 * share:.0f} %"
