"""Units that people write, and what turns a number in them into one in ours (mm, N, rad, s, degC, N mm, N/mm)."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

G_M_PER_S2 = 9.80665
LBF_N = 4.4482216152605

FORCE_MOST_N = 1e4  # the firmware takes no larger component of the force on the tip: firmware/core/src/loaded/loaded.c


@dataclass(frozen=True)
class Unit:
    """value in our unit = factor * number + offset."""

    text: str
    quantity: str  # length, force, angle, time, temperature, torque, stiffness
    factor: float
    offset: float = 0.0


_TABLE: dict[str, dict[str, float]] = {
    "length": {
        "mm": 1.0, "cm": 10.0, "m": 1e3, "um": 1e-3, "nm": 1e-6, "in": 25.4, "mil": 0.0254, "ft": 304.8,
    },
    "force": {
        "N": 1.0, "kN": 1e3, "mN": 1e-3, "cN": 1e-2, "daN": 10.0, "lbf": LBF_N, "ozf": LBF_N / 16, "kgf": G_M_PER_S2,
        "gf": G_M_PER_S2 * 1e-3,
    },
    "angle": {
        "rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "arcmin": math.pi / 10800, "arcsec": math.pi / 648000,
        "gon": math.pi / 200,
        "rev": 2 * math.pi,
    },
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0},
    "temperature": {"degC": 1.0, "K": 1.0, "degF": 5 / 9},
    "torque": {
        "N mm": 1.0, "N m": 1e3, "mN m": 1.0, "N cm": 10.0, "kN m": 1e6, "kgf cm": G_M_PER_S2 * 10,
        "kgf m": G_M_PER_S2 * 1e3, "lbf in": LBF_N * 25.4, "lbf ft": LBF_N * 304.8, "ozf in": LBF_N / 16 * 25.4,
    },
    "stiffness": {
        "N/mm": 1.0, "N/m": 1e-3, "kN/m": 1.0, "N/um": 1e3, "kN/mm": 1e3, "lbf/in": LBF_N / 25.4, "N/cm": 0.1,
    },
}  # fmt: skip
_OFFSET = {"K": -273.15, "degF": -32 * 5 / 9}

UNITS: dict[str, Unit] = {
    text: Unit(text, quantity, factor, _OFFSET.get(text, 0.0))
    for quantity, units in _TABLE.items()
    for text, factor in units.items()
}
OWN = {
    "length": "mm", "force": "N", "angle": "rad", "time": "s", "temperature": "degC", "torque": "N mm",
    "stiffness": "N/mm",
}  # fmt: skip

# Other ways to write them. Case counts in the first list (mN is no MN), not in the second.
_EXACT = {
    "n": "N", "kn": "kN", "KN": "kN", "C": "degC", "F": "degF", "k": "K", '"': "in", "''": "in", "'": "arcmin",
    "\u00b0": "deg", "M": "m", "S": "s", "MM": "mm", "CM": "cm", "RAD": "rad", "DEG": "deg", "Nm": "N m", "NM": "N m",
    "Nmm": "N mm", "NMM": "N mm", "nmm": "N mm", "mNm": "mN m", "kNm": "kN m", "Ncm": "N cm",
    "kg": "kgf", "g": "gf", "lb": "lbf", "lbs": "lbf", "oz": "ozf", "h": "h", "H": "h",
}  # fmt: skip
_SPELLED = {
    "millimeter": "mm", "millimeters": "mm", "millimetre": "mm", "millimetres": "mm", "centimeter": "cm",
    "centimetre": "cm", "meter": "m", "metre": "m", "meters": "m", "metres": "m", "micron": "um", "microns": "um",
    "\u00b5m": "um", "\u03bcm": "um", "mue": "um", "micrometer": "um", "inch": "in", "inches": "in", "zoll": "in",
    "thou": "mil", "mils": "mil", "feet": "ft", "foot": "ft",
    "newton": "N", "newtons": "N", "kilonewton": "kN", "millinewton": "mN", "lb-f": "lbf", "lb_f": "lbf",
    "pound": "lbf", "pounds": "lbf", "kp": "kgf", "kg-f": "kgf", "kilopond": "kgf", "gramm": "gf", "gram": "gf",
    "grams": "gf", "kilogramm": "kgf", "dan": "daN",
    "radian": "rad", "radians": "rad", "radiant": "rad", "degree": "deg", "degrees": "deg",
    "grados": "deg", "gradi": "deg", "graus": "deg", "grader": "deg",
    "\u00b0deg": "deg", "milliradian": "mrad", "minofarc": "arcmin", "arcminutes": "arcmin", "turn": "rev",
    "turns": "rev", "revolution": "rev", "revolutions": "rev", "umdrehung": "rev", "umdrehungen": "rev",
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s", "sekunde": "s", "sekunden": "s",
    "millisecond": "ms", "milliseconds": "ms", "msec": "ms", "millisekunden": "ms", "\u00b5s": "us", "\u03bcs": "us",
    "usec": "us", "microseconds": "us", "nsec": "ns", "nanoseconds": "ns",
    "minute": "min", "minutes": "min", "minuten": "min", "hour": "h", "hours": "h", "stunden": "h",
    "\u00b0c": "degC", "celsius": "degC", "deg_c": "degC", "deg c": "degC", "grad celsius": "degC",
    "kelvin": "K", "\u00b0f": "degF", "fahrenheit": "degF", "deg f": "degF", "deg_f": "degF",
    "newtonmeter": "N m", "newtonmetre": "N m", "newton meter": "N m", "newton metre": "N m",
}  # fmt: skip
# Written by some for one unit and by others for another; what the column is decides, or it is asked.
TWO_MEANINGS: dict[str, tuple[str, ...]] = {
    "grad": ("deg", "gon"), "nm": ("nm", "N m"), "'": ("arcmin", "ft"), '"': ("in", "arcsec"), "mil": ("mil", "mrad"),
    "mils": ("mil", "mrad"),
}  # fmt: skip
_AMOUNT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_JOINTS_OF_UNITS = re.compile(r"[\u00b7\u22c5*.\u2219\u2022_ -]+")


def amount(text: str) -> tuple[float, str] | None:
    """A number and the text of its unit, which may be empty; None where no number comes first."""
    found = _AMOUNT.fullmatch(text)
    return (float(found[1]), found[2]) if found else None


def meanings_of(text: str) -> tuple[Unit, ...]:
    """The units of a text that has two meanings, whatever its case but for Nm; empty for any other text."""
    bare = text.strip().strip("[](){}<>").strip()
    found = TWO_MEANINGS.get(bare if bare.lower() == "nm" else bare.lower(), ())
    return tuple(UNITS[each] for each in found)


def unit_of(text: str, quantity: str = "") -> Unit | None:
    """The unit that a text means, or None. Of two meanings the one that is of the quantity; None if both are, or none
    is given."""
    if meanings := meanings_of(text):
        fit = [unit for unit in meanings if unit.quantity == quantity]
        return fit[0] if len(fit) == 1 else None
    text = text.strip().strip("[](){}<>").strip()
    if text.lower().startswith("in ") and text[3:4].lower() not in ("l", "o"):  # (in mm); in lb is a torque
        text = text[3:].strip()
    if not text:
        return None
    if text in UNITS:
        return UNITS[text]
    if text in _EXACT:
        return UNITS[_EXACT[text]]
    if text.lower() in _SPELLED:
        return UNITS[_SPELLED[text.lower()]]
    per = re.sub(r"\s*(?:/|\bper\b)\s*", "/", text)
    parts = _JOINTS_OF_UNITS.sub(" ", per).strip()
    for written in (
        parts,
        parts.replace(" ", ""),
        re.sub(r"\bmm\^?-1$", "/mm", parts),
        re.sub(r"\bm\^?-1$", "/m", parts),
    ):
        written = written.replace(" /", "/")
        if written in UNITS:
            return UNITS[written]
        if written in _EXACT:
            return UNITS[_EXACT[written]]
    lowered = {unit.lower(): unit for unit in UNITS if " " in unit or "/" in unit or len(unit) > 2}
    for written in (parts.lower(), parts.lower().replace(" ", "")):
        if written in lowered:
            return UNITS[lowered[written]]
        squeezed = {unit.replace(" ", ""): name for unit, name in lowered.items()}
        if written in squeezed and written not in ("mnm",):
            return UNITS[squeezed[written]]
    words = parts.lower().split()
    if len(words) == 2:  # in lb, ft-lbs, kg cm
        both = [unit_of(word) for word in words]
        names = [unit.text for unit in both if unit is not None]
        for pair in (" ".join(names), " ".join(reversed(names))):
            if len(names) == 2 and pair in UNITS:
                return UNITS[pair]
    return None
