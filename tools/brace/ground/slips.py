"""Slips of the pen in numbers: what stands there, and the number that was probably meant."""

from __future__ import annotations

import re

_DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212\ufe63\uff0d"  # hyphens, dashes and minus signs that are no ASCII '-'
_TO_ASCII = str.maketrans(dict.fromkeys(_DASHES, "-"))
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")


def slip(text: str) -> tuple[str, str]:
    """Why a text is no number and the number it was to be, or two empty strings where nobody knows."""
    text = text.strip()
    plain = text.translate(_TO_ASCII)
    pointed = plain.replace(",", ".") if _DECIMAL_COMMA.fullmatch(plain) else plain
    if pointed == text or not _NUMBER.fullmatch(pointed):
        return "", ""
    if plain == text:
        return "the decimal sign is a point", pointed
    sign = next(character for character in text if character in _DASHES)
    return f"its minus sign is a typographic one (U+{ord(sign):04X})", pointed
