"""What each foot bears, reading by reading: sensors say it, K predicts how it changes, and the two are weighed.

A Kalman filter over where the feet stand, the force and moment of what the body carries beyond its weight, and each
sensor's zero and scale. A load that jumps and a foot that moves are no noise: a reading that the state makes less
likely than one in a million is explained by the likeliest of these, which becomes an event (docs/stance.md).
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from brace.stance.limb_law import Spring
from brace.stance.softness import Foot, Response, Soft, Softness
from brace.stance.stance_file import Stance
from brace.stance.statics import Contact, Force, LooseError, Slip, State, Statics

NINETY = 1.645  # sigmas to each end of a 90 % interval
_UNLIKELY = 1e-6  # of a reading, if nothing has happened: once in some hours at 100 Hz
_RECENT = 10  # readings that are judged together, for what moves too little to show in one
_LOAD_SHARE_PER_SQRT_S = 0.02  # of the weight: how what is carried wanders
_LOAD_JUMP_SHARE = 1.0  # of the weight: a payload that is hung on
_FOOT_WANDERS_MM_PER_SQRT_S = 0.002
_FOOT_JUMPS_MM = 3.0  # a slip, or a step
_LEVER_MM = 200.0  # where a payload may pull, from the body's origin
_OFF_GROUND_SIGMAS = 3.0
_NOTHING_SHARE = 0.2  # of what a foot has borne; however unsure its sensor, more is something
_ON_GROUND_SIGMAS = 6.0
_HIDES_ANEW_S = 2.0  # what friction hides creeps
_BETTER_KNOWN = 0.8  # of the variance that was believed: what friction hides is known better now
_TOUCHES = 5  # readings whose mean says whether a foot bears
_NEW_LAW_S = 0.1
_LOG_ODDS_SLIP = -3.0  # of a foot that may slide, against a load that changes
_LOG_ODDS_GIVES_WAY = -12.0  # of a foot whose force is well inside its cone
_LOG_ODDS_BOTH = -5.0  # of a load beside it
_MAY_SLIDE_SIGMAS = 3.0
_QUIET_S = 0.5  # changes that follow one another within this are one event
_SETTLES_S = 0.15  # limbs send one change at different moments of it, which looks like a foot that moves
_AGREED_S = 0.1  # after it: what they then measure says what has changed


@dataclass(frozen=True)
class Reading:
    """What is known of one limb now; vectors in the body's frame.

    tip_mm: where its tip would stand without load, from the angles that it measures
    k_n_per_mm, k_rel: K, 3 x 3, and one sigma of it as a ratio
    force_n: the ground's force on its foot; None: not measured
    noise_n2: of each reading, 3 x 3; hidden_n2: what stays from reading to reading (friction, a sensor's zero)
    scale_rel: one sigma of a torque constant's ratio; 0 for a force sensor
    turns_mm_per_rad: how the tip moves when coxa, femur or tibia turns, a row a joint; None: not known
    """

    tip_mm: np.ndarray
    k_n_per_mm: np.ndarray
    k_rel: float
    force_n: np.ndarray | None
    noise_n2: np.ndarray
    hidden_n2: np.ndarray
    scale_rel: float = 0.0
    turns_mm_per_rad: np.ndarray | None = None


@dataclass(frozen=True)
class Event:
    """Something has happened. kind: load (what is carried has changed), moved (a foot), lifted, landed, soft (`soft`
    says how a limb yields)."""

    time_s: float
    kind: str
    limb: str | None
    change_n: np.ndarray  # load: the force carried beyond the weight; moved, soft: the foot's force; else its change
    soft: Soft | None = None


@dataclass(frozen=True)
class Estimate:
    """Of one moment; a row a limb. Sigmas are one sigma."""

    time_s: float
    force_n: np.ndarray
    force_sigma_n: np.ndarray
    force_covariance_n2: np.ndarray  # n x 3 x 3
    margin_n: np.ndarray  # to sliding, lift-off or letting go; infinite for a foot in the air
    margin_sigma_n: np.ndarray
    is_down: tuple[bool, ...]
    displacement_mm: np.ndarray  # of the body since the first estimate
    displacement_sigma_mm: np.ndarray
    rotation_rad: np.ndarray
    carried_n: np.ndarray  # force and moment beyond the weight, as the body's origin has them: N, N mm
    carried_sigma_n: np.ndarray
    scale: np.ndarray  # of each limb's torques

    @property
    def force_low_n(self) -> np.ndarray:
        """The 5 % ends."""
        return self.force_n - NINETY * self.force_sigma_n

    @property
    def force_high_n(self) -> np.ndarray:
        """The 95 % ends."""
        return self.force_n + NINETY * self.force_sigma_n


@dataclass
class _Law:
    """The statics near where they were last worked out. force = force_n + by_place d(place) + by_load d(carried)."""

    statics: Statics
    place_mm: np.ndarray  # 3 n, of the feet
    carried: np.ndarray  # 6
    force_n: np.ndarray  # 3 n
    by_place: np.ndarray  # 3 n x 3 n
    by_load: np.ndarray  # 3 n x 6
    tip_mm: np.ndarray  # n x 3
    k: np.ndarray  # n x 3 x 3
    spring_force_n: np.ndarray  # n x 3: at it,
    spring_moved_mm: np.ndarray  # n x 3: the tip has moved so far
    pose_of_feet: np.ndarray  # 6 x 3 n: the body's pose, the feet's places less the springs' ways given


class Observer:
    """Of a stance. Not for several threads."""

    def __init__(
        self,
        stance: Stance,
        weights: Sequence[Force],
        places_mm2: Sequence[np.ndarray],
        readings: Sequence[Reading],
        time_s: float,
    ) -> None:
        """weights: of body and limbs. places_mm2: how well each foothold's place is known, 3 x 3. readings: a row a
        limb. Raises LooseError where the limbs do not hold the body."""
        self._stance = stance
        self._weights = list(weights)
        self._weight_n = max(float(np.linalg.norm(sum((force for force, _ in weights), np.zeros(3)))), 1e-3)
        self._contacts = [Contact(limb.normal, limb.friction_ratio, limb.grip_n) for limb in stance.limbs]
        self._n = n = len(stance.limbs)
        self._feet, self._load = slice(0, 3 * n), slice(3 * n, 3 * n + 6)
        self._has_hidden = any(np.any(reading.hidden_n2) or reading.scale_rel > 0.0 for reading in readings)
        self._zero, self._scale = slice(3 * n + 6, 6 * n + 6), slice(6 * n + 6, 7 * n + 6)
        self._size = 7 * n + 6 if self._has_hidden else 3 * n + 6
        self._x = np.zeros(self._size)
        self._x[self._scale] = 1.0
        self._hidden_n2 = [reading.hidden_n2 for reading in readings]  # as it is believed
        self._p = np.zeros((self._size, self._size))
        self._is_down = [True] * n
        self._way_mm = np.zeros((n, 3))  # how far each tip was moved since its force was last known from elsewhere
        self._borne_n = [0.0] * n  # the most since it came down
        self._last_n: list[deque[np.ndarray]] = [deque(maxlen=_TOUCHES) for _ in range(n)]
        self._recent: deque[_Miss] = deque(maxlen=_RECENT)
        self._softness = Softness(stance, self._weight_n)
        self.soft: dict[int, Soft] = {}  # by limb: those that have been found soft; they widen the answer
        self._event: Event | None = None
        self._event_until_s = -np.inf
        self._change: _Change | None = None
        _surprise(3)  # loads what it needs before readings wait
        self._start(places_mm2, readings, time_s)

    def _start(self, places_mm2: Sequence[np.ndarray], readings: Sequence[Reading], time_s: float) -> None:
        tips = np.array([reading.tip_mm for reading in readings])
        k = np.array([reading.k_n_per_mm for reading in readings])
        force = np.array([np.zeros(3) if r.force_n is None else r.force_n for r in readings])
        moved = np.linalg.solve(k, force[:, :, None])[:, :, 0]
        offsets = np.array([limb.offset_mm for limb in self._stance.limbs])
        self._x[self._feet] = (tips + offsets).ravel()
        for i, (place_mm2, reading) in enumerate(zip(places_mm2, readings, strict=True)):
            foot = slice(3 * i, 3 * i + 3)
            self._p[foot, foot] = place_mm2 + np.diag((reading.k_rel * moved[i]) ** 2)
            if self._has_hidden:
                self._p[self._zero, self._zero][foot, foot] = reading.hidden_n2
                self._p[self._scale, self._scale][i, i] = reading.scale_rel**2
        self._p[self._load, self._load] = np.diag(self._load_sd(_LOAD_JUMP_SHARE) ** 2)
        self._time_s = self._law_s = time_s
        self._law = self._new_law(tips, k, force, moved)
        self._scaled_n = force.ravel()
        self._first_pose: np.ndarray | None = None
        self._measure(readings, None)
        self._first_pose = self._pose()[0]

    def _load_sd(self, share: float) -> np.ndarray:
        return share * self._weight_n * np.array([1.0, 1.0, 1.0, _LEVER_MM, _LEVER_MM, _LEVER_MM])

    def update(self, readings: Sequence[Reading | None], time_s: float) -> list[Event]:
        """Takes what has come since the last update, a row a limb; None: nothing. Returns events that have begun."""
        elapsed_s = max(time_s - self._time_s, 0.0)
        self._time_s = time_s
        known = [reading for reading in readings if reading is not None]
        if known and time_s - self._law_s >= _NEW_LAW_S:
            self._renew(readings, time_s)
        self._p[self._load, self._load] += np.diag(self._load_sd(_LOAD_SHARE_PER_SQRT_S) ** 2 * elapsed_s)
        feet = np.arange(3 * self._n)
        self._p[feet, feet] += _FOOT_WANDERS_MM_PER_SQRT_S**2 * elapsed_s
        for i, reading in enumerate(readings):
            self._know_better(i, reading)
            self._hide_anew(i, reading, elapsed_s / _HIDES_ANEW_S)
        events = self._steps(readings, time_s)
        before = self._x.copy(), self._p.copy()
        cause = self._measure(readings, _UNLIKELY)
        if cause is not None and self._change is None:
            self._change = _Change(time_s, *before, [[] for _ in readings])
        if events:  # a foot that leaves or comes is what has changed
            self._change = None
        if self._change is not None:
            self._change.take(readings, time_s)
            events += self._settled(self._change)
        if any(event.kind in ("lifted", "landed") for event in events):
            self._softness.disturbed()
        return events + self._softened(readings, time_s)

    # -- the law -----------------------------------------------------------------------------------------------------

    def _new_law(self, tips: np.ndarray, k: np.ndarray, force: np.ndarray, moved: np.ndarray) -> _Law:
        statics = Statics(tips, self._contacts)
        statics.set_springs([Spring(k[i], moved[i], ()) for i in range(self._n)], force)
        places = self._x[self._feet]
        state = statics.place(places.reshape(-1, 3) - tips)
        self._lift_those_up(state)
        carried = self._x[self._load].copy()
        base = [*self._weights, (carried[:3], np.zeros(3)), *_couple(carried[3:])]
        at_rest, by_place = statics.linear(state, base)
        by_load = np.zeros((3 * self._n, 6))
        for axis, unit in enumerate(np.eye(3)):
            by_load[:, axis] = statics.linear(state, [*base, (unit, np.zeros(3))])[0] - at_rest
            by_load[:, 3 + axis] = (statics.linear(state, [*base, *_couple(unit * _LEVER_MM)])[0] - at_rest) / _LEVER_MM
        bears = np.repeat(self._is_down, 3).astype(float)
        feet = np.zeros((3 * self._n, 6))
        for i in range(self._n):
            feet[3 * i : 3 * i + 3] = np.hstack([np.eye(3), -_cross(places[3 * i : 3 * i + 3])])
        pose = np.linalg.pinv(feet * bears[:, None]) * bears
        return _Law(statics, places.copy(), carried, at_rest, by_place, by_load, tips, k, force, moved, pose)

    def _lift_those_up(self, state: State) -> None:
        for i, is_down in enumerate(self._is_down):
            if not is_down:
                state.lift(i)

    def _renew(self, readings: Sequence[Reading | None], time_s: float) -> None:
        """K and angles of now; the forces go on from what they are."""
        law, force, moved = self._law, *self._springs()
        tips, k = law.tip_mm.copy(), law.k.copy()
        for i, reading in enumerate(readings):
            way = np.abs(moved[i] - law.spring_moved_mm[i])
            if reading is None:
                continue
            tips[i], k[i], rel = reading.tip_mm, reading.k_n_per_mm, reading.k_rel
            rel = max(rel, 1.0 - self.soft[i].low) if i in self.soft else rel
            foot = np.arange(3 * i, 3 * i + 3)
            self._p[foot, foot] += rel**2 * ((self._way_mm[i] + way) ** 2 - self._way_mm[i] ** 2)
            self._way_mm[i] += way
            band_n = 2.0 * float(np.sqrt(_trace(reading.hidden_n2)))
            if band_n > 0.0:
                self._hide_anew(i, reading, float(np.abs(force[i] - law.spring_force_n[i]).max()) / band_n)
        self._law, self._law_s = self._new_law(tips, k, force, moved), time_s

    def _know_better(self, i: int, reading: Reading | None) -> None:
        """A controller's interval may come after its first forces, whose sensor was then believed to hide more. What
        is learnt of it is a measurement: the zero is 0, with the variance that leads from the old belief to the new."""
        if not self._has_hidden or reading is None or reading.force_n is None:
            return
        before, now = self._hidden_n2[i], reading.hidden_n2
        if _trace(now) >= _BETTER_KNOWN * _trace(before):
            return
        self._hidden_n2[i] = now
        nothing = 1e-9 * _trace(before) * np.eye(3)  # a sensor may hide nothing
        learnt, axes = np.linalg.eigh(np.linalg.inv(now + nothing) - np.linalg.inv(before + nothing))
        is_learnt = learnt > 1e-6 / _trace(before)
        h = np.zeros((int(is_learnt.sum()), self._size))
        h[:, self._zero.start + 3 * i : self._zero.start + 3 * i + 3] = axes[:, is_learnt].T
        self._weigh(h, -h @ self._x, np.diag(1.0 / learnt[is_learnt]))

    def _hide_anew(self, i: int, reading: Reading | None, share: float) -> None:
        """Friction hides something else when the load goes the other way: its share of what may be hidden."""
        if self._has_hidden and reading is not None:
            foot = slice(3 * i, 3 * i + 3)
            known_n2 = self._p[self._zero, self._zero][foot, foot]
            if _trace(known_n2) < _trace(reading.hidden_n2):
                known_n2 += min(share, 1.0) * reading.hidden_n2

    def _forces(self, x: np.ndarray | None = None) -> np.ndarray:
        """By the state of now, or by another."""
        law, x = self._law, self._x if x is None else x
        return np.asarray(
            law.force_n + law.by_place @ (x[self._feet] - law.place_mm) + law.by_load @ (x[self._load] - law.carried)
        )

    def _springs(self) -> tuple[np.ndarray, np.ndarray]:
        """Each limb's force and how far it moves the tip, a row a limb."""
        law, force = self._law, self._forces().reshape(-1, 3)
        by_force = np.linalg.solve(law.k, (force - law.spring_force_n)[:, :, None])[:, :, 0]
        return force, np.asarray(law.spring_moved_mm + by_force)

    def _force_by_state(self) -> np.ndarray:
        by_state = np.zeros((3 * self._n, self._size))
        by_state[:, self._feet], by_state[:, self._load] = self._law.by_place, self._law.by_load
        return by_state

    # -- the filter --------------------------------------------------------------------------------------------------

    def _measure(self, readings: Sequence[Reading | None], unlikely: float | None) -> _Cause | None:
        """Weighs what was measured. Returns what has to have happened, where the state explains it with less than this
        probability (None: never)."""
        limbs = [i for i, r in enumerate(readings) if r is not None and r.force_n is not None and self._is_down[i]]
        if not limbs:
            return None
        forces, by_state = self._forces(), self._force_by_state()
        rows = np.concatenate([np.arange(3 * i, 3 * i + 3) for i in limbs])
        h, read = by_state[rows], forces[rows]
        if self._has_hidden:
            # Slopes at the first forces and at the scale 1, until something happens: slopes that follow each reading's
            # noise would look like knowledge of the scale (first-estimates Jacobian, Huang, Mourikis and
            # Roumeliotis 2010).
            scale = np.repeat(self._x[self._scale][limbs], 3)
            h[np.arange(rows.size), self._scale.start + rows // 3] = self._scaled_n[rows]
            h[np.arange(rows.size), self._zero.start + rows] = 1.0
            read = scale * forces[rows] + self._x[self._zero][rows]
        wrong = np.concatenate([readings[i].force_n for i in limbs]) - read  # type: ignore[union-attr]
        noise = np.zeros((rows.size, rows.size))
        for at, i in enumerate(limbs):
            noise[3 * at : 3 * at + 3, 3 * at : 3 * at + 3] = readings[i].noise_n2  # type: ignore[union-attr]
        spread = h @ self._p @ h.T + noise
        cause = None if unlikely is None else self._surprised(limbs, wrong, spread, noise, h, unlikely)
        if cause is not None:
            self._scaled_n = forces
            for i in limbs:
                self._hide_anew(i, readings[i], 1.0)
            self._recent.clear()
            self._p += np.diag(cause.variance)
        self._weigh(h, wrong, noise)
        return cause

    def _weigh(self, h: np.ndarray, wrong: np.ndarray, noise: np.ndarray) -> None:
        ph = self._p @ h.T
        gain = np.linalg.solve(h @ ph + noise, ph.T).T
        self._x += gain @ wrong
        self._p -= gain @ ph.T
        self._p = 0.5 * (self._p + self._p.T)

    def _surprised(
        self,
        limbs: list[int],
        wrong: np.ndarray,
        spread: np.ndarray,
        noise: np.ndarray,
        h: np.ndarray,
        unlikely: float,
    ) -> _Cause | None:
        """What has to have happened where this reading, or the last ones together, are too unlikely."""
        if self._recent and self._recent[-1].limbs != limbs:
            self._recent.clear()
        unlike = float(wrong @ np.linalg.solve(spread, wrong))
        self._recent.append(_Miss(limbs, wrong, unlike))
        if unlike > _surprise(wrong.size, unlikely):
            return self._explain(wrong, spread, h)
        count = len(self._recent)
        if count < _RECENT or sum(miss.unlike for miss in self._recent) <= _surprise(count * wrong.size, unlikely):
            return None
        mean = np.mean([miss.wrong for miss in self._recent], axis=0)
        return self._explain(mean, spread - noise * (1.0 - 1.0 / count), h)

    def _explain(self, wrong: np.ndarray, spread: np.ndarray, h: np.ndarray) -> _Cause:
        """The likeliest of: what is carried has jumped, one foot has moved, both."""
        load = np.zeros(self._size)
        load[self._load] = self._load_sd(_LOAD_JUMP_SHARE) ** 2
        causes = [_Cause(None, load, 0.0)]
        margin_n, sigma_n = self.margins()
        for i in np.flatnonzero(self._is_down):
            foot = np.zeros(self._size)
            foot[3 * i : 3 * i + 3] = _FOOT_JUMPS_MM**2
            odds = _LOG_ODDS_SLIP if margin_n[i] < _MAY_SLIDE_SIGMAS * sigma_n[i] else _LOG_ODDS_GIVES_WAY
            causes += [_Cause(int(i), foot, odds), _Cause(int(i), foot + load, odds + _LOG_ODDS_BOTH)]
        return max(
            causes, key=lambda cause: cause.log_odds + _log_likelihood(wrong, spread + (h * cause.variance) @ h.T)
        )

    # -- events ------------------------------------------------------------------------------------------------------

    def _settled(self, change: _Change) -> list[Event]:
        """What has changed, as soon as the limbs agree: judged by the state before, which then goes on from there.
        Nothing has, where it explains what they measure: a set-point that moved."""
        means = change.means()
        if self._time_s < change.began_s + _SETTLES_S + _AGREED_S or not any(means):
            return []
        self._change = None
        self._x, self._p = change.x, change.p
        self._recent.clear()
        cause = self._measure(means, _UNLIKELY)
        event = None if cause is None else self._happened(cause, change.began_s)
        return [] if event is None else [event]

    def _happened(self, cause: _Cause, time_s: float) -> Event | None:
        """Changes that follow one another are one event."""
        limb = None if cause.limb is None else self._stance.limbs[cause.limb].name
        kind = "load" if limb is None else "moved"
        same = self._event is not None and (self._event.kind, self._event.limb) == (kind, limb)
        is_new = not same or time_s > self._event_until_s
        self._event_until_s = time_s + _QUIET_S
        if not is_new:
            return None
        change = self._x[self._load][:3] if cause.limb is None else self._forces()[3 * cause.limb : 3 * cause.limb + 3]
        self._event = Event(time_s, kind, limb, change.copy())
        return self._event

    def _softened(self, readings: Sequence[Reading | None], time_s: float) -> list[Event]:
        feet = [
            None
            if r is None or r.turns_mm_per_rad is None
            else Foot(r.tip_mm, r.turns_mm_per_rad, r.k_n_per_mm, r.k_rel, r.force_n,
                      r.noise_n2, r.hidden_n2, r.scale_rel)  # fmt: skip
            for r in readings
        ]
        soft = self._softness.take(feet, self._response, time_s)
        if soft is None:
            return []
        self.soft[soft.limb] = soft
        force = self._forces()[3 * soft.limb : 3 * soft.limb + 3].copy()
        return [Event(time_s, "soft", self._stance.limbs[soft.limb].name, force, soft)]

    def _response(self) -> Response:
        law, (margin_n, sigma_n) = self._law, self.margins()
        is_sure = margin_n > _MAY_SLIDE_SIGMAS * sigma_n
        return Response(law.by_place, law.by_load, self._load_sd(_LOAD_JUMP_SHARE), tuple(self._is_down), is_sure)

    def _steps(self, readings: Sequence[Reading | None], time_s: float) -> list[Event]:
        """Feet that have left the ground, and those that have come back."""
        events = []
        forces = self._forces()
        for i, reading in enumerate(readings):
            if reading is None or reading.force_n is None:
                continue
            self._last_n[i].append(reading.force_n)
            count = len(self._last_n[i])
            sigma = math.sqrt(_trace(reading.noise_n2) / count + _trace(reading.hidden_n2))
            size = math.hypot(*sum(self._last_n[i], np.zeros(3))) / count
            self._borne_n[i] = max(self._borne_n[i], size) if self._is_down[i] else size
            nothing_n = min(_OFF_GROUND_SIGMAS * sigma, _NOTHING_SHARE * self._borne_n[i])
            leaves = self._is_down[i] and size < nothing_n and self._may_leave(i, sigma)
            lands = not self._is_down[i] and size > _ON_GROUND_SIGMAS * sigma
            if count < _TOUCHES or not (leaves or lands) or (leaves and sum(self._is_down) <= 1):
                continue
            self._last_n[i].clear()
            self._is_down[i] = not self._is_down[i]
            try:
                self._step(i, reading)
            except LooseError:  # without this foot nothing would hold the body, and yet it stands
                self._is_down[i] = not self._is_down[i]
                continue
            change = -forces[3 * i : 3 * i + 3] if leaves else reading.force_n
            events.append(Event(time_s, "lifted" if leaves else "landed", self._stance.limbs[i].name, change))
        return events

    def _may_leave(self, i: int, sigma_n: float) -> bool:
        """Of a foot that bears nothing now. One that grips may bear nothing while it holds: it has left only where it
        bore something before what changes now."""
        if self._stance.limbs[i].grip_n == 0.0:
            return True
        if self._change is None:
            return False
        before_n = self._forces(self._change.x)[3 * i : 3 * i + 3]
        return float(np.linalg.norm(before_n)) > _ON_GROUND_SIGMAS * sigma_n

    def _step(self, i: int, reading: Reading) -> None:
        """A foot that was lifted or put down: its place is not known any more."""
        law, foot = self._law, slice(3 * i, 3 * i + 3)
        force, moved = self._springs()
        tips = law.tip_mm.copy()
        if self._is_down[i]:
            tips[i] = reading.tip_mm
            pose = self._pose()[0]
            force[i] = reading.force_n if reading.force_n is not None else np.zeros(3)
            moved[i] = np.linalg.solve(law.k[i], force[i])
            self._x[foot] = tips[i] + moved[i] + pose[:3] + np.cross(pose[3:], tips[i])
            self._p[foot, :] = self._p[:, foot] = 0.0
            self._p[foot, foot] = _FOOT_JUMPS_MM**2 * np.eye(3)
        self._p[self._load, self._load] += np.diag(self._load_sd(0.2) ** 2)
        self._law = self._new_law(tips, law.k, force, moved)

    # -- answers -----------------------------------------------------------------------------------------------------

    def _pose(self) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and rotation of the body, and how they follow the state."""
        law, by_state = self._law, self._force_by_state()
        pose = law.pose_of_feet @ (self._x[self._feet] - (law.tip_mm + self._springs()[1]).ravel())
        by_way = np.linalg.solve(law.k, by_state.reshape(self._n, 3, -1)).reshape(3 * self._n, -1)
        feet = np.zeros((3 * self._n, self._size))
        feet[:, self._feet] = np.eye(3 * self._n)
        return np.asarray(pose), np.asarray(law.pose_of_feet @ (feet - by_way))

    def next_slip(self, further: Force, most: float) -> Slip:
        """The first foot that moves when this load is added, up to `most` times, to all that the body carries now."""
        law, force = self._law, self._springs()
        law.statics.set_springs([Spring(k, moved, ()) for k, moved in zip(law.k, force[1], strict=True)], force[0])
        state = law.statics.place((self._x[self._feet].reshape(-1, 3) - law.tip_mm))
        self._lift_those_up(state)
        carried = self._x[self._load]
        law.statics.settle(state, [*self._weights, (carried[:3], np.zeros(3)), *_couple(carried[3:])], 1)
        return law.statics.first_slip(state, [further], most)

    def margins(self) -> tuple[np.ndarray, np.ndarray]:
        """Of each foot, and one sigma; infinite for a foot in the air."""
        forces, covariance = self._forces().reshape(-1, 3), self._force_covariance()
        margin, margin_sigma = np.full(self._n, np.inf), np.zeros(self._n)
        for i, limb in enumerate(self._stance.limbs):
            if not self._is_down[i]:
                continue
            pressing = float(limb.normal @ forces[i])
            along = forces[i] - pressing * limb.normal
            size = float(np.linalg.norm(along))
            margin[i] = self._law.statics.margin_n(i, forces[i])
            slope = limb.friction_ratio * limb.normal - (along / size if size > 1e-9 else 0.0)
            own = covariance[3 * i : 3 * i + 3, 3 * i : 3 * i + 3]
            margin_sigma[i] = np.sqrt(slope @ own @ slope + (limb.friction_sd * (pressing + limb.grip_n)) ** 2)
        return margin, margin_sigma

    def _force_covariance(self) -> np.ndarray:
        by_state = self._force_by_state()
        return np.asarray(by_state @ self._p @ by_state.T)

    def estimate(self) -> Estimate:
        """The state of now."""
        forces, covariance = self._forces().reshape(-1, 3), self._force_covariance()
        margin, margin_sigma = self.margins()
        pose, by_pose = self._pose()
        pose_sigma = np.sqrt(np.einsum("as,as->a", by_pose @ self._p, by_pose))
        first = pose if self._first_pose is None else self._first_pose
        return Estimate(
            self._time_s,
            forces,
            np.sqrt(np.maximum(np.diag(covariance), 0.0)).reshape(-1, 3),
            np.array([covariance[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(self._n)]),
            margin,
            margin_sigma,
            tuple(self._is_down),
            pose[:3] - first[:3],
            pose_sigma[:3],
            pose[3:] - first[3:],
            self._x[self._load].copy(),
            np.sqrt(np.diag(self._p[self._load, self._load])),
            self._x[self._scale].copy() if self._has_hidden else np.ones(self._n),
        )


@dataclass(frozen=True)
class _Miss:
    """By how much a reading missed, and how unlikely that is: its square in sigmas."""

    limbs: list[int]
    wrong: np.ndarray
    unlike: float


@dataclass(frozen=True)
class _Change:
    """Something that begins to change: the state before, and what the limbs measure when it has settled."""

    began_s: float
    x: np.ndarray
    p: np.ndarray
    after: list[list[Reading]]  # a row a limb

    def take(self, readings: Sequence[Reading | None], time_s: float) -> None:
        if time_s < self.began_s + _SETTLES_S:
            return
        for one, reading in zip(self.after, readings, strict=True):
            if reading is not None and reading.force_n is not None:
                one.append(reading)

    def means(self) -> list[Reading | None]:
        """A limb each; None: it has measured nothing."""
        return [
            replace(
                one[-1],
                force_n=np.mean([r.force_n for r in one if r.force_n is not None], axis=0),
                noise_n2=np.mean([reading.noise_n2 for reading in one], axis=0) / len(one),
            )
            if one
            else None
            for one in self.after
        ]


@dataclass(frozen=True)
class _Cause:
    """What may have happened: the limb whose foot has moved, or None; how the state's variance grows; how often."""

    limb: int | None
    variance: np.ndarray
    log_odds: float


def _trace(matrix: np.ndarray) -> float:
    """Of 3 x 3; numpy's own costs ten times as much."""
    return float(matrix[0, 0] + matrix[1, 1] + matrix[2, 2])


def _log_likelihood(wrong: np.ndarray, spread: np.ndarray) -> float:
    return -0.5 * float(wrong @ np.linalg.solve(spread, wrong) + np.linalg.slogdet(spread)[1])


@cache
def _surprise(degrees: int, unlikely: float = _UNLIKELY) -> float:
    from scipy.special import chdtri

    return float(chdtri(degrees, unlikely))


def _couple(moment_n_mm: np.ndarray) -> list[Force]:
    """Forces that add to this moment and to nothing else: for each axis one at the lever's end, one at the origin."""
    forces, levers = np.roll(np.eye(3), 1, axis=0), np.roll(np.eye(3), -1, axis=0)
    couple = []
    for axis in range(3):
        force = forces[axis] * moment_n_mm[axis] / _LEVER_MM
        couple += [(force, levers[axis] * _LEVER_MM), (-force, np.zeros(3))]
    return couple


def _cross(v: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
