"""One Modbus value, as the dictionary states it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Register:
    """Two registers, high word first."""

    name: str
    table: str  # input, holding
    address: int  # as in the frame, from 0
    type: str  # f32, u32
    unit: str
    access: str  # ro, rw, wo
