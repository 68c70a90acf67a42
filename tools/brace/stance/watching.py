"""A stance as its limbs' controllers report it: frames in, what each foot bears out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from brace.bus.frame import Frame
from brace.bus.thinning import thinned
from brace.bus.watch import Watch
from brace.stance.from_bus import BusReader, LimbNews
from brace.stance.observer import NINETY, Estimate, Event, Observer, Reading
from brace.stance.softness import Soft
from brace.stance.stance_file import Stance
from brace.stance.statics import Slip
from brace.stance.world import believed, place_covariance_mm2

PERIOD_S = 0.03  # what comes within it is taken together: of each limb the newest
_SOFT = "SOFT"
ALARM_SHARE = 0.02  # of the weight
_ALARM_ENDS = 1.5  # times its level, so that a margin at the level is one alarm and not many
_ALARM_EVERY_S = 0.05
_ALARM_AFTER = 2  # times in succession: a margin of few readings is now and then low by their noise
_WHOLE_WITHIN_S = 1.0
_FACTOR_MOST = 1000.0
_EVENT_WORDS = {"load": "what the body carries has changed", "moved": "its foot has moved",
                "lifted": "has left the ground",
                "landed": "bears again", "alarm": "may let go next",
                "soft": "yields more than its controller reports"}  # fmt: skip


@dataclass(frozen=True)
class Shown:
    """What is known of the stance now. next_slip: if the payload of stance.toml came on top; None: it has none."""

    stance: Stance
    estimate: Estimate
    news: Sequence[LimbNews]
    alarms: tuple[str, ...]
    next_slip: Slip | None
    soft: Mapping[int, Soft] = field(default_factory=dict)  # by limb

    def why(self, limb: int) -> list[str]:
        """What widens a limb's answer."""
        return [*self.news[limb].why, *([_SOFT] if limb in self.soft else [])]

    def as_json(self) -> dict[str, object]:
        """One object of `watch --json`; names as `load --json` has them."""
        e = self.estimate
        slip = self.next_slip
        return {
            "event": "stance",
            "time_s": round(e.time_s, 4),
            "limbs": [
                {
                    "name": limb.name,
                    "node": limb.node,
                    "force_n": e.force_n[i],
                    "force_low_n": e.force_low_n[i],
                    "force_high_n": e.force_high_n[i],
                    "margin_n": e.margin_n[i],
                    "margin_sigma_n": e.margin_sigma_n[i],
                    "state": "sticks" if e.is_down[i] else "open",
                    "age_ms": None if (age_s := self.news[i].age_s) is None else round(1e3 * age_s, 1),
                    "torque_ratio": e.scale[i],
                    "flags": self.why(i),
                }
                for i, limb in enumerate(self.stance.limbs)
            ],
            "body": {
                "displacement_mm": e.displacement_mm,
                "displacement_sigma_mm": e.displacement_sigma_mm,
                "rotation_rad": e.rotation_rad,
            },
            "carried": {
                "force_n": e.carried_n[:3],
                "moment_n_mm": e.carried_n[3:],
                "force_sigma_n": e.carried_sigma_n[:3],
            },
            "next_slip": None
            if slip is None
            else {
                "limb": None if slip.limb < 0 else self.stance.limbs[slip.limb].name,
                "further_payload_factor": slip.factor,
            },
            "alarms": list(self.alarms),
        }

    def lines(self) -> list[str]:
        """For people."""
        e = self.estimate
        x, y, z = e.displacement_mm
        carried = " ".join(f"{value:.2f}" for value in e.carried_n[:3])
        lines = [f"body moved {x:.2f} {y:.2f} {z:.2f} mm since the start; carries {carried} N beyond its weight"]
        for i, (limb, one) in enumerate(zip(self.stance.limbs, self.news, strict=True)):
            force = "  ".join(
                f"{axis} {f:8.2f} +- {NINETY * s:.2f}" for axis, f, s in zip("xyz", e.force_n[i], e.force_sigma_n[i])
            )
            state = f"margin {e.margin_n[i]:.2f} N" if e.is_down[i] else "in the air"
            alarm = "  ALARM" if limb.name in self.alarms else ""
            why = f"  ({', '.join(self.why(i))})" if self.why(i) else ""
            age = "" if one.age_s is None else f"  {1e3 * one.age_s:.0f} ms"
            lines.append(f"  {limb.name:14s} {force}  {state}{alarm}{age}{why}")
        if self.next_slip is not None and self.next_slip.limb >= 0:
            name = self.stance.limbs[self.next_slip.limb].name
            lines.append(f"  next to let go: {name}, at {self.next_slip.factor:.2f} times the payload on top")
        return lines


class Alarms:
    """The feet whose margin may be below a level. limbs: their names now."""

    def __init__(self, stance: Stance, level_n: float) -> None:
        self._names = [limb.name for limb in stance.limbs]
        self._level_n, self._next_s = level_n, -np.inf
        self._low = np.zeros(len(self._names), int)  # how many times in succession
        self.limbs: tuple[str, ...] = ()

    def begin(self, observer: Observer, now_s: float) -> list[str]:
        """The limbs whose alarm begins now."""
        if now_s < self._next_s:
            return []
        self._next_s = now_s + _ALARM_EVERY_S
        margin_n, sigma_n = observer.margins()
        ends = np.array([_ALARM_ENDS if name in self.limbs else 1.0 for name in self._names])
        self._low = np.where(margin_n - NINETY * sigma_n < self._level_n * ends, self._low + 1, 0)
        alarmed = [name for name, count in zip(self._names, self._low, strict=True)
                   if count >= _ALARM_AFTER or (count and name in self.limbs)]  # fmt: skip
        before, self.limbs = self.limbs, tuple(alarmed)
        return [name for name in self.limbs if name not in before]


