"""The step to which an instrument rounded its readings, and the readings before they were rounded."""

from __future__ import annotations

import numpy as np

ON_GRID = 0.1  # of a step: how near to whole steps two readings stand that an instrument has rounded, and a file again
NEAR = 20  # steps between two values, up to which whole numbers of them are no chance
MOST_ON_GRID = 0.95  # of the values that are near to the next one
OFTEN_NEAR = 0.5  # of the values: fewer are no grid's
PLANNED = 0.9  # of the steps from reading to reading: when so many are alike, they were planned


def step_of(values: np.ndarray) -> float:
    """The step of the grid that these readings, in their order, stand on, in their unit; 0 where they stand on none. A
    plan that moves by the same way from reading to reading has a grid too, and no instrument rounded it."""
    values = values[~np.isnan(values)]
    if not values.size:
        return 0.0
    distinct = np.unique(values)
    apart = np.diff(distinct)
    apart = apart[apart > 1e-6 * max(float(np.ptp(distinct)), 1e-30)]
    if apart.size < 3:
        return 0.0
    step = float(np.median(apart[apart < 1.5 * apart.min()]))
    for _ in range(2):
        steps = np.rint(apart / step)
        near = steps <= NEAR
        step = float(apart[near].sum() / steps[near].sum())
    on_grid = np.abs(apart[near] / step - steps[near]) < ON_GRID
    if near.mean() < OFTEN_NEAR or on_grid.mean() < MOST_ON_GRID:
        return 0.0
    moved = np.rint(np.abs(np.diff(values)) / step)
    alike = np.bincount(moved.astype(int), minlength=2)[1:].max()
    return step if alike < PLANNED * moved.size else 0.0


def unrounded(values: np.ndarray, parts: np.ndarray, step: float) -> np.ndarray:
    """Readings as they stood before they were rounded to `step`; one a row, in their own unit.

    Where a reading changes by one step, the value stood half-way between the two. Between two such changes the value is
    taken to move evenly. Where it turns back within a step, it is taken to reach the step's middle. Readings beside a
    change by more than one step stay as they are. `parts` has the number of each row's stretch; one stretch says
    nothing about the next."""
    result = values.astype(float)
    begins = np.flatnonzero(np.diff(parts, prepend=parts[0] - 1) != 0)
    for first, last in zip(begins, np.append(begins[1:], values.size)):
        result[first:last] = _between_changes(values[first:last], step)
    return result


def _between_changes(values: np.ndarray, step: float) -> np.ndarray:
    begins = np.flatnonzero(np.diff(values, prepend=np.nan) != 0.0)
    ends = np.append(begins[1:], values.size) - 1
    level = values[begins]
    change = np.diff(level)
    crossed = np.abs(np.abs(change) - step) < ON_GRID * step
    jumped = np.flatnonzero(~crossed)
    passes = np.zeros(level.size, dtype=bool)  # its neighbours stand on either side of it
    passes[1:-1] = change[:-1] * change[1:] > 0.0
    stays = np.zeros(level.size, dtype=bool)  # beside a jump
    stays[jumped] = stays[jumped + 1] = True
    turns = ~passes & ~stays
    knots = [
        (0.5 * (ends[:-1] + begins[1:])[crossed], (0.5 * (level[:-1] + level[1:]))[crossed]),
        (0.5 * (begins + ends)[turns], level[turns]),
        (ends[jumped], level[jumped]),
        (begins[jumped + 1], level[jumped + 1]),
    ]
    rows, at = (np.concatenate(parts) for parts in zip(*knots))
    order = np.argsort(rows, kind="stable")
    return np.asarray(np.interp(np.arange(values.size), rows[order], at[order]))
