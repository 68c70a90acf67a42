"""The questions of `brace import` at a terminal."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from brace.ground.errors import UsageError, did_you_mean

if TYPE_CHECKING:
    from brace.importing.mapping import ColumnUse, Constant, MappingTable


def has_terminal() -> bool:
    """Whether somebody can answer."""
    return all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))


def ask(table: MappingTable) -> MappingTable:
    """Asks for all that is open, then whether the whole is right."""
    table = replace(table, columns=tuple(_column(use, table.kind) for use in table.columns))
    table = replace(table, constants=tuple(_constant(each) for each in table.constants))
    if _line("Is all of this right? [y/N] ").lower() not in ("y", "yes", "j", "ja"):
        raise UsageError(
            "not confirmed: nothing was written",
            why="you did not say yes",
            next_step="--draft mapping.toml writes the table; correct it, then --mapping mapping.toml",
        )
    return table


def _line(prompt: str) -> str:
    sys.stderr.write(prompt)
    sys.stderr.flush()
    text = sys.stdin.readline()
    if not text:
        raise UsageError("no answer: nothing was written", why="the input ended", next_step="--mapping FILE.toml")
    return text.strip()


def _choice(prompt: str, allowed: list[str]) -> str:
    while True:
        text = _line(f"{prompt} ({', '.join(allowed)}): ")
        if text in allowed:
            return text
        near = did_you_mean(text, allowed)
        sys.stderr.write(f"  {text!r} is not one of them{f'; did you mean {near}?' if near else ''}\n")


def _number(prompt: str) -> str:
    """A number that is not negative, as text."""
    while True:
        text = _line(prompt)
        try:
            if float(text) >= 0.0:
                return repr(float(text))
        except ValueError:
            pass
        sys.stderr.write(f"  {text!r} is no such number\n")


def _unit(prompt: str, quantity: str) -> str:
    from brace.ground.units import UNITS, unit_of

    while True:
        text = _line(f"{prompt} ({', '.join(unit.text for unit in UNITS.values() if unit.quantity == quantity)}): ")
        unit = unit_of(text, quantity)
        if unit is not None and unit.quantity == quantity:
            return unit.text
        sys.stderr.write(f"  {text!r} is not one of them\n")


def _column(use: ColumnUse, kind: str) -> ColumnUse:
    from brace.importing.meaning import IGNORE, OPEN, TARGETS

    if OPEN in use.targets:
        sys.stderr.write(f"{use.why}; its entries: {use.span}\n")
        use = replace(use, targets=(_choice(f"What is {use.name!r}?", [*TARGETS[kind], IGNORE]),), unit=OPEN)
    quantity = TARGETS[kind].get(use.targets[0], "") if use.used else ""
    if quantity and use.unit == OPEN:
        use = replace(use, unit=_unit(f"Unit of {use.name!r}, {use.span}?", quantity))
    if use.used and use.sign == OPEN:
        sys.stderr.write(f"{use.name!r}: {use.why}\n")
        use = replace(use, sign="-1" if _choice("Turn its sign?", ["yes", "no"]) == "yes" else "1")
    if use.used and use.wrap == OPEN:
        use = replace(use, wrap=_number(f"{use.name!r}: {use.why}. wrap = "))
    if use.used and use.relative == OPEN:
        sys.stderr.write(f"{use.questions[-1]}\n")
        use = replace(use, relative=_choice("Subtract each run's first entry?", ["yes", "no"]))
    return use


def _constant(each: Constant) -> Constant:
    from brace.ground.units import unit_of
    from brace.importing.mapping import CHOICES, WORDS, checked_constant

    if not each.questions:
        return each
    if each.target in CHOICES:
        return replace(each, value=_choice(each.questions[0], list(CHOICES[each.target])))
    while True:
        text = (
            _line(f"{each.questions[0]} (number and unit): ")
            if each.value == "?"
            else f"{each.value} " + _line(f"{each.questions[0]} ")
        )
        value, _, unit = text.partition(" ")
        if not unit:
            import re

            match = re.fullmatch(r"([-+\d.eE]+?)\s*([a-zA-Z\u00b0].*)", text)
            value, unit = match.groups() if match else (text, "")
        found = unit_of(unit)
        if found is not None and found.quantity == WORDS[each.target]:
            try:
                return checked_constant(each.target, value, found.text, each.file)
            except UsageError as error:
                sys.stderr.write(f"  {error.what}\n")
        else:
            sys.stderr.write("  a number and its unit, e.g. 42.5 deg\n")
