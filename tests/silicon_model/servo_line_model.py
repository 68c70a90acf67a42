"""USART6 and the two streams of DMA 2 that move its bytes (RM0090 chapters 30, 10), with the line's direction pin."""

from __future__ import annotations

from chip import Chip
from usart_model import Gpio

ENABLED, CIRCULAR, INCREMENT, FROM_MEMORY = 1 << 0, 1 << 8, 1 << 10, 1 << 6
CLOCK_HZ = 84e6
DATA_REGISTER = 0x40011404
TC, RXNE, ORE, TXE = 1 << 6, 1 << 5, 1 << 3, 1 << 7
FLAGS_OF_STREAM_1, FLAGS_OF_STREAM_6 = 0x00000F40, 0x003D0000


class Stream:
    """One of DMA 2's streams: control, count, peripheral, memory."""

    def __init__(self) -> None:
        self.registers = [0, 0, 0, 0]
        self.whole = 0  # the count that it began with
        self.flags_are_set = False

    @property
    def is_on(self) -> bool:
        return bool(self.registers[0] & ENABLED)

    def next_address(self) -> int:
        """Of the byte that moves now; and counts it."""
        address = self.registers[3] + self.whole - self.registers[1]
        self.registers[1] -= 1
        if self.registers[1] == 0:
            self.flags_are_set = True
            if self.registers[0] & CIRCULAR:
                self.registers[1] = self.whole
            else:
                self.registers[0] &= ~ENABLED
        return address


class Dma:
    def __init__(self, chip: Chip) -> None:
        self.chip = chip
        self.streams = {1: Stream(), 6: Stream()}
        chip.models[0x40026400] = self

    def _place(self, offset: int) -> tuple[Stream | None, int]:
        number, register = divmod(offset - 0x10, 0x18)
        return self.streams.get(number), register // 4

    def read(self, offset: int) -> int:
        stream, register = self._place(offset)
        return stream.registers[register] if stream else 0

    def write(self, offset: int, value: int) -> None:
        if offset == 0x08 and value & FLAGS_OF_STREAM_1 == FLAGS_OF_STREAM_1:
            self.streams[1].flags_are_set = False
        elif offset == 0x0C and value & FLAGS_OF_STREAM_6 == FLAGS_OF_STREAM_6:
            self.streams[6].flags_are_set = False
        stream, register = self._place(offset)
        if stream is None or offset < 0x10:
            return
        if register > 0 and stream.is_on:
            self.chip.violations.append(f"DMA: register {offset:#x} written while the stream is on")
        if register == 0 and value & ENABLED:
            if stream.flags_are_set:
                self.chip.violations.append("DMA: started with its flags set")
            if value >> 25 & 7 != 5 or not value & INCREMENT or stream.registers[2] != DATA_REGISTER:
                self.chip.violations.append("DMA: not USART6's channel, or its memory stands still")
            stream.whole = stream.registers[1]
        stream.registers[register] = value


class ServoUsart:
    """The transmitter asks stream 6 for bytes, the receiver gives its own to stream 1."""

    def __init__(self, chip: Chip, port: Gpio, dma: Dma) -> None:
        self.chip, self.port, self.dma = chip, port, dma
        self.cr1 = self.cr3 = self.brr = 0
        self.shift: int | None = None
        self.shift_us = 0.0
        self.complete, self.overrun, self.unread = True, False, False
        self.sent: list[int] = []
        self.drive_wrong = 0
        chip.models[0x40011400] = self
        chip.lines[71] = (self.asks, "usart6_handler")
        chip.waiting.append(self.advance)

    def baud(self) -> float:
        return CLOCK_HZ / self.brr

    def asks(self) -> bool:
        return bool(self.cr1 >> 6 & 1 and self.complete)

    def drives(self) -> bool:
        return bool(self.port.outputs >> 8 & 1)

    def _fetch(self) -> None:
        stream = self.dma.streams[6]
        if self.shift is None and self.cr3 >> 7 & 1 and stream.is_on and stream.registers[1] > 0:
            if not stream.registers[0] & FROM_MEMORY:
                self.chip.violations.append("DMA: stream 6 does not read memory")
            self.shift = self.chip.cpu.mem_read(stream.next_address(), 1)[0]
            self.shift_us = 10 / self.baud() * 1e6
            self.complete = False

    def advance(self, microseconds: float) -> None:
        left = microseconds
        self._fetch()
        while self.shift is not None and left > 0:
            used = min(left, self.shift_us)
            self.shift_us -= used
            left -= used
            self.drive_wrong += not self.drives()
            if self.shift_us <= 1e-9:
                self.sent.append(self.shift)
                self.shift = None
                self._fetch()
                self.complete = self.shift is None

    def arrive(self, byte: int) -> None:
        """A byte from the line."""
        stream = self.dma.streams[1]
        if self.overrun:
            return
        if self.cr3 >> 6 & 1 and stream.is_on:
            self.chip.cpu.mem_write(stream.next_address(), bytes([byte]))
        else:
            self.overrun, self.unread = self.unread, True

    def read(self, offset: int) -> int:
        if offset == 0x00:
            return TXE | self.complete * TC | self.unread * RXNE | self.overrun * ORE
        if offset == 0x04:
            self.overrun = self.unread = False
        return {0x08: self.brr, 0x0C: self.cr1, 0x14: self.cr3}.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == 0x00 and not value & TC:
            self.complete = False
        elif offset == 0x08:
            self.brr = value
        elif offset == 0x0C:
            self.cr1 = value
        elif offset == 0x14:
            self.cr3 = value
