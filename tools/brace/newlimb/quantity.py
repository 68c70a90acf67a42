"""What people type: numbers with units, links, joints. Each refusal says what may stand there."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

from brace.ground.errors import UsageError, did_you_mean
from brace.ground.units import amount, unit_of
from brace.model.assumed_trust import GUESSED_REL
from brace.model.servos import Held, held
from brace.newlimb import LINK_FORMS
from brace.newlimb.beams import ALIASES, MATERIALS, Compliances, Material, of_modulus, round_beam

_COMMA = re.compile(r"(?<![\d.])(\d+),(\d+)(?![\d.])")
UNKNOWN = "unknown"
LENGTH_MM = (10.0, 3000.0)  # of a link
STIFFNESS_N_M_PER_RAD = (1.0, 1e6)  # of a joint
PLAY_MOST_RAD = 0.1
GUESSED_N_M_PER_RAD = 60.0  # a position-held servo of the MX-106's size: 54 to 66 measured
SAID_REL, MEASURED_REL = 0.2, 0.05


def refusal(what: str, why: str, way: str) -> UsageError:
    """A value that a limb cannot have, or that nobody can read."""
    return UsageError(what, why=why, next_step=way)


def _split(text: str, example: str) -> tuple[float, str]:
    """A number and its unit's text; a refusal shows `example`."""
    found = amount(text)
    if found and found[1].startswith(","):
        raise refusal(f"{text!r} has a decimal comma", "the decimal sign is a point", text.replace(",", "."))
    if not found:
        raise refusal(f"{text!r} is not a number with a unit", "a number comes first", f"e.g. {example}")
    return found


def _no_angle(text: str, unit_text: str) -> str:
    return f"{text!r}: {unit_text!r} is not a unit of angle" if unit_text else f"{text!r}: in which unit?"


def length_mm(text: str) -> float:
    """A length; mm where no unit is said."""
    value, unit_text = _split(text, "185 or 0.185m")
    unit = unit_of(unit_text, "length") if unit_text else unit_of("mm")
    if unit is None or unit.quantity != "length":
        raise refusal(f"{text!r}: {unit_text!r} is not a unit of length", "mm, cm, m or in", "e.g. 185 or 0.185m")
    found = unit.factor * value
    low, high = LENGTH_MM
    if not low <= found <= high:
        likely = f"{1e3 * value:g} if it was in metres" if not unit_text and low <= 1e3 * value <= high else "e.g. 185"
        raise refusal(f"{text!r} is {found:g} mm", f"a link has {low:g} to {high:g} mm", likely)
    return found


def offset_mm(text: str) -> float:
    """A distance that may be small or none."""
    value, unit_text = _split(text, "57")
    unit = unit_of(unit_text, "length") if unit_text else unit_of("mm")
    if unit is None or unit.quantity != "length" or not 0.0 <= unit.factor * value <= LENGTH_MM[1]:
        raise refusal(f"{text!r} is not a distance between axes", f"0 to {LENGTH_MM[1]:g} mm", "e.g. 57")
    return unit.factor * value


def play_rad(text: str) -> float:
    """The full play of a gear; its unit must be said."""
    if text.strip().lower() in ("none", "0"):
        return 0.0
    value, unit_text = _split(text, "20arcmin")
    unit = unit_of(unit_text, "angle")
    if unit is None or unit.quantity != "angle":
        raise refusal(
            _no_angle(text, unit_text), "a play is told in arcmin, deg or rad",
            "20arcmin or 0.3deg" if unit_text else f"{value:g}deg or {value:g}arcmin",
        )  # fmt: skip
    found = unit.factor * value
    if found < 0.0 or found > PLAY_MOST_RAD:
        raise refusal(
            f"{text!r} is {math.degrees(found):.3g} deg of play",
            f"a gear has 0 to {math.degrees(PLAY_MOST_RAD):.2g} deg",
            f"{value:g}deg or {value:g}arcmin, if that was meant" if found > 0 else "a play is not negative",
        )
    return found


