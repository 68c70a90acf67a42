"""A first mapping of somebody's files: by names, by units, by what the entries can be. What is not sure is left
open."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from brace.ground.units import OWN
from brace.importing import names, numerals
from brace.importing.constants import AXES, PERHAPS_ANGLE, constants_of
from brace.importing.mapping import ColumnUse, MappingTable
from brace.importing.meaning import IGNORE, OPEN, TARGETS, UNKNOWN_NAME, quantity_of, target_of
from brace.importing.part import Part

FULL_TURN = 2 * math.pi
BENT_BACK = "all its entries are negative, and theta2 is the femur's angle from +x minus the tibia's"
CLOCK_UNITS = "h: hours and minutes; min: minutes and seconds"
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
    found = _perhaps_resultants(_without_rivals(found, first, kind))
    found = _angles_by_size(found, layout)
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
    if quantity and not readable.any():
        return replace(use, targets=(IGNORE,), why="it holds no numbers")
    if not quantity:
        return use
    unit, why_unit = _unit(name, quantity, values[readable], label)
    if "down" in name.words and target in ("dz_mm", "fz_n", "base_z_mm"):
        return replace(use, unit=unit, sign=OPEN, why="its name says down, and z is up")
    if target == "theta2_rad" and readable.any() and values[readable].max() < 0.0:
        return replace(use, unit=unit, sign=OPEN, why=BENT_BACK)
    return replace(use, unit=unit, why=why_unit or why)


def _unit(name: names.Name, quantity: str, values: np.ndarray, label: str) -> tuple[str, str]:
    """The unit, and why; ? where the name does not say it and the entries cannot."""
    if name.unit is not None and name.unit.quantity == quantity:
        return name.unit.text, ""
    if name.unit is not None:
        return OPEN, f"{name.unit_text!r} is not a unit of {quantity}"
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
            rest = [other for other in rivals if other != at]
            told = [f"{columns[other].name!r} (column {columns[other].number})" for other in rest[:NAMED_MOST]]
            others = ", ".join(told)
            others += f" and {len(rest) - NAMED_MOST} more" if len(rest) > NAMED_MOST else ""
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
                    why=f"it falls as {other!r} grows",
                )  # fmt: skip
    if kind == "loading" and "weight_n" in place and "dz_mm" in place:
        down, weight = values("dz_mm"), np.abs(values("weight_n"))
        both = np.isfinite(down) & np.isfinite(weight)
        if np.count_nonzero(both) > 2 and np.ptp(weight[both]) > 0 and np.ptp(down[both]) > 0:
            if float(np.corrcoef(down[both], weight[both])[0, 1]) > 0.3:
                at = place["dz_mm"]
                changed[at] = replace(changed[at], sign=OPEN, why="it grows with the weight, and z is up")
    return changed


def _within(values: np.ndarray) -> np.ndarray:
    """Changes from entry to entry, over short distances and long: both are blind to offsets between runs."""
    return np.asarray(np.diff(values))
