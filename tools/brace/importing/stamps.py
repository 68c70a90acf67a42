"""When a message's sample was taken: the stamp in its header, where it has one. A recorder's time is when the recorder
got it, which is later, and for each topic by another delay."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from brace.importing.questions import CLOCK

OTHER_CLOCK_S = 10.0  # two topics' delays further apart than this are two clocks, and no delays
AHEAD_S = 0.01  # no message is logged before its sample was taken; synchronised clocks agree within some milliseconds
TOLD_S = 1e-4  # smaller differences change nothing
_SECONDS = ("sec", "secs", "seconds")
_NANOSECONDS = ("nanosec", "nsec", "nsecs", "nanoseconds", "nanos")


def stamp_s(message: object) -> float:
    """Of a header (std_msgs/Header), or of the message itself; NaN where there is none, or only zeros."""
    for holder in (_member(message, "header"), message):
        stamp = _member(holder, "stamp")
        seconds = next((value for name in _SECONDS if (value := _number(_member(stamp, name))) is not None), None)
        if seconds is not None:
            below = next((value for name in _NANOSECONDS if (value := _number(_member(stamp, name))) is not None), 0.0)
            return seconds + 1e-9 * below if seconds or below else math.nan
    return math.nan


def _member(value: object, name: str) -> object:
    return value.get(name) if isinstance(value, Mapping) else getattr(value, name, None)


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


@dataclass(frozen=True)
class Choice:
    """The topics whose stamps give the times of their readings, and the sentences for the user about them."""

    by_stamp: frozenset[str]
    partly: Mapping[str, tuple[int, int]]  # topics with stamps that fit, but not in all: how many have none, of how many
    delays_s: Mapping[str, float]  # of both: how much later the log has their messages (the median)
    told: tuple[str, ...]

    def doubt(self, topics: Collection[str]) -> str:
        """Why these topics, whose readings are joined, would be placed by clocks that disagree; empty where they are
        not. By the log or by stamps, they move against each other by more than synchronised clocks differ."""
        named = [topic for topic in topics if topic in self.delays_s]
        delays = [self.delays_s.get(topic, 0.0) for topic in topics]
        if not named or all(topic in self.by_stamp for topic in topics) or max(delays) - min(delays) <= AHEAD_S:
            return ""
        said = []
        for topic in topics:
            without, count = self.partly.get(topic, (0, 0))
            late = f"the log has them {_time(self.delays_s[topic])} later" if topic in self.delays_s else ""
            said.append(
                f"{topic} has stamps in {count - without} of {count} messages ({late})" if count
                else f"{topic} has stamps ({late})" if late
                else f"{topic} has no stamps that can be used"
            )  # fmt: skip
        return CLOCK.format("; ".join(said))


def chosen(topics: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Choice:
    """Of the topics' times of the log and stamps, s, one of each a message."""
    told: list[str] = []
    delays: dict[str, np.ndarray] = {}
    partly: dict[str, tuple[int, int]] = {}
    medians: dict[str, float] = {}
    for topic, (logged, stamps) in topics.items():
        there = ~np.isnan(stamps)
        if not there.any():
            continue
        if why := _unfit(logged, stamps):
            told.append(f"{topic}: the stamps of its messages {why}: the times of the log are used")
            if there.all() or _unfit(logged[there], stamps[there]):
                continue
            partly[topic] = (int(np.count_nonzero(~there)), len(stamps))
        else:
            delays[topic] = logged - stamps
        medians[topic] = float(np.median((logged - stamps)[there]))
    others = [topic for topic in topics if topic not in delays]
    all_of_them = [*medians.values(), *([0.0] if set(topics) - set(medians) else [])]
    if medians and max(all_of_them) - min(all_of_them) > OTHER_CLOCK_S:
        listed = ", ".join(f"{topic} by {_time(median)}" for topic, median in medians.items())
        told.append(
            f"the stamps of the messages are of several clocks (they differ from the times of the log: {listed}): the "
            "times of the log are used"
        )
        return Choice(frozenset(), {}, {}, tuple(told))
    ahead = {topic: -median for topic, median in medians.items() if median < -AHEAD_S}
    if ahead and len(topics) > 1:
        listed = ", ".join(f"{topic} by {_time(early)}" for topic, early in ahead.items())
        told.append(
            f"messages are in the log before their stamps ({listed}): the clock of those stamps is ahead by an "
            "unknown time; the times of the log are used for all topics"
        )
        return Choice(frozenset(), {}, {}, tuple(told))
    for topic, delay in delays.items():
        if float(np.abs(delay).max()) > TOLD_S:
            told.append(
                f"{topic}: its stamps are used; the log has its {len(delay)} messages {_time(float(delay.min()))} to "
                f"{_time(float(delay.max()))} later"
            )
    if delays and others:
        told.append(f"without usable stamps, at the times of the log: {', '.join(others)}")
    return Choice(frozenset(delays), partly, medians, tuple(told))


def _unfit(logged: np.ndarray, stamps: np.ndarray) -> str:
    """Why a topic's stamps are no times of its samples; empty where they are."""
    missing = int(np.isnan(stamps).sum())
    if missing:
        return f"are missing or 0 in {missing} of {len(stamps)}"
    distinct, moments = len(np.unique(stamps)), len(np.unique(logged))
    if 2 * distinct < moments:
        return f"do not advance ({distinct} different ones in {len(stamps)} messages)"
    if len(stamps) > 1 and not np.any(stamps % 1.0) and np.any(logged % 1.0):
        return "are whole seconds"
    return ""


def _time(seconds: float) -> str:
    return f"{seconds:.4g} s" if abs(seconds) >= 1.0 else f"{seconds * 1e3:.3g} ms"
