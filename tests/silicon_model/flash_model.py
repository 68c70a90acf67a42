"""The flash interface (RM0090 3.5-3.9): keys, sectors, programming, errors, caches; and its memory."""

from __future__ import annotations

from collections.abc import Callable

from chip import Chip
from clock_model import Rcc

KEY1, KEY2 = 0x45670123, 0xCDEF89AB
OPTION_KEYS = (0x08192A3B, 0x4C5D6E7F)
OPTIONS_OF_A_NEW_CHIP = 0x0FFFAAED  # 3.9.10: no protection, no brown-out reset, options locked
OPTION_US = 0.5e6
ERRORS = 0xF2  # OPERR, WRPERR, PGAERR, PGPERR, PGSERR
START = 0x08000000
OTP_PAGE, OTP_OFFSET, OTP_BYTES = 0x1FFF7000, 0x800, 528  # 3.8: 16 blocks of 32 bytes, and their locks
OTP_BLOCK, OTP_LOCKS = 32, 512
SECTORS = [16384] * 4 + [65536] + [131072] * 7
PROGRAM_US = 16.0


class Flash:
    """Registers; the memory is mapped as accesses of its own, so that the caches can be played."""

    BASE = 0x40023C00

    def __init__(self, chip: Chip, rcc: Rcc) -> None:
        self.chip, self.rcc = chip, rcc
        self.memory = bytearray(b"\xff" * sum(SECTORS))
        self.acr, self.sr, self.cr = 0, 0, 1 << 31
        self.keys = 0  # 0: locked, 1: first key given, 2: open, -1: locked until reset
        self.busy_us = 0.0
        self.cached: dict[int, int] = {}
        self.protected: set[int] = set()
        self.sticks = False  # BSY never ends
        self.programmed: list[tuple[int, int]] = []
        self.erased: list[int] = []
        self.at_erase: Callable[[], None] = lambda: None  # before the processor stands still
        self.optcr = OPTIONS_OF_A_NEW_CHIP
        self.option_keys: list[int] = []
        self.options_written: list[int] = []
        self.fails_next = 0  # error bits of the next operation
        chip.models[self.BASE] = self
        chip.waiting.append(self.advance)
        chip.cpu.mmio_map(START, len(self.memory), self._load, None, self._store, None)
        self.otp = bytearray(b"\xff" * OTP_BYTES)
        self.otp_steps: list[bytes] = []  # its content after each write that changed it
        chip.cpu.mmio_map(OTP_PAGE, 0x1000, self._load_otp, None, self._store_otp, None)

    @staticmethod
    def sector(number: int) -> tuple[int, int]:
        """First offset and size."""
        return sum(SECTORS[:number]), SECTORS[number]

    def advance(self, microseconds: float) -> None:
        if self.busy_us > 0 and not self.sticks:
            self.busy_us = max(self.busy_us - microseconds, 0.0)

    def busy(self) -> bool:
        return self.busy_us > 0

    # --- memory, through the data cache

    def _load(self, cpu: object, offset: int, size: int, data: object) -> int:
        return self.chip._guarded(lambda: self._read_memory(offset, size))

    def _load_otp(self, cpu: object, offset: int, size: int, data: object) -> int:
        place = offset - OTP_OFFSET
        return int.from_bytes(self.otp[place : place + size], "little")

    def _store_otp(self, cpu: object, offset: int, size: int, value: int, data: object) -> None:
        place = offset - OTP_OFFSET
        if not 0 <= place <= OTP_BYTES - size:
            self.chip.violations.append(f"flash: write to 0x{OTP_PAGE + offset:x}")
            return
        before = bytes(self.otp)
        self.chip._guarded(lambda: self._program(self.otp, place, size, value, self._is_locked(place)))
        if bytes(self.otp) != before:
            self.otp_steps.append(bytes(self.otp))

    def _is_locked(self, place: int) -> bool:
        """3.8: a block can be programmed until its lock byte is 0x00; 3.6.5: a write to a locked one sets WRPERR."""
        return place < OTP_LOCKS and self.otp[OTP_LOCKS + place // OTP_BLOCK] == 0

    def _read_memory(self, offset: int, size: int) -> int:
        if self.busy():
            self.chip.pass_us(self.busy_us)  # the bus waits
        value = 0
        for i in range(size):
            place = offset + i
            if self.acr >> 10 & 1:
                byte = self.cached.setdefault(place, self.memory[place])
            else:
                byte = self.memory[place]
            value |= byte << 8 * i
        return value

    def _store(self, cpu: object, offset: int, size: int, value: int, data: object) -> None:
        is_protected = self._sector_of(offset) in self.protected
        self.chip._guarded(lambda: self._program(self.memory, offset, size, value, is_protected))

    def _program(self, memory: bytearray, offset: int, size: int, value: int, is_protected: bool) -> int:
        if self.keys != 2 or not self.cr & 1 or self.cr & 2:
            self.sr |= 1 << 7  # PGSERR
            self.chip.violations.append("flash: written without PG")
        elif self.sr & ERRORS:
            self.chip.violations.append("flash: programmed with an error still standing")
        elif 1 << (self.cr >> 8 & 3) != size:
            self.sr |= 1 << 6  # PGPERR
        elif offset % size:
            self.sr |= 1 << 5  # PGAERR
        elif is_protected:
            self.sr |= 1 << 4  # WRPERR
        elif self.fails_next:
            self.sr |= self.fails_next
            self.fails_next = 0
        else:
            if self.busy():
                self.chip.violations.append("flash: programmed while busy")
            old = int.from_bytes(memory[offset : offset + size], "little")
            if old & value != value:
                self.chip.violations.append(f"flash: bits at 0x{offset:x} set by programming (3.6.4: only cleared)")
            memory[offset : offset + size] = (old & value).to_bytes(size, "little")
            if memory is self.memory:
                self.programmed.append((offset, value))
            self.busy_us = PROGRAM_US
        return 0

    @staticmethod
    def _sector_of(offset: int) -> int:
        return next(number for number in range(12) if offset < sum(SECTORS[: number + 1]))

    # --- registers

    def read(self, offset: int) -> int:
        return {0x00: self.acr, 0x0C: self.sr | self.busy() << 16, 0x10: self.cr, 0x14: self.optcr}.get(offset, 0)

    def write(self, offset: int, value: int) -> None:
        if offset == 0x00:
            self._write_acr(value)
        elif offset == 0x04:
            self._write_key(value)
        elif offset == 0x08:
            self._write_option_key(value)
        elif offset == 0x14:
            self._write_options(value)
        elif offset == 0x0C:
            self.sr &= ~value
        elif offset == 0x10:
            self._write_cr(value)

    def _write_acr(self, value: int) -> None:
        for enable, reset in ((9, 11), (10, 12)):
            if value >> reset & 1:
                if self.acr >> enable & 1 or value >> enable & 1:
                    self.chip.violations.append("flash: cache reset while it is on (3.9.1)")
                elif reset == 12:
                    self.cached.clear()
        self.acr = value
        self.rcc.wait_states = value & 7
        self.rcc.check()

    def _write_key(self, value: int) -> None:
        wanted = {0: KEY1, 1: KEY2}.get(self.keys)
        if value != wanted:
            self.chip.violations.append("flash: wrong key, locked until the next reset (3.6.1)")
            self.keys = -1
            return
        self.keys += 1
        if self.keys == 2:
            self.cr &= ~(1 << 31)

    def _write_option_key(self, value: int) -> None:
        self.option_keys.append(value)
        if value != OPTION_KEYS[min(len(self.option_keys), 2) - 1]:
            self.chip.violations.append("flash: wrong option key, locked until the next reset (3.7.1)")
        elif len(self.option_keys) == 2:
            self.optcr &= ~1

    def _write_options(self, value: int) -> None:
        if self.optcr & 1 or self.busy():
            self.chip.violations.append("flash: OPTCR written while locked or busy (3.7.2)")
            return
        if (value ^ self.optcr) & ~0xF:
            self.chip.violations.append("flash: an option changed that is none of the brown-out level's")
        if value & 2:
            if (value ^ self.optcr) & 0xC:
                self.chip.violations.append("flash: options changed in the write that starts them (3.7.2)")
            self.options_written.append(value)
            self.busy_us = OPTION_US
            self.chip.pass_us(self.busy_us)
        if value & 1:
            self.option_keys.clear()
        self.optcr = value & ~2

    def brown_out_level(self) -> int:
        """3: about 2.8 V; 0: off."""
        return 3 - (self.optcr >> 2 & 3)

    def _write_cr(self, value: int) -> None:
        if self.cr >> 31 & 1:
            if value != 1 << 31:
                self.chip.violations.append("flash: CR written while locked")
            return
        if self.busy():
            self.chip.violations.append("flash: CR written while busy (3.6.5)")
            return
        self.cr = value & ~(1 << 16)
        if value >> 31 & 1:
            self.keys = 0
        elif value >> 16 & 1 and value >> 1 & 1:
            self._erase(value >> 3 & 0xF)

    def _erase(self, number: int) -> None:
        if self.sr & ERRORS:
            self.chip.violations.append("flash: erased with an error still standing")
        elif number in self.protected:
            self.sr |= 1 << 4
        elif self.fails_next:
            self.sr |= self.fails_next
            self.fails_next = 0
        else:
            self.at_erase()
            first, size = self.sector(number)
            self.memory[first : first + size] = b"\xff" * size
            self.erased.append(number)
            self.busy_us = {16384: 0.5e6, 65536: 1.1e6, 131072: 2e6}[size]  # data sheet, worst at 32 bits
            self.chip.pass_us(self.busy_us)  # the image runs from flash: the processor stands still
