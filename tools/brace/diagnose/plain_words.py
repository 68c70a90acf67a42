"""Effects, places and keys as a person says them who has never seen limb.toml."""

from __future__ import annotations

import math

from brace.diagnose.diagnosis import Diagnosis, GapPair, HeldOut, Interval, JointSizes, NamedEffect
from brace.diagnose.digits import number, unit
from brace.effects import BY_NAME
from brace.effects.rivals import RIVAL_BY_NAME, RIVAL_UNITS
from brace.model.keys import KEY_BY_NAME
from brace.model.limb import toml_value

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
    "rig": "test rig",
}
_VERDICTS = {
    "effect": "Something is missing in the model, and it has a name",
    "none": "Model and measurement agree",
    "ambiguous": "Something is missing; this record cannot tell which of a few",
    "unknown": "Something is missing that has no name here, or the record shows too little",
    "data_fault": "The record itself is faulty",
}
LEAST_SHARE_OF_LOAD = 1e-3  # friction that grows less with the load is not worth a word
_ARCMIN = 60.0 * 180.0 / math.pi


def verdict(diagnosis: Diagnosis) -> str:
    """The verdict as a headline."""
    return _VERDICTS[diagnosis.verdict]


def effect(name: str) -> str:
    """`backlash`, `a shifted joint zero`."""
    row = BY_NAME.get(name) or RIVAL_BY_NAME.get(name)
    return row.words if row else name.replace("_", " ")


def meaning(name: str) -> str:
    """What the effect does, in half a sentence; empty for a name that the catalogue does not have."""
    row = BY_NAME.get(name) or RIVAL_BY_NAME.get(name)
    return row.meaning if row else ""


def place(where: str) -> str:
    """`knee joint` for joint.tibia."""
    return _PLACES.get(where, where)


def label(text: str) -> str:
    """`backlash@joint.tibia + creep@creep` as words."""
    return " and ".join(_one_label(part) for part in text.split(" + "))


def _one_label(text: str) -> str:
    """Without its place where there is only one for it: its name has said it."""
    name, _, where = text.partition("@")
    has_one_place = where == "rig" or (name in BY_NAME and len(BY_NAME[name].places) == 1)
    return f"{effect(name)} ({place(where)})" if where and not has_one_place else effect(name)


def named(found: NamedEffect) -> str:
    """An effect of the diagnosis with its place."""
    return _one_label(found.label)


def identified(found: NamedEffect) -> str:
    """The same with the identifier of files and options: `backlash (knee joint) [backlash@joint.tibia]`."""
    return f"{named(found)} [{found.label}]"


def key_unit(key: str) -> str:
    """The unit of a key of limb.toml."""
    return KEY_BY_NAME[key].unit if key in KEY_BY_NAME else RIVAL_UNITS.get(key, "")


def value_alone(key: str, value: float) -> str:
    """`0.0061`; a switch as limb.toml writes it, true or false."""
    return toml_value(KEY_BY_NAME[key], value) if is_switch(key, value) else number(value)


def is_switch(key: str, value: float) -> bool:
    """Whether limb.toml writes the value as true or false."""
    entry = KEY_BY_NAME.get(key)
    return entry is not None and entry.kind == "ratio" and value in (0.0, 1.0)


def value_with_unit(key: str, value: float) -> str:
    """`0.0061 rad (21 arcmin)`: small angles also as gear makers print them; a drift also by the hour."""
    text = f"{value_alone(key, value)} {key_unit(key)}".strip()
    if key.endswith("_n_per_s") and value:
        return f"{text} ({number(3600.0 * value)} N in an hour)"
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
    least, most = sorted((abs(found.low), abs(found.high)))
    if 1e-4 <= least < 1e-3 <= most < 1.0:  # both ends in one notation
        return f"{found.low:.3g} to {found.high:.3g}"
    return f"{number(found.low)} to {number(found.high)}"


def joint_sizes(found: JointSizes) -> list[str]:
    """Stiffness, play and friction of a joint in the units that makers of gears and drives print."""
    said = []
    for key, held in found.parameters.items():
        leaf = key.rpartition(".")[2]
        if leaf == "compliance_rad_per_n_mm":  # its inverse, so that the ends change places
            low, high = (1e-3 / end if end > 0.0 else math.inf for end in (held.high, held.low))
            said.append(f"stiffness {_between(1e-3 / held.value, low, high)} N m/rad")
        elif leaf == "gap_rad":
            said.append(f"play {_between(*(end * _ARCMIN for end in (held.value, held.low, held.high)))} arcmin")
        elif leaf == "coulomb_n_mm":
            said.append(f"friction {_between(*(1e-3 * end for end in (held.value, held.low, held.high)))} N m")
        elif leaf == "coulomb_per_load_ratio" and held.value >= LEAST_SHARE_OF_LOAD:
            said.append(f"and {_between(*(100.0 * end for end in (held.value, held.low, held.high)))} % of the load")
    many = f", at any gear position like the {found.gear_positions} of the record" if found.gear_positions > 1 else ""
    return [*said, f"for torques up to {number(1e-3 * found.torque_n_mm)} N m{many}"]


def _between(value: float, low: float, high: float) -> str:
    return f"{number(value)} ({interval(Interval(value, low, high))})"


def gap_pair(pair: GapPair, gap_unit: str) -> str:
    """`0.11 N fitted, 0.12 N held out`."""
    words = f"{number(pair.fitted)} {unit(gap_unit)} fitted"
    return words if pair.held_out is None else f"{words}, {number(pair.held_out)} {unit(gap_unit)} held out"


def held_out(found: HeldOut, gap_unit: str) -> str:
    """`by amplitude: displacements above 1.52 mm are predicted to 0.11 N (expected 0.1 N)`."""
    sizes = f"{number(found.off)} {unit(gap_unit)} (expected {number(found.expected)} {unit(gap_unit)})"
    outcome = "are predicted to" if found.holds else "are NOT predicted: off by"
    return f"by {found.by}: {found.words} {outcome} {sizes}"
