"""Values of limb.toml that a limb may have and hardly any has: they smell of another unit."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator, Mapping

from brace import toml
from brace.ground.errors import ModelDoubt

__all__ = ["ModelDoubt", "doubts"]

G_M_PER_S2 = 9.80665
PLAY_RAD = 0.05  # 170 arcmin; gears have 1 to 60
JOINT_RAD_PER_N_MM = 5e-4  # 2 N m/rad; servos have 50 and more
LINK_MM_PER_N = 5.0
LINK_STIFF_MM_PER_N = 5e-5  # across; a solid steel bar of a limb's length yields more
OFFSET_RAD = 0.17
TILT_RAD = 0.35
WEIGHT_N = 200.0
LENGTH_MM = 3000.0


def doubts(values: Mapping[str, toml.Value], given: Container[str], where: Callable[[str], str]) -> Iterator[str]:
    """A sentence for each of the `given` values that smells of another unit; `where` tells a key's file:line."""
    for suffix, words in _RULES.items():
        for key, value in values.items():
            if key in given and key.endswith(suffix) and isinstance(value, float) and (reported := words(key, value)):
                yield f"{where(key)}: {key} = {value:g} {reported}"


def _play(_key: str, value: float) -> str:
    if value <= PLAY_RAD:
        return ""
    return (
        f"is {math.degrees(value):.3g} deg of play, and gears have less than 1 deg; {value:g} deg would be "
        f"{math.radians(value):.3g}, {value:g} arcmin {math.radians(value / 60):.3g}"
    )


def _joint(_key: str, value: float) -> str:
    if value <= JOINT_RAD_PER_N_MM:
        return ""
    return (
        f"is a joint of {1e-3 / value:.2g} N m/rad, and servos have 50 and more; in rad/(N m) it would be "
        f"{value * 1e-3:.3g} here"
    )


def _link(key: str, value: float) -> str:
    if value > LINK_MM_PER_N:
        return f"is a millimetre under {1 / value:.2g} N; if it was in um/N or mm/kN it is {value * 1e-3:.3g} here"
    if 0.0 < value < LINK_STIFF_MM_PER_N and not key.startswith("base"):
        return f"is stiffer than a solid steel bar; if it was in m/N it is {value * 1e3:.3g} here"
    return ""


def _offset(_key: str, value: float) -> str:
    if abs(value) <= OFFSET_RAD:
        return ""
    return f"is {math.degrees(value):.3g} deg; if it was in degrees it is {math.radians(value):.3g} here"


def _tilt(_key: str, value: float) -> str:
    if abs(value) <= TILT_RAD:
        return ""
    return (
        f"turns the link's compliance by {math.degrees(value):.3g} deg; in degrees it would be "
        f"{math.radians(value):.3g} here"
    )


def _weight(_key: str, value: float) -> str:
    if value <= WEIGHT_N:
        return ""
    return (
        f"is the weight of {value / G_M_PER_S2:.0f} kg; if it was in grams it is {value * 1e-3 * G_M_PER_S2:.3g} here"
    )


def _length(_key: str, value: float) -> str:
    return f"is {value * 1e-3:.3g} m; if it was in um it is {value * 1e-3:.3g} here" if value > LENGTH_MM else ""


_RULES: dict[str, Callable[[str, float], str]] = {
    ".gap_rad": _play,
    ".compliance_rad_per_n_mm": _joint,
    ".bending_mm_per_n": _link,
    ".zero_offset_rad": _offset,
    "uncertainty.angle_rad": _offset,
    ".tilt_rad": _tilt,
    "gravity.femur_n": _weight,
    "gravity.tibia_n": _weight,
    "gravity.knee_n": _weight,
    "geometry.femur_mm": _length,
    "geometry.tibia_mm": _length,
}
