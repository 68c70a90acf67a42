"""A stance with every unknown given a value: as it is believed, or one draw of what it may be."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from brace.model import LIMB_KEYS, LimbModel
from brace.stance.limb_law import CLOSES_AT_N, JOINTS, UNSURE_N, GivesWayError, LimbLaw, Spring, cross, side_of
from brace.stance.stance_file import Limb, Stance
from brace.stance.statics import E_LOOSE, OK, SLIDE_STEPS, Contact, Force, LooseError, Slip, State, Statics

_YIELDS = tuple(
    key.name
    for key in LIMB_KEYS
    if key.name.split(".")[0] in ("link", "joint", "base") and key.name.endswith(("_mm_per_n", "_rad_per_n_mm"))
)
_LENGTHS = tuple(f"geometry.{link}_mm" for link in JOINTS)
_ROUNDS_MOST = 6
_STEPS = 4  # in which a load comes where joints have play
_TURNS_MOST = 40
_SIDE_TOLERANCE = 1e-6  # of the load that closes a joint's play
_SETTLED_SHARE = 1e-4  # of the load: forces that change by less between rounds are those of their own springs


class NoStanceError(Exception):
    """No equilibrium. `why` says what gives way; `share`: how much of the weight is borne, or of the payload beside the
    weight."""

    def __init__(self, why: str, share: float, is_payload: bool) -> None:
        super().__init__(why)
        self.why, self.share, self.is_payload = why, share, is_payload

    def as_json(self) -> dict[str, object]:
        """The reason, and the nearest load that is borne."""
        nearest = {"weight_factor": 1.0, "payload_factor": self.share} if self.is_payload else {
            "weight_factor": self.share, "payload_factor": 0.0}  # fmt: skip
        return {"reason": self.why, "nearest_load": nearest}


@dataclass(frozen=True)
class World:
    """The limbs' laws, the ground under them, and where the footholds are: `offset_mm` from the tips' places without
    load, a row a limb. `place_covariance`: how far they may be elsewhere, by footholds, zeros and lengths, 3 x 3
    a limb [mm^2]."""

    laws: tuple[LimbLaw, ...]
    contacts: tuple[Contact, ...]
    offset_mm: np.ndarray
    place_covariance: tuple[np.ndarray, ...]
    weight: tuple[Force, ...]
    payload: Force

    def _statics(self) -> Statics:
        return Statics(np.array([law.tip_mm for law in self.laws]), self.contacts)

    def stand(self, measured: Measured | None = None, near_n: np.ndarray | None = None) -> Standing:
        """The body under its weight, its forces measured or not. near_n: what the forces may be."""
        statics = self._statics()
        near_n = np.zeros((len(self.laws), 3)) if near_n is None else near_n
        if measured is not None:
            state = self._step(statics, lambda: self._put_down(statics, measured), near_n, 1.0, is_payload=False)
            return Standing(self, statics, state)
        self._set(statics, near_n, False)
        state = statics.place(self.offset_mm)
        for share in self._shares():
            loads = [(share * force, at) for force, at in self.weight]
            near_n = state.force_n if share > self._shares()[0] else near_n
            step = _to(statics, state, loads, 1)
            state = self._step(statics, step, near_n, share, is_payload=False, size=self._shares()[0])
        return Standing(self, statics, state)

    def rest_at(self, force_n: np.ndarray) -> Standing:
        """The body under its weight on footholds that lie where these forces, a row a limb, put the tips. A foot of no
        force at all has let go."""
        held = [side_of(law.sides(force)) for law, force in zip(self.laws, force_n, strict=True)]
        statics = self._statics()
        springs = self._set(statics, force_n, False, held)
        world = replace(self, offset_mm=np.array([spring.moved_mm for spring in springs]))
        state = statics.place(world.offset_mm)
        for limb in np.flatnonzero(~np.any(force_n, axis=1)):
            state.lift(int(limb))
        self._refuse(*statics.settle(state, self.weight, 1), is_payload=False)
        return Standing(world, statics, state)

    def _shares(self) -> list[float]:
        """Of a load, one after the other: what slides and what play opens hangs on the way there."""
        return [1.0] if not self.has_play else [(done + 1) / _STEPS for done in range(_STEPS)]

    @property
    def has_play(self) -> bool:
        """Of any joint."""
        return any(law.has_play for law in self.laws)

    def _put_down(self, statics: Statics, measured: Measured) -> tuple[State, int, float]:
        """On the places that are most probable with the forces measured."""
        state = statics.place(self._places(statics, statics.place(self.offset_mm), measured))
        return state, *statics.settle(state, self.weight, 1)

    def _step(
        self,
        statics: Statics,
        step: Callable[[], tuple[State, int, float]],
        near_n: np.ndarray,
        share: float,
        is_payload: bool,
        size: float = 1.0,
    ) -> State:
        """Springs and joints' places in their play such that the forces that result are those they belong to. One joint
        at a time changes its place, the one whose load says most that it lies elsewhere. share: of the load after the
        step, size: in it."""
        forces, rounds = near_n, 0
        changed = np.zeros((len(self.laws), len(JOINTS)), dtype=int)
        held = [side_of(law.sides(force)) for law, force in zip(self.laws, forces, strict=True)]
        for _ in range(_TURNS_MOST):
            self._set(statics, forces, is_payload, held)
            state, status, part = step()
            if status != OK:
                self._refuse(status, share - (1.0 - part) * size, is_payload)
            elsewhere = self._elsewhere(_on_limbs_n(state, forces), held)
            if elsewhere:
                _, limb, joint, side = max(elsewhere, key=lambda one: (-changed[one[1], one[2]], one[0]))
                changed[limb, joint] += 1
                held[limb][joint] = 0.0 if changed[limb, joint] % 3 == 2 else side
                continue
            before, forces, rounds = forces, state.force_n, rounds + 1
            if rounds == _ROUNDS_MOST or self._is_settled(before, forces):
                break
        return state

    def _elsewhere(self, forces_n: np.ndarray, held: Sequence[np.ndarray]) -> list[tuple[float, int, int, float]]:
        """The joints that do not lie where their load holds them: by how much, limb, joint, and where the load
        holds it."""
        found = []
        for limb, (law, force, places) in enumerate(zip(self.laws, forces_n, held, strict=True)):
            for joint, (side, place) in enumerate(zip(law.sides(force), places, strict=True)):
                if np.isfinite(side) and (by := _beyond(side, place)) > _SIDE_TOLERANCE:
                    found.append((by, limb, joint, float(side_of(side))))
        return found

    def _places(self, statics: Statics, state: State, measured: Measured) -> np.ndarray:
        """Where the feet are, from what is known of their places and from their forces: the most probable."""
        at_rest, stiffness = statics.linear(state, self.weight)
        size = at_rest.size
        places, noise = np.zeros((size, size)), np.zeros((size, size))
        for limb in range(len(self.laws)):
            block = slice(3 * limb, 3 * limb + 3)
            places[block, block] = self.place_covariance[limb] + self.laws[limb].play_covariance_mm2()
            noise[block, block] = measured.covariance_n2[limb]
        gain = places @ stiffness.T @ np.linalg.inv(stiffness @ places @ stiffness.T + noise)
        return np.asarray(self.offset_mm + (gain @ (measured.force_n.ravel() - at_rest)).reshape(-1, 3))

    def load(
        self, standing: Standing, forces: Sequence[Force], near_n: np.ndarray | None = None
    ) -> tuple[Statics, State]:
        """The standing body under its weight and further forces, its springs those at the forces that result; near_n:
        what these may be. Where joints have play the load comes in steps without near_n, and in one with it."""
        statics, state = self._statics(), standing.state
        shares = self._shares() if near_n is None else [1.0]
        near_n = state.force_n if near_n is None else near_n
        for share in shares:
            loads = [*self.weight, *((share * force, at) for force, at in forces)]
            slide_steps = 2 if self.has_play else SLIDE_STEPS
            step = _to(statics, state, loads, slide_steps)
            state = self._step(statics, step, near_n, share, is_payload=True, size=shares[0])
            near_n = state.force_n
        return statics, state

    def lifted(self, state: State, limb: int, forces: Sequence[Force]) -> State:
        """The body under its weight and further forces, as `state` has it, when a foot is let go. What it bore fades in
        steps, for what slides and which play opens hangs on the way there. Raises NoStanceError."""
        statics, loads, bore = self._statics(), [*self.weight, *forces], state.force_n[limb]
        at = self.laws[limb].tip_mm + state.place_mm[limb]
        state = state.copy()
        near_n = state.force_n
        state.lift(limb)
        for done in range(_STEPS + 1):
            share = 1.0 - done / _STEPS
            step = _to(statics, state, [*loads, (share * bore, at)], 1)
            state = self._step(statics, step, near_n, 1.0, is_payload=True)
            near_n = state.force_n
        return state

    def moved(self, standing: Standing, way_mm: np.ndarray, laws: Sequence[LimbLaw] | None = None) -> Standing:
        """After the tips' set-points have moved by ways (a row a limb), under the weight: tips where they then are
        without load, feet where they stand. laws: the limbs at their new angles; without them a limb's K is that of
        before. Raises NoStanceError."""
        laws = [law.at(way) for law, way in zip(self.laws, way_mm, strict=True)] if laws is None else laws
        world = replace(self, laws=tuple(laws), offset_mm=standing.state.place_mm - way_mm)
        statics, state = world._statics(), standing.state.copy()
        state.move(-way_mm)
        step = _to(statics, state, self.weight, 1)
        state = world._step(statics, step, state.force_n, 1.0, is_payload=True)
        return Standing(world, statics, state)

    def first_slip(self, standing: Standing, most: float) -> AtSlip:
        """When the payload grows up to `most` times. Feet stick until then, so the way there is straight from one joint
        that crosses its play to the next."""
        force, at = self.payload
        if not np.any(force):
            return NO_SLIP
        under_payload_n = None
        statics, near_n = self._statics(), standing.state.force_n
        held = [side_of(law.sides(one)) for law, one in zip(self.laws, near_n, strict=True)]
        here, done = standing.state.copy(), 0.0
        for _ in range(_TURNS_MOST):
            self._set(statics, near_n, True, held)
            at_done = [*self.weight, (done * force, at)]
            statics.settle(here, at_done, 1)
            try:
                found = statics.first_slip(here, [self.payload], most - done)
            except LooseError:  # with the springs of these forces the body gives way before a foot does: `load` says so
                return replace(NO_SLIP, under_payload_n=under_payload_n)
            way = min(0.999 * found.factor, 1.0)
            if not way > 0.0:
                break
            there = here.copy()
            statics.settle(there, [*at_done, (way * force, at)], 1)
            now_n, then_n = _on_limbs_n(here, near_n), _on_limbs_n(there, near_n)
            part, limb, joint, side = self._next_crossing(now_n, then_n - now_n, held)
            if done <= 1.0 <= done + min(part * way, found.factor):
                under_payload_n = now_n + (1.0 - done) / way * (then_n - now_n)
            if not part * way < found.factor:
                break
            held[limb][joint] = side
            done += part * way
            if done >= most:
                return replace(NO_SLIP, under_payload_n=under_payload_n)
            statics.settle(here, [*self.weight, (done * force, at)], 1)
            near_n = now_n + part * (then_n - now_n)
        if found.limb < 0:
            return AtSlip(-1, np.inf, under_payload_n)
        return AtSlip(*self._at_its_load(statics, here, done, found, held), under_payload_n)

    def _at_its_load(
        self, statics: Statics, here: State, done: float, found: Slip, held: Sequence[np.ndarray]
    ) -> tuple[int, float]:
        """Again with the springs at the load that moves the foot. here: the state at the factor `done`."""
        force, at = self.payload
        for _ in range(2):
            if found.limb < 0 or found.factor <= 0.0:
                break
            forces, _ = statics.linear(here, [*self.weight, ((done + found.factor) * force, at)])
            try:
                self._set(statics, forces.reshape(-1, 3), True, held)
                found = statics.first_slip(here, [self.payload], 2.0 * found.factor + 1.0)
            except (NoStanceError, LooseError):
                break
        return found.limb, done + found.factor

    def _next_crossing(
        self, forces_n: np.ndarray, per_factor_n: np.ndarray, held: Sequence[np.ndarray]
    ) -> tuple[float, int, int, float]:
        """The joint that leaves its side, or closes, first: after which factor, limb, joint, and where it lies then."""
        first = (np.inf, -1, -1, 0.0)
        for limb, (law, force, grows, places) in enumerate(zip(self.laws, forces_n, per_factor_n, held, strict=True)):
            now, then = law.sides(force), law.sides(force + grows)
            for joint, place in enumerate(places):
                slope = then[joint] - now[joint] if np.isfinite(now[joint]) else 0.0
                if slope == 0.0 or place * slope > 0.0:
                    continue
                end = place if place else float(np.sign(slope))
                first = min(first, (max((end - now[joint]) / slope, 0.0), limb, joint, 0.0 if place else end))
        return first

    def statics_at(self, state: State) -> Statics:
        """The springs those at a state's forces."""
        statics, forces = self._statics(), state.force_n
        on_limbs = _on_limbs_n(state, forces)
        held = [side_of(law.sides(force)) for law, force in zip(self.laws, on_limbs, strict=True)]
        self._set(statics, forces, is_payload=True, held=held)
        return statics

    def _set(
        self,
        statics: Statics,
        forces_n: np.ndarray,
        is_payload: bool,
        held: Sequence[np.ndarray | None] | None = None,
    ) -> list[Spring]:
        held = [None] * len(self.laws) if held is None else held
        try:
            springs = [law.spring(*at) for law, *at in zip(self.laws, forces_n, held, strict=True)]
        except GivesWayError as error:
            raise NoStanceError(str(error), 0.0, is_payload) from None
        statics.set_springs(springs, forces_n)
        return springs

    def _is_settled(self, before_n: np.ndarray, forces_n: np.ndarray) -> bool:
        most = _SETTLED_SHARE * max(float(np.abs(forces_n).sum()), 1e-9)
        return float(np.abs(forces_n - before_n).max()) <= most

    @staticmethod
    def _refuse(status: int, share: float, is_payload: bool) -> None:
        if status == E_LOOSE:
            why = "the limbs do not hold the body: it can move or turn without resistance"
            if is_payload:  # under the weight alone they do
                why = "under the payload the limbs give way: they no longer hold the body"
            raise NoStanceError(why, 0.0, is_payload)
        if status != OK:
            under = "the payload" if is_payload else "the weight"
            raise NoStanceError(f"under {under} too many feet slide or leave the ground", share, is_payload)


