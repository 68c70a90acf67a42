"""Which numbers a fit may turn: keys of limb.toml with scale, bounds and prior, and the model they make."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.errors import UsageError, did_you_mean
from brace.model import LimbModel
from brace.model.keys import CONTROLLER_KEYS, KEY_BY_NAME

TIP_HEIGHT = "tip_height_mm"  # of a stiffness table that gives r alone; not a key of limb.toml
TORQUE_OFFSET = "torque_offset_n_mm"  # of a joint test's torque reading; not a key of limb.toml
FRICTION_TURN = "friction_turn_rad"  # over which a joint's friction changes sign; not a key of limb.toml
ANGLE_ZERO = "angle_zero_rad"  # of a joint test's encoder: deflection = angle + it; not a key of limb.toml
_NUISANCE_UNIT = {
    TIP_HEIGHT: "mm",
    TORQUE_OFFSET: "N mm",
    FRICTION_TURN: "rad",
    ANGLE_ZERO: "rad",
}
NUISANCES = tuple(_NUISANCE_UNIT)

LINK_COMPLIANCES = tuple(
    f"link.{link}.{which}_mm_per_n" for link in ("femur", "tibia") for which in ("axial", "bending")
)
JOINT_COMPLIANCES = tuple(f"joint.{joint}.compliance_rad_per_n_mm" for joint in ("femur", "tibia"))
COMPLIANCES = LINK_COMPLIANCES + JOINT_COMPLIANCES
BASE_COMPLIANCES = ("base.x_mm_per_n", "base.z_mm_per_n", "base.rotation_rad_per_n_mm")

# What a change of one is worth looking at, for keys whose value may be zero; by the end of the key.
_NATURAL_SCALE = {
    "axial_mm_per_n": 0.01,
    "bending_mm_per_n": 0.1,
    "lateral_mm_per_n": 0.1,
    "base.x_mm_per_n": 0.05,
    "base.z_mm_per_n": 0.05,
    "rad_per_n_mm": 1e-5,
    "tilt_rad": 0.1,
    "moment_transfer": 1.0,
    "femur_mm": 1.0,
    "tibia_mm": 1.0,
    "coxa_mm": 1.0,
    "zero_offset_rad": 0.01,
    "gap_rad": 0.002,
    "coulomb_n_mm": 100.0,
    "coulomb_per_load_ratio": 0.1,
    "hardening_n_mm_per_rad3": 1e7,
    "gain": 0.01,
    "rotation_rad": 0.02,
    "crosstalk_xz": 0.02,
    "crosstalk_zx": 0.02,
    "bias_x_n": 0.1,
    "bias_z_n": 0.1,
    "drift_x_n_per_s": 1e-4,
    "drift_z_n_per_s": 1e-4,
    "play_mm": 0.05,
    "_n": 1.0,
    "ratio": 0.05,
    "time_constant_s": 30.0,
    "joint_compliance_per_degc": 0.01,
    "bending_factor": 0.1,
    "at_s": 100.0,
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
        return KEY_BY_NAME[self.key].unit if self.key in KEY_BY_NAME else _NUISANCE_UNIT.get(self.key, "")


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


def natural_scale(key: str) -> float:
    """A size of change that matters, for a key whose value may be zero."""
    for ending in sorted(_NATURAL_SCALE, key=len, reverse=True):
        if key.endswith(ending):
            return _NATURAL_SCALE[ending]
    return 1.0


def free_parameter(model: LimbModel, key: str) -> Parameter:
    """A key without prior."""
    entry, start = KEY_BY_NAME[key], model.number(key)
    return Parameter(key, start, natural_scale(key), entry.low, entry.high)


def prior_parameter(model: LimbModel, key: str) -> Parameter | None:
    """A key under the trust that [uncertainty] puts in it, or None when it is trusted exactly or is absent."""
    start = model.number(key)
    if key.startswith("geometry."):
        sigma = model.number("uncertainty.length_mm")
    elif key.endswith("zero_offset_rad"):
        sigma = model.number("uncertainty.angle_rad")
    elif key == "sensor.gain":
        sigma = model.number("uncertainty.gain_rel") * start
    else:
        sigma = model.number("uncertainty.compliance_rel") * start
    if sigma <= 0.0:
        return None
    entry = KEY_BY_NAME[key]
    return Parameter(key, start, sigma, entry.low, entry.high, sigma)


PRIOR_KEYS = (
    "geometry.femur_mm",
    "geometry.tibia_mm",
    "joint.femur.zero_offset_rad",
    "joint.tibia.zero_offset_rad",
    *COMPLIANCES,
    *BASE_COMPLIANCES,
    "sensor.gain",
)


def with_priors(model: LimbModel, extra: Sequence[str] = ()) -> ParameterSet:
    """Everything that [uncertainty] speaks of, within its trust; `extra` keys free."""
    chosen = [
        parameter
        for key in PRIOR_KEYS
        if key not in extra and (parameter := prior_parameter(model, key)) is not None
    ]
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
                why="it is not a number of limb.toml that a measurement of the limb could tell",
                next_step=f"did you mean {near}?" if near else "e.g. --fit base.rotation_rad_per_n_mm",
            )
        if key not in result:
            result.append(key)
    return result
