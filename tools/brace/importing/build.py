"""From tables and a confirmed mapping to a dataset: units, signs, runs; what is left out or not there is said."""

from __future__ import annotations

import hashlib
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from brace.ground.errors import BadFileError
from brace.ground.units import OWN, UNITS, unit_of
from brace.importing import names, numerals
from brace.importing.loading import assembled as assembled_loading
from brace.importing.logs.can_formats import are_distances
from brace.importing.logs.one_clock import settled
from brace.importing.mapping import ColumnUse, MappingTable
from brace.importing.meaning import TARGETS
from brace.importing.part import Part, Table
from brace.importing.wraps import unwrapped

MAY_BE_BLANK = {"fx_n", "fz_n", "f_n", "weight_n", "enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm", "temp_degc"}
MUST_BE_THERE = {
    "joint_test": ("angle_rad", "torque_n_mm"),
    "stiffness_table": ("r_mm", "k_xx", "k_xz", "k_zx", "k_zz"),
}


@dataclass(frozen=True)
class Built:
    """A dataset in memory."""

    meta: dict[str, object]
    columns: dict[str, np.ndarray]
    notes: tuple[str, ...]


def build(parts: Sequence[Part], mapping: MappingTable) -> Built:
    """Converts and joins the parts. Refuses where something that must be said has not been."""
    parts = [settled(part, mapping) for part in parts]
    notes = [*mapping.notes, *(f"{part.path.name}: {note}" for part in parts for note in part.notes)]
    tables = [_converted(part, mapping, notes) for part in parts]
    conversions = _conversions(mapping)
    try:
        if mapping.kind == "loading":
            columns, extra = assembled_loading(tables, mapping, notes)
        else:
            columns, extra = _stacked(tables, mapping, notes), {}
    except BadFileError as error:  # rows that could not be read may be why
        error.why = "; ".join([error.why, *(note for note in notes if "rows left out" in note)])
        raise
    files = list(dict.fromkeys(part.path for part in parts))
    meta: dict[str, object] = {"format": 1, "kind": mapping.kind, "title": ", ".join(path.name for path in files)[:200]}
    meta |= {name: dict(content) for name, content in mapping.meta.items()}
    for name, content in extra.items():
        if isinstance(content, Mapping):
            given = meta.get(name, {})
            meta[name] = {**content, **(given if isinstance(given, Mapping) else {})}
        else:
            meta[name] = content
    meta["source"] = {
        "what": "imported",
        "files": [path.name for path in files],
        "sha256": [hashlib.sha256(path.read_bytes()).hexdigest() for path in files],
        "notes": notes,
    }
    meta["conversion"] = conversions
    return Built(meta, columns, tuple(notes))


def _conversions(mapping: MappingTable) -> dict[str, str]:
    """Each of our columns: from which of theirs, in which unit, by what it was multiplied."""
    texts: dict[str, str] = {}
    for use in mapping.columns:
        if not use.used:
            continue
        text = f"column {use.name!r}"
        unit = unit_of(use.unit, _quantity(use.targets[0])) if use.unit else None
        if unit is not None:
            text += f" in {unit.text}"
            factor = unit.factor * (-1 if use.sign == "-1" else 1)
            text += f", times {factor:.12g}" if factor != 1.0 else ", as it is"
            offset = use.offset + unit.offset
            text += f", plus {offset:.12g}" if offset else ""
        if use.wrap and float(use.wrap) > 0.0:
            text += f", entries above half of {use.wrap} less by it before"
        if use.relative == "yes":
            text += ", minus the first entry of each run"
        for target in use.targets:
            place = f" of {use.file}" if use.file else ""
            texts[target] = f"{texts[target]}; {text}{place}" if target in texts else text + place
    for each in mapping.constants:
        place = f" in {each.file}" if each.file else ""
        text = f"{each.value} {each.unit}".strip() + place + (f" ({each.why})" if each.why else "")
        texts[each.target] = f"{texts[each.target]}; {text}" if each.target in texts else text
    return texts


def in_our_unit(value: float, unit_text: str) -> float:
    """A constant converted."""
    unit = unit_of(unit_text)
    return value if unit is None else unit.factor * value + unit.offset


