"""Does a loading record's clock run, in seconds, and does the step counter follow it?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.check_runs import MAX_LISTED, run_starts, span
from brace.dataset.faults import DataFault
from brace.dataset.meta import Meta
from brace.dataset.unit_slips import slip_of

Columns = Mapping[str, np.ndarray]
# time between readings over rig.dwell_s -> the unit that the clock is written in, the factor that mends it
TIME_SLIPS = {1e3: ("ms", 1e-3), 1e6: ("us", 1e-6), 1 / 60: ("min", 60.0), 1 / 3600: ("h", 3600.0)}
REGULAR_SHARE = 0.9  # of the rows of a record whose counter counts one by one
STANDS_SHARE = 0.3  # above it, the clock is merely coarse


def faults(columns: Columns, meta: Meta) -> list[DataFault]:
    """Unit, standing clock, counter out of order."""
    inside = np.diff(columns["run"]) == 0
    return [*_unit(columns, meta, inside), *_stands(columns, inside), *_counter(columns, inside)]


def _unit(columns: Columns, meta: Meta, inside: np.ndarray) -> Iterator[DataFault]:
    """A reading comes no sooner than the dwell, and not a thousand dwells later."""
    dwell_s = meta.number("rig.dwell_s")
    steps = np.diff(columns["t_s"])[inside]
    steps = steps[steps > 0.0]
    if dwell_s <= 0.0 or not steps.size:
        return
    typical = float(np.median(steps))
    unit, factor = slip_of(typical / dwell_s, TIME_SLIPS, 2.5)
    if unit:
        yield DataFault(
            None,
            "t_s",
            f"{typical:.4g} between readings in the record, rig.dwell_s = {dwell_s:g} in meta.toml; the column fits "
            f"only in {unit}",
            f"{unit}: multiply by {factor:g}",
        )


def _stands(columns: Columns, inside: np.ndarray) -> Iterator[DataFault]:
    """A clock that otherwise ticks evenly and here and there does not; runs without any tick are reported elsewhere."""
    steps = np.diff(columns["t_s"])
    ticks = steps[inside & (steps > 0.0)]
    starts = run_starts(columns["run"])
    ticking = np.repeat(span(columns["t_s"], starts) > 0.0, np.diff(starts))[1:]
    still = np.flatnonzero(inside & ticking & (steps == 0.0))
    if not still.size or not ticks.size or still.size > STANDS_SHARE * np.count_nonzero(inside):
        return
    typical = float(np.median(ticks))
    if float(np.quantile(ticks, 0.05)) < 0.5 * typical:
        return  # a clock of coarse ticks
    for row in still[:MAX_LISTED]:
        yield DataFault(
            int(row) + 2,
            "t_s",
            f"the clock stands at {columns['t_s'][row]:g} s for another reading; readings are {typical:.4g} s apart",
        )


def _counter(columns: Columns, inside: np.ndarray) -> Iterator[DataFault]:
    """Where steps are counted one by one, one that comes again or too early stands in the wrong place; one that is
    left out is a reading that is not there."""
    change = np.diff(columns["step"])
    within = np.count_nonzero(inside)
    if within == 0 or np.count_nonzero(inside & (change == 1)) < REGULAR_SHARE * within:
        return
    for row in np.flatnonzero(inside & (change <= 0))[:MAX_LISTED]:
        yield DataFault(
            int(row) + 2,
            "step",
            f"step {columns['step'][row + 1]} of run {columns['run'][row]} follows step {columns['step'][row]}: rows "
            "are out of order, or one was written twice",
        )
    for row in np.flatnonzero(inside & (change > 1))[:MAX_LISTED]:
        yield DataFault(
            int(row) + 2,
            "step",
            f"{change[row] - 1} reading{'s are' if change[row] > 2 else ' is'} missing before step "
            f"{columns['step'][row + 1]} of run {columns['run'][row]}",
            blocking=False,
        )
