"""What `brace stance load` says: forces with intervals, how the body moves, the first foot that moves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from brace.stance.stance_file import Stance
from brace.stance.statics import LET_GO, OPEN, SLIDES, State, Statics
from brace.stance.world import Measured, NoStanceError, Standing, World, believed, drawn

DRAWS = 100
FACTOR_MOST = 1000.0
_LOW_HIGH = (5.0, 95.0)
_SEED = 20  # the same question has the same answer
_UNBALANCED_SIGMAS = 4.0


@dataclass(frozen=True)
class FirstSlip:
    """The first foot that slides or lets go when the payload grows; factors multiply it. None: no payload, or nothing
    moves up to FACTOR_MOST of it."""

    limb: str | None
    payload_factor: float | None
    low: float | None
    high: float | None
    surely: float | None  # share of the draws in which this foot is the first

    def as_json(self) -> dict[str, object]:
        """As contracts have it."""
        return {
            "limb": self.limb,
            "payload_factor": self.payload_factor,
            "low": self.low,
            "high": self.high,
            "probability": self.surely,
        }


@dataclass(frozen=True)
class Answer:
    """Of a stance under its payload. Arrays have a row a limb; low and high hold the truth with 90 %."""

    stance: Stance
    force_n: np.ndarray
    force_low_n: np.ndarray
    force_high_n: np.ndarray
    change_n: np.ndarray
    change_low_n: np.ndarray
    change_high_n: np.ndarray
    margin_n: list[float]
    state: list[str]
    displacement_mm: np.ndarray
    displacement_low_mm: np.ndarray
    displacement_high_mm: np.ndarray
    rotation_rad: np.ndarray
    first_slip: FirstSlip
    flags: list[str]

    def as_json(self) -> dict[str, object]:
        """As contracts have it."""
        names = [limb.name for limb in self.stance.limbs]
        return {
            "limbs": [
                {
                    "name": name,
                    "force_n": self.force_n[i],
                    "force_low_n": self.force_low_n[i],
                    "force_high_n": self.force_high_n[i],
                    "margin_n": self.margin_n[i],
                    "state": self.state[i],
                }
                for i, name in enumerate(names)
            ],
            "body": {
                "displacement_mm": self.displacement_mm,
                "displacement_low_mm": self.displacement_low_mm,
                "displacement_high_mm": self.displacement_high_mm,
                "rotation_rad": self.rotation_rad,
            },
            "change": {
                "limbs": [
                    {
                        "name": name,
                        "force_n": self.change_n[i],
                        "force_low_n": self.change_low_n[i],
                        "force_high_n": self.change_high_n[i],
                    }
                    for i, name in enumerate(names)
                ]
            },
            "first_slip": self.first_slip.as_json(),
            "flags": self.flags,
        }


@dataclass(frozen=True)
class _Outcome:
    """One world's answer."""

    before: State
    after: State
    statics: Statics
    slip_limb: int
    slip_factor: float

    @property
    def change_n(self) -> np.ndarray:
        return np.asarray(self.after.force_n - self.before.force_n)

    @property
    def moved_mm(self) -> np.ndarray:
        return np.asarray(self.after.displacement_mm - self.before.displacement_mm)


def answer(stance: Stance, measured: Measured | None = None, draws: int = DRAWS) -> Answer:
    """The stance under its payload, forces before it measured or not. Raises NoStanceError where what is believed has
    no equilibrium; draws that have none are counted in a flag."""
    middle = believed(stance)
    standing = middle.stand(measured)
    best = _outcome(middle, standing)
    chance = np.random.default_rng(_SEED)
    others = [best]
    lost = 0
    for _ in range(draws):
        try:
            world = drawn(stance, middle, chance)
            noisy = measured.with_noise(chance) if measured else None
            others.append(_outcome(world, world.stand(noisy, best.before.force_n), best.after.force_n))
        except NoStanceError:
            lost += 1
    force_low, force_high = _span(other.after.force_n for other in others)
    change_low, change_high = _span(other.change_n for other in others)
    moved_low, moved_high = _span(other.moved_mm for other in others)
    return Answer(
        stance,
        best.after.force_n,
        force_low,
        force_high,
        best.change_n,
        change_low,
        change_high,
        [best.statics.margin_n(i, force) for i, force in enumerate(best.after.force_n)],
        [_state(stance, i, best.after) for i in range(len(stance.limbs))],
        best.moved_mm,
        moved_low,
        moved_high,
        best.after.rotation_rad - best.before.rotation_rad,
        _first_slip(stance, best, others),
        _flags(stance, middle, standing, best, measured, lost, draws),
    )