@dataclass(frozen=True)
class Measured:
    """The ground's forces on the feet before the payload, a row a limb, with their noise (3 x 3 a limb) [N, N^2]."""

    force_n: np.ndarray
    covariance_n2: tuple[np.ndarray, ...]

    @property
    def sigma_n(self) -> float:
        """One sigma of a component, over all feet."""
        return float(np.sqrt(np.mean([np.trace(one) / 3.0 for one in self.covariance_n2])))


@dataclass(frozen=True)
class AtSlip:
    """The first foot to move when the payload grows, and its factor then; -1 and infinity: none. under_payload_n: about
    what the feet bear at the factor 1, if none moves before it."""

    limb: int
    factor: float
    under_payload_n: np.ndarray | None


NO_SLIP = AtSlip(-1, np.inf, None)


@dataclass(frozen=True)
class Standing:
    """A body under its weight."""

    world: World
    statics: Statics
    state: State


def _on_limbs_n(state: State, near_n: np.ndarray) -> np.ndarray:
    """The feet's forces as the limbs have them, whose frames turn with the body; near_n: those of the springs."""
    return np.asarray(state.force_n - cross(state.rotation_rad, near_n))


def _to(
    statics: Statics, state: State, loads: Sequence[Force], slide_steps: int
) -> Callable[[], tuple[State, int, float]]:
    """A step from a state to a load, to be taken again with other springs."""

    def step() -> tuple[State, int, float]:
        new = state.copy()
        return new, *statics.settle(new, loads, slide_steps)

    return step


