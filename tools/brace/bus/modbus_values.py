"""Which registers are read together, and their words as values."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence

from brace.wire.layout import Value
from brace.wire.measured import MEASURED
from brace.wire.register import Register
from brace.wire.registers import REGISTERS

_ONE_READ = 125  # registers that one request reads: values of one snapshot
_ENTRIES = {entry.name: entry for entry in MEASURED}
BY_NAME = {r.name: r for r in REGISTERS}
AT_ONCE = [r for r in REGISTERS if r.table == "input" and r.address + 2 <= _ONE_READ]
ASKED = [r for r in REGISTERS if r.table == "input" and r.address >= 4096]


def _between(first: str, last: str) -> list[Register]:
    """Input registers that lie together."""
    low, high = BY_NAME[first].address, BY_NAME[last].address
    return [r for r in REGISTERS if r.table == "input" and low <= r.address <= high]


SPACE = _between("k_is_in_space", "play_coxa")
DRIFT = _between("drift_state", "drift_next_step")
TAKE_UP_OF = _between("take_up_coxa", "take_up_tibia")
LOAD = _between("unloaded_k_xx", "unloaded_k_across")
ENGAGED = _between("engaged_k_xx", "engaged_k_zz")
SIGMA = _between("sigma_k_xx", "sigma_k_across")
INTERVAL = _between("force_x_low", "load_tibia_high")


def decoded(registers: Sequence[Register], words: Sequence[int]) -> dict[str, Value]:
    """The words of registers that lie together; None: not known."""
    first = registers[0].address
    values: dict[str, Value] = {}
    for register in registers:
        at = register.address - first
        raw = struct.pack(">2H", *words[at : at + 2])
        if register.type == "f32":
            (number,) = struct.unpack(">f", raw)
            values[register.name] = None if math.isnan(number) else number
        else:
            (number,) = struct.unpack(">I", raw)
            known = number != 0xFFFFFFFF or register.name in ("parameter_crc", "sequence", "dictionary_hash")
            values[register.name] = number if known else None
    return values


def code_word(name: str, values: Mapping[str, Value]) -> str:
    """The name of a value that is a code."""
    code = int(values[name] or 0)
    table = _ENTRIES[name].codes
    return str(code) if table is None else table.word_of(code)


def bit_names(name: str, values: Mapping[str, Value]) -> tuple[str, ...]:
    """The names of a value's bits."""
    table = _ENTRIES[name].codes
    return () if table is None else table.names_of_bits(int(values[name] or 0))
