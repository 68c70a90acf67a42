"""A first mapping of somebody's files: by names, by units, by what the entries can be. What is not sure is left
open."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from brace.ground.units import OWN
from brace.importing import names, numerals
from brace.importing.constants import AXES, constants_of
from brace.importing.mapping import ColumnUse, MappingTable
from brace.importing.logs.can_formats import are_distances
from brace.importing.meaning import IGNORE, OPEN, TARGETS, quantity_of, target_of
from brace.importing.part import Part
from brace.importing.questions import (
    BENT_BACK, CLOCKS, FALLS, FORMULAS_FAILED, GROWS_WITH_WEIGHT, NO_CLOCK, NO_NUMBERS, NO_RESULTS, NUMBERED_ANGLES,
    PERHAPS_ANGLE, POINTS_DOWN, TWO_MEANINGS, UNKNOWN_NAME, WHICH_ANGLE,
)  # fmt: skip
from brace.importing.wraps import wraps

WRAPPED = ("fx_n", "fz_n", "f_n", "torque_n_mm", "command_n_mm", "angle_rad", "enc1_rad", "enc2_rad", "dx_mm", "dz_mm",
           "d_mm", "theta1_rad", "theta2_rad")  # fmt: skip
FULL_TURN = 2 * math.pi
CLOCK_UNITS = "h: hours and minutes; min: minutes and seconds"
_FORMULA = re.compile(r"\s*[=+@][A-Za-z$('(].*|\s*=.*")
_FAILED = re.compile(r"#(?:VALUE|REF|DIV/0|NAME\?|WERT|BEZUG|N/A|NV|NUM|ZAHL)!?", re.IGNORECASE)
NAMED_MOST = 4  # rivals of a column in its question
RAW = ("v", "mv", "volt", "volts", "mv/v", "ma", "a", "counts", "count", "ticks", "lsb", "%", "digits", "raw")


def draft(parts: Sequence[Part], kind: str = "") -> MappingTable:
    """What the files seem to be. `kind`, if given, is not guessed."""
    kind = kind or _kind(parts)
    columns: list[ColumnUse] = []
    layouts: dict[tuple[tuple[str, ...], tuple[str, ...]], list[Part]] = {}
    for part in parts:
        layouts.setdefault((part.names, part.units), []).append(part)
    for layout in layouts.values():
        file = "" if len(layouts) == 1 else layout[0].path.name
        columns += _columns(layout, kind, file)
        for other in sorted({part.path.name for part in layout} - {file}) if file else ():
            columns += _columns(layout, kind, other)
    table = MappingTable(kind, tuple(columns))
    return replace(table, constants=tuple(constants_of(parts, table)))


def _kind(parts: Sequence[Part]) -> str:
    read = [
        names.read(name, unit) for part in parts for name, unit in zip(part.names, part.units or [""] * len(part.names))
    ]
    quantities = Counter(quantity_of(name) for name in read)
    of_table = sum(1 for name in read if name.entry) >= 2 or quantities["stiffness"] >= 3
    if of_table and all(part.log is None for part in parts):  # a log has readings by time
        return "stiffness_table"
    moves, pushes = quantities["length"], quantities["force"] + quantities["mass"]
    if quantities["torque"] and not (moves and pushes):
        return "joint_test"
    return "loading"


def _columns(layout: Sequence[Part], kind: str, file: str) -> list[ColumnUse]:
    first = layout[0]
    found = []
    for index, header in enumerate(first.names):
        cells = [cell for part in layout for cell in part.cells(index)]
        found.append(_one(index, header, first, cells, kind, file))
    found = _numbered_joints(found, first)
    found = _perhaps_resultants(_without_rivals(_one_clock(found, layout), first, kind))
    found = _angles_by_size(found, layout)
    found = _wrapped(found, layout)
    found = _perhaps_angles(found, layout) if kind == "loading" else found
    return found if kind == "stiffness_table" else _signs_and_zeros(found, layout, kind)


def _one(index: int, header: str, part: Part, cells: list[str], kind: str, file: str) -> ColumnUse:
    units_row = part.units[index] if part.units else ""
    name = names.read(header, units_row)
    target, why = target_of(name, kind) if part.has_names else (OPEN, "the file names no columns")
    values = np.array([numerals.number(cell, part.decimal) for cell in cells])
    readable = np.isfinite(values)
    span = f"{values[readable].min():g} to {values[readable].max():g}" if readable.any() else ""
    label = header + (f" [{units_row}]" if units_row else "")
    use = ColumnUse(header, index + 1, (target,), file, why=why, span=span)
    quantity = TARGETS[kind].get(target, "")
    if target == "axis":
        return _axis_column(use, cells)
    if target == "t_s" and not readable.any():
        clocks = [cell for cell in cells if not math.isnan(numerals.clock_s(cell))]
        span = f"{clocks[0]} to {clocks[-1]}" if clocks else ""
        if numerals.clocks_are_short(cells):
            return replace(use, unit=OPEN, why="clock times", span=f"{span} ({CLOCK_UNITS})")
        if clocks:
            unit = "min" if numerals.clocks_are_minutes(cells) else "s"
            return replace(use, unit=unit, why="clock times", span=span)
    if target == "t_s" and are_distances(values[readable]):
        return replace(use, targets=(OPEN,), why=NO_CLOCK)
    if quantity and (why := _unreadable(cells, readable.any())):
        return replace(use, targets=(OPEN,), why=why, span=next(cell for cell in cells if cell.strip()))
    if quantity and not readable.any():
        return replace(use, targets=(IGNORE,), why="it holds no numbers")
    if not quantity:
        return replace(use, unit=name.unit.text) if target == OPEN and name.unit is not None else use
    unit, why_unit = _unit(name, quantity, values[readable], label)
    if "down" in name.words and target in ("dz_mm", "fz_n", "base_z_mm"):
        return replace(use, unit=unit, sign=OPEN, why=POINTS_DOWN)
    if target == "theta2_rad" and readable.any() and values[readable].max() < 0.0:
        return replace(use, unit=unit, sign=OPEN, why=BENT_BACK)
    return replace(use, unit=unit, why=why_unit or why)


def _unreadable(cells: Sequence[str], any_number: bool) -> str:
    """Why a column that may be a measurement cannot be read; empty where it can, or where nothing stands in it."""
    if any(_FORMULA.fullmatch(cell) for cell in cells):
        return NO_RESULTS
    if any_number:
        return ""
    if any(_FAILED.fullmatch(cell.strip()) for cell in cells):
        return FORMULAS_FAILED
    text = next((cell for cell in cells if not numerals.is_missing(cell)), "")
    return NO_NUMBERS.format(repr(text[:30])) if text else ""


def _unit(name: names.Name, quantity: str, values: np.ndarray, label: str) -> tuple[str, str]:
    """The unit, and why; ? where the name does not say it and the entries cannot."""
    if name.unit is not None and name.unit.quantity == quantity:
        return name.unit.text, ""
    if name.unit is not None:
        return OPEN, f"{name.unit_text!r} is not a unit of {quantity}"
    if name.meanings:
        return OPEN, TWO_MEANINGS.format(repr(name.unit_text), " or ".join(f'unit = "{m.text}"' for m in name.meanings))
    if name.unit_text.lower() in RAW:
        return OPEN, f"{name.unit_text} is what the instrument gives: convert it to {OWN[quantity]} in your file first"
    if name.unit_text:
        return OPEN, f"the unit {name.unit_text!r} is not known"
    if quantity == "temperature" and values.size:
        if -30.0 <= values.min() and values.max() <= 60.0:
            return "degC", "name; degC from the size of its entries"
        if 230.0 <= values.min() and values.max() <= 350.0:
            return "K", "name; K from the size of its entries"
    return OPEN, ""


def _axis_column(use: ColumnUse, cells: Sequence[str]) -> ColumnUse:
    texts = sorted({cell.strip() for cell in cells if cell.strip()})
    known = {text: AXES.get(text.lower().removesuffix("-axis").removesuffix("-achse").strip("+- ")) for text in texts}
    if texts and all(known.values()):
        turned = {text: str(axis) for text, axis in known.items() if text != axis}
        return replace(use, values=turned, span=", ".join(texts))
    return replace(
        use, targets=(OPEN,), span=", ".join(texts[:6]),
        why=f"an axis column with {', '.join(texts[:4])}: say is = \"axis\", and in values which are x and which z",
    )  # fmt: skip


def _numbered_joints(columns: list[ColumnUse], part: Part) -> list[ColumnUse]:
    """Angles that are known by numbers alone. 1 and 2 are femur and tibia, 0 to 2 coxa, femur, tibia; of any others
    nobody knows which is which."""
    of: dict[int, int] = {}
    units: dict[int, str] = {}
    for at, use in enumerate(columns):
        name = names.read(use.name, part.units[at] if part.units else "")
        if name.number is None or name.words & {"femur", "tibia", "coxa"}:
            continue
        if {"theta1_rad", "theta2_rad", "enc1_rad", "enc2_rad"} & set(use.targets) or quantity_of(name) == "angle":
            of[at] = name.number
            units[at] = name.unit.text if name.unit is not None else ""
    numbers = set(of.values())
    if numbers in ({1, 2}, {0, 1, 2}) or len(numbers) < 2:
        return columns
    return [
        replace(use, targets=(OPEN,), unit=units[at], why=NUMBERED_ANGLES)
        if at in of and use.why != WHICH_ANGLE and (use.targets != (IGNORE,) or of[at] == 0)
        else replace(use, why=NUMBERED_ANGLES)
        if at in of and use.targets == (OPEN,)
        else use
        for at, use in enumerate(columns)
    ]


def _one_clock(columns: list[ColumnUse], layout: Sequence[Part]) -> list[ColumnUse]:
    """Of several times, the stamp of a message's header; else the first, if they run alike: one that lags by more
    than half a reading, or by a varying time, makes the rows' time another."""
    rivals = [at for at, use in enumerate(columns) if use.targets == ("t_s",)]
    if len(rivals) < 2:
        return columns
    stamps = [at for at in rivals if {"header", "stamp"} <= names.read(columns[at].name).words]
    times = {}
    for at in rivals:
        cells = [cell for part in layout for cell in part.cells(at)]
        numbers = np.array([numerals.number(cell, layout[0].decimal) for cell in cells])
        times[at] = numbers if np.isfinite(numbers).any() else np.array(numerals.clocks_s(cells))
    first = stamps[0] if len(stamps) == 1 else rivals[0]
    if len(stamps) != 1 and not all(_run_alike(times[first], times[at]) for at in rivals[1:]):
        return [replace(use, targets=(OPEN,), why=CLOCKS) if at in rivals else use for at, use in enumerate(columns)]
    return [
        replace(use, targets=(IGNORE,), why=f"{columns[first].name!r} is the t_s") if at in rivals and at != first else use
        for at, use in enumerate(columns)
    ]


