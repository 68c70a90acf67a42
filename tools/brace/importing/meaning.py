"""What a column is in a dataset, by its name and unit."""

from __future__ import annotations

import re

from brace.importing.names import Name
from brace.importing.questions import (
    CURRENT, FILTERED, FROM_VERTICAL, INNER_ANGLE, NUMBERED_ANGLES, SHANKS_ANGLE, SUMMARY, TWO_MEANINGS, UNKNOWN_NAME,
    WHICH_ANGLE, Y_FORCE, Y_LENGTH,
)  # fmt: skip

# Names of our columns that a column of somebody's file may be, with the quantity that they hold.
TARGETS: dict[str, dict[str, str]] = {
    "loading": {
        "t_s": "time", "theta1_rad": "angle", "theta2_rad": "angle", "temp_degc": "temperature",
        "dx_mm": "length", "dz_mm": "length", "d_mm": "length", "fx_n": "force", "fz_n": "force", "f_n": "force",
        "weight_n": "force", "enc1_rad": "angle", "enc2_rad": "angle", "base_x_mm": "length", "base_z_mm": "length",
        "axis": "", "run": "", "config": "", "rep": "", "step": "",
    },
    "joint_test": {
        "t_s": "time", "angle_rad": "angle", "torque_n_mm": "torque", "command_n_mm": "torque",
        "temp_degc": "temperature",
        "test": "",
    },
    "stiffness_table": {
        "r_mm": "length", "z_mm": "length", "k_xx": "stiffness", "k_xz": "stiffness", "k_zx": "stiffness",
        "k_zz": "stiffness", "lambda_min": "stiffness", "lambda_max": "stiffness", "theta1_rad": "angle",
        "theta2_rad": "angle", "row": "",
    },
}  # fmt: skip
IGNORE, OPEN = "ignore", "?"
_RATE = re.compile(r"(?:/|\bper\b)\s*(?:s|sec|min|h)\b|/s\S?2|\bs\^?-[12]|rpm", re.IGNORECASE)
# Words of a quantity beside a unit of another, and the unit is right: 'position [deg]', 'load [Nm]', 'T [degC]'.
_UNIT_WINS = frozenset(
    (("length", "angle"), ("force", "torque"), ("time", "temperature"), ("time", "torque"), ("temperature", "torque"),
     ("time", "length"), ("time", "force"), ("temperature", "length"), ("force", "temperature"))
)  # fmt: skip
# Questions that stand for one of both angles.
OPEN_ANGLES = (NUMBERED_ANGLES, WHICH_ANGLE, INNER_ANGLE, FROM_VERTICAL, SHANKS_ANGLE)
_QUANTITIES = ("force", "length", "angle", "torque", "time", "temperature", "stiffness")


def quantity_of(name: Name) -> str:
    """The physical quantity, by the words first and the unit where they leave it open; empty where neither says it."""
    words = name.words
    if "mass" in words and (name.unit is None or name.unit.quantity == "force"):
        return "mass"
    unit = name.unit.quantity if name.unit else ""
    if name.meanings:
        among = {each.quantity for each in name.meanings}
        unit = among.pop() if len(among) == 1 else ""
        if not unit and not set(_QUANTITIES) & words:
            return OPEN
    said = [quantity for quantity in _QUANTITIES if quantity in words]
    if unit and (unit in said or not said):
        return unit
    if unit:  # the unit contradicts the words: 'position [deg]' is an angle, 'tip angle [mm]' nobody knows
        return unit if all((each, unit) in _UNIT_WINS for each in said) else OPEN
    if {"time", "temperature"} <= set(said):
        return OPEN
    if len(said) > 1:
        order = ("temperature", "torque", "stiffness", "force", "angle", "length", "time")
        return next(quantity for quantity in order if quantity in said)
    return said[0] if said else ""


def target_of(name: Name, kind: str) -> tuple[str, str]:
    """Our column, `ignore` or `?`, and why."""
    words, quantity = name.words, quantity_of(name)
    if "noise" in words or "date" in words and "time" not in words:
        return IGNORE, "no column of a dataset"
    if name.unit is None and _RATE.search(name.unit_text):
        return IGNORE, f"{name.unit_text} is a rate: no column of a dataset"
    if quantity == OPEN and name.meanings:
        return OPEN, _either(name)
    of_kind = {"joint_test": _of_joint_test, "stiffness_table": _of_table}.get(kind, _of_loading)
    target, why = of_kind(name, quantity)
    if "current" in words and name.unit is None and name.unit_text and not name.meanings:
        return IGNORE, f"an electric current, {name.unit_text}"
    if target in (IGNORE, OPEN) or not TARGETS[kind].get(target) or "eigen" in words:
        return target, why
    if "current" in words and name.unit is None:
        return OPEN, CURRENT
    if words & {"min", "max", "mean"}:
        return OPEN, SUMMARY
    return (OPEN, FILTERED) if "filtered" in words else (target, why)


