"""A whole STM32F405 as far as the layer knows it, fresh out of reset."""

from __future__ import annotations

from collections.abc import Callable

from bxcan_model import Bus, Bxcan
from chip import Chip, Image
from clock_model import Rcc, Tim2, Tim5
from flash_model import Flash
from random_model import Rng
from supply_model import Pwr
from usart_model import Gpio
from watchdog_model import Iwdg


class Silicon:
    """A chip with every model there is, and calls of the image in Python's terms."""

    def __init__(self, image: Image, seed: int, crystal_hz: int | None, pll_locks: bool, csr: int,
                 lsi_hz: float) -> None:
        self.chip = Chip(image, seed)
        self.rcc = Rcc(self.chip, crystal_hz, pll_locks, csr)
        self.flash = Flash(self.chip, self.rcc)
        self.supply = Pwr(self.chip, self.rcc)
        self.random = Rng(self.chip, self.rcc, seed)
        self.timer = Tim2(self.chip, self.rcc)
        self.stopwatch = Tim5(self.chip, self.rcc, lsi_hz)
        self.watchdog = Iwdg(self.chip, lsi_hz)
        self.ports = {letter: Gpio(self.chip, letter) for letter in "ABCDEFGHI"}
        self.bus = Bus()
        self.can = Bxcan(self.chip, self.rcc, self.bus)

    def start(self, board: str = "board_8_mhz") -> None:
        self.chip.call("start", self.chip.image.symbols[board])

    def lose_crystal(self) -> None:
        """It stops; the processor takes the exception, if the chip raises it."""
        if self.rcc.crystal_stops():
            self.chip.call("nmi_handler")

    def __getattr__(self, name: str) -> Callable[..., int]:
        """Any function of the image."""
        return lambda *arguments: self.chip.call(name, *arguments)


Maker = Callable[..., Silicon]