def _converted(part: Part, mapping: MappingTable, notes: list[str]) -> Table:
    columns: dict[str, np.ndarray] = {}
    texts: dict[str, list[str]] = {}
    bad = np.zeros(len(part.rows), bool)
    reasons: Counter[str] = Counter()
    used: list[ColumnUse] = []
    for index, name in enumerate(part.names):
        use = mapping.column(part.path.name, name, index + 1)
        if use is None:
            raise BadFileError(
                f"column {name!r} is not in the mapping",
                where=part.where,
                why="each column must be in it: this one may be a force",
                next_step='add a [[column]] for it; is = "ignore" leaves it out',
            )
        if not use.used:
            continue
        used.append(use)
        _refuse_other_unit(part, index, use)
        cells = part.cells(index)
        for target in use.targets:
            if target in columns or target in texts:
                raise _two_columns(part, used, target)
            quantity = TARGETS[mapping.kind][target]
            if not quantity:
                texts[target] = [use.values.get(cell, cell) for cell in cells]
                continue
            values, unread = _numbers(part, use, cells, target)
            columns[target] = values
            lost = np.isnan(values) & (unread | (target not in MAY_BE_BLANK))
            for row in np.flatnonzero(lost & ~bad):
                reasons[f"{name!r}: {cells[row] or 'an empty cell'}"] += 1
            bad |= lost
    blank = [columns[target] for target in ("fx_n", "fz_n", "f_n", "weight_n") if target in columns]
    if blank:
        empty = np.isnan(np.stack(blank)).all(axis=0) & ~bad
        if empty.any():
            reasons["no force in the row"] += int(np.count_nonzero(empty))
            bad |= empty
    if bad.all():
        raise BadFileError(
            "no row can be read",
            where=part.where,
            why="; ".join(f"{reason} ({count} rows)" for reason, count in reasons.most_common(3)),
            next_step="is the right column mapped? is = \"ignore\" leaves a column out",
        )
    if bad.any():
        why = "; ".join(f"{reason} ({count})" for reason, count in reasons.most_common(4))
        notes.append(f"{part.places[0]}: {int(bad.sum())} of {bad.size} rows left out: {why}")
    if part.skipped:
        notes.append(
            f"{part.places[0]}: {part.skipped} line{'s' if part.skipped > 1 else ''} among or below the readings left "
            "out: no readings"
        )
    keep = np.flatnonzero(~bad)
    return Table(
        part,
        {target: values[keep] for target, values in columns.items()},
        {target: [cells[row] for row in keep] for target, cells in texts.items()},
    )


def _refuse_other_unit(part: Part, index: int, use: ColumnUse) -> None:
    """A mapping knows columns by their names; a unit in a row of its own may be another in the next file."""
    stated = unit_of(part.units[index]) if part.units and part.log is None else None
    meant = unit_of(use.unit, _quantity(use.targets[0])) if use.unit else None
    in_doubt = part.units and meant in names.read(part.names[index], part.units[index]).meanings
    if stated is not None and meant is not None and stated != meant and not in_doubt:
        raise BadFileError(
            f"column {use.name!r} is in {stated.text} by the file's row of units, and in {meant.text} by the mapping",
            where=part.where,
            why="the mapping was made for a file with other units, or one of the two is wrong",
            next_step=f'a [[column]] for this file alone (file = "{part.path.name}"), or correct the one that is wrong',
        )


def _two_columns(part: Part, used: Sequence[ColumnUse], target: str) -> BadFileError:
    names = [f"{use.name!r}" for use in used if target in use.targets]
    return BadFileError(
        f"{len(names)} columns are {target}: {', '.join(names)}",
        where=part.where,
        why="a dataset has one of it, and which of them is meant is not said",
        next_step='is = "ignore" for all but one of them in the mapping',
    )


def _numbers(part: Part, use: ColumnUse, cells: Sequence[str], target: str) -> tuple[np.ndarray, np.ndarray]:
    """A column in our unit, and which entries are there and are no numbers (OVERLOAD)."""
    values = np.array([numerals.number(cell, part.decimal) for cell in cells])
    if target == "t_s" and np.isnan(values).all():
        values = _clocks(part, use, cells)
    if target == "t_s" and are_distances(values[np.isfinite(values)]):
        raise BadFileError(
            f"column {use.name!r} is no clock: it neither rises nor falls over the file",
            where=part.where,
            why="its entries are distances from reading to reading, or no times",
            next_step='sum them up in your file; or is = "ignore", and --set dwell=4s if they are even',
        )
    values = _without_marks(values, _quantity(target))
    values = unwrapped(values, float(use.wrap or 0.0))
    unread = np.array([math.isnan(value) and not numerals.is_missing(cell) for value, cell in zip(values, cells)])
    unit = UNITS.get(use.unit) or unit_of(use.unit, _quantity(target))
    if unit is None:
        raise BadFileError(
            f"column {use.name!r} has no unit",
            where=part.where,
            why=f"it is {target}",
            next_step=f'e.g. unit = "{OWN[TARGETS["loading"].get(target, "force") or "force"]}" in its [[column]]',
        )
    sign = -1.0 if use.sign == "-1" else 1.0
    return sign * (unit.factor * values + unit.offset) + use.offset, unread


def _quantity(target: str) -> str:
    """Of one of our columns; a name means the same in every kind of record."""
    return next((of[target] for of in TARGETS.values() if target in of), "")


