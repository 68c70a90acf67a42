"""The Python side: tools/brace/wire/names.py."""

from __future__ import annotations

from typing import Any

from interface.dictionary import Dictionary, Entry


def names_module(dictionary: Dictionary) -> str:
    """One `Parameter(...)` for each member of the block, in its order."""
    lines = [
        '"""Numbers of limb.toml by name. Written by tools/interface from dictionary.toml; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from math import inf",
        "",
        "from brace.wire.parameter import Parameter",
        "",
        f"SCHEMA_HASH = 0x{dictionary.schema_hash:08X}",
        "",
        "PARAMETERS: tuple[Parameter, ...] = (",
        *(line for entry in dictionary.parameters for line in _parameter(entry)),
        ")",
        "# Of the simulated limb alone: no controller keeps them.",
        "OF_THE_MODEL: tuple[Parameter, ...] = (",
        *(line for entry in dictionary.of_the_model for line in _parameter(entry)),
        ")",
    ]
    return "\n".join(lines) + "\n"


def _parameter(entry: Entry) -> list[str]:
    number: type = float if entry.type == "f32" else int
    fields: dict[str, Any] = {
        "unit": entry.unit,
        "low": number(entry.low),
        "high": number(entry.high),
        "default": entry.default if entry.default is None or entry.texts else number(entry.default),
        "safe": number(entry.safe),
    }
    if entry.type != "f32":
        fields["type"] = entry.type
    for name in ("open_low", "infinite", "ratio"):
        if getattr(entry, name):
            fields[name] = True
    for name in ("texts", "numbers"):
        if getattr(entry, name):
            fields[name] = getattr(entry, name)
    given = ", ".join(f"{name}={_shown(value)}" for name, value in fields.items())
    return [
        "    Parameter(",
        f"        {entry.index}, {entry.number}, {_shown(entry.key)}, {_shown(entry.member)},",
        f"        {given},",
        f"        description={_shown(entry.description)},",
        "    ),",
    ]


def _shown(value: Any) -> str:
    """repr with double quotes."""
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, tuple):
        return "(" + ", ".join(_shown(item) for item in value) + ",)"
    return repr(value)
