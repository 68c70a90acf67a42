"""RCC, flash access time and TIM2: what clocks the registers really make (RM0090 3.5, 7.2, 7.3, 18.4)."""

from __future__ import annotations

from collections.abc import Callable

from chip import Chip

HSI_HZ = 16_000_000


class Rcc:
    """Reset values of 7.3; oscillators start after a few polls, if they start."""

    BASE = 0x40023800

    def __init__(self, chip: Chip, crystal_hz: int | None = 8_000_000, pll_locks: bool = True,
                 csr: int = 0x0E000000) -> None:
        self.chip, self.crystal_hz, self.pll_locks = chip, crystal_hz, pll_locks
        self.registers = {0x00: 0x83, 0x04: 0x24003010, 0x08: 0, 0x0C: 0, 0x20: 0,
                          0x30: 0x00100000, 0x34: 0, 0x40: 0, 0x44: 0, 0x74: csr}
        self.wait_states = 0
        self.on_reset: dict[tuple[int, int], Callable[[], None]] = {}  # of a peripheral: (register, bit)
        self.ready_in = {17: 0, 25: 0}  # HSERDY, PLLRDY: polls left
        chip.models[self.BASE] = self

    def read(self, offset: int) -> int:
        value = self.registers.get(offset, 0)
        if offset == 0x00:
            value &= ~(1 << 17 | 1 << 25)
            if value >> 16 & 1 and self.crystal_hz and self._counted(17):
                value |= 1 << 17
            if value >> 24 & 1 and self.pll_locks and self._pll_source() and self._counted(25):
                value |= 1 << 25
        if offset == 0x74:
            value = value & ~2 | (value & 1) << 1  # LSIRDY
        if offset == 0x08:
            value = value & ~0xC | (value & 3) << 2
        return value

    def crystal_stops(self) -> bool:
        """What the clock security system makes of it (7.2.7). returns whether the processor gets its NMI"""
        watched = bool(self.registers[0x00] >> 19 & 1)
        self.crystal_hz = None
        if watched:
            self.registers[0x00] &= ~(1 << 16 | 1 << 19 | 1 << 24)  # HSEON, CSSON, PLLON
            self.registers[0x08] &= ~3  # HSI
            self.registers[0x0C] |= 1 << 7  # CSSF
        return watched

    def _counted(self, bit: int) -> bool:
        self.ready_in[bit] = max(self.ready_in[bit] - 1, 0)
        return self.ready_in[bit] == 0

    def _pll_source(self) -> int:
        return (self.crystal_hz or 0) if self.registers[0x04] >> 22 & 1 else HSI_HZ

    def write(self, offset: int, value: int) -> None:
        old = self.registers.get(offset, 0)
        if offset == 0x00:
            if value >> 16 & 1 and not old >> 16 & 1:
                self.ready_in[17] = 50
            if value >> 24 & 1 and not old >> 24 & 1:
                self.ready_in[25] = 20
            if not value & 1 and self.registers[0x08] & 3 == 0:
                self.chip.violations.append("RCC: HSI switched off under the processor")
        if offset == 0x04:
            if self.registers[0x00] >> 24 & 1:
                self.chip.violations.append("RCC: PLLCFGR written while the PLL is on (7.3.2)")
            if value & 0xF0BC8000 != old & 0xF0BC8000:
                self.chip.violations.append("RCC: reserved bits of PLLCFGR changed")
        for (register, bit), reset in self.on_reset.items():
            if register == offset and value >> bit & 1:
                reset()
        if offset == 0x74 and value >> 24 & 1:
            value &= 0x00FFFFFF
        if offset == 0x0C:
            value = (old & ~(1 << 7) if value >> 23 & 1 else old) & 0xFF | value & 0xFF00
        self.registers[offset] = value
        if offset in (0x08, 0x04, 0x00):
            self.check()

    def clocks(self) -> dict[str, float]:
        """The clocks in force [Hz]."""
        pll, config = self.registers[0x04], self.registers[0x08]
        divider, multiplier, post = pll & 0x3F, pll >> 6 & 0x1FF, 2 * ((pll >> 16 & 3) + 1)
        vco_in = self._pll_source() / max(divider, 1)
        source = {0: HSI_HZ, 1: self.crystal_hz or 0, 2: vco_in * multiplier / post}[config & 3]
        ahb = config >> 4 & 0xF
        core = source / (1 if ahb < 8 else (2, 4, 8, 16, 64, 128, 256, 512)[ahb - 8])
        bus = [core / (1 if code < 4 else 2 ** (code - 3)) for code in (config >> 10 & 7, config >> 13 & 7)]
        timer = bus[0] if config >> 10 & 7 < 4 else 2 * bus[0]
        return {"core": core, "apb1": bus[0], "apb2": bus[1], "timer": timer, "vco_in": vco_in,
                "vco": vco_in * multiplier}

    def check(self) -> None:
        """Limits of 7.3.2 and of the data sheet's general operating conditions at 2.7-3.6 V."""
        clocks = self.clocks()
        note = self.chip.violations.append
        if self.registers[0x08] & 3 == 2:
            if not 0.95e6 <= clocks["vco_in"] <= 2.1e6:
                note(f"RCC: {clocks['vco_in']} Hz into the PLL, 1-2 MHz allowed")
            if not 100e6 <= clocks["vco"] <= 432e6 or self.registers[0x04] >> 24 & 0xF < 2:
                note(f"RCC: the PLL's oscillator at {clocks['vco']} Hz, 100-432 MHz allowed")
        if clocks["core"] > 168e6 or clocks["apb1"] > 42e6 or clocks["apb2"] > 84e6:
            note(f"RCC: too fast: {clocks}")
        if clocks["core"] > 30e6 * (self.wait_states + 1):
            note(f"flash: {self.wait_states} wait states at {clocks['core']} Hz (table 10)")

    def enabled(self, offset: int, bit: int) -> bool:
        return bool(self.registers[offset] >> bit & 1)


