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


def registers_page(rows: list[Register]) -> str:
    """docs/modbus.md"""
    head = """# Modbus registers

Written by tools/interface from the dictionary; do not edit. RTU and TCP, the same map. Addresses are those of the frame,
from 0. Every value is 32 bits in two registers, high word first (ABCD): read `probe_f32` (12345.5) and `probe_u32`
(0x01020304) to see that your reader agrees. A float that is not known is NaN, a whole number all ones; never zero.

One read of input registers is one snapshot: all values are of the same tick. A read holds at most 125 registers: 0 to
124 are K in the limb's plane and what belongs to it, 42 to 166 are posture, force, play, the parameters' CRC and K in
space. Addresses never change; new values take free ones. Parameters are staged where they are
written, in CONFIGURATION mode only, and are in force after `commit` has stored them and read them back.

| table | function |
|---|---|
| input | 04 read |
| holding | 03 read, 16 write: both registers of a value; 06 write: the high register, then the low one at once |

Half a value may be read, not written.

Also 08 (echo and the line's counters), 17 (who answers: "Brace", version, dictionary's hash) and 43/14 (device
identification). RTU is 8E1 at `controller.modbus_baud`, address `controller.modbus_address`; over TCP the unit is that
address, 0 or 255. A block is written whole or not at all; commands are written one a request; what belongs to
one question (`asked_...`) is written in one request, and answered when the write is. K at a posture and K at a tip
share their answer registers. The question that was asked last can be read back; the registers of the other question
read NaN, a whole number all ones. Read back, `set_mode` is the mode and `clear_faults` the faults. `commit` and
`rollback` are 1 while a set is being stored and 0 once it is in force. If it could not be stored, they are 255 to 249
for the refusals -81 to -87 ([errors.md](errors.md)). `take_up` is the last one that was begun, `let_go` 0. Function
06's two requests have to come one after the other on their port.

| exception | meaning here |
|---|---|
| 01 | no such function; or not in this mode: parameters and `commit` want CONFIGURATION |
| 02 | no such registers, or a write that begins with a value's second half |
| 03 | a count, length or value that can not be; a tip out of reach; force or sag where an open gap carries nothing; \
a value beyond the board's ceilings (-74); a `commit_crc` of another set |
| 04 | it could not be done: no play to take up; no valid K, or no known force, to answer from |
| 06 | a set is being stored, a commit came less than 10 s after the one before (-75), or four questions of this connection wait already: ask again |
| 07 | somebody else is the owner, or there is no proof that you are (-70 to -73): `last_refusal` tells which |
| 11 | TCP only: no such unit behind this connection |

"""
    lines = []
    for table, access, title in (
        (INPUT, "ro", "Input registers: measured"),
        (HOLDING, "wo", "Holding registers: commands"),
        (HOLDING, "rw", "Holding registers: parameters"),
    ):
        lines.append(f"## {title}\n\n| address | name | type | unit | what |\n|---|---|---|---|---|\n")
        lines += [
            f"| {row.address} | `{row.name}` | {row.type} | {row.unit} | {row.description.replace('|', '/')} |\n"
            for row in rows
            if row.table == table and row.access == access
        ]
        lines.append("\n")
    return (head + "".join(lines)).rstrip("\n") + "\n"


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