class Watching:
    """Frames in; keeps the newest estimate. Events wait until they are asked for."""

    def __init__(self, stance: Stance, where: str, sensor_sd_n: float, alarm_n: float | None) -> None:
        self._stance, self._middle = stance, believed(stance)
        self._watch, self._reader = Watch(where), BusReader(stance, sensor_sd_n)
        weight = float(np.linalg.norm(sum((force for force, _ in self._middle.weight), np.zeros(3))))
        self._alarms = Alarms(stance, ALARM_SHARE * weight if alarm_n is None else alarm_n)
        self._held: list[Frame] = []
        self._observer: Observer | None = None
        self._events: list[Event] = []
        self._newest: list[Reading | None] = [None] * len(stance.limbs)
        self._news: list[LimbNews] = []
        self._heard_s: float | None = None  # since when there is something of every limb

    @property
    def alarms(self) -> tuple[str, ...]:
        """The limbs that may let go next."""
        return self._alarms.limbs

    def missing(self) -> list[str]:
        """The limbs that have not been heard."""
        return [limb.name for limb, one in zip(self._stance.limbs, self._newest, strict=True) if one is None]

    def new_events(self) -> list[Event]:
        """Since the last call."""
        events, self._events = self._events, []
        return events

    def take(self, frames: Sequence[Frame], now_s: float) -> bool:
        """Takes what has come. False: not every limb has been heard yet. Raises LooseError where the limbs do not hold
        the body."""
        thin = thinned([*self._held, *frames], may_hold=bool(frames))
        self._held = thin.held
        for frame in thin.needed:
            self._watch.add(frame)
        self._watch.count(thin.counted)
        self._news = self._reader.read(self._watch.nodes, now_s)
        readings = [one.reading for one in self._news]
        self._newest = [_newer(new, before) for new, before in zip(readings, self._newest, strict=True)]
        if self._observer is None:
            first = self._to_begin_with(now_s)
            if first is None:
                return False
            limbs = zip(self._stance.limbs, self._middle.laws, strict=True)
            places = [place_covariance_mm2(limb, law) for limb, law in limbs]
            self._observer = Observer(self._stance, self._middle.weight, places, first, now_s)
        else:
            self._events += self._observer.update(readings, now_s)
        self._events += [Event(now_s, "alarm", name, np.zeros(3)) for name in self._alarms.begin(self._observer, now_s)]
        return True

    def _to_begin_with(self, now_s: float) -> list[Reading] | None:
        """The readings with which the observer begins, one of each limb. It waits up to a second for K, angles and
        forces of all limbs, then takes what has come. None: it still waits."""
        first = [reading for reading in self._newest if reading is not None]
        if len(first) < len(self._stance.limbs):
            return None
        self._heard_s = now_s if self._heard_s is None else self._heard_s
        whole = all(not set(one.why) - {"late"} for one in self._news) and all(r.force_n is not None for r in first)
        return first if whole or now_s - self._heard_s > _WHOLE_WITHIN_S else None

    def shown(self) -> Shown:
        """What is known now; `take` has said True."""
        assert self._observer is not None
        slip = None
        if np.any(self._stance.payload_n):
            slip = self._observer.next_slip((self._stance.payload_n, self._stance.payload_at_mm), _FACTOR_MOST)
        soft = dict(self._observer.soft)
        return Shown(self._stance, self._observer.estimate(), self._news, self.alarms, slip, soft)


def _newer(new: Reading | None, before: Reading | None) -> Reading | None:
    """To begin with: the newest angles and K, with the last force."""
    if new is None or before is None or new.force_n is not None:
        return new or before
    return replace(new, force_n=before.force_n, noise_n2=before.noise_n2, hidden_n2=before.hidden_n2)


def event_json(event: Event) -> dict[str, object]:
    """One object of `watch --json`."""
    return {
        "event": event.kind,
        "time_s": round(event.time_s, 4),
        "limb": event.limb,
        "change_n": event.change_n,
        **({} if event.soft is None else _soft_json(event.soft)),
    }


def _soft_json(soft: Soft) -> dict[str, object]:
    return {"joint": soft.joint, "stiffness_ratio": soft.ratio, "low": soft.low, "high": soft.high}


def event_line(event: Event) -> str:
    """For people."""
    if event.kind == "alarm":
        return f"ALARM {event.limb}: it {_EVENT_WORDS['alarm']}: its margin may be below the level of --alarm"
    if event.soft is not None:
        what = "the limb" if event.soft.joint is None else f"its {event.soft.joint} joint"
        stiff = f"{event.soft.ratio:.2f} of its stiffness ({event.soft.low:.2f} to {event.soft.high:.2f})"
        return f"{event.limb}: {_EVENT_WORDS[event.kind]}: {what} has {stiff}"
    x, y, z = event.change_n
    who = "" if event.limb is None else f"{event.limb}: "
    what = "carries" if event.kind == "load" else "force" if event.kind == "moved" else "change"
    return f"{who}{_EVENT_WORDS[event.kind]} ({what} {x:.2f} {y:.2f} {z:.2f} N)"
