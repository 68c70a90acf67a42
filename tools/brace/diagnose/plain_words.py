"""Effects, places and keys as a person says them who has never seen limb.toml."""

from __future__ import annotations

import math

from brace.diagnose.diagnosis import Diagnosis, GapPair, Interval, NamedEffect
from brace.model.keys import KEY_BY_NAME

_EFFECTS = {
    "joint_compliance": ("a softer joint", "the joint's drive yields more to torque than the model says"),
    "moment_transfer": (
        "bending passed on through the knee",
        "the femur's end also turns under load, and the turn is carried on by the tibia's length",
    ),
    "base_compliance": ("a yielding base", "what the limb is mounted on gives way or turns under load"),
    "link_compliance_error": (
        "a link of another stiffness",
        "the link yields more or less than its calibration says, by more than that is trusted to",
    ),
    "link_change": ("a link that changed", "the link became softer or stiffer in the middle of the record"),
    "backlash": ("backlash", "the joint moves freely through its play before it carries torque"),
    "coulomb_friction": (
        "dry friction",
        "the joint's deflection sticks until the torque out of balance exceeds a bound: force depends on "
        "direction",
    ),
    "joint_hardening": ("a joint that hardens", "the joint gets stiffer the more it is loaded"),
    "creep": ("creep", "the joints go on yielding after the load is on, so the force relaxes"),
    "thermal_softening": ("softening with warmth", "the joints' compliance changes with temperature"),
    "gravity": ("weight of the links", "the links' own weight loads the joints, by posture"),
    "joint_zero_offset": (
        "a shifted joint zero",
        "the joint stands at another angle than it is commanded to",
    ),
    "link_length_error": ("a link of another length", "a link is longer or shorter than the model says"),
    "sensor_bias": ("a sensor bias", "the force sensor reads something when there is no force"),
    "sensor_drift": ("sensor drift", "the force sensor's zero moves with time"),
    "sensor_gain": ("a sensor gain", "every force reads too large or too small by one ratio"),
    "sensor_rotation": ("a turned sensor", "the force sensor's axes are turned against the limb's"),
    "sensor_crosstalk": ("sensor cross-talk", "force along one axis shows in the other's reading"),
    "sensor_saturation": ("a saturated sensor", "the force sensor's reading ends at a limit"),
    "contact_play": ("play in the contact", "the tip moves in its ball joint before it meets force"),
}
_PLACES = {
    "joint.coxa": "yaw joint",
    "joint.femur": "femur joint",
    "joint.tibia": "knee joint",
    "link.coxa": "coxa",
    "link.femur": "femur",
    "link.tibia": "tibia",
    "geometry": "lengths",
    "base": "base",
    "sensor": "force sensor",
    "gravity": "links",
    "creep": "joints",
    "thermal": "joints",
    "contact": "tip's contact",
    "change": "link",
}
_VERDICTS = {
    "effect": "Something is missing in the model, and it has a name",
    "none": "Model and measurement agree",
    "ambiguous": "Something is missing; this record cannot tell which of a few",
    "unknown": "Something is missing that is not in the catalogue",
    "data_fault": "The record itself is faulty",
}
_UNITS = {"n": "N", "n_mm": "N mm", "n_per_mm": "N/mm"}
_ARCMIN = 60.0 * 180.0 / math.pi


def verdict(diagnosis: Diagnosis) -> str:
    """The verdict as a headline."""
    return _VERDICTS[diagnosis.verdict]


def unit(gap_unit: str) -> str:
    """`n_mm` as N mm."""
    return _UNITS.get(gap_unit, gap_unit)


def effect(name: str) -> str:
    """`backlash`, `a shifted joint zero`."""
    return _EFFECTS[name][0] if name in _EFFECTS else name.replace("_", " ")


def meaning(name: str) -> str:
    """What the effect does, in half a sentence; empty for one that is not known here."""
    return _EFFECTS[name][1] if name in _EFFECTS else ""


def place(where: str) -> str:
    """`knee joint` for joint.tibia."""
    return _PLACES.get(where, where)


def label(text: str) -> str:
    """`backlash@joint.tibia + creep@creep` as words."""
    return " and ".join(_one_label(part) for part in text.split(" + "))


def _one_label(text: str) -> str:
    name, _, where = text.partition("@")
    return f"{effect(name)} ({place(where)})" if where else effect(name)


def named(found: NamedEffect) -> str:
    """An effect of the diagnosis with its place."""
    return _one_label(found.label)


def key_unit(key: str) -> str:
    """The unit of a key of limb.toml."""
    return KEY_BY_NAME[key].unit if key in KEY_BY_NAME else ""


def number(value: float) -> str:
    """Three or four digits, as a person writes them."""
    if not math.isfinite(value):
        return "any" if math.isnan(value) else ("-∞" if value < 0 else "∞")
    if value == 0.0:
        return "0"
    if abs(value) >= 1e4 or abs(value) < 1e-3:
        mantissa, _, exponent = f"{value:.2e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.4g}" if abs(value) >= 1000 else f"{value:.3g}"


def value_with_unit(key: str, value: float) -> str:
    """`0.0061 rad (21 arcmin)`: small angles also as gear makers print them."""
    text = f"{number(value)} {key_unit(key)}".strip()
    if key.endswith(("gap_rad", "offset_rad", "rotation_rad", "tilt_rad")) and math.isfinite(value) and value:
        arcmin = value * _ARCMIN
        return (
            f"{text} ({number(arcmin)} arcmin)" if abs(arcmin) < 120 else f"{text} ({number(arcmin / 60)}°)"
        )
    return text


def interval(found: Interval) -> str:
    """`0.0057 to 0.0065`, or that the record does not say."""
    if not math.isfinite(found.low) and not math.isfinite(found.high):
        return "not determined by this record"
    if not math.isfinite(found.high):
        return f"at least {number(found.low)}"
    if not math.isfinite(found.low):
        return f"at most {number(found.high)}"
    return f"{number(found.low)} to {number(found.high)}"


def gap_pair(pair: GapPair, gap_unit: str) -> str:
    """`0.11 N fitted, 0.12 N held out`."""
    words = f"{number(pair.fitted)} {unit(gap_unit)} fitted"
    return words if pair.held_out is None else f"{words}, {number(pair.held_out)} {unit(gap_unit)} held out"


def percent(share: float) -> str:
    """`97 %`; never 100 % of what is not certain."""
    if not math.isfinite(share):
        return "unknown"
    if 0.995 <= share < 1.0:
        return "over 99 %"
    if 0.0 < share < 0.005:
        return "under 1 %"
    return f"{100 * share:.0f} %"
