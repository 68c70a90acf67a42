"""What each column of somebody's files is here: guessed, shown, confirmed, kept in a file, given again."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from brace import toml
from brace.ground.errors import BadFileError, UsageError, did_you_mean
from brace.ground.units import OWN, UNITS, Unit, meanings_of, unit_of
from brace.importing.meaning import IGNORE, OPEN, TARGETS

WHAT = "mapping file"
CONSTANTS = {
    "loading": ("theta1_rad", "theta2_rad", "axis", "temp_degc", "dwell_s", "clock"),
    "joint_test": ("temp_degc", "dwell_s", "clock"),
    "stiffness_table": (),
}
CHOICES = {"axis": ("x", "z"), "clock": ("log", "stamp")}  # constants that are words
WORDS = {"dwell_s": "time", "theta1_rad": "angle", "theta2_rad": "angle", "temp_degc": "temperature"}
PUSHES = ("fx_n", "fz_n", "f_n", "torque_n_mm")


@dataclass(frozen=True)
class ColumnUse:
    """One column: what it is (several of ours for a symmetric K), its unit, what turns its sign or zero."""

    name: str
    number: int  # place in the file, from 1; it counts where a name is there twice
    targets: tuple[str, ...]
    file: str = ""  # empty: in every file
    unit: str = ""  # "?" where it must be said
    sign: str = "1"  # 1, -1, ?
    offset: float = 0.0  # added after sign and unit, in our unit
    relative: str = "no"  # yes: less the first reading of each run; ?
    wrap: str = ""  # a number in the file's unit: taken off the readings above half of it; ?
    values: Mapping[str, str] = field(default_factory=dict)  # of an axis column
    why: str = ""
    span: str = ""  # least and greatest entry, for the person

    @property
    def used(self) -> bool:
        return self.targets != (IGNORE,)

    @property
    def questions(self) -> list[str]:
        """What has to be said about it."""
        lines = []
        if OPEN in self.targets:
            lines.append(f"{self.name!r}: what is it?" + (f" ({self.why})" if self.why else ""))
        elif self.used:
            if self.unit == OPEN:
                lines.append(
                    f"{self.name!r}: in which unit?"
                    + (f" {self.why}." if "two meanings" in self.why else "")
                    + (f" Its entries go from {self.span}" if self.span else "")
                )
            if self.sign == OPEN:
                lines.append(
                    f"{self.name!r}: must its sign be turned? {self.why + '. ' if self.why else ''}"
                    "sign = -1 turns it, sign = 1 keeps it"
                )
                if self.targets[0] in PUSHES:
                    lines[-1] += (
                        ". The force on a limb grows with its displacement, but many sensors read the force of the "
                        "limb on them. If the displacement has the wrong sign, turn that one"
                    )
            if self.wrap == OPEN:
                lines.append(f"{self.name!r}: has it gone round? {self.why}")
            if self.relative == OPEN:
                lines.append(
                    f"{self.name!r}: does 0 mean unloaded? It begins far from 0; relative = true subtracts each run's "
                    "first entry"
                )
        return lines


@dataclass(frozen=True)
class Constant:
    """What holds for a whole file and stands in no column: an angle, an axis, the time between readings."""

    target: str
    value: str  # a number, or x or z; "?" where it must be said
    unit: str = ""
    file: str = ""
    why: str = ""

    @property
    def questions(self) -> list[str]:
        of = f" of {self.file}" if self.file else ""
        if self.value == OPEN:
            return [f"{self.target}{of}: {self.why or 'what is it?'}"]
        return [f"{self.target}{of} = {self.value}: in which unit?"] if self.unit == OPEN else []


@dataclass(frozen=True)
class MappingTable:
    """All of it. `meta` goes into meta.toml as it is."""

    kind: str
    columns: tuple[ColumnUse, ...]
    constants: tuple[Constant, ...] = ()
    meta: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def questions(self) -> list[str]:
        """What must be said before anything is imported."""
        of_columns = [text for use in self.columns for text in use.questions]
        return of_columns + [text for each in self.constants for text in each.questions]

    @functools.cached_property
    def _of_name(self) -> dict[str, list[ColumnUse]]:
        """Each name's entries: a file may have thousands of columns, and each is looked up several times."""
        found: dict[str, list[ColumnUse]] = {}
        for use in self.columns:
            found.setdefault(use.name, []).append(use)
        return found

    def column(self, file: str, name: str, number: int) -> ColumnUse | None:
        """The entry of a file's column."""
        found = [use for use in self._of_name.get(name, ()) if use.file in ("", file)]
        return next((use for use in found if use.number == number), found[0] if len(found) == 1 else None)

    def constant(self, places: Sequence[str], target: str) -> Constant | None:
        """The constant of the first of the places (a block, its file) that has its own, or the one of all files."""
        found = {each.file: each for each in self.constants if each.target == target}
        return next((found[place] for place in (*places, "") if place in found), None)

    def with_constants(self, given: Iterable[Constant], tables: Sequence[Sequence[str]]) -> MappingTable:
        """The same with some constants said. tables: the places of each table. Where each has a constant of its own,
        the one of all files says nothing any more."""
        kept = self
        for new in given:
            rest = tuple(
                c
                for c in kept.constants
                if c.target != new.target or (new.file and c.file != new.file and not c.file.startswith(new.file + "#"))
            )
            kept = replace(kept, constants=(*rest, new))
            own = {c.file for c in kept.constants if c.target == new.target and c.file}
            if all(own & set(places) for places in tables):
                left = tuple(c for c in kept.constants if c.target != new.target or c.file)
                kept = replace(kept, constants=left)
        return kept


