"""How likely a lag is before the record is seen, and the sentence that reports it. While a rig moves on, a late
sensor reads the force of an earlier displacement. Where a rig waits before each reading, a delay changes nothing. Only
a sensor that has not settled yet makes the same readings there."""

from __future__ import annotations

import numpy as np

from brace.diagnose.loading.evidence import implausible
from brace.effects.rivals import RIVAL_BY_NAME
from brace.identify.record import Record

SIZE = RIVAL_BY_NAME["lag"].ways[0][0]
EARLY_IS_RARER = 3.0  # sensors, filters and buses make forces late; only a second clock makes them early
QUICKEST_WAIT_S = 0.3  # even odds that a rig that is said to wait so long before each reading moves on instead


def rarity_nats(record: Record, lag_s: float) -> float:
    """What a lag costs in nats, by its size and by whether the rig waits (`rig.dwell_s`). 0 for one that is as common
    as play."""
    moves_on = 1.0 / (1.0 + _wait_s(record) / QUICKEST_WAIT_S)
    if_it_moves_on = _of_time(abs(lag_s)) + (np.log(EARLY_IS_RARER) if lag_s < 0.0 else 0.0)
    if_it_waits = _of_time(settling_s(record, lag_s))
    return float(-np.log(moves_on * np.exp(-if_it_moves_on) + (1.0 - moves_on) * np.exp(-if_it_waits)))


def settling_s(record: Record, lag_s: float) -> float:
    """Time constant [s] of a sensor that, after the rig's wait, still lacks as much of the last step as a sensor that
    is late by `lag_s` lacks in a rig that moves on. Infinite where no time constant does that: for a lag below zero, or
    of a whole interval and more."""
    between_s = np.diff(record.dataset["t_s"])[np.diff(record.dataset["run"]) == 0]
    share = lag_s / float(np.median(between_s)) if between_s.size else 0.0
    return _wait_s(record) / float(np.log(1.0 / share)) if 0.0 < share < 1.0 else float("inf")


def lag_in_words(record: Record, lag_s: float, sigma_s: float) -> str:
    """What happened and what to do. `lag_s` is below zero where forces are early; `sigma_s` is one sigma of it."""
    side = "after" if lag_s >= 0.0 else "before"
    digits = 0 if sigma_s >= 1e-3 else 2
    size = f"{1e3 * abs(lag_s):.{digits}f} ms (+- {1e3 * sigma_s:.{digits}f}, one sigma) {side} the displacements"
    waits = ""
    if (wait_s := _wait_s(record)) > QUICKEST_WAIT_S:
        settles = settling_s(record, lag_s)
        or_settles = f", or its sensor settles with a time constant of {settles:.2g} s" if np.isfinite(settles) else ""
        waits = f" if the rig did not wait {wait_s:g} s before each reading, as rig.dwell_s says{or_settles}"
    return f"the forces are read {size}{waits}; give both columns one clock, or read after the tip has come to rest"


def _wait_s(record: Record) -> float:
    return record.dataset.meta.number("rig.dwell_s")


def _of_time(time_s: float) -> float:
    return implausible(time_s / SIZE.usual, SIZE.plausible_times) if np.isfinite(time_s) else float("inf")
