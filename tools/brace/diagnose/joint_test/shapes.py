"""What compete with the effects of the catalogue, so that no effect is named for what only looks a little like it.

A diagnosis describes shapes and never exports them. `record` terms are instruments' doings and viscosity, which
limb.toml has no number for. `law` terms are how friction turns in detail."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from brace.diagnose.joint_test.terms import Role, Term
from brace.effects import JointTestSize
from brace.effects.catalogue import FADING_STARTS
from brace.identify.fit import Nuisances
from brace.identify.parameters import LAG, VISCOUS, Parameter
from brace.model.keys import KEY_BY_NAME

ASYMMETRY = "asymmetry_ratio"  # the spring on one side is this much stiffer
COG_SIN, COG_COS, COG_PERIOD = "cogging_sin_n_mm", "cogging_cos_n_mm", "cogging_period_rad"
TORQUE_DRIFT = "torque_drift_n_mm_per_s"  # of the reading's zero
STOP, STOP_AT = "stop_n_mm_per_rad", "stop_at_rad"  # beyond the angle, on the side of the stiffness' sign
SOFT, SOFT_OVER = "soft_middle_n_mm", "soft_over_rad"  # what the spring lacks beyond its middle; negative: has there
SLIP, SLIP_TURN, SLIP_FREE = "slip_n_mm", "slip_turn_rad", "slip_free_share"
LATER, LATER_TURN = "later_friction_n_mm", "later_turn_rad"  # friction that turns over another angle besides
# Without one of them a torque stays as it is played.
SHAPES = frozenset({ASYMMETRY, COG_PERIOD, TORQUE_DRIFT, STOP, SOFT, SLIP, LATER})
BENDS_THE_SPRING = frozenset({"asymmetric_spring", "cogging", "end_stop", "soft_middle"})

MOST_LAG_S = 0.3
MOST_SLIP = 0.25  # of the range of angles, to either side: a slider that hardly ever slips is a gap
Shares = Callable[[np.ndarray], np.ndarray]


def added(
    torque: np.ndarray, bent_rad: np.ndarray, stiffness: np.ndarray, angle_rad: np.ndarray, since_s: np.ndarray,
    shares: Shares, nuisances: Nuisances,
) -> np.ndarray:  # fmt: skip
    """Torques (models x readings) with the shapes in them. `bent_rad`: of the spring, models x readings. `shares`: how
    far friction that turns over an angle is turned, [-1, 1], for one angle a model."""
    one = {name: values[:, np.newaxis] for name, values in nuisances.items()}
    if ASYMMETRY in one:
        torque = torque + one[ASYMMETRY] * stiffness[:, np.newaxis] * np.maximum(bent_rad, 0.0)
    if STOP in one:
        side = np.sign(one[STOP])
        torque = torque + one[STOP] * np.maximum(side * bent_rad - one[STOP_AT], 0.0)
    if SOFT in one:
        torque = torque - one[SOFT] * np.tanh(bent_rad / one[SOFT_OVER])
    if COG_PERIOD in one:
        phase = 2.0 * np.pi * angle_rad / one[COG_PERIOD]
        torque = torque + one[COG_SIN] * np.sin(phase) + one[COG_COS] * np.cos(phase)
    if SLIP in one:
        share, free = shares(nuisances[SLIP_TURN]), one[SLIP_FREE]
        torque = torque + one[SLIP] * np.sign(share) * np.maximum(np.abs(share) - free, 0.0) / (1.0 - free)
    if LATER in one:
        torque = torque + one[LATER] * shares(nuisances[LATER_TURN])
    if TORQUE_DRIFT in one:
        torque = torque + one[TORQUE_DRIFT] * since_s
    return np.asarray(torque)


def record_terms(size: JointTestSize, speeds_differ: bool) -> list[Term]:
    """A torque that is read late, and what grows with speed. At one speed friction is all that can be found."""
    found: list[Term] = []
    if size.length_s <= 0.0 or size.speed_rad_per_s <= 0.0:
        return found
    most = min(MOST_LAG_S, 0.1 * size.length_s)
    found.append(_term("lag", "sensor", "record", [Parameter(LAG, 0.0, 0.1 * most, 0.0, most)], {LAG: 0.1 * most}))
    if speeds_differ:
        viscous = size.torque_n_mm / size.speed_rad_per_s
        own = Parameter(VISCOUS, 0.0, 0.01 * viscous, 0.0, viscous)
        found.append(_term("viscous_friction", "joint", "record", [own], {VISCOUS: 0.01 * viscous}))
    return found


def shapes(size: JointTestSize, period_rad: float, rubs: bool) -> list[Term]:
    """What no effect of the catalogue does: `period_rad` is the period that the residuals show most. `rubs`: friction
    is there, whose turn may be another."""
    torque, angle = size.torque_n_mm, size.angle_rad
    stiffness = torque / max(angle, 1e-30)
    found = [
        _term("asymmetric_spring", "joint", "shape", [Parameter(ASYMMETRY, 0.0, 0.1, -0.9, 5.0)],
              {ASYMMETRY: 0.2}, {ASYMMETRY: -0.2}),
        _term("cogging", "joint", "shape",
              [Parameter(COG_SIN, 0.0, 0.02 * torque, -torque, torque),
               Parameter(COG_COS, 0.0, 0.02 * torque, -torque, torque),
               Parameter(COG_PERIOD, period_rad, 0.02 * period_rad, 0.7 * period_rad, 1.4 * period_rad)],
              {COG_SIN: 0.01 * torque}),
        _term("end_stop", "joint", "shape",
              [Parameter(STOP, 0.0, 0.1 * stiffness, -10.0 * stiffness, 10.0 * stiffness),
               Parameter(STOP_AT, 0.25 * angle, 0.05 * angle, 0.05 * angle, 0.48 * angle)],
              {STOP: stiffness, STOP_AT: 0.3 * angle}, {STOP: -stiffness, STOP_AT: 0.3 * angle}),
        _term("soft_middle", "joint", "shape",
              [Parameter(SOFT, 0.0, 0.1 * torque, -torque, torque),
               Parameter(SOFT_OVER, 0.2 * angle, 0.05 * angle, 0.02 * angle, 0.7 * angle)],
              {SOFT: 0.1 * torque, SOFT_OVER: 0.15 * angle}, {SOFT: -0.1 * torque, SOFT_OVER: 0.3 * angle}),
        _term("series_slip", "joint", "shape",
              [Parameter(SLIP, 0.0, 0.05 * torque, 0.0, torque),
               Parameter(SLIP_TURN, 0.1 * angle, 0.03 * angle, 0.01 * angle, MOST_SLIP * angle),
               Parameter(SLIP_FREE, 0.8, 0.05, 0.3, 0.98)],
              {SLIP: 0.15 * torque, SLIP_TURN: 0.15 * angle}, {SLIP: 0.3 * torque, SLIP_TURN: 0.05 * angle}),
    ]  # fmt: skip
    if rubs:
        found.append(
            _term("later_friction", "joint", "law",
                  [Parameter(LATER, 0.0, 0.05 * torque, 0.0, torque),
                   Parameter(LATER_TURN, 0.05 * angle, 0.02 * angle, 1e-3 * angle, 0.5 * angle)],
                  {LATER: 0.03 * torque, LATER_TURN: 0.05 * angle}, {LATER: 0.03 * torque, LATER_TURN: 0.2 * angle})
        )  # fmt: skip
    if size.length_s > 0.0 and size.speed_rad_per_s > 0.0:
        drift = torque / size.length_s
        own = Parameter(TORQUE_DRIFT, 0.0, 0.01 * drift, -drift, drift)
        found.append(_term("torque_drift", "sensor", "shape", [own], {}))
    return found


def fading(joint: str, size: JointTestSize) -> Term:
    """A law that limb.toml has numbers for: the share of the load that friction grows by fades as the load grows."""
    fade, share = f"joint.{joint}.coulomb_load_fade_per_n_mm", f"joint.{joint}.coulomb_per_load_ratio"
    one = 1.0 / size.torque_n_mm
    starts = ({fade: fades * one, share: ratio} for fades, ratio in FADING_STARTS)
    return _term("fading_friction", "joint", "law", [Parameter(fade, 0.0, one, 0.0, KEY_BY_NAME[fade].high)], *starts)


def _term(name: str, where: str, role: Role, parameters: list[Parameter], *starts: dict[str, float]) -> Term:
    return Term(name, where, tuple(parameters), starts, None, role)
