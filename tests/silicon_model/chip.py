"""The compiled hardware layer on an emulated Cortex-M4, its peripherals played by register models.

The models are written from the reference manual RM0090, apart from the layer, and note every access the manual forbids
in `Chip.violations`. They judge the layer against our reading of the manual; silicon may differ.

Time is model time: reading TIM2's counter takes 1 us, and tests let it pass with `Chip.wait_us`. There is no interrupt
controller in the emulator; `Chip.call` looks for pending interrupts between slices of instructions and then runs the
handler as the processor would, at any instruction of what it interrupts.
"""

from __future__ import annotations

import random
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import unicorn
from unicorn import arm_const as arm

PROJECT = Path(__file__).resolve().parents[2]
RAM, RAM_BYTES = 0x20000000, 0x20000
STOP = 0x1FFF0000  # where calls return to
PERIPHERALS, PERIPHERAL_BYTES = 0x40000000, 0x80000
FAST_PERIPHERALS, FAST_PERIPHERAL_BYTES = 0x50000000, 0x80000
SYSTEM, SYSTEM_BYTES = 0xE0000000, 0x100000
CALL_LIMIT = 40_000_000  # instructions; whoever needs more waits for ever
SLICE = (1, 60)  # instructions between looks at the interrupts


class Model(Protocol):
    """A peripheral: registers by offset, 32 bits."""

    def read(self, offset: int) -> int: ...
    def write(self, offset: int, value: int) -> None: ...


SHIPPED = ("-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-mgeneral-regs-only")  # as the build compiles the layer
SOFT_FLOAT = ("-mfloat-abi=soft",)  # for callers that compute: the emulator's FPU stays off


class Image:
    """The layer and a file of tests/silicon_model/image, compiled for the Cortex-M4 and linked; symbols by name."""

    def __init__(self, folder: Path, calls: str = "calls.c", flags: tuple[str, ...] = SHIPPED,
                 beside: str = "") -> None:
        hal, here = PROJECT / "hal", Path(__file__).parent / "image"
        elf, flat = folder / "image.elf", folder / "image.bin"
        parts = ["stm32f405"] + ([beside] if beside else [])
        sources = [here / calls] + [source for part in parts for source in sorted((hal / part / "src").glob("*.c"))]
        folders = [hal / "include"] + [hal / part / kind for part in parts for kind in ("include", "src")]
        command: list[str | Path] = ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", *flags, "-O2", "-std=c11"]
        command += ["-nostartfiles", "--specs=nano.specs", "-Wall", "-Wextra", "-Werror", "-Wl,--build-id=none"]
        command += [f"-I{place}" for place in folders]
        subprocess.run([*command, *sources, "-T", here / "memory.ld", "-o", elf], check=True)
        subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", elf, flat], check=True)
        self.bytes = flat.read_bytes()
        listing = subprocess.run(["arm-none-eabi-nm", elf], check=True, capture_output=True, text=True).stdout
        self.symbols = {line.split()[2]: int(line.split()[0], 16) for line in listing.splitlines()
                        if len(line.split()) == 3}


class Nvic:
    """Enabled and pending interrupts."""

    def __init__(self) -> None:
        self.enabled: set[int] = set()
        self.requested: set[int] = set()

    def read(self, offset: int) -> int:
        return 0

    def write(self, offset: int, value: int) -> None:
        for first, numbers in ((0x100, self.enabled), (0x200, self.requested)):
            if first <= offset < first + 12:
                numbers |= {8 * (offset - first) + bit for bit in range(32) if value >> bit & 1}


