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
_HALVINGS = 10


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
    pressing_n: np.ndarray  # out of the ground and along it: low, most probable, high
    along_n: np.ndarray
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
    """One world's answer under the payload."""

    before: State
    after: State
    statics: Statics

    @property
    def change_n(self) -> np.ndarray:
        return np.asarray(self.after.force_n - self.before.force_n)

    @property
    def moved_mm(self) -> np.ndarray:
        return np.asarray(self.after.displacement_mm - self.before.displacement_mm)


@dataclass(frozen=True)
class _Slip:
    """The first foot to move in one world, and the payload's factor then; -1 and infinity: none."""

    limb: int
    factor: float


class OverloadedError(NoStanceError):
    """The body stands under its weight, and not under the payload."""

    def __init__(self, error: NoStanceError, first_slip: FirstSlip) -> None:
        super().__init__(error.why, error.share, error.is_payload)
        self.first_slip = first_slip

    def as_json(self) -> dict[str, object]:
        """With the first foot that moves on the way."""
        return super().as_json() | {"first_slip": self.first_slip.as_json()}


def answer(stance: Stance, measured: Measured | None = None, draws: int = DRAWS) -> Answer:
    """The stance under its payload, forces before it measured or not. Raises NoStanceError where what is believed has
    no equilibrium, OverloadedError where it has one without the payload; draws that have none are counted in a flag."""
    middle = believed(stance, measured.sigma_n) if measured else believed(stance)
    standing = middle.stand(measured, measured.force_n if measured else None)
    slips = [_slip(middle, standing)]
    best, trouble = _outcome(middle, standing)
    others = [best] if best else []
    chance = np.random.default_rng(_SEED)
    lost = 0
    for _ in range(draws):
        world = drawn(stance, middle, chance)
        noisy = measured.with_noise(chance) if measured else None
        try:
            near_n = _near(world, standing.state.force_n) if noisy else standing.state.force_n
            here = world.stand(noisy, near_n)
        except NoStanceError:
            lost += 1
            continue
        slips.append(_slip(world, here))
        if best:
            outcome, _ = _outcome(world, here, best.after.force_n)
            others += [outcome] if outcome else []
            lost += outcome is None
    first_slip = _first_slip(stance, slips)
    if best is None:
        assert trouble is not None
        trouble.share = max(trouble.share, _borne_share(middle, standing))
        raise OverloadedError(trouble, first_slip)
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
        *_in_cones(stance, best, others),
        [best.statics.margin_n(i, force) for i, force in enumerate(best.after.force_n)],
        [_state(stance, i, best.after) for i in range(len(stance.limbs))],
        best.moved_mm,
        moved_low,
        moved_high,
        best.after.rotation_rad - best.before.rotation_rad,
        first_slip,
        _flags(stance, middle, standing, best, measured, lost, draws),
    )


def _in_cones(stance: Stance, best: _Outcome, others: list[_Outcome]) -> tuple[np.ndarray, np.ndarray]:
    """Each foot's force out of the ground and along it: low, most probable, high."""
    normal = np.array([limb.normal for limb in stance.limbs])

    def split(force_n: np.ndarray) -> np.ndarray:
        pressing = np.einsum("nc,nc->n", normal, force_n)
        return np.stack([pressing, np.linalg.norm(force_n - pressing[:, None] * normal, axis=1)])

    low, high = _span(split(other.after.force_n) for other in others)
    pressing, along = np.stack([low, split(best.after.force_n), high], -1)
    return pressing, along


def _near(world: World, near_n: np.ndarray) -> np.ndarray:
    """Where a draw's search for what was measured begins: at its own forces, for its footholds say which joints are
    within their play."""
    try:
        return world.stand(None, near_n).state.force_n
    except NoStanceError:
        return near_n


def _outcome(
    world: World, standing: Standing, near_n: np.ndarray | None = None
) -> tuple[_Outcome | None, NoStanceError | None]:
    """Or why there is none."""
    try:
        statics, after = world.load(standing, [world.payload], near_n)
    except NoStanceError as error:
        return None, error
    return _Outcome(standing.state, after, statics), None


def _borne_share(world: World, standing: Standing) -> float:
    """Of the payload, by halving; the feet's history begins anew with each."""
    force, at = world.payload
    borne, lost = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (borne + lost)
        try:
            world.load(standing, [(share * force, at)])
            borne = share
        except NoStanceError:
            lost = share
    return borne


def _slip(world: World, standing: Standing) -> _Slip:
    if not np.any(world.payload[0]):
        return _Slip(-1, np.inf)
    try:
        return _Slip(*world.first_slip(standing, FACTOR_MOST))
    except NoStanceError:
        return _Slip(-1, np.inf)


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


def _first_slip(stance: Stance, slips: list[_Slip]) -> FirstSlip:
    """slips: the believed world's first, then one for each draw."""
    best = slips[0]
    if best.limb < 0:
        return FirstSlip(None, None, None, None, None)
    low, high = np.percentile(np.minimum([slip.factor for slip in slips], FACTOR_MOST), _LOW_HIGH)
    surely = float(np.mean([slip.limb == best.limb for slip in slips]))
    return FirstSlip(stance.limbs[best.limb].name, best.factor, float(low), float(high), surely)


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
