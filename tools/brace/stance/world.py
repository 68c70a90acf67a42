"""A stance with every unknown given a value: as it is believed, or one draw of what it may be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.model import LIMB_KEYS, LimbModel
from brace.stance.limb_law import JOINTS, UNSURE_N, GivesWayError, LimbLaw
from brace.stance.stance_file import Limb, Stance
from brace.stance.statics import E_LOOSE, OK, Contact, Force, State, Statics

_YIELDS = tuple(
    key.name
    for key in LIMB_KEYS
    if key.name.split(".")[0] in ("link", "joint", "base") and key.name.endswith(("_mm_per_n", "_rad_per_n_mm"))
)
_LENGTHS = tuple(f"geometry.{link}_mm" for link in JOINTS)
_ROUNDS_MOST = 6
_SETTLED_SHARE = 1e-4  # of the load: forces that change by less between rounds are those of their own springs
_PLACE_SD_OF_GAP = 1.0 / np.sqrt(12.0)  # where a joint stands in its play, if nothing says it


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
    load, a row a limb. `place_covariance`: how far they may be elsewhere, 3 x 3 a limb [mm^2]."""

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
        statics, forces = self._statics(), np.zeros((len(self.laws), 3)) if near_n is None else near_n
        for _ in range(_ROUNDS_MOST):
            self._set(statics, forces, is_payload=False)
            state = statics.place(self.offset_mm)
            if measured is not None:
                state = statics.place(self._places(statics, state, measured))
            status, share = statics.settle(state, self.weight, 1)
            self._refuse(status, share, is_payload=False)
            before, forces = forces, state.force_n
            if self._is_settled(before, forces):
                break
        return Standing(self, statics, state)

    def _places(self, statics: Statics, state: State, measured: Measured) -> np.ndarray:
        """Where the feet are, from what is known of their places and from their forces: the most probable."""
        at_rest, stiffness = statics.linear(state, self.weight)
        size = at_rest.size
        places, noise = np.zeros((size, size)), np.zeros((size, size))
        for limb in range(len(self.laws)):
            block = slice(3 * limb, 3 * limb + 3)
            places[block, block] = self.place_covariance[limb]
            noise[block, block] = measured.covariance_n2[limb]
        gain = places @ stiffness.T @ np.linalg.inv(stiffness @ places @ stiffness.T + noise)
        return np.asarray(self.offset_mm + (gain @ (measured.force_n.ravel() - at_rest)).reshape(-1, 3))

    def load(
        self, standing: Standing, forces: Sequence[Force], near_n: np.ndarray | None = None
    ) -> tuple[Statics, State]:
        """The standing body under its weight and further forces, its springs those at the forces that result; near_n:
        what these may be."""
        statics, guess = self._statics(), standing.state.force_n if near_n is None else near_n
        for _ in range(_ROUNDS_MOST):
            self._set(statics, guess, is_payload=True)
            state = standing.state.copy()
            status, share = statics.settle(state, [*self.weight, *forces])
            self._refuse(status, share, is_payload=True)
            before, guess = guess, state.force_n
            if self._is_settled(before, guess):
                break
        return statics, state

    def statics_at(self, forces_n: np.ndarray) -> Statics:
        """The springs those at these forces, a row a limb."""
        statics = self._statics()
        self._set(statics, forces_n, is_payload=True)
        return statics

    def _set(self, statics: Statics, forces_n: np.ndarray, is_payload: bool) -> None:
        try:
            springs = [law.spring(force) for law, force in zip(self.laws, forces_n, strict=True)]
        except GivesWayError as error:
            raise NoStanceError(str(error), 0.0, is_payload) from None
        statics.set_springs(springs, forces_n)

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

    def with_noise(self, chance: np.random.Generator) -> Measured:
        """What else might have been measured."""
        noise = [chance.multivariate_normal(np.zeros(3), covariance) for covariance in self.covariance_n2]
        return Measured(self.force_n + np.array(noise), self.covariance_n2)


@dataclass(frozen=True)
class Standing:
    """A body under its weight."""

    world: World
    statics: Statics
    state: State


def believed(stance: Stance) -> World:
    """Every unknown at its most probable value."""
    laws = tuple(LimbLaw(limb, stance.down, closes_at_n=UNSURE_N) for limb in stance.limbs)
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


def _world(stance: Stance, laws: tuple[LimbLaw, ...], offset_mm: np.ndarray, frictions: Sequence[float]) -> World:
    contacts = tuple(
        Contact(limb.normal, friction, limb.grip_n) for limb, friction in zip(stance.limbs, frictions, strict=True)
    )
    weight = [(stance.weight_n * stance.down, stance.com_mm)]
    weight += [(newton * stance.down, at) for law in laws for newton, at in law.weights() if newton > 0.0]
    covariance = tuple(_place_covariance(limb, law) for limb, law in zip(stance.limbs, laws, strict=True))
    return World(laws, contacts, offset_mm, covariance, tuple(weight), (stance.payload_n, stance.payload_at_mm))


def _place_covariance(limb: Limb, law: LimbLaw) -> np.ndarray:
    """Of a foothold, seen from where the tip is believed to be: its own, and those of zeros, lengths and play."""
    number = limb.model.number
    own = limb.offset_sd_mm**2 + number("uncertainty.length_mm") ** 2
    joints = [number("uncertainty.angle_rad") ** 2 + (number(f"joint.{joint}.gap_rad") * _PLACE_SD_OF_GAP) ** 2
              for joint in JOINTS]  # fmt: skip
    turns = law.turns_in_body()
    return np.asarray(own * np.eye(3) + (turns.T * joints) @ turns + 1e-12 * np.eye(3))


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
