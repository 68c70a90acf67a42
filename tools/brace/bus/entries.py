"""Entries of the dictionary by name: measured values and parameters, 32 bits each."""

from __future__ import annotations

import math
import struct

from brace.ground.errors import UsageError, did_you_mean
from brace.wire.measured import MEASURED
from brace.wire.names import PARAMETERS

_MEASURED = {entry.name: entry for entry in MEASURED}
_PARAMETERS = {parameter.key: parameter for parameter in PARAMETERS}


def index_of(name: str) -> int:
    """As the wire counts them."""
    if name in _MEASURED:
        return _MEASURED[name].index
    if name in _PARAMETERS:
        return _PARAMETERS[name].number
    leaves = [key for key in _PARAMETERS if key.endswith(f".{name}")]
    near = " or ".join(leaves) or did_you_mean(name, [*_MEASURED, *_PARAMETERS])
    raise UsageError(
        f"no entry {name!r}",
        where="--entry",
        why=f"there are {len(_MEASURED)} measured values and {len(_PARAMETERS)} parameters",
        next_step=f"did you mean {near}?" if near else "docs/protocol.md and docs/limb-keys.md list them",
    )


def unit_of(name: str) -> str:
    """Empty for plain numbers."""
    return _MEASURED[name].unit if name in _MEASURED else _PARAMETERS[name].unit


def value_of(name: str, bits: int) -> float | int | str | list[str] | None:
    """Number, name, list of names; None: not known."""
    kind = _MEASURED[name].type if name in _MEASURED else _PARAMETERS[name].type
    if kind == "f32":
        (value,) = struct.unpack("<f", struct.pack("<I", bits))
        return None if math.isnan(value) else float(value)
    if name in _PARAMETERS:
        texts = _PARAMETERS[name].texts
        return texts[bits] if bits < len(texts) else bits
    entry = _MEASURED[name]
    table = entry.codes
    if table is None or entry.numeric:
        return bits
    if table.is_bits:
        return list(table.names_of_bits(bits))
    code = table.find(bits)
    return bits if code is None else code.name.lower()


def number_of(name: str, bits: int) -> float:
    """The value of an entry that is a number; NaN: not known."""
    value = value_of(name, bits)
    if isinstance(value, (int, float)):
        return value
    if value is None:
        return math.nan
    raise TypeError(f"{name} is {value!r}, not a number")


def names_of(name: str, bits: int) -> list[str]:
    """The value of an entry that is a set of names."""
    value = value_of(name, bits)
    if isinstance(value, list):
        return value
    raise TypeError(f"{name} is {value!r}, not a set of names")