def _beyond(side: float, place: float) -> float:
    """By how much a load says that a joint is not where it is taken to lie; negative: it is there."""
    return 1.0 - place * side if place else abs(side) - 1.0


def believed(stance: Stance, unsure_n: float = UNSURE_N) -> World:
    """Every unknown at its most probable value. unsure_n: one sigma of what is known of a foot's force."""
    laws = tuple(LimbLaw(limb, stance.down, closes_at_n=max(unsure_n, CLOSES_AT_N)) for limb in stance.limbs)
    offsets = np.array([limb.offset_mm for limb in stance.limbs])
    return _world(stance, laws, offsets, [limb.friction_ratio for limb in stance.limbs])


def drawn(stance: Stance, middle: World, chance: np.random.Generator) -> World:
    """Footholds, zeros, lengths, compliances and friction drawn from what stance.toml and limb.toml trust them.
    `middle`: the believed world of this stance."""
    laws, offsets, frictions = [], [], []
    for limb, at_middle in zip(stance.limbs, middle.laws, strict=True):
        law = LimbLaw(limb, stance.down, _drawn_model(limb.model, chance))
        foothold = at_middle.tip_mm + limb.offset_mm + chance.normal(0.0, limb.offset_sd_mm, 3)
        laws.append(law)
        offsets.append(foothold - law.tip_mm)
        frictions.append(max(0.0, limb.friction_ratio + limb.friction_sd * chance.standard_normal()))
    return _world(stance, tuple(laws), np.array(offsets), frictions)


