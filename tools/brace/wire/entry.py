"""One measured value, as the dictionary tells it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class MeasuredEntry:
    """Read only; 32 bits."""

    index: int  # for read_entry
    name: str
    type: str  # f32, u32
    unit: str
    names: tuple[str, ...]
    bit_names: tuple[str, ...]
