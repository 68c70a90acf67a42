"""A model as the parameter block that a controller keeps: packed by the firmware's own C."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from brace.errors import BadFileError
from brace.model import LimbModel
from brace.native.limb import status_text
from brace.native.loader import Library
from brace.wire.names import PARAMETERS

_ROOM = 8192


def parameter_block(native: Library, model: LimbModel, changes: Mapping[str, float] | None = None) -> bytes:
    """The block, sequence 1. `changes` (by key) go before the model's values."""
    parameters = native.ffi.new("brace_parameters_t *")
    words = native.ffi.buffer(parameters)
    numbers = np.frombuffer(words, dtype=np.float32)
    counts = np.frombuffer(words, dtype=np.uint32)
    for parameter in PARAMETERS:
        value: Any = (changes or {}).get(parameter.key, model.values.get(parameter.key, parameter.default))
        if isinstance(value, str):
            value = parameter.texts.index(value)
        (counts if parameter.type == "u32" else numbers)[parameter.index] = value
    block = native.ffi.new("uint8_t[]", _ROOM)
    status = native.lib.brace_parameters_pack(parameters, 1, block, _ROOM)
    if status != 0:
        wrong = native.ffi.new("uint32_t *", len(PARAMETERS))
        native.lib.brace_parameters_check(parameters, wrong)
        key = PARAMETERS[wrong[0]].key if wrong[0] < len(PARAMETERS) else "link"
        raise BadFileError(
            f"the controller refuses this limb: {key}",
            where=model.where(key),
            why=status_text(native, status),
            next_step="docs/calibrate.md lists the keys with their ranges",
        )
    header = native.ffi.new("brace_block_header_t *")
    native.lib.brace_block_header(block, _ROOM, header)
    return bytes(native.ffi.buffer(block, header.block_bytes))