def _clocks(part: Part, use: ColumnUse, cells: Sequence[str]) -> np.ndarray:
    """Clock times, in the column's unit. Of 12:34 the unit says what its first number is."""
    unit = unit_of(use.unit)
    factor_s = unit.factor if unit else 1.0
    values = np.array(numerals.clocks_s(cells)) / factor_s
    short = np.array([numerals.short_clock(cell) for cell in cells])
    if np.isfinite(short).any() and (unit is None or unit.text not in ("h", "min")):
        raise BadFileError(
            f"column {use.name!r} has times such as {cells[int(np.flatnonzero(np.isfinite(short))[0])]}",
            where=part.where,
            why="they may be hours and minutes, or minutes and seconds",
            next_step='unit = "h" or unit = "min" in its [[column]]',
        )
    values = np.where(np.isfinite(short), short, values)
    day = numerals.DAY_S / factor_s
    return np.asarray(values + np.cumsum(np.concatenate([[0.0], np.where(np.diff(values) < -day / 2, day, 0.0)])))


_NINES = re.compile(r"9{3,}|9{2,}\.9+")  # a program's number for 'nothing read', as wide as its field
_MARK_REPEATS = 3
_MARK_OF = frozenset(("force", "torque", "length"))  # 99.9 deg are an angle that a posture may have
_MARKS = (9999.0, 99999.0, 999999.0, 9999999.0, 999.0, 999.9, 9999.9, 99999.9, 32767.0, 65535.0)


def _without_marks(values: np.ndarray, quantity: str) -> np.ndarray:
    """NaN where a program wrote -9999, -99.99 or 1e38 for 'nothing read': far beyond all other entries. Nines of any
    width count where they are repeated."""
    sizes = np.abs(values)
    with np.errstate(invalid="ignore"):
        marks = np.isin(sizes, _MARKS) | (sizes > 1e30)
    nines = np.zeros(len(values), bool)
    if quantity in _MARK_OF:
        largest, counts = np.unique(sizes[np.isfinite(sizes) & ~marks], return_counts=True)
        at = largest.size - 1
        if at >= 0 and counts[at] >= _MARK_REPEATS and _NINES.fullmatch(f"{largest[at]:.10g}"):
            nines = sizes == largest[at]
    others = sizes[~marks & ~nines & np.isfinite(values)]
    if not (marks | nines).any() or not others.size or others.max() <= 0.0:
        return values
    far = (marks & (sizes > 20.0 * others.max())) | (nines & (sizes > 3.0 * others.max()))
    return np.asarray(np.where(far, math.nan, values))


def _stacked(tables: Sequence[Table], mapping: MappingTable, notes: list[str]) -> dict[str, np.ndarray]:
    """Joint tests and stiffness tables: the parts below one another; each file of joint tests is a test of its own."""
    names = list(dict.fromkeys(name for table in tables for name in table.columns))
    out: dict[str, np.ndarray] = {}
    for needed in MUST_BE_THERE[mapping.kind]:
        for table in tables:
            if needed not in table.columns:
                raise BadFileError(
                    f"no column is {needed}",
                    where=table.part.where,
                    why=_needed(mapping.kind, needed),
                    next_step=f'map a column to it (is = "{needed}")'
                    + (
                        '; is = ["k_xz", "k_zx"] where the source prints K symmetric'
                        if needed in ("k_xz", "k_zx")
                        else ""
                    ),
                )
    for name in names:
        if all(name in table.columns for table in tables):
            out[name] = np.concatenate([table.columns[name] for table in tables])
        else:
            notes.append(f"{name} is left out: it is not in every file")
    rows = [len(next(iter(table.columns.values()))) for table in tables]
    if mapping.kind == "joint_test":
        if "t_s" not in out:
            dwell = [mapping.constant(table.part.places, "dwell_s") for table in tables]
            if any(each is None or each.value == "?" for each in dwell):
                raise BadFileError(
                    "no column is t_s", where=tables[0].part.where, why="friction and creep follow the time",
                    next_step="--set dwell_s=0.01s where readings are evenly apart",
                )  # fmt: skip
            out["t_s"] = np.concatenate(
                [
                    in_our_unit(float(each.value), each.unit) * np.arange(count)
                    for each, count in zip(dwell, rows)
                    if each
                ]
            )
            notes.append("there is no time: t_s is the row number times dwell_s")
        if "temp_degc" in out and np.isnan(out["temp_degc"]).any():
            notes.append("temp_degc is left out: it is not there in every row")
            del out["temp_degc"]
        tests = [np.full(count, number, np.int32) for number, count in enumerate(rows, start=1)]
        if all("test" in table.texts for table in tables):
            labels = [f"{at}/{text}" for at, table in enumerate(tables) for text in table.texts["test"]]
            order = {label: number for number, label in enumerate(dict.fromkeys(labels), start=1)}
            out["test"] = np.array([order[label] for label in labels], np.int32)
        elif len(tables) > 1:
            out["test"] = np.concatenate(tests)
    return out


def _needed(kind: str, column: str) -> str:
    if kind == "joint_test":
        return "a joint test is the joint's angle and the torque in it, whichever of the two was imposed"
    return f"a stiffness table has {column} in every row"


def sources(parts: Sequence[Part]) -> list[Path]:
    """The files."""
    return list(dict.fromkeys(part.path for part in parts))