def _run_alike(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether one clock is the other but for unit and beginning."""
    both = np.isfinite(a) & np.isfinite(b)
    if np.count_nonzero(both) < 3 or np.ptp(a[both]) == 0.0 or np.ptp(b[both]) == 0.0:
        return False
    a, b = a[both] - a[both][0], b[both] - b[both][0]
    slope = float(a @ b) / float(a @ a)
    return bool(np.abs(b - slope * a).max() <= 0.5 * abs(slope) * float(np.median(np.abs(np.diff(a)))))


def _wrapped(columns: list[ColumnUse], layout: Sequence[Part]) -> list[ColumnUse]:
    """Readings of two clusters, at zero and at the top: negative numbers read unsigned, or an angle beyond its turn."""
    changed = list(columns)
    for at, use in enumerate(columns):
        if use.used and use.targets[0] in WRAPPED:
            values = np.array([numerals.number(cell, part.decimal) for part in layout for cell in part.cells(at)])
            if why := wraps(values[np.isfinite(values)]):
                changed[at] = replace(use, wrap=OPEN, why=why)
    return changed


def _without_rivals(columns: list[ColumnUse], part: Part, kind: str) -> list[ColumnUse]:
    """Two columns for one of ours: the commanded one of two angles; of all others nobody knows."""
    taken = Counter(use.targets[0] for use in columns if use.targets[0] not in (IGNORE, OPEN))
    changed = list(columns)
    for target in (target for target, count in taken.items() if count > 1):
        rivals = [at for at, use in enumerate(columns) if use.targets[0] == target]
        words = {at: names.read(columns[at].name).words for at in rivals}
        wanted = [at for at in rivals if "command" in words[at]]
        if not target.startswith("theta"):
            wanted = [at for at in rivals if "command" not in words[at] and "base" not in words[at]]
            if (
                target in ("f_n", "d_mm", "t_s", "run", "step", "rep", "config", "temp_degc", "test")
                and len(wanted) != 1
            ):
                wanted = rivals[:1] if target in ("t_s", "run", "step", "rep", "config", "test") else []
        for at in rivals:
            if len(wanted) == 1:
                if at != wanted[0]:
                    changed[at] = replace(
                        columns[at], targets=(IGNORE,), why=f"{columns[wanted[0]].name!r} is the {target}"
                    )
                continue
            rest = [other for other in rivals[: NAMED_MOST + 1] if other != at][:NAMED_MOST]
            others = ", ".join(f"{columns[other].name!r} (column {columns[other].number})" for other in rest)
            more = len(rivals) - 1 - len(rest)
            others += f" and {more} more" if more else ""
            changed[at] = replace(columns[at], targets=(OPEN,), why=f"it may be {target}, and so may {others}")
    return changed


def _perhaps_resultants(columns: list[ColumnUse]) -> list[ColumnUse]:
    """A force without an axis beside one along x or z: along the motion, or the length of the vector? It is asked."""
    changed = list(columns)
    for plain, along in (("f_n", ("fx_n", "fz_n")), ("d_mm", ("dx_mm", "dz_mm"))):
        others = [use.name for use in columns if set(use.targets) & set(along)]
        for at, use in enumerate(columns):
            if others and plain in use.targets:
                changed[at] = replace(
                    use, targets=(OPEN,),
                    why=f"{plain}, along the motion, or a resultant of {', '.join(map(repr, others))} (ignore)",
                )  # fmt: skip
    return changed


def _angles_by_size(columns: list[ColumnUse], layout: Sequence[Part]) -> list[ColumnUse]:
    """Angles of a posture whose unit is not said: beyond a full turn they are degrees; two that are not, and differ
    from zero as a leg's do, are radians."""
    places = [
        at for at, use in enumerate(columns) if use.targets[0] in ("theta1_rad", "theta2_rad") and use.unit == OPEN
    ]
    if not places or any("unit" in columns[at].why for at in places):
        return columns
    sizes = []
    for at in places:
        values = [numerals.number(cell, part.decimal) for part in layout for cell in part.cells(at)]
        sizes.append(np.abs(np.array([value for value in values if math.isfinite(value)] or [0.0])).max())
    largest = max(sizes)
    unit = "deg" if FULL_TURN < largest <= 360.0 else "rad" if 0.15 < largest <= 3.2 and len(places) == 2 else OPEN
    if unit == "deg" and len(places) < 2 and largest < 7.0:
        unit = OPEN
    changed = list(columns)
    for at in places:
        if unit != OPEN:
            changed[at] = replace(columns[at], unit=unit, why=f"name; {unit} from the size of its entries")
    return changed


def _perhaps_angles(columns: list[ColumnUse], layout: Sequence[Part]) -> list[ColumnUse]:
    """No angle is known, and numbers of an unknown name stay for some rows and then change, as postures do: asked.
    Left out, they would let one angle be said for a record of several postures."""
    known = {target for use in columns for target in use.targets}
    if {"theta1_rad", "theta2_rad"} <= known or not layout[0].has_names:
        return columns
    changed = list(columns)
    for at, use in enumerate(columns):
        if use.targets[0] != IGNORE or use.why != UNKNOWN_NAME:
            continue
        values = np.array([numerals.number(cell, part.decimal) for part in layout for cell in part.cells(at)])
        values = values[np.isfinite(values)]
        changes = np.count_nonzero(np.diff(values))
        if 0 < 2 * changes <= values.size and np.abs(values).max() <= 360.0:
            changed[at] = replace(use, targets=(OPEN,), why=PERHAPS_ANGLE)
    return changed


_SIGNED = {
    "loading": (("dx_mm", "fx_n"), ("dz_mm", "fz_n"), ("d_mm", "f_n")),
    "joint_test": (("angle_rad", "torque_n_mm"),),
}


def _signs_and_zeros(columns: list[ColumnUse], layout: Sequence[Part], kind: str) -> list[ColumnUse]:
    """A force that falls as the displacement grows has one of the two turned. A displacement that begins far from zero
    may count from elsewhere."""
    changed = list(columns)
    place = {use.targets[0]: at for at, use in enumerate(columns)}

    def values(target: str) -> np.ndarray:
        at = place[target]
        return np.array([numerals.number(cell, part.decimal) for part in layout for cell in part.cells(at)])

    for moved, pushed in _SIGNED[kind]:
        if moved in place and kind == "loading":
            readings = values(moved)
            readings = readings[np.isfinite(readings)]
            if readings.size and abs(readings[0]) > 0.05 * max(float(np.ptp(readings)), 1e-12):
                changed[place[moved]] = replace(changed[place[moved]], relative=OPEN)
        if moved not in place or pushed not in place:
            continue
        if OPEN in (changed[place[moved]].wrap, changed[place[pushed]].wrap):
            continue  # once that is said, the sign is none of the questions
        a, b = values(moved), values(pushed)
        both = np.isfinite(a) & np.isfinite(b)
        if np.count_nonzero(both) > 3 and np.ptp(a[both]) > 0 and np.ptp(b[both]) > 0:
            steps_a, steps_b = _within(a[both]), _within(b[both])
            norm = math.sqrt(float(np.sum(steps_a**2)) * float(np.sum(steps_b**2)))
            if norm > 0 and float(np.sum(steps_a * steps_b)) / norm < -0.3:
                at = place[pushed]
                other = columns[place[moved]].name
                changed[at] = replace(
                    changed[at], sign=OPEN,
                    why=FALLS.format(repr(other)),
                )  # fmt: skip
    if kind == "loading" and "weight_n" in place and "dz_mm" in place:
        down, weight = values("dz_mm"), np.abs(values("weight_n"))
        both = np.isfinite(down) & np.isfinite(weight)
        if np.count_nonzero(both) > 2 and np.ptp(weight[both]) > 0 and np.ptp(down[both]) > 0:
            if float(np.corrcoef(down[both], weight[both])[0, 1]) > 0.3:
                at = place["dz_mm"]
                changed[at] = replace(changed[at], sign=OPEN, why=GROWS_WITH_WEIGHT)
    return changed


def _within(values: np.ndarray) -> np.ndarray:
    """Changes from entry to entry, over short distances and long: both are blind to offsets between runs."""
    return np.asarray(np.diff(values))
