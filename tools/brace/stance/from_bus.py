"""Readings of a stance from what its limbs' controllers send."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brace.bus.interval import Interval
from brace.bus.load import Load
from brace.bus.sigma import Sigma
from brace.bus.snapshot import Snapshot
from brace.bus.space import SpaceSnapshot
from brace.bus.watch import NodeState
from brace.stance.limb_law import JOINTS, MATRIX, LimbLaw, Shape, shape_of
from brace.stance.observer import NINETY, Reading
from brace.stance.stance_file import Limb, Stance

FRESH_S = 0.030  # an older K or load is named
USED_S = 0.5  # a still older one is not used
_UNSURE_K_REL = 1.0  # of a K with open play, or of none: the model's then
_K_REL = 0.1  # where neither the controller nor limb.toml says how sure K is
_MIXED_FLAGS = ("GAP_OPEN", "OUT_OF_RANGE", "MOVED_FAR")
_FOLLOWS = 0.05  # how much a reading counts for the noise: some twenty readings are remembered
_JUMP = 9.0  # a difference beyond three sigma is a load that came, and counts as three sigma
_UNKNOWN_SPREAD_N = 2.0
_INTERVAL_WITHIN_S = 1.0  # it comes beside the load; what the first forces hide stays in every later answer
_STANDS_RAD = 0.002  # a joint that is elsewhere by more, twice in a row, has been moved; less is the force's noise
_STANDS_FOLLOWS = 0.1
_SHAPE_S = 0.05  # a shape is worked out so often: the observer takes a new one every tenth of a second
_COUNTED = tuple(f"counted_force_{axis}" for axis in "xyz")
_ENDS = tuple((f"force_{axis}_low", f"force_{axis}_high") for axis in "xyz")
_ACROSS_UNKNOWN_N = 1e3  # one sigma of a force's component that no sensor measures


@dataclass(frozen=True)
class LimbNews:
    """One limb. age_s: of its K; None: nothing has come. why: what widens its answer; empty: nothing."""

    node: int
    reading: Reading | None
    age_s: float | None
    why: tuple[str, ...]


class BusReader:
    """Of one stance; keeps what it has read of each limb."""

    def __init__(self, stance: Stance, sensor_sd_n: float) -> None:
        """sensor_sd_n: one sigma of a tip sensor's reading, each component."""
        self._stance, self._sensor_sd_n = stance, sensor_sd_n
        self._laws = [LimbLaw(limb, stance.down) for limb in stance.limbs]
        self._stands = [_Stands(limb, law) for limb, law in zip(stance.limbs, self._laws, strict=True)]
        self._loads_s = [-np.inf] * len(stance.limbs)
        self._first_loads_s = [np.inf] * len(stance.limbs)
        self._noises = [_Noise(sensor_sd_n**2) for _ in stance.limbs]

    def read(self, nodes: Mapping[int, NodeState], now_s: float) -> list[LimbNews]:
        """What is new since the last call, a row a limb. A force is used once."""
        return [self._read(i, limb, nodes.get(limb.node), now_s) for i, limb in enumerate(self._stance.limbs)]

    def _read(self, i: int, limb: Limb, state: NodeState | None, now_s: float) -> LimbNews:
        if state is None or state.snapshot is None:
            return LimbNews(limb.node, None, None, ("nothing heard",))
        shape = self._stands[i].shape(state, now_s)
        why = [] if state.posture is not None else ["no angles yet"]
        space = state.space
        k, k_rel, age_s = None, _K_REL, now_s - state.snapshot.time_s
        if space is not None and space.space is not None and space.space.is_valid:
            k = limb.turn @ np.array([float(value or 0.0) for value in space.space.k])[MATRIX] @ limb.turn.T
            age_s = now_s - space.time_s + 1e-3 * float(space.age_ms or 0.0)
            k_rel = _relative(None if state.sigma is None else state.sigma.sigma, space.space)
            why += [flag for flag in _MIXED_FLAGS if flag in space.space.flags]
        if k is None or age_s > USED_S:
            why.append("no K in space" if k is None else "K is old")
            k = self._laws[i].spring(np.zeros(3)).k_n_per_mm
        elif age_s > FRESH_S:
            why.append("late")
        if set(why) - {"late"}:
            k_rel = _UNSURE_K_REL
        force, noise, hidden = self._force(i, shape, state, now_s)
        if state.load is None or state.load.load is None or not state.load.load.is_counted:
            why.append("no load sent")
        turns = shape.turns @ shape.from_plane.T
        reading = Reading(shape.tip_mm, k, k_rel, force, noise, hidden, turns_mm_per_rad=turns)
        return LimbNews(limb.node, reading, age_s, tuple(why))

    def _force(
        self, i: int, shape: Shape, state: NodeState, now_s: float
    ) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """The ground's force, its noise, and what stays hidden; in the body's frame. None: no new one."""
        sent = state.load
        none = None, np.zeros((3, 3)), np.zeros((3, 3))
        if sent is None or sent.load is None or not sent.load.is_counted:
            return none
        if sent.time_s <= self._loads_s[i] or now_s - sent.time_s > USED_S:
            return none
        self._first_loads_s[i] = min(self._first_loads_s[i], now_s)
        if state.interval is None and now_s - self._first_loads_s[i] < _INTERVAL_WITHIN_S:
            return none
        self._loads_s[i] = sent.time_s
        force, is_known = _components(sent.load)
        spread = _spread_n2(None if state.interval is None else state.interval.interval)
        noise = np.where(is_known, self._noises[i].of(force, spread), _ACROSS_UNKNOWN_N**2)
        hidden = np.maximum(spread - self._sensor_sd_n**2, 0.0)
        turn = shape.from_plane
        return turn @ force, (turn * noise) @ turn.T, (turn * np.where(is_known, hidden, 0.0)) @ turn.T


