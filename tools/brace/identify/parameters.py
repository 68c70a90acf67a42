"""Which numbers a fit may turn: keys of limb.toml with scale, bounds and prior, and the model they make."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from brace.effects.catalogue import FRICTION_TURN, NUMBER_BY_KEY
from brace.ground.errors import UsageError, did_you_mean
from brace.model import LimbModel
from brace.model.keys import CONTROLLER_KEYS, KEY_BY_NAME
from brace.native.plant_batch import model_numbers, number_index

TIP_HEIGHT = "tip_height_mm"  # of a stiffness table that gives r alone; not a key of limb.toml
TORQUE_OFFSET = "torque_offset_n_mm"  # of a joint test's torque reading; not a key of limb.toml
ANGLE_ZERO = "angle_zero_rad"  # of a joint test's encoder: deflection = angle + it; not a key of limb.toml
LAG = "lag_s"  # by which a joint test's torque is read late; not a key of limb.toml
VISCOUS = "viscous_n_mm_s_per_rad"  # a joint test's torque that grows with speed; not a key of limb.toml
_NUISANCE_UNIT = {
    LAG: "s",
    VISCOUS: "N mm s/rad",
    TIP_HEIGHT: "mm",
    TORQUE_OFFSET: "N mm",
    FRICTION_TURN: "rad",
    ANGLE_ZERO: "rad",
}
NUISANCES = tuple(_NUISANCE_UNIT)
SPREAD = ("compliance_rad_per_n_mm", "gap_rad", "coulomb_n_mm")  # what differs between a joint's gear positions


def spread(leaf: str, position: int) -> str:
    """By how much a number of the joint is another one at a gear position than at the first: log of the ratio."""
    return f"spread_{leaf}.{position}"


def angle_zero(position: int) -> str:
    """The encoder's zero at one gear position of a joint test, counted from 0."""
    return f"{ANGLE_ZERO}.{position}" if position else ANGLE_ZERO


LINK_COMPLIANCES = tuple(
    f"link.{link}.{which}_mm_per_n" for link in ("femur", "tibia") for which in ("axial", "bending")
)
JOINT_COMPLIANCES = tuple(f"joint.{joint}.compliance_rad_per_n_mm" for joint in ("femur", "tibia"))
COMPLIANCES = LINK_COMPLIANCES + JOINT_COMPLIANCES
BASE_COMPLIANCES = ("base.x_mm_per_n", "base.z_mm_per_n", "base.rotation_rad_per_n_mm")

# Sizes of change that matter, for numbers that no effect of the catalogue turns; by the end of the key.
_OTHER_SCALE = {
    "lateral_mm_per_n": 0.1,
    "torsion_rad_per_n_mm": 1e-5,
    TIP_HEIGHT: 10.0,
    TORQUE_OFFSET: 100.0,
}


@dataclass(frozen=True)
class Parameter:
    """One number of a fit. `prior_sigma` is inf when the data alone decide."""

    key: str
    start: float
    scale: float
    low: float
    high: float
    prior_sigma: float = math.inf

    @property
    def unit(self) -> str:
        """The unit as printed."""
        if self.key in KEY_BY_NAME:
            return KEY_BY_NAME[self.key].unit
        return _NUISANCE_UNIT.get(self.key.partition(".")[0], "")