def _either(name: Name) -> str:
    """The two meanings of a name's unit, as a question."""
    told = " or ".join(f'{each.quantity} (unit = "{each.text}")' for each in name.meanings)
    return TWO_MEANINGS.format(repr(name.unit_text), told)


def _axis(words: frozenset[str]) -> str:
    letters = [axis for axis in "xyz" if axis in words] or (["z"] if "down" in words else [])
    return letters[0] if len(letters) == 1 else OPEN if letters else ""


def _joint(name: Name) -> str:
    if "femur" in name.words and "tibia" in name.words:
        return OPEN
    if "femur" in name.words:
        return "1"
    if "tibia" in name.words:
        return "2"
    if "coxa" in name.words or name.number == 0:
        return "0"
    return str(name.number) if name.number in (1, 2) else ""


def _of_loading(name: Name, quantity: str) -> tuple[str, str]:
    words, axis, joint = name.words, _axis(name.words), _joint(name)
    if not quantity:
        for word in ("axis", "config", "run", "rep", "step"):
            if word in words:
                return word, "name"
        if "test" in words:
            return "run", "name"
        if words & {"femur", "tibia"} and words <= {"femur", "tibia", "joint", "actual"}:
            return OPEN, WHICH_ANGLE
        return IGNORE, "a counter" if "count" in words else UNKNOWN_NAME
    if quantity == "time":
        return "t_s", "name"
    if quantity == "temperature":
        return "temp_degc", "name"
    if quantity == "mass":
        return "weight_n", "hung weights"
    if quantity == "force":
        if axis == "y":
            return OPEN, Y_FORCE
        return {"x": ("fx_n", "name"), "z": ("fz_n", "name"), "": ("f_n", "name: force along the motion")}.get(
            axis, (OPEN, "several axes in one name")
        )
    if quantity == "length":
        if axis == "y":
            return OPEN, Y_LENGTH
        if "base" in words:
            return (f"base_{axis}_mm", "name") if axis in ("x", "z") else (OPEN, "which axis of the base?")
        if "command" in words:
            return IGNORE, "what was asked for, not what was done"
        return {"x": ("dx_mm", "name"), "z": ("dz_mm", "name"), "": ("d_mm", "name: displacement along the axis")}.get(
            axis, (OPEN, "several axes in one name")
        )
    if quantity == "angle":
        if "encoder" in words and joint in ("1", "2"):
            return f"enc{joint}_rad", "name"
        if joint == "0":
            return IGNORE, "the coxa's angle: a record is of the limb's plane"
        if "interior" in words:
            return OPEN, INNER_ANGLE
        if "shank" in words and "joint" not in words:
            return OPEN, SHANKS_ANGLE
        if "z" in words:
            return OPEN, FROM_VERTICAL
        return (f"theta{joint}_rad", "name") if joint in ("1", "2") else (OPEN, WHICH_ANGLE)
    if quantity == "torque":
        return IGNORE, "a loading record has no torques"
    return OPEN, "name and unit contradict each other"


def _of_joint_test(name: Name, quantity: str) -> tuple[str, str]:
    words = name.words
    if quantity == "time":
        return "t_s", "name"
    if quantity == "temperature":
        return "temp_degc", "name"
    if quantity == "torque":
        return ("command_n_mm" if "command" in words else "torque_n_mm"), "name"
    if quantity == "angle":
        return (IGNORE, "what was asked for, not what was read") if "command" in words else ("angle_rad", "name")
    if quantity == "mass":
        return OPEN, "a hung weight: multiply by g and the lever arm into a torque in your file"
    if not quantity:
        if words & {"test", "run", "config"}:
            return "test", "name"
        return IGNORE, "a counter" if words & {"count", "step", "rep"} else UNKNOWN_NAME
    return IGNORE, "a joint test has time, angle and torque"


def _of_table(name: Name, quantity: str) -> tuple[str, str]:
    words, joint = name.words, _joint(name)
    if "eigen" in words:
        ends = [end for end in ("min", "max") if end in words]
        return (f"lambda_{ends[0]}", "name") if len(ends) == 1 else (OPEN, "the smaller or the larger eigenvalue?")
    if quantity == "stiffness" and not name.entry:
        return IGNORE, "not one of K's entries"
    if name.entry in ("xx", "xz", "zx", "zz"):
        return f"k_{name.entry}", "name"
    if quantity == "stiffness":
        return OPEN, f"K_{name.entry}: a limb's plane has x outwards and z up"
    if "reach" in words:
        return "r_mm", "name"
    if quantity == "length" or not quantity and "z" in words:
        return ("z_mm", "name") if "z" in words else (OPEN, "a length: r_mm or z_mm?")
    if quantity == "angle" and joint in ("1", "2"):
        return f"theta{joint}_rad", "name"
    if "count" in words:
        return "row", "name"
    return IGNORE, UNKNOWN_NAME