def angle_rad(text: str) -> float:
    """A joint's angle; its unit must be said."""
    value, unit_text = _split(text, "-60deg")
    unit = unit_of(unit_text, "angle")
    if unit is None or unit.quantity != "angle":
        raise refusal(
            _no_angle(text, unit_text), "an angle is told in deg or rad",
            "e.g. -60deg or -1.05rad" if unit_text else f"{value:g}deg or {value:g}rad",
        )  # fmt: skip
    if abs(unit.factor * value) > 2 * math.pi:
        raise refusal(f"{text!r} is more than a turn", "a joint of a limb turns once at most", f"{value:g}deg?")
    return unit.factor * value


@dataclass(frozen=True)
class Joint:
    """A joint's spring; how far it may be off; whether it was guessed."""

    compliance_rad_per_n_mm: float
    sigma_rel: float
    words: str
    guessed: bool = False
    held: Held | None = None  # the servo, where one is named


def joint(text: str) -> Joint:
    """60, '60 N m/rad', '1 N m/deg', '1.6e-5 rad/(N mm)', XM430-W350, 'MX-106 P1200 14.8V', rigid, unknown."""
    said = text.strip().lower()
    if by_name := held(text):
        stiffness = by_name.stiffness_n_m_per_rad
        return Joint(1e-3 / stiffness, by_name.sigma_rel, by_name.words, by_name.servo.fit is None, by_name)
    if said == UNKNOWN:
        return Joint(1e-3 / GUESSED_N_M_PER_RAD, GUESSED_REL, f"a servo of {GUESSED_N_M_PER_RAD:g} N m/rad", True)
    if said == "rigid":
        return Joint(0.0, 0.0, "rigid")
    value, unit = _split(text, "'60 N m/rad', or: unknown")
    per_rad, is_compliance = _of_turning(unit) if unit else (1.0, False)
    if per_rad is None:
        raise refusal(
            f"{text!r}: {unit!r} is no unit of a joint's stiffness",
            "N m/rad, N m/deg, N m/arcmin, kgf cm/deg, ozf in/deg, or of its compliance: rad/(N mm), deg/(N m)",
            "e.g. '60 N m/rad'; a servo's name, e.g. XM430-W350; or: unknown",
        )
    if value <= 0.0:
        raise refusal(
            f"{text!r} is not a stiffness",
            "it is above zero; a joint that does not yield is: rigid",
            "e.g. '60 N m/rad'",
        )
    stiffness = 1.0 / (value * per_rad) if is_compliance else value * per_rad  # N m/rad
    low, high = STIFFNESS_N_M_PER_RAD
    if not low <= stiffness <= high:
        raise refusal(
            f"{text!r} is {stiffness:.3g} N m/rad",
            f"servos and gears of limbs have {low:g} to {high:g} N m/rad",
            "e.g. '60 N m/rad'; is the unit right?",
        )
    return Joint(1e-3 / stiffness, SAID_REL, f"{stiffness:.4g} N m/rad")


def _of_turning(text: str) -> tuple[float | None, bool]:
    """What turns a number in this unit into N m/rad, or rad/(N m) where it is one of compliance (then true); None: no
    such unit."""
    over, _, under = text.replace("(", " ").replace(")", " ").partition("/")
    for torque_text, angle_text, is_compliance in ((over, under, False), (under, over, True)):
        torque, angle = unit_of(torque_text.strip(), "torque"), unit_of(angle_text.strip(), "angle")
        if torque and angle and (torque.quantity, angle.quantity) == ("torque", "angle"):
            per = 1e-3 * torque.factor / angle.factor
            return (1.0 / per if is_compliance else per), is_compliance
    return None, False


@dataclass(frozen=True)
class Link:
    """A link's compliances; whether it bends as a beam; how far they may be off."""

    compliances: Compliances
    is_beam: bool
    sigma_rel: float
    words: str
    guessed: bool = False


