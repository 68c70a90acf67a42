"""The C side: parameter_list.h (count, hash, an index for each member) and parameter_table.c
(rules, defaults, keys)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from interface.c_comment import c_comment
from interface.c_structs import c_float, c_range
from interface.dictionary import Dictionary, Entry

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"
_COLUMNS = 110
T = TypeVar("T")


def list_header(dictionary: Dictionary) -> str:
    """generated/brace/parameter_list.h"""
    names = [f"    {index_name(entry)} = {entry.index}," for entry in dictionary.parameters]
    return (
        _MADE
        + "#ifndef BRACE_PARAMETER_LIST_H\n#define BRACE_PARAMETER_LIST_H\n\n#include <stdint.h>\n\n"
        + "/* Of the list below with its types and units; a block of another list is refused. */\n"
        + f"#define BRACE_SCHEMA_HASH 0x{dictionary.schema_hash:08x}u\n\n"
        + "/* Members of brace_parameters_t, in its order. */\nenum {\n"
        + "\n".join(names)
        + f"\n    BRACE_PARAMETER_COUNT = {len(dictionary.parameters)}\n}};\n\n"
        + c_comment("Numbers that parameters have on the wire, from 0 on: half a Modbus register, and what CAN calls"
                    " them by. brace_parameter_index (brace/parameters.h) finds a number's member.")
        + f"enum {{ BRACE_PARAMETER_NUMBERS = {_numbers_count(dictionary)} }};\n\n"
        + "extern const uint16_t brace_parameter_indices[BRACE_PARAMETER_NUMBERS];\n\n#endif\n"
    )


def _numbers_count(dictionary: Dictionary) -> int:
    return max(entry.number for entry in dictionary.parameters) + 1


def _indices(dictionary: Dictionary) -> list[str]:
    """The member of each number; where there is none, the count of all."""
    index_of = {entry.number: entry.index for entry in dictionary.parameters}
    none = len(dictionary.parameters)
    return [f"{index_of.get(number, none)}," for number in range(_numbers_count(dictionary))]


def index_name(entry: Entry) -> str:
    """BRACE_PARAMETER_LINK_FEMUR_AXIAL_MM_PER_N"""
    return "BRACE_PARAMETER_" + entry.key.upper().replace(".", "_")


def table_source(dictionary: Dictionary) -> str:
    """generated/parameter_table.c"""
    entries = dictionary.parameters
    f32 = _distinct(c_range(entry) for entry in entries if entry.type == "f32")
    u32 = _distinct(c_range(entry) for entry in entries if entry.type == "u32" and not entry.numbers)
    lists = _distinct(_numbers(entry) for entry in entries if entry.numbers)
    rules = [
        (
            f32.index(c_range(entry))
            if entry.type == "f32"
            else len(f32) + len(u32) + lists.index(_numbers(entry))
            if entry.numbers
            else len(f32) + u32.index(c_range(entry))
        )
        for entry in entries
    ]
    longest = max(len(entry.numbers) for entry in entries)
    parts = [
        _MADE,
        '#include "parameter_table.h"\n\n#include <float.h>\n#include <math.h>\n#include <stddef.h>\n\n',
        f"_Static_assert(sizeof(brace_parameters_t) == 4 * {len(entries)}, \"the dictionary lists every member\");\n",
        *(
            f"_Static_assert(offsetof(brace_parameters_t, {entry.member}) == {4 * entry.index}, \"order\");\n"
            for entry in entries
        ),
        f"\nconst float brace_f32_range[{len(f32)}][2] = {{\n",
        *(f"    {{{low}, {high}}},\n" for low, high in f32),
        f"}};\n\nconst uint32_t brace_u32_range[{len(u32)}][2] = {{\n",
        *(f"    {{{low}, {high}}},\n" for low, high in u32),
        f"}};\n\nconst uint32_t brace_u32_choices[{len(lists)}][{longest}] = {{\n",
        *(f"    {{{values}}},\n" for values in lists),
        "};\n\n/* For each member: its range of floats, or of whole numbers after these, or its choices after "
        "those. */\n",
        f"const uint8_t brace_parameter_rule[{len(entries)}] = {{\n",
        *_wrapped([f"{rule}," for rule in rules]),
        "};\n\nconst brace_parameters_t brace_parameters_safe = {\n",
        *(f"    .{entry.member} = {_literal(entry)},\n" for entry in entries if entry.safe != 0),
        "};\n\nstatic const char *const keys[] = {\n",
        *(f'    "{entry.key}",\n' for entry in entries),
        "};\n\nstatic const char *const units[] = {\n",
        *_wrapped([f'"{entry.unit}",' for entry in entries]),
        "};\n\n",
        "const char *brace_parameter_key(uint32_t index)\n{\n"
        '    return index < BRACE_PARAMETER_COUNT ? keys[index] : "the limb as a whole";\n}\n\n',
        "const char *brace_parameter_unit(uint32_t index)\n{\n"
        '    return index < BRACE_PARAMETER_COUNT ? units[index] : "";\n}\n\n',
        "const uint16_t brace_parameter_indices[BRACE_PARAMETER_NUMBERS] = {\n",
        *_wrapped(_indices(dictionary)),
        "};\n\n",
        "uint32_t brace_parameter_number(uint32_t index)\n{\n"
        "    static const uint16_t number[BRACE_PARAMETER_COUNT] = {\n",
        *("    " + line for line in _wrapped([f"{entry.number}," for entry in entries])),
        "    };\n    return index < BRACE_PARAMETER_COUNT ? number[index] : (uint32_t)BRACE_PARAMETER_NUMBERS;\n}\n",
    ]
    return "".join(parts)


def table_header(dictionary: Dictionary) -> str:
    """generated/parameter_table.h: what the block's code reads; private to the interface."""
    entries = dictionary.parameters
    f32 = len(_distinct(c_range(entry) for entry in entries if entry.type == "f32"))
    u32 = len(_distinct(c_range(entry) for entry in entries if entry.type == "u32" and not entry.numbers))
    lists = len(_distinct(_numbers(entry) for entry in entries if entry.numbers))
    longest = max(len(entry.numbers) for entry in entries)
    return (
        _MADE
        + "#ifndef BRACE_PARAMETER_TABLE_H\n#define BRACE_PARAMETER_TABLE_H\n\n#include <stdint.h>\n\n"
        + '#include "brace/parameters.h"\n\n'
        + f"enum {{ BRACE_F32_RANGES = {f32}, BRACE_U32_RANGES = {u32}, BRACE_U32_LISTS = {lists}, "
        + f"BRACE_U32_LIST_MAX = {longest} }};\n\n"
        + "extern const float brace_f32_range[BRACE_F32_RANGES][2];\n"
        + "extern const uint32_t brace_u32_range[BRACE_U32_RANGES][2];\n"
        + "extern const uint32_t brace_u32_choices[BRACE_U32_LISTS][BRACE_U32_LIST_MAX]; /* 0 fills up */\n"
        + "extern const uint8_t brace_parameter_rule[BRACE_PARAMETER_COUNT];\n"
        + "extern const brace_parameters_t brace_parameters_safe;\n\n#endif\n"
    )


def _numbers(entry: Entry) -> str:
    return ", ".join(f"{number}u" for number in entry.numbers)


def _literal(entry: Entry) -> str:
    return f"{entry.safe}u" if entry.type == "u32" else c_float(float(entry.safe), True)


def _distinct(values: Iterable[T]) -> list[T]:
    return list(dict.fromkeys(values))


def _wrapped(items: Iterable[str]) -> list[str]:
    lines, line = [], "   "
    for item in items:
        if len(line) + 1 + len(item) > _COLUMNS:
            lines.append(line + "\n")
            line = "   "
        line += " " + item
    return [*lines, line + "\n"]
