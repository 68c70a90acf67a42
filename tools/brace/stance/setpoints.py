"""What `brace stance set` says: how to move the tips' set-points so that the feet hold better, bear wanted forces, or
the body comes back to where it is without load."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linprog, lsq_linear

from brace.model.travel import travel_rad
from brace.stance.draws import DRAWS, before_payload, span
from brace.stance.limb_law import JOINTS, LimbLaw
from brace.stance.stance_file import Limb, Stance
from brace.stance.statics import LET_GO, OPEN, State, Statics
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, carrying

_CUTS_MOST = 40
_CUT_N = 1e-4  # a cone's side is met so closely
_KEPT_RATIO = 0.995  # of the best smallest margin: the rest buys shorter ways
_LEAST_GAIN_N_PER_MM = 0.02  # a way that gains less is not worth it: moved together, tips change no force
_ROUNDS = 6
_STEPS_MOST = 6
_SHARES = (1.0, 0.5, 0.25, 0.125)
_JUDGING_DRAWS = 24
_JUDGED_STEPS = 2  # the last, beside no way at all: all of them cost a second
_ENOUGH_RATIO = 0.005  # a step that gains less is the last


@dataclass(frozen=True)
class Begun:
    """What is known before set-points move. with_payload: the forces were measured under weight and payload, else under
    the weight alone."""

    stance: Stance
    measured: Measured | None = None
    with_payload: bool = False

    def under_load(self) -> tuple[World, State]:
        """The body under weight and payload. Raises NoStanceError."""
        world = believed(self.stance)
        if not self.with_payload:
            _, state = world.load(world.stand(self.measured), [world.payload])
            return world, state
        world = carrying(world)
        return world, world.stand(self.measured).state


@dataclass(frozen=True)
class SetPoints:
    """Arrays have a row a limb. way_mm: of the tip's set-point in the body's frame. before and after: forces and
    margins under weight and payload. beyond: joints that leave their travel. change_low_n,
    change_high_n: of ways that were given, 90 %. offset_mm: where each foothold then lies,
    from the tip that the new angles mean without load: for stance.toml."""

    stance: Stance
    theta_rad: np.ndarray
    way_mm: np.ndarray
    offset_mm: np.ndarray
    before_n: np.ndarray
    after_n: np.ndarray
    margin_before_n: list[float]
    margin_after_n: list[float]
    displacement_mm: np.ndarray
    beyond: list[str]
    change_n: np.ndarray
    change_low_n: np.ndarray | None = None
    change_high_n: np.ndarray | None = None

    def as_json(self) -> dict[str, object]:
        """For scripts."""
        low, high = self.change_low_n, self.change_high_n
        return {
            "limbs": [
                {
                    "name": limb.name,
                    "theta_rad": self.theta_rad[i],
                    "tip_moves_mm": self.way_mm[i],
                    "offset_mm": self.offset_mm[i],
                    "force_before_n": self.before_n[i],
                    "force_n": self.after_n[i],
                    "change_n": self.change_n[i],
                    **({} if low is None or high is None else {"change_low_n": low[i], "change_high_n": high[i]}),
                    "margin_before_n": self.margin_before_n[i],
                    "margin_n": self.margin_after_n[i],
                }
                for i, limb in enumerate(self.stance.limbs)
            ],
            "body": {"displacement_mm": self.displacement_mm},
            "flags": [f"beyond_travel: {joint}" for joint in self.beyond],
        }


def largest_margin(begun: Begun, travel_mm: float) -> SetPoints:
    """The largest smallest margin of all feet that bear, each component of a way within travel_mm; of such ways the
    shortest. Raises NoStanceError."""
    world, state = begun.under_load()
    tried = _sought(
        begun.stance,
        world,
        state,
        lambda at, force, stiffness: _widest(begun.stance, at, force, stiffness, travel_mm),
        _least_margin_n,
    )
    return _said(begun.stance, world, state, _surest(begun, tried))


def wanted_forces(begun: Begun, wanted_n: np.ndarray, travel_mm: float) -> SetPoints:
    """Forces as near to the wanted ones as weight and payload allow (a row a limb). Raises NoStanceError."""

    def nearest(_: State, force: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
        lack = force - wanted_n.ravel()
        rows = np.vstack([stiffness, _LEAST_GAIN_N_PER_MM * np.eye(lack.size)])
        found = lsq_linear(rows, np.concatenate([lack, np.zeros(lack.size)]), (-travel_mm, travel_mm))
        return np.asarray(found.x.reshape(-1, 3))

    world, state = begun.under_load()
    tried = _sought(begun.stance, world, state, nearest, lambda _, at: -float(np.linalg.norm(at.force_n - wanted_n)))
    return _said(begun.stance, world, state, tried[-1])


def least_sag(begun: Begun) -> SetPoints:
    """The body back to where it is without load: all tips move as the body has sagged, which changes no force. Raises
    NoStanceError."""
    world, state = begun.under_load()
    way = np.array([state.displacement_mm + np.cross(state.rotation_rad, law.tip_mm) for law in world.laws])
    return _said(begun.stance, world, state, _execute(begun.stance, world, state, way))


def moved(begun: Begun, way_mm: np.ndarray, draws: int = DRAWS) -> SetPoints:
    """Ways that are given (a row a limb). Forces and what changes are what is believed, or the draws' median, with
    intervals, as in `answer`. Raises NoStanceError."""
    world, state = begun.under_load()
    said = _said(begun.stance, world, state, _execute(begun.stance, world, state, way_mm))
    standings, is_median = before_payload(begun.stance, begun.measured, draws, begun.with_payload)
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for standing in standings:
        loaded = carrying(standing.world)
        try:
            _, under = standing.world.load(standing, [standing.world.payload])
            after = loaded.moved(replace(standing, world=loaded, state=under), way_mm).state
        except NoStanceError:
            if standing is standings[0]:
                raise
            continue
        found.append((under.force_n, after.force_n))
    before, after_n = np.swapaxes(np.array(found), 0, 1)
    low, high = span(after_n - before)
    said = replace(said, change_low_n=low, change_high_n=high)
    if not is_median:
        return said
    force, contacts = np.median(after_n, axis=0), world.statics_at(state)
    return replace(
        said,
        before_n=np.median(before, axis=0),
        after_n=force,
        change_n=np.median(after_n - before, axis=0),
        margin_before_n=[contacts.margin_n(i, one) for i, one in enumerate(np.median(before, axis=0))],
        margin_after_n=[contacts.margin_n(i, one) for i, one in enumerate(force)],
    )


Ways = Callable[[State, np.ndarray, np.ndarray], np.ndarray]  # of state, forces before any way, and how they change
Worth = Callable[[Statics, State], float]


def _sought(stance: Stance, world: World, state: State, ways: Ways, worth: Worth) -> list[_Executed]:
    """Ways by the law made linear, executed in the whole law, in which joints cross their play and feet slide, and sought
    again from where that leads. A step that makes things worse is halved; one that stays so is not made. All steps,
    the first of no way at all, each better than the one before."""
    at = _execute(stance, world, state, np.zeros((len(stance.limbs), 3)))
    tried, best = [at], worth(at.statics, at.state)
    for _ in range(_STEPS_MOST):
        force, stiffness = _linear(at.world, at.state)
        step = ways(at.state, force + stiffness @ at.way_mm.ravel(), stiffness) - at.way_mm
        for share in _SHARES:
            try:
                at = _execute(stance, world, state, tried[-1].way_mm + share * step)
            except NoStanceError:
                continue
            if (value := worth(at.statics, at.state)) > best:
                break
        else:
            break
        is_done = value - best < _ENOUGH_RATIO * abs(value)
        tried.append(at)
        best = value
        if is_done:
            break
    return tried


def _surest(begun: Begun, tried: Sequence[_Executed]) -> _Executed:
    """The last of ways, or an earlier one that surely leaves a larger smallest margin, on average over what may be. The
    believed limb has its joints in the middle of what their play allows; in truth a joint that bears little may lie on
    either side, and cross its play on the way, or not."""
    standings, _ = before_payload(begun.stance, begun.measured, _JUDGING_DRAWS, begun.with_payload)
    drawn = []
    for standing in standings[1:]:
        try:
            _, under = standing.world.load(standing, [standing.world.payload])
        except NoStanceError:
            continue
        drawn.append(Standing(carrying(standing.world), standing.statics, under))
    if not drawn or not any(one.world.has_play for one in drawn):
        return tried[-1]
    some = [tried[0], *tried[1:][-_JUDGED_STEPS:]]
    margins_n = np.array([[_margin_after_n(at, one.shift_mm) for at in drawn] for one in some])
    better_n = margins_n - margins_n[-1]
    doubt_n = better_n.std(axis=1) / np.sqrt(len(drawn))
    surely_n = better_n.mean(axis=1) - doubt_n
    return tried[-1] if surely_n.max() <= 0.0 else some[int(np.argmax(surely_n))]


def _margin_after_n(standing: Standing, way_mm: np.ndarray) -> float:
    """The smallest margin in one world after ways; where it has no rest, none."""
    if not np.any(way_mm):
        return _least_margin_n(standing.statics, standing.state)
    try:
        after = standing.world.moved(standing, way_mm)
    except NoStanceError:
        return 0.0
    return _least_margin_n(after.statics, after.state)


def _least_margin_n(statics: Statics, state: State) -> float:
    """Of all feet that bear."""
    return min(
        statics.margin_n(i, force)
        for i, (force, contact) in enumerate(zip(state.force_n, state.contact, strict=True))
        if contact not in (OPEN, LET_GO)
    )


def _linear(world: World, state: State) -> tuple[np.ndarray, np.ndarray]:
    """Forces (3 n) and how they change with the feet's places; a set-point that moves is a place that moves back."""
    statics = world.statics_at(state)
    return statics.linear(state, [*world.weight, world.payload])


