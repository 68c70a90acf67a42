"""A number's meanings, as the dictionary tells them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Code:
    """One meaning, or one bit."""

    number: int  # of a bit: its place, from 0
    name: str
    text: str  # one sentence


@dataclass(frozen=True)
class CodeTable:
    """All meanings of one number."""

    name: str
    is_bits: bool
    codes: tuple[Code, ...]

    def find(self, number: int) -> Code | None:
        """The meaning of a number; a negative one may be given as 256 plus it, as an unsigned value carries it."""
        return next((code for code in self.codes if number in (code.number, code.number % 256)), None)

    def name_of(self, number: int) -> str:
        """The number's name, or its digits where it has none."""
        code = self.find(number)
        return str(number) if code is None else code.name

    def names_of_bits(self, bits: int) -> tuple[str, ...]:
        """The names of the bits that are set; a bit without a name is told by its place."""
        named = {code.number: code.name for code in self.codes}
        return tuple(named.get(place, f"BIT_{place}") for place in range(bits.bit_length()) if bits >> place & 1)

    def texts_of(self, names: Iterable[str]) -> list[str]:
        """What each name means: "NAME: a sentence"."""
        said = {code.name: code.text for code in self.codes}
        return [f"{name}: {said.get(name, 'not in this version of brace')}" for name in names]

    @property
    def names(self) -> tuple[str, ...]:
        """All names, in the order of the dictionary: of bits, from bit 0 on."""
        return tuple(code.name for code in self.codes)
