"""Servos by name: how they hold a joint, their gear's play, their friction. data/servos.toml has the sources.

How far a stiffness may be off, as one sigma of the compliance relative to it:
- FIT_REL, of a servo that others measured: fits of one servo are apart by 5 %, a warm winding has 10 % more resistance,
  and a supply is within 10 % of what it is called.
- MANUAL_REL, of one that is known by its manual alone. The stall torque has already lost what rubs: of the two servos
  with both, the fit's compliance is 25 and 36 % below the manual's. And nobody has measured that these servos' gain is
  what the manual says. It is a guess.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from brace.ground.errors import UsageError, did_you_mean
from brace.toml.parser import tomllib

LIST = Path(__file__).resolve().parents[1] / "data" / "servos.toml"
FIT_REL, MANUAL_REL = 0.15, 0.4
_STEPS_OF_GAIN, _WHOLE_SUPPLY = 128.0, 885.0
_GAIN_MOST = 16383
_SUPPLY = (0.75, 1.3)  # of the recommended one
# Nobody has measured the friction of this servo: limb.toml gets a value between those of the two that were measured.
GUESSED_FRICTION = {
    "friction_per_torque_ratio": 0.45,
    "friction_per_load_ratio": 0.10,
    "friction_sliding_ratio": 0.5,
    "friction_tolerance_ratio": 1.0,
    "torque_gain_rel": 0.28,
}


@dataclass(frozen=True)
class Fit:
    """What others measured of a servo."""

    source: str
    torque_n_m_per_a: float
    resistance_ohm: float
    friction_n_mm: float
    friction_per_torque_ratio: float
    friction_per_load_ratio: float
    friction_sliding_ratio: float
    friction_tolerance_ratio: float
    torque_gain_rel: float


@dataclass(frozen=True)
class Servo:
    """A servo as its manual has it; the torques and the play are at the joint, the gear is in them."""

    name: str
    number: int
    manual: str
    current_step_ma: float
    stall_torque_n_m: float
    stall_current_a: float
    supply_v: float
    position_p_gain: int
    play_arcmin: float
    steps_per_turn: int
    fit: Fit | None = None

    @property
    def play_rad(self) -> float:
        """The full play of the gear."""
        return math.radians(self.play_arcmin / 60.0)

    @property
    def angle_step_rad(self) -> float:
        """The encoder's resolution."""
        return 2.0 * math.pi / self.steps_per_turn

    @property
    def source(self) -> str:
        """Where the stiffness is from."""
        return self.fit.source if self.fit else self.manual

    @property
    def motor_friction(self) -> dict[str, float]:
        """Keys of limb.toml's [motor.*], and values; guessed where there is no fit."""
        if self.fit is None:
            return dict(GUESSED_FRICTION)
        named = ("friction_n_mm", *GUESSED_FRICTION)
        return {name: float(getattr(self.fit, name)) for name in named}


@dataclass(frozen=True)
class Held:
    """A servo that holds a position, at a gain and a supply."""

    servo: Servo
    gain: int
    supply_v: float

    @property
    def stiffness_n_m_per_rad(self) -> float:
        """Proportional to gain and supply: of each step that the joint is off, the controller commands a share of the
        supply (data/servos.toml)."""
        fit = self.servo.fit
        if fit:
            whole_n_m = fit.torque_n_m_per_a * self.supply_v / fit.resistance_ohm
        else:
            whole_n_m = self.servo.stall_torque_n_m * self.supply_v / self.servo.supply_v
        share_per_rad = self.gain / _STEPS_OF_GAIN / _WHOLE_SUPPLY / self.servo.angle_step_rad
        return share_per_rad * whole_n_m

    @property
    def sigma_rel(self) -> float:
        """Of the compliance."""
        return FIT_REL if self.servo.fit else MANUAL_REL

    @property
    def words(self) -> str:
        """What it is, and what its stiffness follows."""
        delivered = " as delivered" if self.gain == self.servo.position_p_gain else ""
        return (
            f"{self.servo.name} at position P gain {self.gain}{delivered} and {self.supply_v:g} V: "
            f"{self.stiffness_n_m_per_rad:.3g} N m/rad"
        )


@cache
def servos() -> dict[str, Servo]:
    """By name."""
    listed = tomllib.loads(LIST.read_text(encoding="utf-8"))["servo"]
    found = [Servo(**{**raw, "fit": Fit(**raw["fit"]) if "fit" in raw else None}) for raw in listed]
    return {servo.name: servo for servo in found}


def held(text: str) -> Held | None:
    """'XM430-W350', 'MX-106 P1200 14.8V'; None where no servo is named. Case, dashes and the ending for the line (T, R)
    do not count. UsageError: a gain or a supply that this servo cannot have, or a servo that is not in the list."""
    words = text.split()
    if not words or not re.match(r"[A-Za-z]{2}[-\s]?\d{2,3}", text.strip()):
        return None
    plain = {_plain(name): servo for name, servo in servos().items()}
    servo = plain.get(_plain(words[0])) or plain.get(re.sub(r"[RT]$", "", _plain(words[0])))
    if servo is None:
        near = did_you_mean(words[0].upper(), servos())
        raise UsageError(
            f"{words[0]!r} is no servo that Brace knows",
            why=f"known: {', '.join(servos())}",
            next_step=f"did you mean {near}? Else its stiffness, e.g. '60 N m/rad', or: unknown",
        )
    gain, supply_v = servo.position_p_gain, servo.supply_v
    for word in words[1:]:
        if match := re.fullmatch(r"[Pp]=?(\d{1,5})", word):
            gain = int(match[1])
        elif match := re.fullmatch(r"(\d+(?:\.\d+)?)[Vv]", word):
            supply_v = float(match[1])
        else:
            raise UsageError(
                f"{text!r}: {word!r} is neither a gain nor a supply",
                why="a servo's name may be followed by its position P gain and its supply",
                next_step=f"'{servo.name} P{servo.position_p_gain} {servo.supply_v:g}V'",
            )
    least, most = (round(share * servo.supply_v, 1) for share in _SUPPLY)
    if not 1 <= gain <= _GAIN_MOST:
        raise UsageError(f"{text!r}: a gain of {gain}", why=f"the register takes 1 to {_GAIN_MOST}",
                         next_step=f"'{servo.name} P{servo.position_p_gain}', as delivered")  # fmt: skip
    if not least <= supply_v <= most:
        raise UsageError(f"{text!r}: a supply of {supply_v:g} V", why=f"{servo.name} has {least:g} to {most:g} V",
                         next_step=f"'{servo.name} {servo.supply_v:g}V'")  # fmt: skip
    return Held(servo, gain, supply_v)


def _plain(name: str) -> str:
    return re.sub(r"[-_\s]", "", name).upper()