def to_toml(table: MappingTable) -> str:
    """The mapping file: what may stand where is said in its comments."""
    quantity = TARGETS[table.kind]
    lines = [
        "# How brace import reads these files. Every ? must be answered; all else may be corrected.",
        f"# is: {', '.join(quantity)}, or ignore",
        "# unit: as written, e.g. " + ", ".join(f"{unit.text}" for unit in list(UNITS.values())[:60:3]),
        "# sign: -1 turns it. x is outwards, z up; a force is the one on the limb; theta2 is 0 for the straight knee.",
        "# offset: added afterwards, in our unit. relative = true: minus the first entry of each run.",
        "# wrap: taken off the entries above half of it, in the file's unit (65536.0 for 16 bits; 0.0: none went round).",
        "format = 1",
        f'kind = "{table.kind}"',
    ]
    for name, content in table.meta.items():
        lines += ["", f"[meta.{name}]", *(f"{key} = {_value(value)}" for key, value in content.items())]
    for use in table.columns:
        is_text = _value(list(use.targets)) if len(use.targets) > 1 else _value(use.targets[0])
        lines += ["", "[[column]]" + (f"  # {use.span}" if use.span else ""), f"name = {_value(use.name)}"]
        lines += [f"number = {use.number}"] + ([f"file = {_value(use.file)}"] if use.file else [])
        lines.append(f"is = {is_text}" + (f"  # {use.why}" if use.why else ""))
        if use.used and OPEN not in use.targets and any(quantity.get(target) for target in use.targets):
            lines += [f"unit = {_value(use.unit)}", f"sign = {_value(OPEN) if use.sign == OPEN else use.sign}"]
        elif OPEN in use.targets:
            lines.append(f"unit = {_value(use.unit or OPEN)}  # it counts unless is = \"ignore\"")
        if use.offset:
            lines.append(f"offset = {use.offset!r}")
        if use.relative != "no":
            lines.append(f"relative = {_value(OPEN) if use.relative == OPEN else 'true'}")
        if use.wrap:
            lines.append(f"wrap = {_value(OPEN) if use.wrap == OPEN else use.wrap}")
        if use.values:
            lines.append("values = { " + ", ".join(f"{_value(k)} = {_value(v)}" for k, v in use.values.items()) + " }")
    for each in table.constants:
        lines += ["", "[[constant]]", f"is = {_value(each.target)}"] + (
            [f"file = {_value(each.file)}"] if each.file else []
        )
        lines.append(f"value = {_value(each.value)}" + (f"  # {each.why}" if each.why else ""))
        if each.target not in CHOICES:
            lines.append(f"unit = {_value(each.unit)}")
    return "\n".join(lines) + "\n"


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return '"' + "".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in escaped) + '"'
    return repr(value)