def _widest(stance: Stance, state: State, force_n: np.ndarray, stiffness: np.ndarray, travel_mm: float) -> np.ndarray:
    """A linear programme in ways and the smallest margin; a cone is cut by planes where the solution leaves it."""
    size = force_n.size
    bearing = [i for i, contact in enumerate(state.contact) if contact not in (OPEN, LET_GO)]
    planes: list[tuple[int, np.ndarray]] = []
    for i in bearing:
        along = _along(stance.limbs[i], force_n[3 * i : 3 * i + 3])
        aside = np.cross(stance.limbs[i].normal, along)
        planes += [(i, np.cos(a) * along + np.sin(a) * aside) for a in np.arange(8) * np.pi / 4.0]
    bounds = [(-travel_mm, travel_mm)] * size + [(None, None)]
    way = np.zeros(size)
    for _ in range(_CUTS_MOST):
        rows, limits = _planes(stance, planes, force_n, stiffness)
        best = linprog(np.append(np.zeros(size), -1.0), rows, limits, bounds=bounds).x
        way = _shortest(rows, limits, best[-1], size, travel_mm)
        new = []
        for i in bearing:
            force = (force_n - stiffness @ way)[3 * i : 3 * i + 3]
            along = _along(stance.limbs[i], force)
            if float(along @ force) > max(float(d @ force) for limb, d in planes if limb == i) + _CUT_N:
                new.append((i, along))
        if not new:
            break
        planes += new
    return way.reshape(-1, 3)


