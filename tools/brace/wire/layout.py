"""Bytes of a frame <-> named values: the layouts that the dictionary's frames have."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from brace.wire.code import CodeTable

Value = float | int | None


@dataclass(frozen=True)
class Field:
    """A run of bits, least significant first."""

    name: str
    start: int
    bits: int
    kind: str = "number"  # value: steps of a unit, None where not known; f32: a float's bits
    signed: bool = False
    step: float = 1.0
    unit: str = ""
    codes: CodeTable | None = None  # what the number or its bits mean

    @property
    def names(self) -> Mapping[int, str]:
        """The number's meanings; empty: it has none, or they are its bits'."""
        if self.codes is None or self.codes.is_bits:
            return {}
        return {code.number if self.signed else code.number % 256: code.name for code in self.codes.codes}

    @property
    def bit_names(self) -> tuple[str, ...]:
        """The names of the bits, from bit 0 on; empty: they have none."""
        return tuple(code.name for code in self.codes.codes) if self.codes is not None and self.codes.is_bits else ()

    @property
    def is_whole_float(self) -> bool:
        """A float that begins with a byte."""
        return self.kind == "f32" and self.start % 8 == 0

    def decoder(self) -> Callable[[int], Value]:
        """A function: bits of a frame -> value in its unit; None: not known. Made once, because frames come by the
        thousand a second."""
        start, mask = self.start, (1 << self.bits) - 1
        per_unit = round(1.0 / self.step, 9)  # steps: 13 / 50000 is 0.00026, and 13 * 2e-05 0.00026000000000000003
        negative = 1 << (self.bits - 1) if self.signed else mask + 1  # codes from here on
        unknown = negative if self.signed else mask

        def f32(frame_bits: int) -> Value:
            (value,) = struct.unpack("<f", struct.pack("<I", frame_bits >> start & mask))
            return None if math.isnan(value) else float(value)

        def value(frame_bits: int) -> Value:
            code = frame_bits >> start & mask
            if code == unknown:
                return None
            return (code if code < negative else code - mask - 1) / per_unit

        def number(frame_bits: int) -> Value:
            code = frame_bits >> start & mask
            return code if code < negative else code - mask - 1

        return {"f32": f32, "value": value}.get(self.kind, number)

    def encode(self, value: Value) -> int:
        """Bits in place. ValueError outside the range."""
        mask = (1 << self.bits) - 1
        if self.kind == "f32":
            (code,) = struct.unpack("<I", struct.pack("<f", math.nan if value is None else value))
            return int(code) << self.start
        if value is None or (isinstance(value, float) and math.isnan(value)):
            if self.kind != "value":
                raise ValueError(f"{self.name}: a number is wanted")
            code = 1 << (self.bits - 1) if self.signed else mask
            return code << self.start
        code = round(value / self.step)
        low = -(1 << (self.bits - 1)) if self.signed else 0
        high = (1 << (self.bits - 1)) - 1 if self.signed else mask
        if self.kind == "value":
            low, high = low + self.signed, high - (not self.signed)
        if not low <= code <= high:
            raise ValueError(
                f"{self.name}: {value} {self.unit} does not fit ({low * self.step:g} to {high * self.step:g})"
            )
        return (code & mask) << self.start


class _Floats:
    """All floats of a frame in one call, for a CAN FD frame has a dozen."""

    def __init__(self, fields: Iterable[Field]) -> None:
        ordered, at, pattern = sorted(fields, key=lambda item: item.start), 0, "<"
        for item in ordered:
            pattern += f"{item.start // 8 - at}xf"
            at = item.start // 8 + 4
        self.names = tuple(item.name for item in ordered)
        self._pattern = struct.Struct(pattern)

    def unpacked(self, data: bytes) -> tuple[float, ...]:
        """In the order of the names."""
        return self._pattern.unpack_from(data)


@dataclass(frozen=True)
class Layout:
    """One frame."""

    name: str
    identifier: int  # of node 0
    command: int | None  # first byte of requests and answers
    fields: tuple[Field, ...]
    size: int = 8  # bytes; more: CAN FD
    part: int | None = None  # of a multiplexed message
    part_at: int = 0  # the first bit of the part's number

    def codes_of(self, name: str) -> CodeTable:
        """What a field's number or bits mean. KeyError for a field without a meaning."""
        return self._codes[name]

    def decode(self, data: bytes) -> dict[str, Value]:
        """Name -> value."""
        whole = data[: self.size].ljust(self.size, b"\0")
        bits = int.from_bytes(whole, "little")
        values: dict[str, Value] = dict.fromkeys(self._names)
        for name, value in zip(self._floats.names, self._floats.unpacked(whole), strict=True):
            if value == value:  # not NaN, which means not known
                values[name] = value
        for name, decode in self._decoders:
            values[name] = decode(bits)
        return values

    @cached_property
    def _codes(self) -> Mapping[str, CodeTable]:
        return {item.name: item.codes for item in self.fields if item.codes is not None}

    @cached_property
    def _names(self) -> tuple[str, ...]:
        return tuple(item.name for item in self.fields)

    @cached_property
    def _floats(self) -> _Floats:
        return _Floats(item for item in self.fields if item.is_whole_float)

    @cached_property
    def _decoders(self) -> tuple[tuple[str, Callable[[int], Value]], ...]:
        return tuple((item.name, item.decoder()) for item in self.fields if not item.is_whole_float)

    def encode(self, values: Mapping[str, Value], token: int = 0) -> bytes:
        """`size` bytes. KeyError for a field that is missing, ValueError for one that does not fit."""
        bits = 0 if self.command is None else self.command | (token & 0xFF) << 8
        bits |= (self.part or 0) << self.part_at
        for item in self.fields:
            bits |= item.encode(values[item.name])
        return bits.to_bytes(self.size, "little")
