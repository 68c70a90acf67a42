"""Values that `brace sim` takes: faults, postures, the contact, what happens to a stance. Each refusal says what would
do."""

from __future__ import annotations

import math
import re

from brace.cli.options import (
    Quantity,
    RefusedValue,
    angle,
    flexion,
    force,
    length,
    moment,
    number,
    ratio,
    refused,
    stiffness,
)
from brace.ground.errors import did_you_mean
from brace.ground.units import amount
from brace.sim.spec import FAULTS, JOINTS, Fault, Lift, Move, Payload, Posture

_FAULT = re.compile(
    r"(?P<name>[a-z_]+)(?::(?P<where>[^=@]*))?(?:=(?P<value>[^@]*))?(?:@(?P<at>[^+]*)(?:\+(?P<time>.*))?)?"
)
_EXAMPLES = {"joint_soft": 0.6}
_FAULT_FORM = "NAME[:[LIMB.]JOINT][=VALUE][@SECONDS[+DURATION]]"
_torque, _lateness = Quantity("torque", "500Nmm"), Quantity("time", "5ms", least=0.0)


def fault(text: str) -> Fault:
    """encoder_stuck:femur@2.0+1.5, current_offset:2.tibia=500@3, bus_off:1@4+0.5, nvm_fails"""
    found = _FAULT.fullmatch(text)
    if found is None:
        raise refused(f"{text!r} is no fault", f"the form is {_FAULT_FORM}", "OPTION encoder_stuck:femur@2.0+1.5")
    name = found["name"]
    if name not in FAULTS:
        near = did_you_mean(name, FAULTS)
        raise refused(
            f"{name!r} is no fault that can be made",
            f"known: {', '.join(FAULTS)}",
            f"OPTION {text.replace(name, near, 1)}" if near else "brace sim --help",
        )
    of_joint, unit, value = FAULTS[name]
    limb, joint = _where(name, found["where"], of_joint)
    if found["value"] is not None:
        if not unit:
            raise refused(f"{text!r} has a value", f"{name} takes none", f"OPTION {name}")
        try:
            value = _value(found["value"], unit)
        except RefusedValue as error:
            before = text[: found.start("value")]
            raise refused(error.what, error.why, error.way.replace("OPTION ", f"OPTION {before}")) from None
    if value is None:
        example = f"{name}:femur={_EXAMPLES.get(name, 500)}@2+1" if of_joint else f"{name}=2@2+1"
        raise refused(f"{text!r} has no value", f"{name} needs one, in {unit}", f"OPTION {example}")
    at_s = moment(found["at"]) if found["at"] is not None else 0.0
    for_s = moment(found["time"]) if found["time"] is not None else math.inf
    return Fault(tuple(FAULTS).index(name), limb, joint, value, at_s, for_s)


def _value(text: str, unit: str) -> float:
    """In the unit that the fault has, where the text names none."""
    if unit == "N mm":
        return _torque(text)
    if unit == "N":
        return force(text)
    if unit != "ms":
        return ratio(text)
    found = amount(text)
    return 1e3 * _lateness(text) if found is not None and found[1] else number(text)  # ms


def _where(name: str, text: str | None, of_joint: bool) -> tuple[int | None, int]:
    """Limb (from 0) and joint of 'femur', '2.femur', '2'."""
    limb_text, dot, rest = (text or "").rpartition(".")
    joint_text = rest
    if not dot and rest.isdigit():
        limb_text, joint_text = rest, ""
    if of_joint and joint_text not in JOINTS:
        raise refused(
            f"{name} without a joint" if not joint_text else f"{joint_text!r} is no joint",
            f"joints: {', '.join(JOINTS)}",
            f"OPTION {name}:femur@2.0+1.5",
        )
    if not of_joint and joint_text:
        raise refused(f"{joint_text!r} after {name}", "this fault is the whole limb's", f"OPTION {name}:1@2.0+1.5")
    if limb_text and not (limb_text.isdigit() and 1 <= int(limb_text) <= 16):
        raise refused(f"{limb_text!r} is no limb's number", "limbs count from 1", f"OPTION {name}:1.femur")
    return (int(limb_text) - 1 if limb_text else None), (JOINTS.index(joint_text) if of_joint else 0)


def posture(text: str) -> Posture:
    """1.0,1.4 or 1.0,1.4@2.5"""
    angles, _, at = text.partition("@")
    parts = angles.split(",")
    if len(parts) != 2:
        raise refused(f"{text!r} is no posture", "the form is THETA1,THETA2[@SECONDS], in rad", "OPTION 1.0,1.4@2.5")
    return Posture(angle(parts[0]), flexion(parts[1]), moment(at) if at else 0.0)


def payload(text: str) -> Payload:
    """1.5, 1.5@3 or 1.5@3+2"""
    factor, _, when = text.partition("@")
    at, _, ramp = when.partition("+")
    return Payload(ratio(factor), moment(at) if at else 0.0, moment(ramp) if ramp else 0.0)


def move(text: str) -> Move:
    """front left:0,0.02,0@3"""
    limb, colon, rest = text.rpartition(":")
    by, _, at = rest.partition("@")
    parts = by.split(",")
    if not colon or not limb or len(parts) != 3:
        raise refused(
            f"{text!r} is no move of a limb",
            "the form is LIMB:COXA,FEMUR,TIBIA[@SECONDS], by how much each set-point moves, in rad",
            "OPTION 2:0,0.02,0@3",
        )
    coxa, femur, tibia = (angle(part) for part in parts)
    return Move(limb, (coxa, femur, tibia), moment(at) if at else 0.0)


def lift(text: str) -> Lift:
    """front left@3 or front left@3+2"""
    limb, _, when = text.partition("@")
    at, _, time = when.partition("+")
    if not limb:
        raise refused(f"{text!r} names no limb", "the form is LIMB[@SECONDS[+DURATION]]", "OPTION 2@3+1")
    return Lift(limb, moment(at) if at else 0.0, moment(time) if time else math.inf)


def contact(text: str) -> float:
    """Stiffness of the contact [N/mm]: planted is inf, free is 0, wall:K is K."""
    if text == "planted":
        return math.inf
    if text == "free":
        return 0.0
    kind, _, of_wall = text.partition(":")
    if kind == "wall":
        value = stiffness(of_wall)
        if value > 0:
            return value
    raise refused(
        f"{text!r} is no contact",
        "planted: the tip is held where it is; free: in the air; wall:K: held by a spring of K N/mm",
        "OPTION wall:20",
    )


def pair_mm(text: str) -> tuple[float, float]:
    """1.5,-2 [mm]"""
    parts = text.split(",")
    if len(parts) != 2:
        raise refused(f"{text!r} is no pair", "the form is X,Z in mm", "OPTION 1.0,2.0")
    return length(parts[0]), length(parts[1])
