"""The simulated limb's side: its model as a C struct of doubles, and the table of its keys with ranges and defaults."""

from __future__ import annotations

import math
from collections.abc import Iterable

from interface.dictionary import LINKS, Dictionary, Entry

_MADE = "Written by tools/interface from dictionary.toml; do not edit."

# What a controller is sent of its motors, its noise, its calibration's trust and itself is no part of the limb.
_NOT_OF_THE_LIMB = ("motor", "controller", "uncertainty")
_NOISE = "sensor.noise_n"


def plant_entries(dictionary: Dictionary) -> list[Entry]:
    """The entries that describe the limb, side by side by their tables in limb.toml."""
    tables: dict[str, list[Entry]] = {}
    for entry in (*dictionary.parameters, *dictionary.of_the_model):
        if _kind(entry) not in _NOT_OF_THE_LIMB and entry.key != _NOISE:
            tables.setdefault(_kind(entry), []).append(entry)
    return [entry for entries in tables.values() for entry in entries]


def model_header(dictionary: Dictionary) -> str:
    """host_sim/api/brace_plant_model.h"""
    tables: dict[str, list[Entry]] = {}
    for entry in plant_entries(dictionary):
        fields = tables.setdefault(_kind(entry), [])
        if _field(entry) not in [_field(other) for other in fields]:
            fields.append(entry)
    structs = "".join(_struct(table, entries) for table, entries in tables.items())
    members = "".join(
        f"    brace_plant_{table}_t {table}{'[3]; /* coxa, femur, tibia */' if _is_repeated(entries[0]) else ';'}\n"
        for table, entries in tables.items()
    )
    return (
        f"/* The simulated limb's model: the tables and keys of limb.toml, one double each, with the range of each.\n"
        f" * What a key means: docs/limb-keys.md. {_MADE} */\n"
        "#ifndef BRACE_PLANT_MODEL_H\n#define BRACE_PLANT_MODEL_H\n\n"
        f"{structs}typedef struct {{\n{members}}} brace_plant_model_t;\n\n#endif\n"
    )


def key_table(dictionary: Dictionary) -> str:
    """host_sim/plant/model_key_table.h"""
    entries = plant_entries(dictionary)
    rows = "".join(
        f'    {{"{entry.key}", offsetof(brace_plant_model_t, {_member(entry)}),\n'
        f"     {_least(entry)}, {_most(entry)}, {_default(entry)}, {'true' if entry.texts else 'false'}}},\n"
        for entry in entries
    )
    return (
        f"// Every key of limb.toml that the simulated limb has. {_MADE}\n"
        "#pragma once\n\n#include <cfloat>\n#include <cmath>\n#include <cstddef>\n\n"
        '#include "api/brace_plant_model.h"\n\n'
        "namespace brace::plant {\n\n"
        "struct ModelKey {\n"
        "    const char *name;\n"
        "    std::size_t offset;\n"
        "    double least; // allowed, as `most` is\n"
        "    double most;\n"
        "    double zero_effect; // what limb.toml means when it is silent; of a length, the paper's\n"
        "    bool whole;\n"
        "};\n\n"
        f"inline constexpr ModelKey kModelKeys[] = {{\n{rows}}};\n\n"
        "static_assert(sizeof(kModelKeys) / sizeof(kModelKeys[0]) == sizeof(brace_plant_model_t) / sizeof(double),\n"
        '              "every double of the model has a key");\n\n'
        "} // namespace brace::plant\n"
    )


def _kind(entry: Entry) -> str:
    """`joint` of joint.femur.gap_rad."""
    return entry.key.partition(".")[0]


def _is_repeated(entry: Entry) -> bool:
    return entry.key.count(".") == 2 and entry.key.split(".")[1] in LINKS


def _field(entry: Entry) -> str:
    """The key's last part. Of a text the double holds the index."""
    return entry.key.rpartition(".")[2] + ("_index" if entry.texts else "")


def _member(entry: Entry) -> str:
    if _is_repeated(entry):
        return f"{_kind(entry)}[{LINKS.index(entry.key.split('.')[1])}].{_field(entry)}"
    return f"{_kind(entry)}.{_field(entry)}"


def _struct(table: str, entries: Iterable[Entry]) -> str:
    lines = "".join(f"    double {_field(entry)}; /* {_range(entry)} */\n" for entry in entries)
    return f"typedef struct {{\n{lines}}} brace_plant_{table}_t;\n\n"


def _range(entry: Entry) -> str:
    if entry.texts:
        return ", ".join(f"{index} {text}" for index, text in enumerate(entry.texts))
    left = "(" if entry.open_low or (math.isinf(entry.low) and not entry.infinite) else "["
    right = ")" if math.isinf(entry.high) and not entry.infinite else "]"
    return f"{left}{entry.low:g}, {entry.high:g}{right}"


def _least(entry: Entry) -> str:
    return "DBL_MIN" if entry.open_low else _double(entry.low, entry.infinite)


def _most(entry: Entry) -> str:
    return _double(entry.high, entry.infinite)


def _default(entry: Entry) -> str:
    """What limb.toml means when it is silent. No length means that nothing is there, so the controller's safe ones
    (the paper's limb) stand in."""
    if entry.texts:
        return _double(entry.texts.index(entry.default), True)
    return _double(entry.safe if _kind(entry) == "geometry" else entry.default, True)


def _double(value: float, infinite: bool) -> str:
    if math.isinf(value):
        return ("-" if value < 0 else "") + ("HUGE_VAL" if infinite else "DBL_MAX")
    return repr(float(value))
