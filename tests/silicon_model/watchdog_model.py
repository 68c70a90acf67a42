"""The independent watchdog (RM0090 chapter 21)."""

from __future__ import annotations

from chip import Chip


class Iwdg:
    BASE = 0x40003000

    def __init__(self, chip: Chip, lsi_hz: float = 32_000.0) -> None:
        self.chip, self.lsi_hz = chip, lsi_hz
        self.prescaler, self.reload = 0, 0xFFF
        self.open = self.running = False
        self.update_reads = 0
        self.left_us = 0.0
        self.bites_at_us: list[float] = []
        self.feeds = 0
        chip.models[self.BASE] = self
        chip.waiting.append(self.advance)

    def patience_us(self) -> float:
        return (4 << self.prescaler) * (self.reload + 1) / self.lsi_hz * 1e6

    def advance(self, microseconds: float) -> None:
        if self.running:
            self.left_us -= microseconds
            if self.left_us <= 0:
                self.bites_at_us.append(self.chip.time_us)
                self.left_us = self.patience_us()

    def read(self, offset: int) -> int:
        if offset == 0x0C:
            self.update_reads = max(self.update_reads - 1, 0)
            return 3 if self.update_reads else 0
        return {0x04: self.prescaler, 0x08: self.reload}.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        note = self.chip.violations.append
        if offset == 0x00:
            self.open = value == 0x5555
            if value == 0xAAAA:
                if self.update_reads:
                    note("IWDG: reloaded before its new values are in")
                self.feeds += 1
                self.left_us = self.patience_us()
            elif value == 0xCCCC:
                self.running = True
                self.left_us = self.patience_us()
            elif value != 0x5555:
                note(f"IWDG: no such key 0x{value:x}")
        elif not self.open:
            note("IWDG: PR or RLR written without the access key")
        else:
            self.update_reads = 10
            if offset == 0x04:
                self.prescaler = value & 7
            elif offset == 0x08:
                self.reload = value & 0xFFF