def carrying(world: World) -> World:
    """The same with the payload as a part of its weight."""
    return replace(world, weight=(*world.weight, world.payload), payload=(np.zeros(3), np.zeros(3)))


def _world(stance: Stance, laws: tuple[LimbLaw, ...], offset_mm: np.ndarray, frictions: Sequence[float]) -> World:
    contacts = tuple(
        Contact(limb.normal, friction, limb.grip_n) for limb, friction in zip(stance.limbs, frictions, strict=True)
    )
    weight = [(stance.weight_n * stance.down, stance.com_mm)]
    weight += [(newton * stance.down, at) for law in laws for newton, at in law.weights() if newton > 0.0]
    covariance = tuple(foothold_covariance_mm2(limb, law) for limb, law in zip(stance.limbs, laws, strict=True))
    return World(laws, contacts, offset_mm, covariance, tuple(weight), (stance.payload_n, stance.payload_at_mm))


def place_covariance_mm2(limb: Limb, law: LimbLaw) -> np.ndarray:
    """Of a foothold, seen from where the tip is believed to be: its own, and those of zeros, lengths and play."""
    return np.asarray(foothold_covariance_mm2(limb, law) + law.play_covariance_mm2())


def foothold_covariance_mm2(limb: Limb, law: LimbLaw) -> np.ndarray:
    """The same, as if it were known where the joints lie in their play."""
    number = limb.model.number
    own = limb.offset_sd_mm**2 + number("uncertainty.length_mm") ** 2
    turns = number("uncertainty.angle_rad") * law.turns_in_body()
    return np.asarray(own * np.eye(3) + turns.T @ turns + 1e-12 * np.eye(3))


def _drawn_model(model: LimbModel, chance: np.random.Generator) -> LimbModel:
    number = model.number
    of_all = np.exp(number("uncertainty.gain_rel") * chance.standard_normal())
    yields = {
        key: number(key) * of_all * np.exp(number("uncertainty.compliance_rel") * chance.standard_normal())
        for key in _YIELDS
        if number(key) > 0.0
    }
    lengths = {
        key: max(number(key) + number("uncertainty.length_mm") * chance.standard_normal(), 0.5 * number(key))
        for key in _LENGTHS
    }
    zeros = {
        (key := f"joint.{joint}.zero_offset_rad"): number(key)
        + number("uncertainty.angle_rad") * chance.standard_normal()
        for joint in JOINTS
    }
    return model.with_values({**yields, **lengths, **zeros})