def link(text: str, length: float) -> Link:
    """'tube 20 16 aluminium', 'rod 12 70GPa', 'measured 0.06', 'rigid'."""
    words = text.replace(",", " ").replace("/", " ").split()
    kind = words[0].lower() if words else ""
    _refuse_decimal_comma(text, kind, words)
    if kind == "rigid" and len(words) == 1:
        return Link(Compliances(0.0, 0.0, 0.0, 0.0), False, 0.0, "rigid")
    if kind == "measured" and len(words) in (2, 3):
        bending = _diameter(words[1], "a compliance across the link [mm/N]")
        axial = _diameter(words[2], "a compliance along the link [mm/N]") if len(words) == 3 else 0.0
        if bending > 5.0:
            raise refusal(
                f"{text!r}: {bending:g} mm/N is a millimetre under {1 / bending:.2g} N",
                "a limb's link yields 0.0001 to 5 mm/N",
                f"measured {bending * 1e-3:g} if it was in um/N or mm/kN",
            )
        return Link(Compliances(axial, bending, bending, 0.0), False, MEASURED_REL, f"measured {bending:g} mm/N")
    if kind in ("tube", "rod") and len(words) >= (4 if kind == "tube" else 3):
        outer = _diameter(words[1], "an outer diameter [mm]")
        inner = _diameter(words[2], "an inner diameter [mm]") if kind == "tube" else 0.0
        made_of = material(" ".join(words[3 if kind == "tube" else 2 :]))
        if inner >= outer:
            raise refusal(
                f"{text!r}: the inner diameter is not smaller than the outer",
                "OUTER comes first",
                f"tube {inner:g} {outer:g}",
            )
        if not 1.0 <= outer <= 500.0 or outer > 2.0 * length:
            way = f"{outer * 1e3:g} if it was in metres" if outer < 1.0 else "outer diameter in mm"
            raise refusal(
                f"{text!r}: {outer:g} mm cannot be the diameter of a link {length:g} mm long", "1 to 500 mm", way
            )
        shape = f"tube {outer:g}/{inner:g} mm" if inner else f"rod {outer:g} mm"
        return Link(
            round_beam(length, outer, inner, made_of),
            True,
            math.hypot(made_of.sigma_rel, 0.05),
            f"{shape}, {made_of.name}",
        )
    near = did_you_mean(kind, ("tube", "rod", "measured", "rigid"))
    raise refusal(
        f"{text!r} does not describe a link",
        LINK_FORMS,
        f"did you mean {near}?" if near and near != kind else "'tube 20 16 aluminium'",
    )


def _refuse_decimal_comma(text: str, kind: str, words: Sequence[str]) -> None:
    """Commas may stand between the numbers, too: 'tube 20,16,alu'. One within a number leaves a number too many."""
    first = {"tube": 3, "rod": 2}.get(kind, len(words))  # of the material's words
    too_many = len(words) > first + 1 and re.fullmatch(r"[\d.]+", words[first])
    if _COMMA.search(text) and (kind == "measured" or too_many):
        raise refusal(f"{text!r}: a comma is in a number", "the decimal sign is a point", _COMMA.sub(r"\1.\2", text))


def _diameter(text: str, what: str) -> float:
    try:
        value = float(text.lower().removesuffix("mm"))
    except ValueError:
        raise refusal(f"{text!r} is not a number", f"it is {what}", "e.g. 'tube 20 16 aluminium'") from None
    if not value >= 0.0:
        raise refusal(f"{text!r} is negative", f"it is {what}", "a number above zero")
    return value


def material(text: str) -> Material:
    """By name, or by E in GPa."""
    said = text.strip().lower().replace(" ", "")
    name = ALIASES.get(said, said)
    if name in MATERIALS:
        return MATERIALS[name]
    match = re.fullmatch(r"(\d*\.?\d+)(gpa|mpa|n/?mm2|n/?mm\^2)", said)
    if match:
        e_gpa = float(match.group(1)) * (1.0 if match.group(2) == "gpa" else 1e-3)
        if not 0.1 <= e_gpa <= 1000.0:
            likely = f"{match.group(1)}MPa" if e_gpa > 1000.0 else f"{match.group(1)}GPa"
            raise refusal(f"{text!r} is {e_gpa:g} GPa", "materials have 0.1 to 1000 GPa", f"{likely}?")
        return of_modulus(e_gpa)
    near = did_you_mean(name, [*MATERIALS, *ALIASES])
    raise refusal(
        f"{text!r} is not a known material",
        f"known: {', '.join(MATERIALS)}",
        f"did you mean {near}?" if near else "its modulus of elasticity, e.g. 70GPa",
    )