class _Stands:
    """Where a limb's joints would stand without load. A controller sends their true angles, which the load has turned:
    what the load that it counts turns them is taken off, by their compliances in limb.toml."""

    def __init__(self, limb: Limb, law: LimbLaw) -> None:
        self._limb, self._law, self._shape = limb, law, law.shape
        self._yields = np.array([limb.model.number(f"joint.{joint}.compliance_rad_per_n_mm") for joint in JOINTS])
        self._rad: np.ndarray | None = None
        self._seen: tuple[float, ...] = ()
        self._elsewhere = self._count = 0
        self._shaped_s = -np.inf
        self._shaped_rad: np.ndarray | None = None
        self._knows_load = False  # of what _rad is from

    def shape(self, state: NodeState, now_s: float) -> Shape:
        """From what has come; until angles have come, of the angles in stance.toml."""
        posture, space = state.posture, state.space
        theta = [
            None if space is None or space.space is None else space.space.theta0,
            None if posture is None else posture.theta1,
            None if posture is None else posture.theta2,
        ]
        seen = (*(float(self._limb.theta_rad[j] if value is None else value) for j, value in enumerate(theta)),
                -1.0 if state.load is None else state.load.time_s)  # fmt: skip
        if seen != self._seen:
            self._seen = seen
            known = np.array([value is not None for value in theta])
            knows_load = state.load is not None and state.load.load is not None and state.load.load.is_counted
            if knows_load and not self._knows_load:  # what was known without it says nothing
                self._rad, self._knows_load, self._count = None, bool(known.all()), 0
            self._take(np.array(seen[:3]) - np.where(known, self._turned_rad(state.load), 0.0))
        if self._rad is not None and self._rad is not self._shaped_rad:
            if not 0.0 <= now_s - self._shaped_s < _SHAPE_S:
                self._shaped_s, self._shaped_rad = now_s, self._rad
                self._shape = shape_of(self._limb, self._limb.model, self._rad)
        return self._shape

    def _turned_rad(self, sent: Snapshot | None) -> np.ndarray:
        if sent is None or sent.load is None or not sent.load.is_counted:
            return np.zeros(3)
        force, _ = _components(sent.load)
        return np.asarray(self._yields * self._law.torques_n_mm(self._law.shape.from_plane @ force))

    def _take(self, rad: np.ndarray) -> None:
        before = self._rad
        if before is None:
            self._shaped_s = -np.inf
        elif np.abs(rad - before).max() < _STANDS_RAD:
            self._elsewhere, self._count = 0, self._count + 1
            rad = before + max(_STANDS_FOLLOWS, 1.0 / self._count) * (rad - before)
        else:
            self._elsewhere += 1
            if self._elsewhere < 2:
                return
            self._count, self._shaped_s = 0, -np.inf
        self._rad = rad


class _Noise:
    """The variance of a force's components: the sensor's, or what neighbouring readings show, whichever is more. A
    force that is worked out from currents is noisier than a sensor's."""

    def __init__(self, least_n2: float) -> None:
        self._least_n2, self._shown_n2 = least_n2, np.full(3, least_n2)
        self._last_n: np.ndarray | None = None

    def of(self, force_n: np.ndarray, spread_n2: np.ndarray) -> np.ndarray:
        """With one more reading. spread_n2: the variance of the controller's interval; all of it may be noise, until
        readings show how much is."""
        if self._last_n is None:
            self._shown_n2 = np.maximum(spread_n2, self._least_n2)
        else:
            shown = np.minimum(0.5 * (force_n - self._last_n) ** 2, _JUMP * np.maximum(self._shown_n2, self._least_n2))
            self._shown_n2 = self._shown_n2 + _FOLLOWS * (shown - self._shown_n2)
        self._last_n = force_n
        return np.asarray(np.maximum(self._shown_n2, self._least_n2))


def _components(load: Load) -> tuple[np.ndarray, np.ndarray]:
    """Outwards in the limb's plane, to its left, upwards; and which are known."""
    values = [load.values.get(name) for name in _COUNTED]
    return np.array([float(v or 0.0) for v in values]), np.array([v is not None for v in values])


def _spread_n2(interval: Interval | None) -> np.ndarray:
    """The variance that a controller's 90 % interval of the force says; a wide one until it has come."""
    variance = np.full(3, _UNKNOWN_SPREAD_N**2)
    for axis, (name_low, name_high) in enumerate(_ENDS):
        if interval is None:
            break
        low, high = interval.values.get(name_low), interval.values.get(name_high)
        if low is not None and high is not None:
            variance[axis] = (0.5 * (float(high) - float(low)) / NINETY) ** 2
    return variance


def _relative(sigma: Sigma | None, space: SpaceSnapshot) -> float:
    """One sigma of K as a ratio: the middle one of its three eigenvalues'."""
    if sigma is None or sigma.space is None:
        return _K_REL
    pairs = [(sigma.space.get(f"space_lambda_{n}"), space.eigenvalues[n - 1]) for n in (1, 2, 3)]
    ratios = sorted(float(one) / float(of) for one, of in pairs if one is not None and of)
    return ratios[len(ratios) // 2] if ratios else _K_REL
