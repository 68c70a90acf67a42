"""What no column says: a posture, an axis, the time between readings. Remarks and names of files may."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace

from brace.ground.errors import BadFileError, UsageError, did_you_mean
from brace.ground.units import unit_of
from brace.importing import names, numerals
from brace.importing.logs import one_clock
from brace.importing.mapping import CHOICES, CONSTANTS, Constant, MappingTable
from brace.importing.meaning import OPEN, OPEN_ANGLES, TARGETS, target_of
from brace.importing.part import Part
from brace.importing.questions import PERHAPS_ANGLE

SAME_RAD, SAME_DEGC = 1e-3, 0.05  # two ways to write one angle or temperature
AXES = {"x": "x", "z": "z", "horizontal": "x", "vertical": "z", "waagrecht": "x", "waagerecht": "x", "senkrecht": "z",
        "vertikal": "z", "hor": "x", "ver": "z", "vert": "z", "h": "x", "v": "z"}  # fmt: skip


def targets_of(part: Part, table: MappingTable) -> set[str]:
    """What the part's columns are."""
    return {
        target
        for index, name in enumerate(part.names, start=1)
        if (use := table.column(part.path.name, name, index))
        for target in use.targets
    }


_VALUE = re.compile(r"\s*([-+\u2212]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(.*)")


def constants_of(parts: Sequence[Part], table: MappingTable) -> list[Constant]:
    """What no column says: from the remarks above the table, from the file's name, or open."""
    found: list[Constant] = []
    for part in parts:
        if not part.has_names:
            continue
        have = targets_of(part, table)
        if len(parts) > 1 and "t_s" in have and table.kind == "loading" and not (_MOVES & have and _PUSHES & have):
            continue  # one of two instruments: the other file says the rest
        asked = sum(
            1
            for index, name in enumerate(part.names, start=1)
            if (use := table.column(part.path.name, name, index))
            and OPEN in use.targets
            and use.why in (*OPEN_ANGLES, PERHAPS_ANGLE)
        )
        for target in CONSTANTS[table.kind]:
            given = from_remarks(part, target, table.kind)
            if target in have or target in ("dwell_s", "clock"):
                continue
            if target == "axis" and not _needs_axis(have):
                continue
            if given is None and target in ("theta1_rad", "theta2_rad") and asked:
                asked -= 1
                continue  # the column's question stands for it
            if given is None and target == "axis":
                given = axis_of_name(part)
            if given is None and target == "temp_degc":
                continue
            found.append(
                given or Constant(target, OPEN, OPEN if target not in CHOICES else "", part.places[0], _ask(target))
            )
        if why := one_clock.doubt(part, table):
            found.append(Constant("clock", OPEN, "", part.places[0], why))
        if table.kind != "stiffness_table" and "t_s" not in have:
            found.append(Constant("dwell_s", OPEN, "s", part.places[0], _ask("dwell_s")))
    return _of_all(found, parts)


_MOVES = {"dx_mm", "dz_mm", "d_mm"}
_PUSHES = {"fx_n", "fz_n", "f_n", "weight_n"}


def _needs_axis(have: set[str]) -> bool:
    return (
        not ({"dx_mm", "dz_mm"} <= have)
        and not (have & {"dx_mm", "dz_mm"} and "d_mm" not in have)
        and "axis" not in have
    )


def _ask(target: str) -> str:
    return {
        "theta1_rad": "at which femur angle (from +x) was it measured?",
        "theta2_rad": "at which knee angle (0 is straight) was it measured?",
        "axis": "along which axis was the tip moved, x (outwards) or z (up)?",
        "dwell_s": "the file has no time: how much time is between two readings?",
    }.get(target, "")


def from_remarks(part: Part, target: str, kind: str) -> Constant | None:
    for key, text in part.remarks.items():
        name = names.read(key)
        file = part.places[0]
        if target == "axis":
            if "axis" in name.words and (axis := AXES.get(text.lower().strip("+- "))):
                return Constant("axis", axis, "", file, f"{key}: {text}")
            continue
        if name.words & {"noise", "command"} and "angle" not in name.words:
            continue
        match = _VALUE.fullmatch(text)
        is_it = target_of(name, kind)[0] == target
        if not is_it and match and target.startswith("theta"):  # 'Femur: 42.5 deg'
            joint = {"theta1_rad": "femur", "theta2_rad": "tibia"}[target]
            unit = unit_of(match.group(2), "angle")
            is_it = (
                joint in name.words and unit is not None and unit.quantity == "angle" and not name.words & {"encoder"}
            )
        if not is_it or not match:
            continue
        written = match.group(1)
        sign = numerals.decimal_sign([written])[0]
        value = numerals.number(written, sign if sign in (".", ",") else part.decimal)
        unit = unit_of(match.group(2), TARGETS[kind][target]) or (name.unit if not match.group(2).strip() else None)
        if math.isfinite(value):
            fits = unit is not None and unit.quantity == TARGETS[kind][target]
            return Constant(target, repr(value), unit.text if fits and unit else OPEN, file, f"{key}: {text}")
    return None


