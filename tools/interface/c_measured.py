"""The C side of what is measured: generated/brace/measured.h, structs of 32-bit members in the dictionary's order."""

from __future__ import annotations

from collections.abc import Sequence

from interface.c_comment import c_comment
from interface.measured import ANSWERED_REGISTER, COMMAND_REGISTER, MEASURED_REGISTER, Measured, Values
from interface.registers import ANSWERED_ENTRY, COMMAND_ENTRY, MEASURED_ENTRY

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"


def measured_header(values: Values) -> str:
    """generated/brace/measured.h"""
    return (
        _MADE
        + "#ifndef BRACE_MEASURED_H\n#define BRACE_MEASURED_H\n\n#include <stdint.h>\n\n"
        + "/* Entries of the dictionary by number: parameters from 0 on, these from here on. */\n"
        + f"enum {{\n    BRACE_ENTRY_MEASURED = {MEASURED_ENTRY:#06x},\n    BRACE_ENTRY_ANSWERED = "
          f"{ANSWERED_ENTRY:#06x},\n    BRACE_ENTRY_COMMANDS = {COMMAND_ENTRY:#06x}\n}};\n\n"
        + "/* The first Modbus register of each struct below: input registers of what is measured and answered,\n"
          " * holding registers of the commands. Every value takes two, high word first, in the struct's order. */\n"
        + f"enum {{\n    BRACE_REGISTER_MEASURED = {MEASURED_REGISTER:#06x},\n"
          f"    BRACE_REGISTER_ANSWERED = {ANSWERED_REGISTER:#06x},\n"
          f"    BRACE_REGISTER_COMMANDS = {COMMAND_REGISTER:#06x}\n}};\n\n"
        + _struct("measured", values.measured, "All of one tick. A float that is not known is NaN, a u32 all ones.")
        + _struct("answered", values.answered, "The answers to what was last asked over Modbus.")
        + _struct("commands", values.commands, "What was last written to the command registers.")
        + "#endif\n"
    )


def _struct(name: str, values: Sequence[Measured], words: str) -> str:
    upper, count = name.upper(), values[-1].index + 1
    at = {value.index: value for value in values}
    members = [_member(at[index]) if index in at else f"    uint32_t reserved_{index};\n" for index in range(count)]
    return (
        f"{c_comment(words)}typedef struct {{\n"
        + "".join(members)
        + f"}} brace_{name}_t;\n\nenum {{ BRACE_{upper}_COUNT = {count} }};\n"
        + "#ifndef __cplusplus\n"
        + f"_Static_assert(sizeof(brace_{name}_t) == 4 * BRACE_{upper}_COUNT, \"32 bits each\");\n#endif\n\n"
    )


def _member(value: Measured) -> str:
    kind = "float" if value.type == "f32" else "uint32_t"
    return c_comment(value.description, "    ") + f"    {kind} {value.member};\n"

