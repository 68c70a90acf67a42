"""What a log holds: readings with a time each, signal by signal. Every source has a rate of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from brace.importing.stamps import Choice


@dataclass(frozen=True)
class Signal:
    """One number of one source, as it came."""

    source: str  # a CAN message or a topic
    name: str  # with the source before it: LOADCELL.Fx
    unit: str  # as the database or the message's type says; empty where neither does
    times_s: np.ndarray  # rising
    values: np.ndarray  # NaN where the log marks 'not known'


@dataclass(frozen=True)
class Log:
    """The signals of one file. `notes`: what of it is not among them, and why."""

    signals: tuple[Signal, ...]
    how: str
    notes: tuple[str, ...] = ()
    choice: Choice | None = None  # of a log whose messages may have stamps
    by_clock: Mapping[str, tuple[Signal, ...]] = field(default_factory=dict)  # log, stamp: where it may be asked
