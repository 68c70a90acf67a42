"""The C side of the codes: brace/codes.h, and codes.c with their names and sentences."""

from __future__ import annotations

import textwrap

from interface.c_comment import c_comment
from interface.codes import Code, Codes, Table

_MADE = "/* Written by tools/interface from dictionary.toml; do not edit. */\n"
_HEAD = """
/* What numbers mean: modes, faults, causes, next steps. Names and sentences for people: brace/code_names.h. The
 * constants of the other tables stand in hand-written headers; codes.c asserts that they agree with the dictionary. */
"""
_NAMES_HEAD = """
/* Names and sentences for numbers that mean something.
 *
 * brace_<table>_name gives the name of a number, brace_<table>_text the sentence that explains it; of bits, those of
 * the bit at that place. A number without a meaning has the name "?" and the text "?". Constant storage, never null.
 * Pure functions; any thread. An image that never asks carries no texts. */
#include <stdint.h>

"""


def codes_header(codes: Codes) -> str:
    """generated/brace/codes.h: constants alone."""
    parts = [_MADE, "#ifndef BRACE_CODES_H\n#define BRACE_CODES_H\n", _HEAD]
    parts += [
        "\n" + c_comment(table.description) + _constants(table)
        for table in codes.tables
        if not table.header and any(code.constant for code in table.codes)
    ]
    return "".join(parts) + "\n#endif\n"


def code_names_header(codes: Codes) -> str:
    """generated/brace/code_names.h"""
    functions = [f"const char *brace_{table.name}_{what}(int32_t number);\n"
                 for table in codes.tables for what in ("name", "text")]
    return "".join([_MADE, "#ifndef BRACE_CODE_NAMES_H\n#define BRACE_CODE_NAMES_H\n", _NAMES_HEAD, *functions,
                    "\n#endif\n"])


def _constants(table: Table) -> str:
    lines = [
        c_comment(code.text, "    ")
        + f"    {code.constant} = {_number(table, code)}{'' if code is table.codes[-1] else ','}\n"
        for code in table.codes
    ]
    head, tail = ("typedef enum {\n", f"}} {table.type};\n") if table.type else ("enum {\n", "};\n")
    return head + "".join(lines) + tail + _emergencies(table)


def _emergencies(table: Table) -> str:
    """How many faults there are, and the emergency code of each."""
    if any(code.emergency is None for code in table.codes):
        return ""
    upper = table.name.upper()
    rows = [f"X({code.constant}, {code.emergency:#06x})" for code in table.codes]
    return (
        f"enum {{ BRACE_{upper}_COUNT = {len(table.codes)} }};\n"
        + c_comment(f"X({table.name}, code) for every {table.name} in the order of the bits: its CANopen emergency code.")
        + f"#define BRACE_{upper}S(X) \\\n    " + " \\\n    ".join(rows) + "\n"
    )


def _number(table: Table, code: Code) -> str:
    return f"1u << {code.number}" if table.is_bits else str(code.number)


def codes_source(codes: Codes) -> str:
    """generated/codes.c"""
    headers = sorted({table.header for table in codes.tables if table.header})
    parts = [
        _MADE, '#include "brace/code_names.h"\n\n#include <stddef.h>\n\n',
        *(f'#include "{header}"\n' for header in headers),
        "\ntypedef struct {\n    int32_t number;\n    const char *name, *text;\n} meaning_t;\n\n",
        "static const meaning_t *find(const meaning_t *meanings, size_t count, int32_t number)\n{\n"
        '    static const meaning_t unknown = {0, "?", "?"};\n'
        "    for (size_t i = 0; i < count; i++) { /* the numbers of one table */\n"
        "        if (meanings[i].number == number) {\n            return &meanings[i];\n        }\n    }\n"
        "    return &unknown;\n}\n",
    ]
    for table in codes.tables:
        parts.append("\n")
        if table.header:
            parts += [
                f'_Static_assert((uint32_t){code.constant} == (uint32_t)({_number(table, code)}), "{table.name}");\n'
                for code in table.codes
            ]
        parts.append(f"static const meaning_t {table.name}_meanings[] = {{\n")
        parts += [f'    {{{code.number}, "{code.name}",\n     {_wrapped(code.text)}}},\n' for code in table.codes]
        parts.append("};\n")
        for what in ("name", "text"):
            parts.append(
                f"\nconst char *brace_{table.name}_{what}(int32_t number)\n{{\n"
                f"    enum {{ COUNT = sizeof {table.name}_meanings / sizeof *{table.name}_meanings }};\n"
                f"    return find({table.name}_meanings, COUNT, number)->{what};\n}}\n"
            )
    return "".join(parts)


def _wrapped(text: str) -> str:
    """A string literal over as many lines as it takes."""
    lines = textwrap.wrap(text, 108, drop_whitespace=False)
    return "\n     ".join(f'"{line}"' for line in lines)
