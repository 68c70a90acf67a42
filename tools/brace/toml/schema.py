"""One entry a key: type, unit, range, default, meaning. The check names line, field, reason and remedy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from brace.ground.errors import BadFileError, did_you_mean
from brace.toml.document import Document
from brace.toml.likely_unit import likely

Value = float | str | bool | int | list[str] | list[float]


@dataclass(frozen=True)
class Key:
    """A key that a file may have. Numbers are `low <= value <= high` (`low < value` when `open_low`)."""

    name: str  # dotted: "link.femur.bending_mm_per_n"
    default: Value | None  # None: must be given
    meaning: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    open_low: bool = False
    infinite: bool = False  # may inf be written?
    # number, integer, text, flag, ratio (a number in [0, 1] or true/false), list, vector (three numbers)
    kind: str = "number"
    choices: tuple[str, ...] = ()
    numbers: tuple[int, ...] = ()  # an integer must be one of these

    @property
    def range_text(self) -> str:
        """The allowed values in words."""
        if self.kind == "list" and self.choices:
            return "a list such as [" + ", ".join(f'"{choice}"' for choice in self.choices) + "]"
        if self.choices:
            return " or ".join(f'"{choice}"' for choice in self.choices)
        if self.numbers:
            return " or ".join(str(number) for number in self.numbers) + (f" {self.unit}" if self.unit else "")
        if self.kind in ("text", "flag", "list"):
            return {"text": "text in quotes", "flag": "true or false", "list": "a list"}[self.kind]
        unit = f" {self.unit}" if self.unit else ""
        if self.infinite and self.high == math.inf:
            right = "inf]"
        else:
            right = f"{self.high:g}]" if self.high < math.inf else "inf)"
        left = "(" if self.open_low or self.low == -math.inf else "["
        if self.low == self.high:
            return f"{self.low:g}{unit}"
        noun = {"integer": "a whole number", "vector": "[x, y, z], each"}.get(self.kind, "a number")
        also = ", or true/false" if self.kind == "ratio" else ""
        return f"{noun} in {left}{self.low:g}, {right}{unit}{also}"


    @property
    def entry_text(self) -> str:
        """What may stand behind the equals sign."""
        return self.range_text if self.low == self.high else f"... ({self.range_text})"


def check(
    document: Document,
    keys: Sequence[Key],
    what: str,
    *,
    prefix: str = "",
    content: Mapping[str, object] | None = None,
) -> dict[str, Value]:
    """Values of all `keys` (defaults filled in) from a document, or from one table of it under `prefix`.

    Refuses unknown keys and tables, wrong types, values out of range, missing keys; with file:line."""
    known = {key.name: key for key in keys}
    given = dict(_flatten(document.content if content is None else content))
    tables = {".".join(key.split(".")[:depth]) for key in known for depth in range(1, key.count(".") + 1)}
    for name, value in given.items():
        if name in known:
            continue
        if name in tables and value == {}:
            continue  # an empty table says nothing
        raise _another_kind(document, what) or _unknown(document, prefix, name, value, known, tables, what)
    values: dict[str, Value] = {}
    for key in keys:
        if key.name in given:
            values[key.name] = _checked(document, prefix + key.name, key, given[key.name])
        elif key.default is None:
            raise BadFileError(
                f"{prefix}{key.name} is missing",
                where=document.where((prefix + key.name)),
                why=f"a {what} needs it: {key.meaning}",
                next_step=f"add {key.name.rpartition('.')[2]} = {key.entry_text}"
                + (f" under [{prefix}{key.name.rpartition('.')[0]}]" if "." in key.name else ""),
            )
        else:
            values[key.name] = key.default
    return values


def _flatten(content: Mapping[str, object], prefix: str = "") -> Iterable[tuple[str, object]]:
    for name, value in content.items():
        dotted = f"{prefix}{name}"
        if isinstance(value, Mapping) and value:
            yield from _flatten(value, f"{dotted}.")
        else:
            yield dotted, value


_LIKE_ELSEWHERE = 0.8  # a key of another table is meant only where the whole name is so like it
_KINDS = {"geometry": "limb model", "configuration": "rig file", "kind": "dataset's meta.toml", "body": "stance file"}
"""What a file is that has such a key."""


def _another_kind(document: Document, what: str) -> BadFileError | None:
    """The refusal of a whole file that is of another kind, if this is one: files in the wrong order."""
    for mark, kind in _KINDS.items():
        if mark in document.content and kind != what:
            return BadFileError(
                f"a {kind}, where a {what} is wanted",
                where=document.where(mark),
                why=f"it has {mark}, as no {what} has",
                next_step=f"name the {what} here; were two files exchanged?",
            )
    return None


def _unknown(
    document: Document,
    prefix: str,
    name: str,
    value: object,
    known: Mapping[str, Key],
    tables: set[str],
    what: str,
) -> BadFileError:
    where = document.where(prefix + name)
    if name in tables:
        if isinstance(value, list):
            where = document.where(f"{prefix}{name}.0")
        return BadFileError(
            f"[{name}] is a table, not " + ("a list of tables [[...]]" if isinstance(value, list) else "a value"),
            where=where,
            why=f"found {_shown(value)}",
            next_step=f"write [{name}] on its own line and its keys below it",
        )
    table, _, leaf = name.rpartition(".")
    siblings = {key.rpartition(".")[2]: key for key in known if key.rpartition(".")[0] == table}
    near = did_you_mean(leaf, siblings)
    better = siblings[near] if near else did_you_mean(name, known, _LIKE_ELSEWHERE)
    if table and table not in tables:
        near_table = _near_table(table, tables)
        return BadFileError(
            f"unknown table [{prefix}{table}]",
            where=document.where(prefix + table),
            why=f"a {what} has no such table; a misspelt one would silently do nothing",
            next_step=(
                f"did you mean [{near_table}]?"
                if near_table
                else f"known tables: {', '.join(sorted(_beside(table, tables)))}"
            ),
        )
    listed = ", ".join(sorted(siblings)[:12])
    next_step = (
        f"did you mean {better}?"
        if better
        else (f"known here: {listed}" if listed else f"known tables: {', '.join(sorted(tables))}")
    )
    return BadFileError(
        f"unknown key {prefix}{name}",
        where=where,
        why=f"a {what} has no such key; a misspelt one would silently do nothing",
        next_step=next_step,
    )


def _beside(table: str, tables: set[str]) -> set[str]:
    """The tables under the same parent, or all."""
    parent = table.rpartition(".")[0]
    return {name for name in tables if parent and name.rpartition(".")[0] == parent} or tables


def _near_table(table: str, tables: set[str]) -> str:
    """The table that was probably meant. Under a parent that there is, the last word alone decides: [joint.knee] is no
    slip of [joint.femur]."""
    parent, _, leaf = table.rpartition(".")
    siblings = {name.rpartition(".")[2]: name for name in tables if parent and name.rpartition(".")[0] == parent}
    if not siblings:
        return did_you_mean(table, tables)
    near = did_you_mean(leaf, siblings)
    return siblings[near] if near else ""


def _checked(document: Document, name: str, key: Key, value: object) -> Value:
    def refuse(why: str) -> BadFileError:
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e15
        meant = likely(name, float(str(value)), key.low, key.high) if is_number else ""
        return BadFileError(
            f"{name} = {_shown(value)} is not allowed",
            where=document.where(name),
            why=f"{why}; {name.rpartition('.')[2]} is {key.meaning}",
            next_step=f"write {key.range_text}" + (f"; {meant}" if meant else ""),
        )

    if key.kind == "text":
        if not isinstance(value, str):
            raise refuse("it must be text")
        if key.choices and value not in key.choices:
            raise refuse("it is not one of the choices")
        return value
    if key.kind == "flag":
        if not isinstance(value, bool):
            raise refuse("it must be true or false")
        return value
    if key.kind == "list":
        if not isinstance(value, list) or not value or any(item not in key.choices for item in value):
            raise refuse("it must be a list of " + ", ".join(key.choices))
        return list(value)
    if key.kind == "vector":
        if not isinstance(value, list) or len(value) != 3:
            raise refuse("it must be three numbers in brackets")
        one = replace(key, kind="number")
        return [float(str(_checked(document, name, one, item))) for item in value]
    if key.kind == "ratio" and isinstance(value, bool):
        return 1.0 if value else 0.0
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise refuse(f"it must be a number, not {_type_name(value)}")
    if key.kind == "integer" and not isinstance(value, int):
        raise refuse("it must be a whole number")
    try:
        number = float(value)
    except OverflowError:
        raise refuse("it is too large") from None
    if math.isnan(number):
        raise refuse("it is not a number")
    if math.isinf(number) and not key.infinite:
        raise refuse("it must be finite")
    if number < key.low or (key.open_low and number == key.low):
        raise refuse("it is too small" if number >= 0 or key.low < 0 else "it is negative")
    if number > key.high:
        raise refuse("it is too large")
    if key.numbers and value not in key.numbers:
        raise refuse("it is not one of the choices")
    return value if key.kind == "integer" else number


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float, str)):
        try:
            text = repr(value)
        except ValueError:  # an integer of thousands of digits
            return "a number of thousands of digits"
        return text if len(text) <= 60 else text[:57] + "..."
    return _type_name(value)


def _type_name(value: object) -> str:
    if isinstance(value, bool):
        return "true/false"
    for kind, name in ((str, "text"), (list, "a list"), (dict, "a table")):
        if isinstance(value, kind):
            return name
    return "a date or time" if not isinstance(value, (int, float)) else "a number"


def number(values: Mapping[str, Value], key: str) -> float:
    """A checked value that is a number or a flag."""
    value = values[key]
    if isinstance(value, (int, float)):
        return value
    raise TypeError(f"{key} = {value!r} is not a number")


def whole(values: Mapping[str, Value], key: str) -> int:
    """A checked value that is a whole number or a flag."""
    return int(number(values, key))
