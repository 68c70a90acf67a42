"""One measured value, as the dictionary states it."""

from __future__ import annotations

from dataclasses import dataclass

from brace.wire.code import CodeTable


@dataclass(frozen=True)
class MeasuredEntry:
    """Read only; 32 bits."""

    index: int  # for read_entry
    name: str
    type: str  # f32, u32
    unit: str
    codes: CodeTable | None = None  # what the number or its bits mean
    numeric: bool = False  # tools give the number, not its name
