"""Which limb yields more than its K says, from how forces change: what is carried changes, K predicts how it is shared
out, and a limb that has gone soft leaves a part of its share to the others.

A limb whose joint j has 1 / (1 + s) of its stiffness yields further by s c J (J' df) when its foot's force changes by
df: c the joint's compliance, J how the tip moves when the joint turns. On the feet that is the force
-S s c J (J' df), S how forces follow the feet's places: linear in s, however large. So all limbs' s follow from linear
least squares over the changes, with the change of the load unknown in each (docs/stance.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from brace.stance.limb_law import JOINTS, UNSURE_N, LimbLaw
from brace.stance.stance_file import Stance

_LEVEL_S = 0.3  # forces are means of so long at least,
_LEAST_READINGS = 8  # and of so many of each foot; too few within
_LEVEL_MOST_S = 3.0
_SETTLED = 4  # levels without a change: more say little more
_JUMP_SIGMAS = 5.0  # between the halves of a level: the load comes within it
_CHANGE_SHARE = 0.03  # of the weight, at some foot: less says too little
_CHANGE_SIGMAS = 8.0
_LEAST_REL = 0.05  # one sigma; nobody knows a compliance better
_WHOLE = 0.5  # of K's doubt: that of the limb beside its joints
_SOFT_SD = 1.0  # of s, for a limb that may be soft
_BY_CHANCE = 1e-6  # of a sound limb, over all limbs and joints
_BY_CHANCE_HALF = 1e-2  # of every other change alone
_ODDS = np.log(100.0)  # against the next limb or joint
_STIFFEST = -0.6  # an s that no limb has
_UNEXPLAINED = 1e-5  # of a change that neither load nor softness makes
_SLIPS_MM = 3.0
_HIDES_AGAIN = 10.0  # friction goes with the load and would look like softness: what it hides counts for little
_LINEAR_REL = 0.03  # of a change: K and the limbs' levers change on the way
_NINETY = 1.645
_KINDS = (*JOINTS, "")  # a joint, or the limb as a whole


@dataclass(frozen=True)
class Soft:
    """A limb that has gone soft. joint: the one that must be it; None: nobody can tell, and `ratio` is that of the
    whole limb. ratio, low, high: its stiffness as a share of what its controller reports, with 90 %."""

    limb: int
    joint: str | None
    ratio: float
    low: float
    high: float


@dataclass(frozen=True)
class Foot:
    """Of one limb at one moment, in the body's frame.

    tip_mm: where its tip would stand without load; turns_mm_per_rad: how it moves when a joint turns, a row a joint
    k_n_per_mm, k_rel: K, 3 x 3, and one sigma of it as a ratio
    force_n: measured; None: not. noise_n2, hidden_n2: 3 x 3, of a reading, and what stays from reading to reading
    scale_rel: one sigma of a torque constant's ratio
    """

    tip_mm: np.ndarray
    turns_mm_per_rad: np.ndarray
    k_n_per_mm: np.ndarray
    k_rel: float
    force_n: np.ndarray | None
    noise_n2: np.ndarray
    hidden_n2: np.ndarray
    scale_rel: float


@dataclass(frozen=True)
class Response:
    """How the feet's forces follow their places (3 n x 3 n) and the load (3 n x 6); `load_sd`: how large a load's
    change may be. is_sure: a row a limb, whether its foot is surely within its cone."""

    by_place: np.ndarray
    by_load: np.ndarray
    load_sd: np.ndarray
    is_down: Sequence[bool]
    is_sure: np.ndarray


@dataclass(frozen=True)
class _Level:
    """Mean forces of a while, a row a limb; nan: not measured. noise: 3 x 3 a limb."""

    force_n: np.ndarray
    noise_n2: np.ndarray
    feet: tuple[Foot, ...]
    response: Response
    count: int = 1

    def with_next(self, other: _Level) -> _Level:
        """The mean of both."""
        own, its = self.count / (self.count + other.count), other.count / (self.count + other.count)
        noise = own**2 * self.noise_n2 + its**2 * other.noise_n2
        force = own * self.force_n + its * other.force_n
        return _Level(force, noise, other.feet, other.response, self.count + other.count)


@dataclass
class _Evidence:
    """Of the changes so far: what least squares needs."""

    information: np.ndarray
    projected: np.ndarray

    def add(self, g: np.ndarray, weight: np.ndarray, wrong: np.ndarray) -> None:
        """One change: g how it follows s, weight the inverse of its covariance."""
        self.information += g.T @ weight @ g
        self.projected += g.T @ weight @ wrong

    def of(self, which: int, prior: np.ndarray) -> tuple[float, float]:
        """One s and its variance, the others within what they are trusted to; infinite variance: nothing is known."""
        precision = 1.0 / prior**2
        precision[which] = 0.0
        matrix = self.information + np.diag(precision)
        own = matrix[which, which] - matrix[which] @ _without(matrix, which) @ matrix[:, which]
        if own <= 1e-9 * max(matrix[which, which], 1e-30):
            return 0.0, np.inf
        rest = self.projected[which] - matrix[which] @ _without(matrix, which) @ self.projected
        return float(rest / own), float(1.0 / own)

    def log_likelihood(self, prior: np.ndarray) -> float:
        """Of all changes, if every s is within its prior; but for a number that is the same for all priors."""
        matrix = self.information + np.diag(1.0 / prior**2)
        return 0.5 * float(
            self.projected @ np.linalg.solve(matrix, self.projected)
            - np.linalg.slogdet(matrix)[1]
            - 2.0 * np.log(prior).sum()
        )


class Softness:
    """Of a stance's limbs; keeps what changes of force have said."""

    def __init__(self, stance: Stance, weight_n: float) -> None:
        self._n, self._least_n = len(stance.limbs), _CHANGE_SHARE * weight_n
        number = [limb.model.number for limb in stance.limbs]
        self._compliance = np.array([[n(f"joint.{j}.compliance_rad_per_n_mm") for j in JOINTS] for n in number])
        self._gap_rad = np.array([[n(f"joint.{j}.gap_rad") for j in JOINTS] for n in number])
        self._sticks_rad = self._compliance * [[n(f"joint.{j}.coulomb_n_mm") for j in JOINTS] for n in number]
        self._own_n_mm = np.array([LimbLaw(limb, stance.down).torques_n_mm(np.zeros(3)) for limb in stance.limbs])
        self._rel = np.maximum([n("uncertainty.compliance_rel") for n in number], _LEAST_REL)
        self._named: set[int] = set()
        self._block: list[list[Foot]] = [[] for _ in range(self._n)]
        self._began_s: float | None = None
        self._level: _Level | None = None  # before a change
        self._next: _Level | None = None  # after it
        self._forget()

    def _forget(self) -> None:
        size = len(_KINDS) * self._n
        self._all, *self._halves = (_Evidence(np.zeros((size, size)), np.zeros(size)) for _ in range(3))
        self._changes = self._unexplained = 0

    def disturbed(self) -> None:
        """A foot was lifted or put down: changes count from the next level on."""
        self._level = self._next = self._began_s = None

    def take(self, feet: Sequence[Foot | None], response: Callable[[], Response], time_s: float) -> Soft | None:
        """What has come since the last call, a row a limb. `response` is asked now and then. Returns a limb that has
        been found soft, once."""
        if self._began_s is None:
            self._block, self._began_s = [[] for _ in range(self._n)], time_s
        for block, foot in zip(self._block, feet, strict=True):
            if foot is not None and foot.force_n is not None:
                block.append(foot)
        lasted_s, least = time_s - self._began_s, min(len(block) for block in self._block)
        if lasted_s < _LEVEL_S or (least < _LEAST_READINGS and lasted_s < _LEVEL_MOST_S):
            return None
        level, self._began_s = self._closed(response()), None
        return None if level is None else self._came_to(level)

    def _came_to(self, level: _Level) -> Soft | None:
        """A change is judged when the level after it has settled, or ended."""
        before, after = self._level, self._next
        if before is None:
            self._level = level
        elif after is None and not self._is_change(before, level):
            self._level = before.with_next(level) if before.count < _SETTLED else before
        elif after is None:
            self._next = level
        elif self._is_change(after, level):
            self._level, self._next = after, level
            return self._changed(before, after)
        elif after.count + 1 < _SETTLED:
            self._next = after.with_next(level)
        else:
            self._level, self._next = after.with_next(level), None
            return self._changed(before, self._level)
        return None

    def _closed(self, response: Response) -> _Level | None:
        """The level of the block; None: its forces jump, or too little has come."""
        force, noise = np.full((self._n, 3), np.nan), np.zeros((self._n, 3, 3))
        newest: list[Foot] = []
        for i, block in enumerate(self._block):
            if len(block) < _LEAST_READINGS:
                return None
            read = np.array([foot.force_n for foot in block])
            half = len(block) // 2
            apart = read[:half].mean(axis=0) - read[half:].mean(axis=0)
            noise_n2 = np.mean([foot.noise_n2 for foot in block], axis=0)
            sigma = np.sqrt(np.diag(noise_n2) * (1.0 / half + 1.0 / (len(block) - half)))
            if np.any(np.abs(apart) > _JUMP_SIGMAS * sigma):
                return None
            force[i], noise[i] = read.mean(axis=0), noise_n2 / len(block)
            newest.append(block[-1])
        return _Level(force, noise, tuple(newest), response)

    def _is_change(self, before: _Level, after: _Level) -> bool:
        change = np.abs(after.force_n - before.force_n)
        sigma = np.sqrt(np.diagonal(before.noise_n2 + after.noise_n2, axis1=1, axis2=2))
        return bool(np.any((change > self._least_n) & (change > _CHANGE_SIGMAS * sigma)))

    def _changed(self, before: _Level, after: _Level) -> Soft | None:
        n, size, response = self._n, 3 * self._n, after.response
        by_place = 0.5 * (before.response.by_place + response.by_place)
        by_load = 0.5 * (before.response.by_load + response.by_load)
        change = after.force_n - before.force_n
        tips = np.array([b.tip_mm - a.tip_mm for a, b in zip(before.feet, after.feet, strict=True)])
        wrong = change.ravel() + by_place @ tips.ravel()
        spread = by_load @ np.diag(response.load_sd**2) @ by_load.T
        places = np.zeros((size, size))
        g = np.zeros((size, len(_KINDS) * n))
        for i, foot in enumerate(after.feet):
            own = slice(3 * i, 3 * i + 3)
            spread[own, own] += before.noise_n2[i] + after.noise_n2[i] + _HIDES_AGAIN * foot.hidden_n2
            spread[own, own] += foot.scale_rel**2 * np.outer(change[i], change[i])
            spread[own, own] += (_LINEAR_REL * np.linalg.norm(change[i])) ** 2 * np.eye(3)
            places[own, own] += self._place_mm2(i, foot, before.force_n[i], after.force_n[i], response.is_sure[i])
            places[own, own] += (_LINEAR_REL * np.linalg.norm(tips[i])) ** 2 * np.eye(3)
            for kind, yields in enumerate(self._yields(i, foot)):
                g[:, len(_KINDS) * i + kind] = -by_place[:, own] @ (yields @ change[i])
        spread += by_place @ places @ by_place.T
        rows = np.repeat(np.asarray(response.is_down), 3)
        g, wrong, weight = g[rows], wrong[rows], np.linalg.inv(spread[np.ix_(rows, rows)])
        trust = self._trust(after.feet)
        if not self._is_explained(g, wrong, spread[np.ix_(rows, rows)], trust):
            self._unexplained += 1
            if self._unexplained > 1:
                self._forget()
            return None
        self._unexplained = 0
        self._all.add(g, weight, wrong)
        self._halves[self._changes % 2].add(g, weight, wrong)
        self._changes += 1
        return self._named_by(trust)

    def _yields(self, i: int, foot: Foot) -> list[np.ndarray]:
        """By how much the tip yields further [mm/N] where a joint, or the whole limb, is half as stiff (s = 1)."""
        turns = foot.turns_mm_per_rad
        joints = [c * np.outer(turn, turn) for c, turn in zip(self._compliance[i], turns, strict=True)]
        return [*joints, np.linalg.inv(foot.k_n_per_mm)]

    def _place_mm2(self, i: int, foot: Foot, before_n: np.ndarray, after_n: np.ndarray, is_sure: bool) -> np.ndarray:
        """By how much else a foot may have moved against its limb: a slip, play that was crossed, friction."""
        torques = np.array([foot.turns_mm_per_rad @ force + self._own_n_mm[i] for force in (before_n, after_n)])
        unsure = UNSURE_N * np.abs(foot.turns_mm_per_rad).sum(axis=1)
        stays = (torques[0] * torques[1] > 0.0) & np.all(np.abs(torques) > unsure, axis=0)
        angles = np.where(stays, 0.0, self._gap_rad[i]) ** 2 + self._sticks_rad[i] ** 2
        slips = 0.0 if is_sure else _SLIPS_MM**2
        return np.asarray((foot.turns_mm_per_rad.T * angles) @ foot.turns_mm_per_rad + slips * np.eye(3))

    def _trust(self, feet: Sequence[Foot]) -> np.ndarray:
        """One sigma of each s of a sound robot."""
        rel = np.maximum([foot.k_rel for foot in feet], self._rel)
        return np.asarray(np.outer(rel, [1.0] * len(JOINTS) + [_WHOLE]).ravel())

    def _is_explained(self, g: np.ndarray, wrong: np.ndarray, spread: np.ndarray, trust: np.ndarray) -> bool:
        """By a load and by one joint or limb that may have gone soft, beside what the changes so far have said."""
        for h in range(trust.size):
            wide = trust.copy()
            wide[h] = _SOFT_SD
            matrix = np.linalg.inv(self._all.information + np.diag(1.0 / wide**2))
            off = wrong - g @ (matrix @ self._all.projected)
            expected = spread + g @ matrix @ g.T
            s = matrix @ (self._all.projected + g.T @ np.linalg.solve(expected, off))
            if off @ np.linalg.solve(expected, off) < _surprise(wrong.size) and s[h] > _STIFFEST:
                return True
        return False

    def _named_by(self, trust: np.ndarray) -> Soft | None:
        most = _sigmas(_BY_CHANCE / trust.size)
        odds = np.full(trust.size, -np.inf)
        for h in range(trust.size):
            wide = trust.copy()
            wide[h] = _SOFT_SD
            odds[h] = self._all.log_likelihood(wide)
        best = int(np.argmax(odds))
        limb, kind = divmod(best, len(_KINDS))
        rivals = odds.reshape(self._n, -1)
        others = np.delete(rivals, limb, axis=0)
        if limb in self._named or odds[best] - others.max() < _ODDS:
            return None
        if not _is_beyond(self._all.of(best, trust), trust[best], most):
            return None
        half = _sigmas(_BY_CHANCE_HALF)
        if not all(_is_beyond(one.of(best, trust), trust[best], half) for one in self._halves):
            return None
        is_one = bool(_KINDS[kind]) and odds[best] - np.delete(rivals[limb], kind).max() > _ODDS
        at = best if is_one else len(_KINDS) * limb + len(JOINTS)
        s, variance = self._all.of(at, trust)
        half = _NINETY * float(np.sqrt(variance))
        ratio, low, high = (1.0 / max(1.0 + one, 1e-3) for one in (s, s + half, s - half))
        self._named.add(limb)
        return Soft(limb, _KINDS[kind] if is_one else None, ratio, low, high)


def _is_beyond(found: tuple[float, float], trust: float, sigmas: float) -> bool:
    s, variance = found
    return bool(np.isfinite(variance) and s > sigmas * np.sqrt(variance + trust**2))


def _without(matrix: np.ndarray, which: int) -> np.ndarray:
    """The inverse of a matrix without one row and column, with zeros there."""
    rest = np.delete(np.arange(len(matrix)), which)
    found = np.zeros_like(matrix)
    found[np.ix_(rest, rest)] = np.linalg.inv(matrix[np.ix_(rest, rest)])
    return found


@cache
def _sigmas(probability: float) -> float:
    from scipy.special import ndtri

    return float(-ndtri(probability))


@cache
def _surprise(degrees: int) -> float:
    from scipy.special import chdtri

    return float(chdtri(degrees, _UNEXPLAINED))
