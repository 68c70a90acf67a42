"""Power control (RM0090 5.4): the detector of a falling supply."""

from __future__ import annotations

from chip import Chip
from clock_model import Rcc

THRESHOLD_V = (2.0, 2.1, 2.3, 2.5, 2.6, 2.7, 2.8, 2.9)  # of PLS


class Pwr:
    BASE = 0x40007000

    def __init__(self, chip: Chip, rcc: Rcc) -> None:
        self.chip, self.rcc = chip, rcc
        self.cr = 0x00004000  # reset value
        self.supply_v = 3.3
        chip.models[self.BASE] = self

    def threshold_v(self) -> float | None:
        """None: the detector is off."""
        return THRESHOLD_V[self.cr >> 5 & 7] if self.cr >> 4 & 1 else None

    def read(self, offset: int) -> int:
        self._needs_clock()
        if offset == 0x04:
            threshold = self.threshold_v()
            return (threshold is not None and self.supply_v < threshold) << 2
        return self.cr

    def write(self, offset: int, value: int) -> None:
        self._needs_clock()
        if offset == 0x00:
            if (value ^ self.cr) & ~0xF0:
                self.chip.violations.append("PWR: bits changed that are none of the detector's")
            if value >> 4 & 1 and (value ^ self.cr) >> 5 & 7:
                self.chip.violations.append("PWR: the detector's level changed in the write that switches it on")
            self.cr = value

    def _needs_clock(self) -> None:
        if not self.rcc.enabled(0x40, 28):
            self.chip.violations.append("PWR: used without its clock")
