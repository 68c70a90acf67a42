"""What may be missing in a joint: effects of the catalogue, and shapes that no effect has.

The shapes compete with the effects so that no effect is named for what only looks a little like it. They are
described, never exported.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from brace.identify.parameters import FRICTION_TURN, Parameter
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

ASYMMETRY = "asymmetry_ratio"  # the torque on one side is this much larger
COG_SIN, COG_COS, COG_PERIOD = "cogging_sin_n_mm", "cogging_cos_n_mm", "cogging_period_rad"
VISCOUS = "viscous_n_mm_s_per_rad"
TORQUE_DRIFT = "torque_drift_n_mm_per_s"  # of the reading's zero


@dataclass(frozen=True)
class Extent:
    """How large a record is: ranges of angle [rad] and torque [N mm], length [s], range of temperature
    [degC]."""

    angle_rad: float
    torque_n_mm: float
    length_s: float
    temp_degc: float
    speed_rad_per_s: float


@dataclass(frozen=True)
class Term:
    """One thing that may be missing: parameters that it frees, and values to start them from."""

    name: str
    where: str
    parameters: tuple[Parameter, ...]
    starts: tuple[Mapping[str, float], ...]
    catalogued: bool = True

    @property
    def label(self) -> str:
        return f"{self.name}@{self.where}"


def catalogue(model: LimbModel, joint: str, extent: Extent, *, given: bool, rests: bool) -> list[Term]:
    """Effects that a joint test can show; `given` says that the model was measured, so that its spring can be
    wrong; `rests` that the record dwells or changes its speed: at one steady speed creep makes a loop as
    friction does."""
    at = f"joint.{joint}."
    angle, torque = extent.angle_rad, extent.torque_n_mm
    stiffness = torque / angle

    def free(key: str, scale: float, low: float = -np.inf, high: float = np.inf) -> Parameter:
        entry = KEY_BY_NAME[key]
        return Parameter(key, model.number(key), scale, max(entry.low, low), min(entry.high, high))

    gap = at + "gap_rad"
    terms = [
        Term(
            "backlash",
            f"joint.{joint}",
            (free(gap, 0.1 * angle, high=0.5 * angle),),
            tuple({gap: share * angle} for share in (0.1, 0.3)),
        ),
        Term(
            "coulomb_friction",
            f"joint.{joint}",
            (
                free(at + "coulomb_n_mm", 0.05 * torque),
                free(at + "coulomb_per_load_ratio", 0.1),
                Parameter(FRICTION_TURN, 0.01 * angle, 0.01 * angle, 1e-4 * angle, min(1.0, 0.25 * angle)),
            ),
            (
                {at + "coulomb_n_mm": 0.05 * torque, at + "coulomb_per_load_ratio": 0.05},
                {at + "coulomb_n_mm": 0.05 * torque, FRICTION_TURN: 0.1 * angle},
            ),
        ),
        Term(
            "joint_hardening",
            f"joint.{joint}",
            (free(at + "hardening_n_mm_per_rad3", stiffness / angle**2),),
            tuple({at + "hardening_n_mm_per_rad3": share * stiffness / angle**2} for share in (1.0, 10.0)),
        ),
    ]
    if given:
        compliance = at + "compliance_rad_per_n_mm"
        terms.append(
            Term(
                "joint_compliance",
                f"joint.{joint}",
                (free(compliance, 0.2 / stiffness, low=1e-3 / stiffness),),
                ({compliance: 1.0 / stiffness},),
            )
        )
    if rests:
        terms.append(
            Term(
                "creep",
                "creep",
                (
                    free("creep.ratio", 0.1, high=1.0),
                    free(
                        "creep.time_constant_s",
                        0.1 * extent.length_s,
                        0.01 * extent.length_s,
                        0.5 * extent.length_s,
                    ),
                ),
                tuple(
                    {"creep.ratio": 0.1, "creep.time_constant_s": share * extent.length_s}
                    for share in (0.05, 0.3)
                ),
            )
        )
    if extent.temp_degc >= 2.0:
        key = "thermal.joint_compliance_per_degc"
        most = 0.5 / extent.temp_degc
        terms.append(Term("thermal_softening", "thermal", (free(key, 0.005, -most, most),), ({key: 0.005},)))
    return terms


def shapes(extent: Extent, period_rad: float) -> list[Term]:
    """What no effect of the catalogue does: `period_rad` is the period that the residuals show most."""
    torque = extent.torque_n_mm
    found = [
        Term(
            "asymmetric_spring",
            "joint",
            (Parameter(ASYMMETRY, 0.0, 0.1, -0.9, 5.0),),
            ({ASYMMETRY: 0.2}, {ASYMMETRY: -0.2}),
            False,
        ),
        Term(
            "cogging",
            "joint",
            (
                Parameter(COG_SIN, 0.0, 0.02 * torque, -torque, torque),
                Parameter(COG_COS, 0.0, 0.02 * torque, -torque, torque),
                Parameter(COG_PERIOD, period_rad, 0.02 * period_rad, 0.7 * period_rad, 1.4 * period_rad),
            ),
            ({COG_SIN: 0.01 * torque},),
            False,
        ),
    ]
    if extent.length_s > 0.0 and extent.speed_rad_per_s > 0.0:
        drift = torque / extent.length_s
        found.append(
            Term(
                "torque_drift",
                "sensor",
                (Parameter(TORQUE_DRIFT, 0.0, 0.01 * drift, -drift, drift),),
                ({},),
                False,
            )
        )
        viscous = torque / extent.speed_rad_per_s
        found.append(
            Term(
                "viscous_friction",
                "joint",
                (Parameter(VISCOUS, 0.0, 0.01 * viscous, 0.0, viscous),),
                ({VISCOUS: 0.01 * viscous},),
                False,
            )
        )
    return found
