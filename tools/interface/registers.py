"""Modbus: which value stands in which register. Two registers a value, high word first (ABCD)."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from dataclasses import dataclass

from interface.dictionary import Dictionary
from interface.measured import Measured, Values

MEASURED_ENTRY = 0x1000  # number of the first measured value in the dictionary's count
ANSWERED_ENTRY = 0x1800
COMMAND_ENTRY = 0x2000  # of the first command; write_entry on CAN takes those that stop or show who commands
INPUT, HOLDING = "input", "holding"
_COLUMNS = ("name", "table", "address", "registers", "type", "unit", "scale", "access", "description")


@dataclass(frozen=True)
class Register:
    """One row of the map."""

    name: str
    table: str  # input (function 04), holding (03, 06, 16)
    address: int  # as in the frame, from 0
    type: str  # f32, u32
    unit: str
    access: str  # ro, rw (CONFIGURATION only), wo
    description: str


def registers(dictionary: Dictionary, values: Values) -> list[Register]:
    """All rows: measured, answered, parameters, commands."""
    return [*_inputs(values), *_parameters(dictionary), *_commands(values)]


def _inputs(values: Values) -> Iterator[Register]:
    for value in (*values.measured, *values.answered):
        yield Register(value.name, INPUT, value.register, value.type, value.unit, "ro", _words(value))


def _parameters(dictionary: Dictionary) -> Iterator[Register]:
    for entry in sorted(dictionary.parameters, key=lambda entry: entry.register):
        yield Register(entry.key, HOLDING, entry.register, entry.type, entry.unit, "rw", entry.description)


def _commands(values: Values) -> Iterator[Register]:
    for value in values.commands:
        yield Register(value.name, HOLDING, value.register, value.type, value.unit, "wo", value.description)


def _words(value: Measured) -> str:
    table = value.codes
    if table is None:
        return value.description
    if table.is_bits:
        return value.description + "; bits from 0: " + ", ".join(code.name for code in table.codes)
    return value.description + ": " + ", ".join(f"{number} {name}" for number, name in table.unsigned_names.items())


def registers_csv(rows: list[Register]) -> str:
    """firmware/interface/modbus.csv"""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for row in rows:
        writer.writerow((row.name, row.table, row.address, 2, row.type, row.unit, 1, row.access, row.description))
    return text.getvalue()


def registers_module(rows: list[Register]) -> str:
    """tools/brace/wire/registers.py"""
    lines = [
        '"""Modbus registers by name. Written by tools/interface from dictionary.toml; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from brace.wire.register import Register",
        "",
        "REGISTERS: tuple[Register, ...] = (",
        *(f'    Register("{r.name}", "{r.table}", {r.address}, "{r.type}", "{r.unit}", "{r.access}"),' for r in rows),
        ")",
    ]
    return "\n".join(lines) + "\n"


def measured_module(values: Values) -> str:
    """tools/brace/wire/measured.py"""
    lines = [
        '"""Measured values by name. Written by tools/interface from dictionary.toml; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from brace.wire import codes",
        "from brace.wire.entry import MeasuredEntry",
        "",
        "MEASURED: tuple[MeasuredEntry, ...] = (",
    ]
    for value in values.measured:
        table = "" if value.codes is None else f", codes.{value.codes.name.upper()}"
        table += ", numeric=True" if value.numeric else ""
        lines.append(
            f'    MeasuredEntry({MEASURED_ENTRY + value.index:#06x}, "{value.name}", "{value.type}", '
            f'"{value.unit}"{table}),'
        )
    lines.append(")")
    return "\n".join(lines) + "\n"
