"""The fit to beat: torque = spring beyond a gap + friction, constant and growing with the spring's torque, that builds
up over a sliding distance; with an angle zero. Numbers: k, gap, F, mu, distance, zero."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from plant import Array
from scipy.optimize import least_squares

TERMS = ("backlash", "coulomb_friction", "per_load")
POINTS = 160  # of a test's average
SETS: tuple[tuple[str, ...], ...] = (
    (),
    ("backlash",),
    ("coulomb_friction",),
    ("coulomb_friction", "per_load"),
    ("backlash", "coulomb_friction"),
    TERMS,
)


@dataclass
class Points:
    """Tests averaged to so many points each (tests x points); `counts`: where the drive follows its command."""

    angle: Array
    torque: Array
    counts: Array
    tests: Array


def points_of(columns: dict[str, Array], count: int = POINTS, centred: bool = False) -> Points:
    """Blocks of rows, averaged. `centred`: each test's angle counts from the middle of its range, for records of
    several gear positions."""
    test = columns.get("test", np.zeros(len(columns["angle_rad"])))
    names = np.unique(test)
    count = min([count] + [int(np.sum(test == t)) for t in names])
    out: dict[str, list[Array]] = {"angle_rad": [], "torque_n_mm": [], "command_n_mm": []}
    for t in names:
        rows = np.flatnonzero(test == t)
        for name, kept in out.items():
            values = columns.get(name, columns["torque_n_mm"])[rows]
            if centred and name == "angle_rad":
                values = values - 0.5 * (values.max() + values.min())
            kept.append(np.array([np.nanmean(part) for part in np.array_split(values, count)]))
    angle, torque, command = (np.array(out[name]) for name in out)
    follows = np.abs(torque - command) < 0.1 * np.max(np.abs(command))
    return Points(angle, torque, follows, names)


def predicted(numbers: Array, points: Points) -> Array:
    """Torque at each point, each test from rest."""
    k, gap, constant, share, over, zero = numbers
    bent = points.angle - zero
    spring = k * np.sign(bent) * np.maximum(0.0, np.abs(bent) - 0.5 * gap)
    level = constant + share * np.abs(spring)
    rubs = np.zeros_like(spring)
    moved = np.diff(points.angle, axis=1)
    for i in range(1, spring.shape[1]):
        most = level[:, i]
        rubs[:, i] = np.clip(rubs[:, i - 1] + most * moved[:, i - 1] / over, -most, most)
    return np.asarray(spring + rubs)


def fit(points: Points, terms: tuple[str, ...] = TERMS) -> tuple[Array, float]:
    """The numbers, and the rms of what is left where the drive follows."""
    reach = 0.5 * float(np.ptp(points.angle))
    full = float(np.max(np.abs(points.torque)))
    middle = 0.5 * float(points.angle.max() + points.angle.min())
    has = [1.0, *(float(term in terms) for term in TERMS), 1.0, 1.0]
    free = np.array([True, *(term in terms for term in TERMS), any(t != "backlash" for t in terms), True])
    unit = np.array([full / reach, reach, full, 1.0, reach, reach])
    low = np.array([1e-3, 0.0, 0.0, 0.0, 1e-3, middle / reach - 1.0])
    high = np.array([1e3, 1.9, 1.0, 1.0, 1.0, middle / reach + 1.0])
    best: tuple[Array, float] = (np.array([full / reach, 0, 0, 0, reach, middle]), math.inf)
    for gap in (0.05, 0.8) if "backlash" in terms else (0.0,):
        start = np.array([1.2, gap, 0.05 * has[2], 0.1 * has[3], 0.05, middle / reach])

        def off(x: Array, start: Array = start) -> Array:
            full_x = start.copy()
            full_x[free] = x
            return np.asarray((predicted(full_x * unit, points) - points.torque)[points.counts] / full)

        found = least_squares(off, np.clip(start, low, high)[free], bounds=(low[free], high[free]), max_nfev=60)
        rms = full * math.sqrt(float(np.mean(found.fun**2)))
        if rms < best[1]:
            whole = start.copy()
            whole[free] = found.x
            best = whole * unit, rms
    return best


def aligned_rms(numbers: Array, points: Points) -> float:
    """What is left of other points where the drive follows, with the zeros of angle and torque and the sliding distance
    fitted to them."""
    reach, full = 0.5 * float(np.ptp(points.angle)), float(np.max(np.abs(points.torque)))
    middle = 0.5 * float(points.angle.max() + points.angle.min())

    def off(x: Array) -> Array:
        moved = np.array([*numbers[:4], x[0] * reach, middle + x[1] * reach])
        return np.asarray((predicted(moved, points) + x[2] * full - points.torque)[points.counts] / full)

    best = math.inf
    for zero in ((numbers[5] - middle) / reach, -0.2, 0.0, 0.2):
        start = np.array([numbers[4] / reach, zero, 0.0])
        low, high = np.array([1e-3, -1.0, -1.0]), np.array([1.0, 1.0, 1.0])
        found = least_squares(off, np.clip(start, low, high), bounds=(low, high), max_nfev=60)
        best = min(best, full * math.sqrt(float(np.mean(found.fun**2))))
    return best


def named(points: Points) -> list[str]:
    """The terms that the Bayesian information criterion keeps: as a baseline for naming. Neighbouring points are not
    independent; eight count as one."""
    count = points.counts.sum() / 8.0
    best = math.inf
    kept: tuple[str, ...] = ()
    for terms in SETS:
        left = fit(points, terms)[1]
        worth = count * math.log(max(left, 1e-9) ** 2) + (len(terms) + (len(terms) > 0)) * math.log(count)
        if worth < best:
            best, kept = worth, terms
    return sorted({"coulomb_friction" if term == "per_load" else term for term in kept})
