"""The random number generator (RM0090 24): its 48 MHz clock, a word every 40 of its periods, its faults."""

from __future__ import annotations

import random

from chip import Chip
from clock_model import Rcc

WORD_PERIODS = 40


class Rng:
    BASE = 0x50060800

    def __init__(self, chip: Chip, rcc: Rcc, seed: int) -> None:
        self.chip, self.rcc = chip, rcc
        self.enabled = False
        self.faults = 0  # of SR: SEIS 6, CEIS 5, as long as nobody clears them
        self.lasting = 0  # of SR: SECS 2, CECS 1
        self.words = random.Random(seed)
        self.repeats = False  # it has broken down: every word is the last one again
        self.word, self.wait_us = 0, 0.0
        self.is_spoilt = False  # since a fault of the seed, until it is disabled and enabled
        self.given: list[int] = []  # every word that was read since it was enabled
        chip.models[self.BASE] = self
        chip.waiting.append(self.advance)

    def rate_hz(self) -> float:
        pll, is_on = self.rcc.registers[0x04], self.rcc.registers[0x00] >> 24 & 1
        return self.rcc.clocks()["vco"] / max(pll >> 24 & 0xF, 1) if is_on and self.rcc.pll_locks else 0.0

    def advance(self, microseconds: float) -> None:
        self.wait_us = max(self.wait_us - microseconds, 0.0)

    def fail(self, bit: int) -> None:
        """A fault of the seed (6) or the clock (5)."""
        self.faults |= 1 << bit
        self.is_spoilt = self.is_spoilt or bit == 6

    def _next(self) -> None:
        self.wait_us = WORD_PERIODS / self.rate_hz() * 1e6 if self.rate_hz() else float("inf")
        if not self.repeats and not self.is_spoilt:
            self.word = self.words.getrandbits(32)

    def read(self, offset: int) -> int:
        if not self.rcc.enabled(0x34, 6):
            self.chip.violations.append("RNG: used without its clock")
        slow = self.enabled and self.rate_hz() < self.rcc.clocks()["core"] / 16
        if offset == 0x04:
            self.faults |= slow << 5
            return self.is_ready() | self.lasting | slow << 1 | self.faults
        if offset != 0x08:
            return self.enabled << 2
        if not self.is_ready() or self.faults >> 6 & 1:
            self.chip.violations.append("RNG: read without a word, or with a seed that had failed (24.3.1)")
        word = self.word
        self.given.append(word)
        self._next()
        return word

    def is_ready(self) -> bool:
        return self.enabled and self.wait_us == 0.0

    def write(self, offset: int, value: int) -> None:
        if not self.rcc.enabled(0x34, 6):
            self.chip.violations.append("RNG: used without its clock")
        if offset == 0x04:
            self.faults &= value
        if offset == 0x00:
            if value >> 2 & 1 and not self.enabled:
                self.given.clear()
                self.is_spoilt = False
                self._next()
            self.enabled = bool(value >> 2 & 1)
            if self.enabled and self.rate_hz() > 48.5e6:
                self.chip.violations.append(f"RNG: clocked with {self.rate_hz()} Hz (7.2.3: at most 48 MHz)")
