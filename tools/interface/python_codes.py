"""The Python side of the codes: tools/brace/wire/codes.py."""

from __future__ import annotations

from interface.codes import Codes


def codes_module(codes: Codes) -> str:
    """One `CodeTable(...)` for each table."""
    lines = [
        '"""What numbers on the wire mean. Written by tools/interface from dictionary.toml; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from brace.wire.code import Code, CodeTable",
    ]
    for table in codes.tables:
        lines += ["", f"# {table.description}", f'{table.name.upper()} = CodeTable("{table.name}", {table.is_bits}, (']
        lines += [f'    Code({code.number}, "{code.name}", "{code.text}"),' for code in table.codes]
        lines.append("))")
    listed = [f"    {table.name.upper()}," for table in codes.tables]
    return "\n".join([*lines, "", "TABLES = {table.name: table for table in (", *listed, ")}"]) + "\n"