COLUMN_KEYS = ("name", "number", "file", "is", "unit", "sign", "offset", "relative", "wrap", "values")
_CONSTANT_KEYS = ("is", "value", "unit", "file")


def read(path: Path) -> MappingTable:
    """Reads and checks a mapping file; refuses with file:line."""
    document = toml.read(path, WHAT)
    content = document.content
    _known(document, content, ("format", "kind", "meta", "column", "constant"), "")
    kind = content.get("kind")
    if not isinstance(kind, str) or kind not in TARGETS:
        raise _bad(document, "kind", f"kind = {kind!r} is no kind of record", f"one of {', '.join(TARGETS)}")
    columns = tuple(
        _column(document, f"column.{number}", entry, str(kind))
        for number, entry in enumerate(_tables(content, "column"))
    )
    constants = tuple(
        _constant(document, f"constant.{number}", entry, str(kind))
        for number, entry in enumerate(_tables(content, "constant"))
    )
    _refuse_twice(document, "column", [(use.file, use.name, use.number) for use in columns])
    _refuse_twice(document, "constant", [(each.file, each.target) for each in constants])
    meta = content.get("meta", {})
    if not isinstance(meta, dict) or not all(isinstance(item, dict) for item in meta.values()):
        raise _bad(document, "meta", "meta holds tables of meta.toml", "e.g. [meta.sensor] range_n = 145.0")
    return MappingTable(str(kind), columns, constants, meta)


def _refuse_twice(document: toml.Document, name: str, keys: Sequence[tuple[object, ...]]) -> None:
    seen: set[tuple[object, ...]] = set()
    for number, key in enumerate(keys):
        if key in seen:
            what = " ".join(str(part) for part in key if part)
            raise _bad(document, f"{name}.{number}", f"a second [[{name}]] for {what}", "delete one of the two")
        seen.add(key)


def _tables(content: Mapping[str, object], name: str) -> list[dict[str, object]]:
    found = content.get(name, [])
    return [item for item in found if isinstance(item, dict)] if isinstance(found, list) else []


def _known(document: toml.Document, entry: Mapping[str, object], keys: tuple[str, ...], prefix: str) -> None:
    for key in entry:
        if key not in keys:
            near = did_you_mean(key, keys)
            raise _bad(
                document, f"{prefix}{key}", f"unknown key {key}", f"did you mean {near}?" if near else ", ".join(keys)
            )


def _column(document: toml.Document, at: str, entry: dict[str, object], kind: str) -> ColumnUse:
    _known(document, entry, COLUMN_KEYS, at + ".")
    given = entry.get("is", OPEN)
    targets = tuple(given) if isinstance(given, list) else (given,)
    for target in targets:
        _target(document, f"{at}.is", target, (*TARGETS[kind], IGNORE, OPEN))
    quantity = {TARGETS[kind].get(str(target), "") for target in targets} - {""}
    unit = str(entry.get("unit", OPEN)) if quantity or OPEN in targets else ""
    if quantity and unit != OPEN:
        _unit(document, f"{at}.unit", unit, quantity.pop())
    sign = str(entry.get("sign", 1))
    if sign not in ("1", "-1", OPEN):
        raise _bad(document, f"{at}.sign", f"sign = {sign} is no sign", "1 or -1")
    offset, relative, values = entry.get("offset", 0.0), entry.get("relative", False), entry.get("values", {})
    number = entry.get("number", 0)
    if isinstance(number, bool) or not isinstance(number, int):
        raise _bad(document, f"{at}.number", f"number = {number!r} is no place in the file", "a whole number, from 1")
    if not targets:
        raise _bad(document, f"{at}.is", "is = [] says nothing", f'is = "{IGNORE}" leaves the column out')
    if isinstance(offset, bool) or not isinstance(offset, (int, float)) or not math.isfinite(offset):
        raise _bad(
            document, f"{at}.offset", f"offset = {offset!r} is not a number", "a number in our unit (rad, mm, N)"
        )
    if relative not in (True, False, OPEN):
        raise _bad(document, f"{at}.relative", f"relative = {relative!r}", "true or false")
    wrap = entry.get("wrap", "")
    is_wrap = isinstance(wrap, (int, float)) and not isinstance(wrap, bool) and 0.0 <= wrap < math.inf
    if wrap not in ("", OPEN) and not is_wrap:
        raise _bad(document, f"{at}.wrap", f"wrap = {wrap!r} is no full range", "65536.0 for 16 bits, 360.0 for a turn")
    if not isinstance(values, dict) or any(value not in ("x", "z") for value in values.values()):
        raise _bad(document, f"{at}.values", "values says x or z for each entry", '{ "horizontal" = "x" }')
    return ColumnUse(
        name=str(entry.get("name", "")),
        number=number,
        targets=tuple(map(str, targets)),
        file=str(entry.get("file", "")),
        unit=unit,
        sign=sign,
        offset=float(offset),
        relative="yes" if relative is True else "no" if relative is False else OPEN,
        wrap=str(wrap),
        values={str(k): str(v) for k, v in values.items()},
    )


