"""Packing and unpacking, by the firmware's own C."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from brace.ground.errors import BadFileError, VersionMismatchError
from brace.ground.files import read_bytes
from brace.model import LimbModel, load_limb
from brace.native import Library, library
from brace.native.c_data import CData
from brace.native.limb import refused_limb, status_text
from brace.params.values import Rounded, model_of, words_of
from brace.wire.names import PARAMETERS, SCHEMA_HASH

WHAT = "parameter block"
MAGIC = b"BRCE"
_LIMIT_BYTES = 1 << 20
_E_MAGIC, _E_FORMAT, _E_SCHEMA = -10, -11, -14
_OUT_OF_RANGE = (-2, -5)


@dataclass(frozen=True)
class Block:
    """A set of parameters as a controller holds it."""

    content: bytes
    words: "array[int]" = field(repr=False)  # 32 bits for each parameter
    sequence: int
    identity: int  # CRC-32 of schema and values, whatever the sequence: what the controller reports
    rounded: Sequence[Rounded] = ()

    @property
    def model(self) -> LimbModel:
        """As a limb model."""
        return model_of(self.words)


def pack(model: LimbModel, sequence: int = 1) -> Block:
    """The block of a limb model; refused with file:line when the firmware would refuse it."""
    native = library()
    _refuse_other_library(native)
    words, rounded = words_of(model)
    parameters = native.ffi.new("brace_parameters_t *")
    native.ffi.memmove(parameters, words, words.itemsize * len(words))
    wrong = native.ffi.new("uint32_t *")
    status = native.lib.brace_parameters_check(parameters, wrong)
    if status != 0:
        raise _refused_value(native, model, int(status), int(wrong[0]))
    content = native.ffi.new("uint8_t[]", int(native.lib.BRACE_BLOCK_BYTES))
    status = native.lib.brace_parameters_pack(parameters, sequence, content, len(content))
    if status != 0:
        raise BadFileError("the firmware does not pack this", where=model.where(), why=status_text(native, status))
    identity = int(native.lib.brace_parameters_crc(parameters))
    return Block(bytes(native.ffi.buffer(content)), words, sequence, identity, tuple(rounded))


def unpack(content: bytes, where: str) -> Block:
    """A block's values; `where` names it in refusals."""
    native = library()
    _refuse_other_library(native)
    parameters = native.ffi.new("brace_parameters_t *")
    sequence, wrong = native.ffi.new("uint32_t *"), native.ffi.new("uint32_t *")
    status = native.lib.brace_parameters_unpack(content, len(content), parameters, sequence, wrong)
    if status != 0:
        raise _refused_block(native, content, where, int(status), int(wrong[0]))
    words = array("I", bytes(native.ffi.buffer(parameters)))
    return Block(content, words, int(sequence[0]), int(native.lib.brace_parameters_crc(parameters)))


def read_block(path: Path) -> Block:
    """A block from a file."""
    return unpack(read_bytes(path, _LIMIT_BYTES, WHAT), str(path))


def read_either(path: Path) -> Block:
    """A block, or a limb.toml as a controller would hold it; distinguished by the block's first bytes."""
    if read_bytes(path, _LIMIT_BYTES, "limb model or parameter block").startswith(MAGIC):
        return read_block(path)
    return pack(load_limb(path))


def _refuse_other_library(native: Library) -> None:
    """The library's own defaults, packed, show its schema."""
    safe = native.ffi.new("brace_parameters_t *")
    content = native.ffi.new("uint8_t[]", int(native.lib.BRACE_BLOCK_BYTES))
    native.lib.brace_parameters_default(safe)
    native.lib.brace_parameters_pack(safe, 0, content, len(content))
    built = int.from_bytes(bytes(content[8:12]), "little")
    if built != SCHEMA_HASH:
        raise VersionMismatchError(
            f"names of schema {SCHEMA_HASH:08x}, library of schema {built:08x}",
            where=str(native.path),
            why="the list of parameters has changed between them",
            next_step="./dev setup builds it anew",
        )


def _refused_value(native: Library, model: LimbModel, status: int, wrong: int) -> BadFileError:
    if wrong >= len(PARAMETERS):
        return refused_limb(native, model, status)
    parameter = PARAMETERS[wrong]
    return BadFileError(
        f"{parameter.key} = {model.values[parameter.key]} is not allowed",
        where=model.where(parameter.key),
        why=f"the firmware refuses it; {parameter.key.rpartition('.')[2]} is {parameter.description}",
        next_step=_ranges(native, parameter.key, model),
    )


def _ranges(native: Library, key: str, model: LimbModel) -> str:
    """What to write instead, where the value is in its own range and at odds with another one."""
    table = key.rpartition(".")[0]
    other = {
        "torque_noise_n_mm": f"{table}.torque_range_n_mm",
        "torque_bias_n_mm": f"{table}.torque_range_n_mm",
        "takeup_torque_n_mm": f"{table}.torque_range_n_mm",
        "angle_max_rad": f"{table}.angle_min_rad",
        "age_limit_us": "controller.tick_us",
    }.get(key.rpartition(".")[2])
    if other is None:
        return f"see docs/limb-keys.md for the range of {key}"
    return f"{'more than' if key.endswith(('max_rad', 'limit_us')) else 'at most'} {other} = {model.values[other]}"


def _refused_block(native: Library, content: bytes, where: str, status: int, wrong: int) -> Exception:
    header: CData = native.ffi.new("brace_block_header_t *")
    if status == _E_SCHEMA and native.lib.brace_block_header(content, len(content), header) == 0:
        return VersionMismatchError(
            f"a block of schema {header.schema_hash:08x}, where {SCHEMA_HASH:08x} is understood",
            where=where,
            why="it was packed for a firmware with another list of parameters; its CRC is right",
            next_step="pack it anew from its limb.toml, or use the brace of that firmware's version",
        )
    if status == _E_FORMAT:
        return VersionMismatchError(
            "a parameter block of another format",
            where=where,
            why=status_text(native, status),
            next_step="use the brace of the firmware's version",
        )
    if status in _OUT_OF_RANGE:
        name = PARAMETERS[wrong].key if wrong < len(PARAMETERS) else "the limb as a whole"
        return BadFileError(
            f"the block's {name} is not allowed",
            where=where,
            why=status_text(native, status) + "; its CRC is right, so it was packed so",
            next_step="pack it anew from its limb.toml",
        )
    return BadFileError(
        f"not a {WHAT}" if status == _E_MAGIC else f"a broken {WHAT} of {len(content)} bytes",
        where=where,
        why=status_text(native, status),
        next_step="check that this is the file; brace params pack makes one from a limb.toml",
    )
