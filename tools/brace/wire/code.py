"""A number's meanings, as the dictionary states them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache


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
        return self._by_number.get(number)

    def name_of(self, number: int) -> str:
        """The number's name, or its digits where it has none."""
        code = self.find(number)
        return str(number) if code is None else code.name

    def word_of(self, number: int) -> str:
        """The number's name in small letters, or its digits where it has none."""
        return self._words.get(number) or str(number)

    def names_of_bits(self, bits: int) -> tuple[str, ...]:
        """The names of the bits that are set; a bit without a name is named by its place."""
        return self._names_of_bits(bits)

    @cached_property
    def _names_of_bits(self) -> Callable[[int], tuple[str, ...]]:
        """Keeps the last answers: a controller says the same bits a hundred times a second."""
        return lru_cache(maxsize=64)(self._look_up_bits)

    def _look_up_bits(self, bits: int) -> tuple[str, ...]:
        found = ((place, self._by_number.get(place)) for place in range(bits.bit_length()) if bits >> place & 1)
        return tuple(f"BIT_{place}" if code is None else code.name for place, code in found)

    def texts_of(self, names: Iterable[str]) -> list[str]:
        """What each name means: "NAME: a sentence"."""
        return [f"{name}: {self.texts.get(name, 'not in this version of brace')}" for name in names]

    @cached_property
    def texts(self) -> Mapping[str, str]:
        """Name -> sentence."""
        return {code.name: code.text for code in self.codes}

    @cached_property
    def _by_number(self) -> Mapping[int, Code]:
        return {code.number % 256: code for code in self.codes} | {code.number: code for code in self.codes}

    @cached_property
    def _words(self) -> Mapping[int, str]:
        return {number: code.name.lower() for number, code in self._by_number.items()}

    @property
    def names(self) -> tuple[str, ...]:
        """All names, in the order of the dictionary: of bits, from bit 0 on."""
        return tuple(code.name for code in self.codes)
