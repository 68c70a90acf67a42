"""What the page shows of a body on its limbs: what each foot bears, its margin, and what has happened."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TypedDict

from brace.bus.frame import Frame
from brace.stance.limb_law import UNSURE_N
from brace.stance.observer import NINETY
from brace.stance.stance_file import Stance
from brace.stance.statics import LooseError
from brace.stance.watching import PERIOD_S, Shown, Watching, event_line

_EVERY_S = 0.1  # what is worked out for the page
_EVENTS = 6


class FootNumbers(TypedDict):
    """`force_n` is the ground's force on the foot in the body's frame, `half_n` half of its 90 % interval; None of a
    foot in the air: it has no margin."""

    name: str
    force_n: list[float]
    half_n: list[float]
    margin_n: float | None
    margin_half_n: float | None
    age_ms: float | None
    is_alarm: bool
    why: list[str]


class StanceNumbers(TypedDict):
    """`waits_for`: limbs that have not been heard yet, then no feet. `trouble`: why there is no answer."""

    name: str
    waits_for: list[str]
    trouble: str
    feet: list[FootNumbers]
    carried_n: list[float]
    moved_mm: list[float]
    next_limb: str | None
    next_factor: float | None
    events: list[str]


class StanceFeed:
    """Frames in; keeps the newest numbers."""

    def __init__(self, stance: Stance, where: str) -> None:
        self._watching = Watching(stance, where, UNSURE_N, None)
        self._events: deque[str] = deque(maxlen=_EVENTS)
        self._first_s: float | None = None
        self._next_s = 0.0
        self._is_heard = False
        self.numbers: StanceNumbers = {
            "name": stance.name, "waits_for": self._watching.missing(), "trouble": "", "feet": [], "carried_n": [],
            "moved_mm": [], "next_limb": None, "next_factor": None, "events": [],
        }  # fmt: skip

    def take(self, frames: Sequence[Frame], now_s: float) -> None:
        """What has come, in the order of its time."""
        part: list[Frame] = []
        try:
            for frame in frames:
                if part and frame.time_s - part[0].time_s >= PERIOD_S:
                    self._take(part, part[-1].time_s)
                    part = []
                part.append(frame)
            self._take(part, part[-1].time_s if part else now_s)
        except LooseError as error:
            self.numbers["trouble"], self.numbers["feet"] = f"no stance: {error}", []

    def _take(self, frames: Sequence[Frame], now_s: float) -> None:
        self._is_heard = self._watching.take(frames, now_s)
        self._first_s = now_s if self._first_s is None else self._first_s
        for event in self._watching.new_events():
            self._events.appendleft(f"{event.time_s - self._first_s:.1f} s: {event_line(event)}")
        if now_s < self._next_s:
            return
        self._next_s = now_s + _EVERY_S
        self.numbers["waits_for"] = self._watching.missing()
        if self._is_heard:
            self._show(self._watching.shown())

    def _show(self, shown: Shown) -> None:
        slip, numbers = shown.next_slip, self.numbers
        is_named = slip is not None and slip.limb >= 0
        numbers["trouble"] = ""
        numbers["feet"] = [_foot(shown, i) for i in range(len(shown.stance.limbs))]
        numbers["carried_n"] = [round(float(one), 2) for one in shown.estimate.carried_n[:3]]
        numbers["moved_mm"] = [round(float(one), 2) for one in shown.estimate.displacement_mm]
        numbers["next_limb"] = shown.stance.limbs[slip.limb].name if slip is not None and is_named else None
        numbers["next_factor"] = round(slip.factor, 2) if slip is not None and is_named else None
        numbers["events"] = list(self._events)


def _foot(shown: Shown, i: int) -> FootNumbers:
    estimate, name, age_s = shown.estimate, shown.stance.limbs[i].name, shown.news[i].age_s
    is_down = estimate.is_down[i]
    return {
        "name": name,
        "force_n": [round(float(one), 2) for one in estimate.force_n[i]],
        "half_n": [round(NINETY * float(one), 2) for one in estimate.force_sigma_n[i]],
        "margin_n": round(float(estimate.margin_n[i]), 2) if is_down else None,
        "margin_half_n": round(NINETY * float(estimate.margin_sigma_n[i]), 2) if is_down else None,
        "age_ms": None if age_s is None else round(1e3 * age_s),
        "is_alarm": name in shown.alarms,
        "why": shown.why(i),
    }