def _constant(document: toml.Document, at: str, entry: dict[str, object], kind: str) -> Constant:
    _known(document, entry, _CONSTANT_KEYS, at + ".")
    target = entry.get("is")
    _target(document, f"{at}.is", target, CONSTANTS[kind])
    try:
        return checked_constant(
            str(target), str(entry.get("value", OPEN)), str(entry.get("unit", "")), str(entry.get("file", ""))
        )
    except UsageError as error:
        raise _bad(document, f"{at}.value", error.what, error.next_step) from None


def checked_constant(target: str, value: str, unit: str = "", file: str = "") -> Constant:
    """A constant as it was said; refuses what it cannot be."""
    if value == OPEN:
        return Constant(target, value, unit, file)
    if target == "axis":
        if value not in ("x", "z"):
            raise UsageError(f"axis = {value!r} is no axis", why="x is outwards, z up", next_step="x or z")
        return Constant(target, value, "", file, "said")
    if target == "clock":
        if value not in CHOICES["clock"]:
            raise UsageError(
                f"clock = {value!r} is no clock", why="it is the log's own, or the stamps'", next_step="log or stamp"
            )
        return Constant(target, value, "", file, "said")
    try:
        if not math.isfinite(float(value)):
            raise ValueError
    except ValueError:
        raise UsageError(f"{target} = {value!r} is not a number", why="", next_step="e.g. 42.5") from None
    found = unit_of(unit, WORDS[target])
    if both := meanings_of(unit) if found is None else ():
        raise UsageError(
            f"{unit!r} has two meanings: {' and '.join(each.text for each in both)}",
            why="which of them is meant changes the number",
            next_step=f"{value}{both[0].text}, or {value}{both[-1].text}",
        )
    if unit and unit != OPEN and (found is None or found.quantity != WORDS[target]):
        raise UsageError(
            f"{unit!r} is no unit of {target}",
            why=f"it is {_article(WORDS[target])}",
            next_step=f"e.g. {OWN[WORDS[target]]}",
        )
    return Constant(target, value, unit or OPEN, file, "said")


def _article(quantity: str) -> str:
    return f"an {quantity}" if quantity[0] in "aeiou" else f"a {quantity}"


def _target(document: toml.Document, at: str, target: object, allowed: Sequence[str]) -> None:
    if target in allowed:
        return
    near = did_you_mean(str(target), allowed)
    raise _bad(
        document, at, f"is = {target!r} is no column of ours", f"did you mean {near}?" if near else ", ".join(allowed)
    )


def _unit(document: toml.Document, at: str, text: str, quantity: str) -> Unit:
    unit = unit_of(text, quantity)
    if both := meanings_of(text) if unit is None else ():
        told = " or ".join(f'"{each.text}"' for each in both)
        raise _bad(document, at, f"unit = {text!r} has two meanings", f"unit = {told}")
    if unit is None or unit.quantity != quantity:
        known = ", ".join(each.text for each in UNITS.values() if each.quantity == quantity)
        raise _bad(document, at, f"unit = {text!r} is no unit of {_article(quantity)}", known)
    return unit


def _bad(document: toml.Document, key: str, what: str, way: str) -> BadFileError:
    return BadFileError(what, where=document.where(key), why="a mapping file says what each column is", next_step=way)