def _planes(
    stance: Stance, planes: list[tuple[int, np.ndarray]], force_n: np.ndarray, stiffness: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Rows and limits of: margin <= friction (normal force + grip) - force along a direction."""
    rows, limits = [], []
    for i, direction in planes:
        limb, block = stance.limbs[i], slice(3 * i, 3 * i + 3)
        side = direction - limb.friction_ratio * limb.normal
        rows.append(np.append(-side @ stiffness[block], 1.0))
        limits.append(limb.friction_ratio * limb.grip_n - float(side @ force_n[block]))
    return np.array(rows), np.array(limits)


def _shortest(rows: np.ndarray, limits: np.ndarray, margin_n: float, size: int, travel_mm: float) -> np.ndarray:
    """The ways of the least sum that keep nearly this margin."""
    kept = _KEPT_RATIO * margin_n if margin_n > 0.0 else margin_n - _CUT_N
    ways = np.hstack([rows[:, :-1], -rows[:, :-1]])
    found = linprog(np.ones(2 * size), ways, limits - kept, bounds=[(0.0, travel_mm)] * (2 * size)).x
    return np.asarray(found[:size] - found[size:])


def _along(limb: Limb, force_n: np.ndarray) -> np.ndarray:
    """The unit vector along the ground that a force has."""
    along = force_n - float(limb.normal @ force_n) * limb.normal
    length = float(np.linalg.norm(along))
    if length > 1e-9:
        return np.asarray(along / length)
    aside = np.cross(limb.normal, np.eye(3)[int(np.argmin(np.abs(limb.normal)))])
    return np.asarray(aside / np.linalg.norm(aside))


@dataclass(frozen=True)
class _Executed:
    """Set-points that have moved. The world's weight has the payload in it."""

    limbs: tuple[Limb, ...]
    way_mm: np.ndarray
    shift_mm: np.ndarray  # of the tips without load
    world: World
    statics: Statics
    state: State


def _execute(stance: Stance, world: World, state: State, way_mm: np.ndarray) -> _Executed:
    """What the whole law says: tips where they then are, feet where they stand. Raises NoStanceError."""
    limbs = tuple(_moved(limb, law, way) for limb, law, way in zip(stance.limbs, world.laws, way_mm, strict=True))
    laws = believed(replace(stance, limbs=limbs)).laws
    shift = np.array([new.tip_mm - old.tip_mm for new, old in zip(laws, world.laws, strict=True)])
    after = carrying(world).moved(Standing(world, world.statics_at(state), state), shift, laws)
    return _Executed(limbs, way_mm, shift, after.world, after.statics, after.state)


def _said(stance: Stance, world: World, state: State, moved: _Executed) -> SetPoints:
    before, after = world.statics_at(state), moved.state
    return SetPoints(
        stance,
        np.array([limb.theta_rad for limb in moved.limbs]),
        moved.way_mm,
        world.offset_mm - moved.shift_mm,
        state.force_n,
        after.force_n,
        [before.margin_n(i, force) for i, force in enumerate(state.force_n)],
        [moved.statics.margin_n(i, force) for i, force in enumerate(after.force_n)],
        after.displacement_mm,
        [f"{limb.name}, {joint}" for limb in moved.limbs for joint in _beyond(limb)],
        after.force_n - state.force_n,
    )


def _moved(limb: Limb, law: LimbLaw, way_mm: np.ndarray) -> Limb:
    """The limb with its tip's set-point moved."""
    wanted, down = law.tip_mm + way_mm, np.array([0.0, 0.0, -1.0])
    for _ in range(_ROUNDS):
        left = wanted - law.tip_mm
        if float(np.linalg.norm(left)) < 1e-6:
            break
        try:
            turn = np.linalg.solve(law.turns_in_body().T, left)
        except np.linalg.LinAlgError:
            raise NoStanceError(f"limb {limb.name!r} is stretched: its tip cannot move so", 1.0, True) from None
        limb = replace(limb, theta_rad=limb.theta_rad + turn)
        law = LimbLaw(limb, down)
    return limb


def _beyond(limb: Limb) -> list[str]:
    """The joints that leave their travel."""
    return [
        joint
        for joint, angle in zip(JOINTS, limb.theta_rad, strict=True)
        for low, high in [travel_rad(limb.model, joint)]
        if not low <= angle <= high
    ]
