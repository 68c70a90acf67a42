"""The boards there are images for."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Board:
    """Where an image goes. Emulated boards, which have a `machine`, are started with it instead of written."""

    name: str
    chip: str
    flash_start: int
    flash_bytes: int  # that an image may take; what lies behind is the parameter store's
    ram_start: int
    ram_bytes: int
    openocd_target: str = ""
    machine: str = ""


BOARDS = {
    board.name: board
    for board in (
        Board(
            "stm32f405", "STM32F405RG", 0x08000000, 768 * 1024, 0x20000000, 128 * 1024,
            openocd_target="target/stm32f4x.cfg",
        ),
        Board(
            "netduinoplus2", "STM32F405, emulated", 0x08000000, 768 * 1024, 0x20000000, 128 * 1024,
            machine="netduinoplus2",
        ),
        Board(
            "mps2-an386", "Cortex-M4F, emulated", 0x00000000, 768 * 1024, 0x20000000, 128 * 1024,
            machine="mps2-an386",
        ),
    )
}  # fmt: skip