class Tim2:
    """The counter; prescaler taken over by EGR.UG, each read takes time."""

    BASE = 0x40000000

    def __init__(self, chip: Chip, rcc: Rcc) -> None:
        self.chip, self.rcc = chip, rcc
        self.prescaler = self.waiting_prescaler = self.reload = 0
        self.running = False
        self.ticks = 0.0
        self.read_takes_us = 1.0
        chip.models[self.BASE] = self
        chip.waiting.append(self.advance)

    def advance(self, microseconds: float) -> None:
        if self.running:
            self.ticks += microseconds * self.rcc.clocks()["timer"] / 1e6 / (self.prescaler + 1)

    def read(self, offset: int) -> int:
        if offset == 0x24:
            self.chip.pass_us(self.read_takes_us)
            return int(round(self.ticks, 6)) % (self.reload + 1)
        return 0

    def write(self, offset: int, value: int) -> None:
        if not self.rcc.enabled(0x40, 0):
            self.chip.violations.append("TIM2: written without its clock")
        elif offset == 0x00:
            self.running = bool(value & 1)
        elif offset == 0x14 and value & 1:
            self.prescaler, self.ticks = self.waiting_prescaler, 0.0
        elif offset == 0x28:
            self.waiting_prescaler = value & 0xFFFF
        elif offset == 0x2C:
            self.reload = value


class Tim5:
    """Input capture of channel 4, which the LSI can be led to (18.4, 19.4.21)."""

    BASE = 0x40000C00

    def __init__(self, chip: Chip, rcc: Rcc, lsi_hz: float) -> None:
        self.chip, self.rcc, self.lsi_hz = chip, rcc, lsi_hz
        self.registers: dict[int, int] = {}
        self.now_us = self.next_us = 0.0
        self.captured: int | None = None
        self.captures = True
        chip.models[self.BASE] = self
        chip.waiting.append(self.advance)

    def _is_capturing(self) -> bool:
        wired = self.registers.get(0x50, 0) >> 6 & 3 == 1
        selected = self.registers.get(0x1C, 0) >> 8 & 3 == 1
        return bool(self.registers.get(0x00, 0) & 1 and self.registers.get(0x20, 0) >> 12 & 1 and wired and selected)

    def advance(self, microseconds: float) -> None:
        self.now_us += microseconds
        if not self._is_capturing() or not self.captures:
            self.next_us = self.now_us
            return
        while self.next_us <= self.now_us:
            ticks = self.next_us * self.rcc.clocks()["timer"] / 1e6 / (self.registers.get(0x28, 0) + 1)
            self.captured = int(ticks) & 0xFFFFFFFF
            self.next_us += 1e6 / self.lsi_hz * (1 << (self.registers[0x1C] >> 10 & 3))

    def read(self, offset: int) -> int:
        if offset == 0x10:
            return (self.captured is not None) << 4
        if offset == 0x40:
            value, self.captured = self.captured or 0, None
            return value
        return self.registers.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if not self.rcc.enabled(0x40, 3):
            self.chip.violations.append("TIM5: written without its clock")
        self.registers[offset] = value
