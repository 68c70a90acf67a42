"""Entries of the dictionary by name: measured values and parameters, 32 bits each."""

from __future__ import annotations

import math
import struct
from typing import Any

from brace.errors import UsageError, did_you_mean
from brace.wire.measured import MEASURED
from brace.wire.names import PARAMETERS

_MEASURED = {entry.name: entry for entry in MEASURED}
_PARAMETERS = {parameter.key: parameter for parameter in PARAMETERS}


def index_of(name: str) -> int:
    """As the wire counts them."""
    if name in _MEASURED:
        return _MEASURED[name].index
    if name in _PARAMETERS:
        return _PARAMETERS[name].index
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


def value_of(name: str, bits: int) -> Any:
    """Number, name, list of names; None: not known."""
    kind = _MEASURED[name].type if name in _MEASURED else _PARAMETERS[name].type
    if kind == "f32":
        (value,) = struct.unpack("<f", struct.pack("<I", bits))
        return None if math.isnan(value) else float(value)
    if name in _PARAMETERS:
        texts = _PARAMETERS[name].texts
        return texts[bits] if bits < len(texts) else bits
    entry = _MEASURED[name]
    if entry.bit_names:
        return [text for bit, text in enumerate(entry.bit_names) if bits >> bit & 1]
    return entry.names[bits].lower() if bits < len(entry.names) else bits
