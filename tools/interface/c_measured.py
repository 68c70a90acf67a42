"""The C side of what is measured: generated/brace/measured.h, structs of 32-bit members in the dictionary's order."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from interface.measured import Measured, Values
from interface.registers import ANSWERED_ENTRY, COMMAND_REGISTER, MEASURED_ENTRY

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"


def measured_header(values: Values) -> str:
    """generated/brace/measured.h"""
    return (
        _MADE
        + "#ifndef BRACE_MEASURED_H\n#define BRACE_MEASURED_H\n\n#include <stdint.h>\n\n"
        + "/* Entries of the dictionary by number: parameters from 0 on, these from here on. As Modbus input "
          "registers: two\n"
        + f" * each, high word first, from 0 on and from {2 * (ANSWERED_ENTRY - MEASURED_ENTRY):#06x} on. */\n"
        + f"enum {{\n    BRACE_ENTRY_MEASURED = {MEASURED_ENTRY:#06x},\n    BRACE_ENTRY_ANSWERED = "
          f"{ANSWERED_ENTRY:#06x}\n}};\n\n"
        + "/* First Modbus register of the commands, two each. */\n"
        + f"enum {{ BRACE_REGISTER_COMMANDS = {COMMAND_REGISTER:#06x} }};\n\n"
        + _struct("measured", values.measured, "All of one tick. A float that is not known is NaN, a u32 all ones.")
        + _struct("answered", values.answered, "K at the posture asked for over Modbus.")
        + _struct("commands", values.commands, "What was last written to the command registers.")
        + _names([*values.measured, *values.answered])
        + "#endif\n"
    )


def _struct(name: str, values: Sequence[Measured], words: str) -> str:
    lines = [f"/* {words} */\ntypedef struct {{\n"]
    for value in values:
        kind = "float" if value.type == "f32" else "uint32_t"
        lines.append(f"    {kind} {value.member}; /* {value.description} */\n")
    upper = name.upper()
    count = len(values)
    return (
        "".join(lines)
        + f"}} brace_{name}_t;\n\nenum {{ BRACE_{upper}_COUNT = {count} }};\n"
        + "#ifndef __cplusplus\n"
        + f"_Static_assert(sizeof(brace_{name}_t) == 4 * BRACE_{upper}_COUNT, \"32 bits each\");\n#endif\n\n"
    )


def _names(values: Sequence[Measured]) -> str:
    lines = ["/* What numbers are called, and bits, from 0: to initialise arrays of const char * with. */\n"]
    for value in values:
        words = [f'"{word}"' for word in value.names or value.bit_names]
        if words:
            rows = textwrap.wrap(", ".join(words), 110)
            lines.append(f"#define BRACE_{value.name.upper()}_NAMES \\\n    {{ " + " \\\n      ".join(rows) + " }\n")
    return "".join(lines) + "\n"
