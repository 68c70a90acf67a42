"""Between a limb model and the words of the firmware's struct: 32-bit floats and whole numbers."""

from __future__ import annotations

import math
from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from brace.ground.errors import BadFileError
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME
from brace.toml import Value
from brace.wire.names import OF_THE_MODEL, PARAMETERS
from brace.wire.parameter import Parameter

_HALF_STEP = 2.0**-24  # of a 32-bit float: what rounding may change, of the value


@dataclass(frozen=True)
class Rounded:
    """A value that a 32-bit float can only hold with fewer digits than half a step allows (below 1e-38)."""

    key: str
    given: float
    held: float


def words_of(model: LimbModel) -> tuple["array[int]", list[Rounded]]:
    """One 32-bit word for each parameter, in the block's order; and what was rounded by more than usual."""
    words = array("I", [0] * len(PARAMETERS))
    rounded: list[Rounded] = []
    for parameter in PARAMETERS:
        if parameter.texts:
            words[parameter.index] = parameter.texts.index(str(model.values[parameter.key]))
            continue
        value = model.number(parameter.key)
        if parameter.type == "u32":
            words[parameter.index] = int(value)
            continue
        single = array("f", [value + 0.0])  # -0 is 0
        if math.isinf(single[0]) and not math.isinf(value):
            raise BadFileError(
                f"{parameter.key} = {value:g} is too large for the controller",
                where=model.where(parameter.key),
                why="it holds 32-bit floats, at most 3.4e38",
                next_step="write a smaller value" + (", or inf" if parameter.infinite else ""),
            )
        if math.isfinite(value) and abs(single[0] - value) > abs(value) * _HALF_STEP:
            rounded.append(Rounded(parameter.key, value, single[0]))
        words[parameter.index] = memoryview(single).cast("B").cast("I")[0]
    return words, rounded


def value_of(parameter: Parameter, word: int) -> float | int | str:
    """A word as limb.toml would write it: the shortest decimals that the controller reads as this very float."""
    if parameter.texts:
        return parameter.texts[word]
    if parameter.type == "u32":
        return int(word)
    import numpy as np  # it knows the shortest decimals of a 32-bit float

    single = np.uint32(word).view(np.float32)
    shortest = float(str(single))
    key = KEY_BY_NAME[parameter.key]
    return min(max(shortest, key.low), key.high)  # a bound's decimals may lie just outside of it


def model_of(words: Sequence[int]) -> LimbModel:
    """The limb model of a block's words; what equals the format's default is not marked as given."""
    values: dict[str, Value] = {"format": 1, "name": "", **{one.key: one.default or 0.0 for one in OF_THE_MODEL}}
    given = {"format"}
    for parameter in PARAMETERS:
        values[parameter.key] = value_of(parameter, words[parameter.index])
        if parameter.default is None:
            given.add(parameter.key)
    return LimbModel(values, frozenset(given))
