"""Where two sets of parameters differ, as the controller would hold them."""

from __future__ import annotations

from dataclasses import dataclass

from brace.params.block import Block
from brace.params.values import value_of
from brace.wire.names import PARAMETERS


@dataclass(frozen=True)
class Difference:
    """One key with both values."""

    key: str
    unit: str
    first: float | int | str
    second: float | int | str


def differences(first: Block, second: Block) -> list[Difference]:
    """Keys whose 32 bits differ, in the block's order; 0 and -0 are the same."""
    found = []
    for parameter in PARAMETERS:
        words = [int(block.words[parameter.index]) for block in (first, second)]
        values = [value_of(parameter, word) for word in words]
        if words[0] != words[1] and values[0] != values[1]:
            found.append(Difference(parameter.key, parameter.unit, *values))
    return found
