"""A USART (RM0090 chapter 30) and the pins that matter to it: baud, parity, order, the RS-485 drive line."""

from __future__ import annotations

from collections import deque

from chip import Chip


class Gpio:
    """One port: what is written to it, and its outputs."""

    def __init__(self, chip: Chip, letter: str) -> None:
        self.registers: dict[int, int] = {}
        self.outputs = 0
        chip.models[0x40020000 + 0x400 * (ord(letter) - ord("A"))] = self

    def read(self, offset: int) -> int:
        return self.registers.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == 0x18:
            self.outputs = (self.outputs | value & 0xFFFF) & ~(value >> 16 & ~value)
        else:
            self.registers[offset] = value

    def function(self, number: int) -> int | None:
        """Alternate function of a pin; None: it is none."""
        if self.registers.get(0x00, 0) >> 2 * number & 3 != 2:
            return None
        return self.registers.get(0x20 + 4 * (number // 8), 0) >> 4 * (number % 8) & 0xF


class Usart:
    def __init__(self, chip: Chip, base: int, irq: int, handler: str, clock_hz: float,
                 drive: tuple[Gpio, int] | None) -> None:
        self.chip, self.clock_hz, self.drive = chip, clock_hz, drive
        self.cr1, self.brr = 0, 0
        self.shift: int | None = None  # the byte on the line
        self.shift_us = 0.0
        self.waiting: int | None = None  # the byte in DR
        self.complete = True  # TC
        self.tc_may_clear = False
        self.sent: list[int] = []
        self.drive_wrong = 0
        self.received: deque[tuple[int, int]] = deque()  # byte, error bits
        self.overrun = False
        chip.models[base] = self
        chip.lines[irq] = (self.asks, handler)
        chip.waiting.append(self.advance)

    def word_bits(self) -> int:
        return 1 + (9 if self.cr1 >> 12 & 1 else 8) + 1

    def baud(self) -> float:
        return self.clock_hz / self.brr

    def _drive_is_on(self) -> bool:
        return self.drive is None or bool(self.drive[0].outputs >> self.drive[1] & 1)

    def advance(self, microseconds: float) -> None:
        left = microseconds
        while self.shift is not None and left > 0:
            used = min(left, self.shift_us)
            self.shift_us -= used
            left -= used
            self.drive_wrong += not self._drive_is_on()
            if self.shift_us <= 1e-9:
                self.sent.append(self.shift)
                self.shift = None
                self._load()
        if self.shift is None and self.drive is not None and self.complete is False:
            self.complete = True

    def _load(self) -> None:
        if self.waiting is not None:
            self.shift, self.waiting = self.waiting, None
            self.shift_us = self.word_bits() / self.baud() * 1e6
        else:
            self.complete = True

    def arrive(self, byte: int, errors: int = 0) -> None:
        """A byte from the line, or with PE 1, FE 2."""
        if self.received:
            self.overrun = True
        else:
            self.received.append((byte, errors))

    def status(self) -> int:
        errors = self.received[0][1] if self.received else 0
        return (
            (self.waiting is None) << 7
            | self.complete << 6
            | bool(self.received) << 5
            | self.overrun << 3
            | errors
        )

    def asks(self) -> bool:
        status = self.status()
        return bool(status & self.cr1 & 0xE0 or self.cr1 >> 5 & 1 and self.overrun)

    def read(self, offset: int) -> int:
        if offset == 0x00:
            self.tc_may_clear = True
            return self.status()
        if offset == 0x04:
            self.overrun = False
            return self.received.popleft()[0] if self.received else 0
        return {0x08: self.brr, 0x0C: self.cr1}.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == 0x04:
            if self.waiting is not None:
                self.chip.violations.append("USART: DR written while it is not empty")
            if not self.cr1 >> 13 & 1:
                self.chip.violations.append("USART: written while off")
            if self.tc_may_clear:  # status read, then data written
                self.complete = False
            self.waiting = value & 0xFF
            if self.shift is None:
                self._load()
        elif offset == 0x08:
            if self.cr1 >> 13 & 1:
                self.chip.violations.append("USART: BRR changed while on")
            self.brr = value
        elif offset == 0x0C:
            self.cr1 = value