@dataclass(frozen=True)
class ParameterSet:
    """Parameters over a start model. A vector x is in the parameters' own units."""

    base: LimbModel
    parameters: tuple[Parameter, ...]

    def __len__(self) -> int:
        return len(self.parameters)

    @property
    def keys(self) -> list[str]:
        return [parameter.key for parameter in self.parameters]

    def array(self, field: str) -> np.ndarray:
        """One field of all parameters."""
        return np.array([getattr(parameter, field) for parameter in self.parameters], dtype=float)

    def model(self, x: Sequence[float] | np.ndarray) -> LimbModel:
        """The limb that x describes."""
        return self.base.with_values(
            {key: float(value) for key, value in zip(self.keys, x) if key in KEY_BY_NAME}
        )

    def nuisances(self, x: Sequence[float] | np.ndarray) -> dict[str, float]:
        """The parts of x that are not keys of limb.toml."""
        return {key: float(value) for key, value in zip(self.keys, x) if key not in KEY_BY_NAME}

    def models(self, points: np.ndarray) -> np.ndarray:
        """The limbs that many x (points x parameters) describe, as brace.native.plant_batch has them."""
        numbers, columns, places = self._layout
        models = numbers[np.newaxis].repeat(len(points), axis=0)
        models[:, places] = points[:, columns]
        return models

    def nuisance_columns(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """The same as `nuisances` for many x: one entry per point."""
        return {key: points[:, column] for column, key in enumerate(self.keys) if key not in KEY_BY_NAME}

    @cached_property
    def _layout(self) -> tuple[np.ndarray, list[int], list[int]]:
        """The base's numbers, and which columns of x go where in them."""
        index = number_index()
        columns = [column for column, key in enumerate(self.keys) if key in index]
        return model_numbers(self.base), columns, [index[self.keys[column]] for column in columns]


def natural_scale(key: str) -> float:
    """A size of change that matters, for a key whose value may be zero."""
    number = NUMBER_BY_KEY.get(key.replace("coxa", "femur"))  # the coxa's numbers are sized like the femur's
    if number is not None:
        return number.scale
    return next((scale for ending, scale in _OTHER_SCALE.items() if key.endswith(ending)), 1.0)


def free_parameter(model: LimbModel, key: str) -> Parameter:
    """A key without prior."""
    entry, start = KEY_BY_NAME[key], model.number(key)
    return Parameter(key, start, natural_scale(key), entry.low, entry.high)


# What a calibration is trusted to, the numbers it measures first before those that it fits.
_TRUST = ("length_mm", "angle_rad", "compliance_rel", "gain_rel")


def _trusted_keys() -> tuple[str, ...]:
    """Keys of which [uncertainty] says how well the calibration knows them: by what it says, then as limb.toml has
    them."""
    trusts = [f"uncertainty.{leaf}" for leaf in _TRUST]
    listed = list(KEY_BY_NAME)
    keys = [key for key, number in NUMBER_BY_KEY.items() if number.trust]
    return tuple(sorted(keys, key=lambda key: (trusts.index(NUMBER_BY_KEY[key].trust), listed.index(key))))


PRIOR_KEYS = _trusted_keys()


def prior_parameter(model: LimbModel, key: str) -> Parameter | None:
    """A key under the trust that [uncertainty] puts in it, or None when it is trusted exactly or is absent."""
    start, trust = model.number(key), NUMBER_BY_KEY[key].trust
    sigma = model.number(trust) * (start if trust.endswith("_rel") else 1.0)
    if sigma <= 0.0:
        return None
    entry = KEY_BY_NAME[key]
    return Parameter(key, start, sigma, entry.low, entry.high, sigma)


# Which share of the tibia's bending is a beam's. Without load it changes nothing, so no calibration at small loads
# determines it: where limb.toml is silent it is anything from 0 to 1.
TIBIA_BEAM = "link.tibia.moment_transfer"


def tibia_beam(model: LimbModel) -> Parameter | None:
    """What a record of a limb that turns may show of the tibia, unless limb.toml says it."""
    return None if TIBIA_BEAM in model.given else Parameter(TIBIA_BEAM, 0.5, 1.0, 0.0, 1.0, prior_sigma=0.5)


def with_priors(model: LimbModel, extra: Sequence[str] = (), *, turns: bool = False) -> ParameterSet:
    """Everything that [uncertainty] speaks of, within its trust; `extra` keys free. `turns`: the record's limb turned
    as it was displaced."""
    chosen = [
        parameter
        for key in PRIOR_KEYS
        if key not in extra and (parameter := prior_parameter(model, key)) is not None
    ]
    if turns and TIBIA_BEAM not in extra and (beam := tibia_beam(model)) is not None:
        chosen.append(beam)
    return ParameterSet(model, (*chosen, *(free_parameter(model, key) for key in extra)))


def free(model: LimbModel, keys: Sequence[str]) -> ParameterSet:
    """The given keys, the data alone deciding."""
    return ParameterSet(model, tuple(free_parameter(model, key) for key in keys))


def free_compliances(model: LimbModel, extra: Sequence[str] = ()) -> ParameterSet:
    """Every compliance of links and joints free, and `extra`; lengths, zeros and gain within their trust."""
    keys = list(dict.fromkeys((*COMPLIANCES, *extra)))
    trusted = [
        parameter
        for key in PRIOR_KEYS
        if key not in keys
        and key not in BASE_COMPLIANCES
        and (parameter := prior_parameter(model, key)) is not None
    ]
    return ParameterSet(model, (*(free_parameter(model, key) for key in keys), *trusted))


def _fittable_keys() -> list[str]:
    return [
        name
        for name, item in KEY_BY_NAME.items()
        if item.kind in ("number", "ratio") and name not in CONTROLLER_KEYS
    ]


def checked_keys(keys: Sequence[str]) -> list[str]:
    """Keys from the command line; refuses what a fit cannot turn."""
    result: list[str] = []
    for key in keys:
        entry = KEY_BY_NAME.get(key)
        if entry is None or entry.kind not in ("number", "ratio") or key in CONTROLLER_KEYS:
            near = did_you_mean(key, _fittable_keys())
            raise UsageError(
                f"--fit {key}: no such parameter",
                why="it is not a number of limb.toml that a measurement of the limb could determine",
                next_step=f"did you mean {near}?" if near else "e.g. --fit base.rotation_rad_per_n_mm",
            )
        if key not in result:
            result.append(key)
    return result
