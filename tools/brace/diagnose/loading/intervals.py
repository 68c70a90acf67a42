"""90 % intervals of an effect's parameters: where refitting everything else costs 2.71 of chi squared."""

from __future__ import annotations

import numpy as np

from brace.diagnose.diagnosis import Interval
from brace.diagnose.loading.fit import Fit, residuals
from brace.identify.information import half_width_90
from brace.identify.record import Record
from brace.diagnose.loading.screen import Remover
from brace.model.keys import KEY_BY_NAME
from brace.native.plant_batch import number_index

Z_90 = 1.6449
TIMES_AT_ONCE = 100
SIZE_STEP = 1e-3  # of a factor of change, which is about one


def intervals(record: Record, fitted: Fit, keys: tuple[str, ...]) -> dict[str, Interval]:
    """By the curvature at the best fit, as `brace identify` has them: sigma grows with what the fit leaves beyond the
    noise, and of few readings it is uncertain itself. A key that the record does not determine has infinite ends,
    cut at what the format allows."""
    space = fitted.space
    freedom = max(record.readings - space.own, 1)
    width = half_width_90(freedom) * float(np.sqrt(max(1.0, fitted.chi2 / freedom)))
    weight = np.where(np.isinf(space.sigma), 0.0, fitted.scale / space.sigma)
    normal = fitted.jacobian.T @ fitted.jacobian + np.diag(weight**2)
    inside = (fitted.x > space.low) & (fitted.x < space.high)
    of_changes = {factor for factor, _ in space.changing}
    found: dict[str, Interval] = {}
    for key in keys:
        place = space.keys.index(key)
        value = float(fitted.x[place])
        if place in space.stepwise:
            found[key] = _time_interval(record, fitted, place)
            continue
        free = np.flatnonzero(inside | (np.arange(space.size) == place))
        part = normal[np.ix_(free, free)]
        spread = np.sqrt(np.clip(np.diag(np.linalg.pinv(part, rcond=1e-14, hermitian=True)), 0.0, None))
        sigma = float(spread[free.tolist().index(place)] * fitted.scale[place])
        if fitted.jacobian[:, place] @ fitted.jacobian[:, place] < 1e-6:
            sigma = np.inf
        low, high = value - width * sigma, value + width * sigma
        entry = KEY_BY_NAME.get(key)  # none for a size of the rig
        least, most = (entry.low, entry.high) if entry else (space.low[place], space.high[place])
        if entry and number_index()[key] in of_changes:  # limb.toml has how it was before
            value, low, high = 1.0 / value, 1.0 / high, 1.0 / low if low > 0.0 else np.inf
        found[key] = Interval(value, max(low, least), min(high, most))
    return found


def without_none(found: Interval, none: float, lost: float) -> Interval:
    """The interval of an effect's size, where the curvature at the best fit would let it hold `none`, the size of no
    effect, although no effect costs `lost` of chi squared: more than an interval's end may. The end on that side is
    then where a parabola through both would put it."""
    if not found.low <= none <= found.high or lost <= Z_90**2 or none == found.value:
        return found
    end = found.value + (none - found.value) * float(np.sqrt(Z_90**2 / lost))
    return Interval(found.value, end, found.high) if none < found.value else Interval(found.value, found.low, end)


def _time_interval(record: Record, fitted: Fit, place: int) -> Interval:
    """From the times' own posterior, the other keys refitted linearly at each: the reading before its 5 % point to the
    reading after its 95 % point. How large the change is, is refitted with the change at the time in question: its
    signature at the best time would make up for a change that comes later."""
    space, x = fitted.space, fitted.x
    clock = record.dataset["t_s"]
    between = 0.5 * (clock[1:] + clock[:-1])
    widths = np.diff(clock)
    inside = (between >= space.low[place]) & (between <= space.high[place]) & (widths > 0.0)
    times, widths = between[inside], widths[inside]
    if not times.size:
        return Interval(float(x[place]), float(x[place]), float(x[place]))
    of_changes = {factor for factor, _ in space.changing}
    sizes = [i for i, key in enumerate(space.keys) if number_index().get(key) in of_changes]
    remover = Remover(fitted, [space.keys[i] for i in sizes])
    costs = np.empty(times.size)
    for begin in range(0, times.size, TIMES_AT_ONCE):
        points = np.tile(x, (min(TIMES_AT_ONCE, times.size - begin), 1))
        points[:, place] = times[begin : begin + TIMES_AT_ONCE]
        left = remover.augmented(residuals(record, space, points))
        for size in sizes:  # one: an effect has one moment, and what changes at it
            points[:, size] += SIZE_STEP
            column = remover.augmented(residuals(record, space, points)) - left
            points[:, size] -= SIZE_STEP
            norm = np.maximum(np.einsum("ij,ij->i", column, column), 1e-300)
            left = left - (np.einsum("ij,ij->i", left, column) / norm)[:, None] * column
        costs[begin : begin + TIMES_AT_ONCE] = np.einsum("ij,ij->i", left, left)
    weight = widths * np.exp(-0.5 * (costs - costs.min()))
    share = np.cumsum(weight) / weight.sum()
    first, last = times[np.searchsorted(share, 0.05)], times[min(np.searchsorted(share, 0.95), times.size - 1)]
    low = clock[max(int(np.searchsorted(clock, first)) - 1, 0)]
    high = clock[min(int(np.searchsorted(clock, last)), clock.size - 1)]
    return Interval(float(x[place]), float(low), float(high))