class Chip:
    def __init__(self, image: Image, seed: int = 0) -> None:
        self.image = image
        self.violations: list[str] = []
        self.time_us = 0.0
        self.models: dict[int, Model] = {}
        self.lines: dict[int, tuple[Callable[[], bool], str]] = {}  # interrupt -> is it asked for, handler
        self.waiting: list[Callable[[float], None]] = []  # called with the time that has passed
        self.untouched: set[int] = set()
        self.in_handler = False
        self.interrupts_taken = 0
        self.interrupts_on = True
        self.random = random.Random(seed)
        self.slice = SLICE
        self.failure: BaseException | None = None

        self.cpu: Any = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        self.cpu.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
        self.cpu.mem_map(RAM, RAM_BYTES)
        self.cpu.mem_map(STOP, 0x1000)
        self.cpu.mem_write(RAM, image.bytes)
        self.cpu.mmio_map(PERIPHERALS, PERIPHERAL_BYTES, self._read, PERIPHERALS, self._write, PERIPHERALS)
        self.cpu.mmio_map(FAST_PERIPHERALS, FAST_PERIPHERAL_BYTES, self._read, FAST_PERIPHERALS,
                          self._write, FAST_PERIPHERALS)
        self.cpu.mmio_map(SYSTEM, SYSTEM_BYTES, self._read, SYSTEM, self._write, SYSTEM)
        self.nvic = Nvic()
        self.models[0xE000E000] = self.nvic

    # --- registers

    def _model(self, address: int) -> tuple[Model | None, int]:
        base = address & ~0x3FF
        if 0xE000E000 <= address < 0xE000F000:
            base = 0xE000ED00 if address >= 0xE000ED00 else 0xE000E000
        return self.models.get(base), address - base

    def _read(self, cpu: object, offset: int, size: int, start: int) -> int:
        return self._guarded(lambda: self._read_register(start + offset, size))

    def _write(self, cpu: object, offset: int, size: int, value: int, start: int) -> None:
        self._guarded(lambda: self._write_register(start + offset, size, value))

    def _guarded(self, action: Callable[[], int]) -> int:
        """Errors of a model come out of `call`, not lost in the emulator's callback."""
        try:
            return action()
        except BaseException as error:
            self.failure = self.failure or error
            return 0

    def _read_register(self, address: int, size: int) -> int:
        model, offset = self._model(address)
        if model is None:
            self.untouched.add(address & ~0x3FF)
            return 0
        if size != 4:
            self.violations.append(f"read of {size} bytes at 0x{address:x}")
        return model.read(offset) & 0xFFFFFFFF

    def _write_register(self, address: int, size: int, value: int) -> int:
        model, offset = self._model(address)
        if model is None:
            self.untouched.add(address & ~0x3FF)
            return 0
        if size != 4:
            self.violations.append(f"write of {size} bytes at 0x{address:x}")
        model.write(offset, value)
        return 0

    # --- time

    def pass_us(self, microseconds: float) -> None:
        self.time_us += microseconds
        for notify in self.waiting:
            notify(microseconds)

    def wait_us(self, microseconds: float, step_us: float = 20.0) -> None:
        """Lets time pass with the processor idle, interrupts served."""
        left = microseconds
        while left > 0:
            step = min(step_us, left)
            self.pass_us(step)
            left -= step
            self.serve_interrupts()

    # --- running

    def _run(self, address: int, limit: int) -> bool:
        """True: came back to STOP."""
        self.cpu.emu_start(address | 1, STOP, count=limit)
        if self.failure is not None:
            failure, self.failure = self.failure, None
            raise failure
        return bool(self.cpu.reg_read(arm.UC_ARM_REG_PC) == STOP)

    def call(self, name: str, *arguments: int) -> int:
        """Calls a function of the image with up to four integers; its answer, as signed."""
        registers = (arm.UC_ARM_REG_R0, arm.UC_ARM_REG_R1, arm.UC_ARM_REG_R2, arm.UC_ARM_REG_R3)
        for register, value in zip(registers, arguments):
            self.cpu.reg_write(register, value & 0xFFFFFFFF)
        self.cpu.reg_write(arm.UC_ARM_REG_SP, RAM + RAM_BYTES)
        self.cpu.reg_write(arm.UC_ARM_REG_LR, STOP | 1)
        address, done, back = self.image.symbols[name] & ~1, 0, False
        while not back:
            step = self.random.randint(*self.slice) if self.interrupts_on else CALL_LIMIT
            back = self._run(address, step)
            done += step
            assert done <= 2 * CALL_LIMIT and (back or step < CALL_LIMIT), f"{name} does not come back"
            address = self.cpu.reg_read(arm.UC_ARM_REG_PC)
            if not back and not self._in_conditional_block():
                self.serve_interrupts()
        answer = int(self.cpu.reg_read(arm.UC_ARM_REG_R0))
        self.serve_interrupts()
        return answer - (1 << 32) if answer >> 31 else answer

    def _in_conditional_block(self) -> bool:
        """Inside an IT block the emulator can not be left and entered again."""
        return bool(self.cpu.reg_read(arm.UC_ARM_REG_XPSR) & 0x0600FC00)

    def serve_interrupts(self) -> None:
        if self.in_handler or not self.interrupts_on:
            return
        for _ in range(1000):
            due = [
                (number, handler)
                for number, (asked, handler) in self.lines.items()
                if number in self.nvic.enabled and (asked() or number in self.nvic.requested)
            ]
            if not due:
                return
            number, handler = min(due)
            self.nvic.requested.discard(number)
            self._interrupt(handler)
        raise AssertionError("an interrupt that its handler does not end")

    def _interrupt(self, handler: str) -> None:
        self.in_handler = True
        self.interrupts_taken += 1
        saved = self.cpu.context_save()
        stack = self.cpu.reg_read(arm.UC_ARM_REG_SP) or RAM + RAM_BYTES
        self.cpu.reg_write(arm.UC_ARM_REG_SP, (stack - 128) & ~7)
        self.cpu.reg_write(arm.UC_ARM_REG_LR, STOP | 1)
        assert self._run(self.image.symbols[handler] & ~1, 100_000), f"{handler} does not come back"
        self.cpu.context_restore(saved)
        self.in_handler = False

    # --- memory

    def put(self, name: str, data: bytes) -> None:
        self.cpu.mem_write(self.image.symbols[name], data)

    def get(self, name: str, count: int) -> bytes:
        return bytes(self.cpu.mem_read(self.image.symbols[name], count))

    def words(self, name: str, count: int) -> tuple[int, ...]:
        return struct.unpack(f"<{count}I", self.get(name, 4 * count))