def _outcome(world: World, standing: Standing, near_n: np.ndarray | None = None) -> _Outcome:
    force_n, _ = world.payload
    slip_limb, slip_factor = -1, np.inf
    if np.any(force_n):
        slip_limb, slip_factor = _slip(world, standing)
    statics, after = world.load(standing, [world.payload], near_n)
    return _Outcome(standing.state, after, statics, slip_limb, slip_factor)


def _slip(world: World, standing: Standing) -> tuple[int, float]:
    """The first foot to move and the payload's factor then, the springs those at the load that moves it."""
    statics, limb, factor = standing.statics, -1, np.inf
    for _ in range(2):
        found = statics.first_slip(standing.state, [world.payload], FACTOR_MOST)
        limb, factor = found.limb, found.factor
        if limb < 0 or factor <= 0.0:
            break
        force, at = world.payload
        try:
            statics, _ = world.load(standing, [(0.999 * factor * force, at)])
        except NoStanceError:
            break
    return limb, factor


def _span(values: Iterable[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    low, high = np.percentile(np.array(list(values)), _LOW_HIGH, axis=0)
    return low, high


def _state(stance: Stance, index: int, state: State) -> str:
    contact = state.contact[index]
    if contact in (OPEN, LET_GO):
        return "open"
    if contact == SLIDES:
        return "slides"
    return "grips" if float(stance.limbs[index].normal @ state.force_n[index]) < 0.0 else "sticks"


def _first_slip(stance: Stance, best: _Outcome, others: list[_Outcome]) -> FirstSlip:
    if best.slip_limb < 0:
        return FirstSlip(None, None, None, None, None)
    factors = np.minimum([other.slip_factor for other in others], FACTOR_MOST)
    low, high = np.percentile(factors, _LOW_HIGH)
    surely = float(np.mean([other.slip_limb == best.slip_limb for other in others]))
    return FirstSlip(stance.limbs[best.slip_limb].name, best.slip_factor, float(low), float(high), surely)


def _flags(
    stance: Stance,
    middle: World,
    standing: Standing,
    best: _Outcome,
    measured: Measured | None,
    lost: int,
    draws: int,
) -> list[str]:
    flags = []
    for index, limb in enumerate(stance.limbs):
        opened = middle.laws[index].spring(best.after.force_n[index]).is_open
        flags += [f"gap_open: {limb.name}, {joint}" for joint in opened]
        if not any(key.startswith("uncertainty.") for key in limb.model.given):
            flags.append(f"no_uncertainty: {limb.name}'s model says nothing of how well it is known")
    slid = [limb.name for limb, contact in zip(stance.limbs, standing.state.contact, strict=True) if contact == SLIDES]
    flags += [f"slid_before_payload: {name}" for name in slid]
    if measured is not None:
        flags += _balance(middle, measured)
    if lost:
        flags.append(f"no_rest_in: {lost} of {draws} draws of what is not known")
    return flags


def _balance(middle: World, measured: Measured) -> list[str]:
    """Do the measured forces carry the weight?"""
    weight = sum((force for force, _ in middle.weight), np.zeros(3))
    left = measured.force_n.sum(axis=0) + weight
    sd = np.sqrt(np.diag(sum(measured.covariance_n2, np.zeros((3, 3)))))
    if np.all(np.abs(left) <= _UNBALANCED_SIGMAS * sd + 1e-9):
        return []
    x, y, z = left
    return [f"measured_unbalanced: forces and weight leave {x:.2f} {y:.2f} {z:.2f} N"]
