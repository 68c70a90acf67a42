"""One member of the controller's parameter block, as the dictionary states it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Parameter:
    """A key of limb.toml and its place in the block."""

    index: int  # in the block
    number: int  # what CAN calls it by; half its Modbus register
    key: str  # "link.femur.bending_mm_per_n"
    member: str  # of brace_parameters_t in C: "limb.link[1].bending_mm_per_n"
    unit: str
    low: float  # low <= value <= high; low < value when open_low
    high: float
    default: float | int | str | None  # limb.toml's; None: it must be given
    safe: float | int  # of a controller without a valid block
    type: str = "f32"  # or u32
    open_low: bool = False
    infinite: bool = False
    ratio: bool = False  # limb.toml may say true or false
    texts: tuple[str, ...] = ()  # limb.toml writes the u32 as one of these
    numbers: tuple[int, ...] = ()  # the u32 must be one of these
    description: str = ""