def axis_of_name(part: Part) -> Constant | None:
    words = re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", f"{part.path.stem} {part.sheet}").lower())
    axes = {AXES[word] for word in words if word in AXES and word not in ("h", "v")}
    return Constant("axis", axes.pop(), "", part.places[0], "the file's name") if len(axes) == 1 else None


def _of_all(found: Sequence[Constant], parts: Sequence[Part]) -> list[Constant]:
    """Constants that every file has alike stand once, and so do those that every block of a file has alike."""
    blocks: dict[str, list[str]] = {}
    for part in parts:
        blocks.setdefault(part.path.name, []).append(part.places[0])
    kept: list[Constant] = []
    for target in dict.fromkeys(each.target for each in found):
        each = [constant for constant in found if constant.target == target]
        if one := _alike(each, [place for places in blocks.values() for place in places]):
            kept.append(replace(one, file=""))
            continue
        for file, places in blocks.items():
            own = [constant for constant in each if constant.file in places]
            one = _alike(own, places)
            kept += [replace(one, file=file)] if one else own
    return kept


def _alike(each: Sequence[Constant], places: Sequence[str]) -> Constant | None:
    """The one that stands for all, if each place has one and they say the same."""
    if {constant.file for constant in each} != set(places):
        return None
    return each[0] if len({(constant.value, constant.unit) for constant in each}) == 1 else None


def against_remarks(parts: Sequence[Part], table: MappingTable, said: Sequence[Constant]) -> list[str]:
    """Notes of what was said (--set) against a table's own remark. Refuses a constant of the mapping that is not this
    table's alone and that its remark contradicts: it is another's."""
    notes = []
    for part in parts if all(part.log is None for part in parts) else ():
        for target in CONSTANTS[table.kind]:
            used = table.constant(part.places, target)
            remarked = from_remarks(part, target, table.kind) or (axis_of_name(part) if target == "axis" else None)
            if used is None or remarked is None or used.value == OPEN:
                continue
            if _has(part, table, target) or _same(used, remarked):
                continue
            value = f"{used.value} {used.unit}".strip()
            other = remarked.why if remarked.unit else f"{remarked.value} ({remarked.why})"
            if used in said:
                notes.append(f"{part.places[0]}: {target} = {value} was said, and the file has {other}")
            elif used.file != part.places[0]:
                raise BadFileError(
                    f"{target} is {value} by the mapping, and this file has {other}",
                    where=str(part.path) + (f", table {part.block}" if part.block else ""),
                    why="the mapping was made for another file, or the remark is wrong",
                    next_step=f'a [[constant]] for this one alone (file = "{part.places[0]}"), or '
                    f"--set {part.places[0]}:{target}=VALUE",
                )
    return notes


def refuse_without_effect(parts: Sequence[Part], table: MappingTable, said: Sequence[Constant]) -> None:
    """What is said on the command line and would change nothing: a slip."""
    known = list(dict.fromkeys(place for part in parts for place in part.places))
    for each in said:
        name = f"{each.file}:{each.target}" if each.file else each.target
        concerned = [part for part in parts if not each.file or each.file in part.places]
        near = did_you_mean(each.file, known)
        if each.target not in CONSTANTS[table.kind]:
            why, way = f"a {table.kind.replace('_', ' ')} record has no {each.target}", "leave it out, or say --kind"
        elif not concerned:
            why = f"no file is called {each.file}; the files are {', '.join(known)[:200]}"
            way = f"--set {near}:{each.target}=VALUE" if near else "name one of the files, or none"
        elif each.target == "clock" and not any(part.log and part.log.by_clock for part in concerned):
            why, way = "it has no log whose topics are by several clocks", "leave it out"
        elif all(_has(part, table, each.target) for part in concerned):
            why, way = "a column holds it", "leave it out, or ignore the column in the mapping"
        elif each not in table.constants:
            why, way = "another --set says it for the same files", "leave out one of them"
        else:
            continue
        raise UsageError(f"--set {name} would change nothing", why=why, next_step=way)


def _has(part: Part, table: MappingTable, target: str) -> bool:
    return {"dwell_s": "t_s"}.get(target, target) in targets_of(part, table)


def _same(used: Constant, remarked: Constant) -> bool:
    """Whether both say the same; a remark without a unit is read in the other's."""
    if used.target == "axis":
        return used.value == remarked.value
    units = [unit_of(used.unit), unit_of(used.unit if remarked.unit == OPEN else remarked.unit)]
    values = [float(each.value) for each in (used, remarked)]
    ours = [unit.factor * value + unit.offset if unit else value for unit, value in zip(units, values)]
    return abs(ours[0] - ours[1]) <= (SAME_DEGC if used.target == "temp_degc" else SAME_RAD)
