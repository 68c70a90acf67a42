"""What `brace stance load` says: forces with intervals, how the body moves, the first foot that moves."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import mode

import numpy as np

from brace.stance.draws import DRAWS, before_payload, span
from brace.stance.stance_file import Stance
from brace.stance.statics import LET_GO, OPEN, SLIDES, State
from brace.stance.world import AtSlip, Measured, NoStanceError, Standing, World

FACTOR_MOST = 1000.0
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
    before_n: np.ndarray  # the payload
    before_low_n: np.ndarray
    before_high_n: np.ndarray
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
            "before": {
                "limbs": [
                    {
                        "name": name,
                        "force_n": self.before_n[i],
                        "force_low_n": self.before_low_n[i],
                        "force_high_n": self.before_high_n[i],
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

    @property
    def change_n(self) -> np.ndarray:
        return np.asarray(self.after.force_n - self.before.force_n)

    @property
    def moved_mm(self) -> np.ndarray:
        return np.asarray(self.after.displacement_mm - self.before.displacement_mm)

    @property
    def turned_rad(self) -> np.ndarray:
        return np.asarray(self.after.rotation_rad - self.before.rotation_rad)


class OverloadedError(NoStanceError):
    """The body stands under its weight, and not under the payload."""

    def __init__(self, error: NoStanceError, first_slip: FirstSlip) -> None:
        super().__init__(error.why, error.share, error.is_payload)
        self.first_slip = first_slip

    def as_json(self) -> dict[str, object]:
        """With the first foot that moves on the way."""
        return super().as_json() | {"first_slip": self.first_slip.as_json()}


def answer(stance: Stance, measured: Measured | None = None, draws: int = DRAWS) -> Answer:
    """The stance under its payload: what is believed; but where forces were measured and joints have play, or a foot
    may have let go, the median of the draws, for then no one world is likely. Intervals are the draws'. Raises
    NoStanceError where what is believed has no equilibrium, OverloadedError where that, or most of the draws, has one
    without the payload only; draws that have none are counted in a flag."""
    standings, is_median = before_payload(stance, measured, draws)
    standing = standings[0]
    slips: list[AtSlip] = []
    others: list[_Outcome] = []
    overloaded: list[tuple[Standing, NoStanceError]] = []
    for here in standings:
        slips.append(here.world.first_slip(here, FACTOR_MOST))
        try:
            others.append(_outcome(here, slips[-1]))
        except NoStanceError as trouble:
            overloaded.append((here, trouble))
    first_slip = _first_slip(stance, slips, is_median)
    falls = 2 * len(overloaded) > len(standings) if is_median else overloaded and overloaded[0][0] is standing
    if falls:
        here, error = overloaded[0]
        error.share = max(error.share, _borne_share(here))
        raise OverloadedError(error, first_slip)
    those = others if is_median else others[:1]
    force_n = np.median([one.after.force_n for one in those], axis=0)
    force_low, force_high = span(other.after.force_n for other in others)
    before_low, before_high = span(one.state.force_n for one in standings)
    change_low, change_high = span(other.change_n for other in others)
    moved_low, moved_high = span(other.moved_mm for other in others)
    return Answer(
        stance,
        force_n,
        force_low,
        force_high,
        np.median([one.state.force_n for one in (standings if is_median else standings[:1])], axis=0),
        before_low,
        before_high,
        np.median([one.change_n for one in those], axis=0),
        change_low,
        change_high,
        *_in_cones(stance, force_n, others),
        [standing.statics.margin_n(i, force) for i, force in enumerate(force_n)],
        [mode(_state(stance, i, one.after) for one in those) for i in range(len(stance.limbs))],
        np.median([one.moved_mm for one in those], axis=0),
        moved_low,
        moved_high,
        np.median([one.turned_rad for one in those], axis=0),
        first_slip,
        _flags(stance, standings, force_n, measured, draws + 1 - len(others), draws),
    )


def _in_cones(stance: Stance, force_n: np.ndarray, others: list[_Outcome]) -> tuple[np.ndarray, np.ndarray]:
    """Each foot's force out of the ground and along it: low, most probable, high."""
    normal = np.array([limb.normal for limb in stance.limbs])

    def split(force_n: np.ndarray) -> np.ndarray:
        pressing = np.einsum("nc,nc->n", normal, force_n)
        return np.stack([pressing, np.linalg.norm(force_n - pressing[:, None] * normal, axis=1)])

    low, high = span(split(other.after.force_n) for other in others)
    pressing, along = np.stack([low, split(force_n), high], -1)
    return pressing, along


def _outcome(standing: Standing, slip: AtSlip) -> _Outcome:
    """Raises NoStanceError."""
    world = standing.world
    _, after = world.load(standing, [world.payload], slip.under_payload_n)
    return _Outcome(standing.state, after)


def _borne_share(standing: Standing) -> float:
    """Of the payload, by halving; the feet's history begins anew with each."""
    force, at = standing.world.payload
    borne, lost = 0.0, 1.0
    for _ in range(_HALVINGS):
        share = 0.5 * (borne + lost)
        try:
            standing.world.load(standing, [(share * force, at)])
            borne = share
        except NoStanceError:
            lost = share
    return borne


def _state(stance: Stance, index: int, state: State) -> str:
    contact = state.contact[index]
    if contact in (OPEN, LET_GO):
        return "open"
    if contact == SLIDES:
        return "slides"
    return "grips" if float(stance.limbs[index].normal @ state.force_n[index]) < 0.0 else "sticks"


def _first_slip(stance: Stance, slips: list[AtSlip], is_median: bool) -> FirstSlip:
    """slips: the believed world's first, then one for each draw."""
    limb = mode(slip.limb for slip in slips) if is_median else slips[0].limb
    if limb < 0:
        return FirstSlip(None, None, None, None, None)
    factors = np.minimum([slip.factor for slip in slips], FACTOR_MOST)
    low, high = span(factors)
    factor = np.median(factors) if is_median else factors[0]
    surely = float(np.mean([slip.limb == limb for slip in slips]))
    return FirstSlip(stance.limbs[limb].name, float(factor), float(low), float(high), surely)


def _flags(
    stance: Stance,
    standings: list[Standing],
    force_n: np.ndarray,
    measured: Measured | None,
    lost: int,
    draws: int,
) -> list[str]:
    """standings: the believed world's first."""
    flags = []
    middle, state = standings[0].world, standings[0].state
    for index, limb in enumerate(stance.limbs):
        opened = middle.laws[index].spring(force_n[index]).is_open
        flags += [f"gap_open: {limb.name}, {joint}" for joint in opened]
        if not any(key.startswith("uncertainty.") for key in limb.model.given):
            flags.append(f"no_uncertainty: {limb.name}'s model says nothing of how well it is known")
        gone = 100.0 * float(np.mean([one.state.contact[index] == LET_GO for one in standings]))
        if gone > 50.0:
            flags.append(f"let_go: {limb.name} bears nothing: its grip is off before the payload, in {gone:.0f} %")
    slid = [limb.name for limb, contact in zip(stance.limbs, state.contact, strict=True) if contact == SLIDES]
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
