"""What the driver costs on a Cortex-M4F: instructions in the tick, and between ticks. It prints them (pytest -s)."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import pytest
import unicorn
from brace.native import servos_library
from unicorn import arm_const as arm

PROJECT = Path(__file__).resolve().parents[2]
RAM, RAM_BYTES, STOP = 0x20000000, 0x20000, 0x1FFF0000
FLAGS = ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-O2", "-std=c11", "-ffreestanding")
SERVE_US, SECONDS = 250, 2
OK, AGAIN = 0, 0xFFFFFFFF


class Controller:
    """The compiled driver; every call's instructions are counted."""

    def __init__(self, folder: Path) -> None:
        elf, flat, hal = folder / "cost.elf", folder / "cost.bin", PROJECT / "hal"
        sources = [Path(__file__).parent / "image" / "cost.c", *sorted((hal / "dynamixel" / "src").glob("*.c"))]
        includes = [f"-I{hal / part}" for part in ("include", "dynamixel/include", "dynamixel/src")]
        script = PROJECT / "tests" / "silicon_model" / "image" / "memory.ld"
        subprocess.run(["arm-none-eabi-gcc", *FLAGS, "-nostartfiles", "--specs=nano.specs", *includes, *sources,
                        "-T", script, "-o", elf], check=True)  # fmt: skip
        subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", elf, flat], check=True)
        listing = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
        rows = [line.split() for line in listing.splitlines()]
        self.symbols = {row[2]: int(row[0], 16) for row in rows if len(row) == 3}
        emulator: Any = unicorn  # it has types for some of its names only
        self.cpu: Any = emulator.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        self.cpu.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
        self.cpu.mem_map(RAM, RAM_BYTES)
        self.cpu.mem_map(STOP, 0x1000)
        self.cpu.mem_write(RAM, flat.read_bytes())
        self.cpu.reg_write(arm.UC_ARM_REG_FPEXC, 1 << 30)
        self.count = 0
        self.cpu.hook_add(unicorn.UC_HOOK_CODE, self._count)

    def _count(self, *_: object) -> None:
        self.count += 1

    def call(self, name: str, argument: int = 0) -> int:
        """Calls a function of the image; returns its answer, and leaves its instructions in `count`."""
        self.cpu.reg_write(arm.UC_ARM_REG_R0, argument)
        self.cpu.reg_write(arm.UC_ARM_REG_SP, RAM + RAM_BYTES)
        self.cpu.reg_write(arm.UC_ARM_REG_LR, STOP | 1)
        self.count = 0
        self.cpu.emu_start(self.symbols[name] | 1, STOP, count=1_000_000)
        assert self.cpu.reg_read(arm.UC_ARM_REG_PC) == STOP
        return int(self.cpu.reg_read(arm.UC_ARM_REG_R0))

    def cost(self, name: str) -> int:
        """Instructions of a call for each of the three joints."""
        total = 0
        for joint in range(3):
            assert self.call(name, joint) in (OK, AGAIN)
            total += self.count
        return total

    def word(self, name: str) -> int:
        return int.from_bytes(self.cpu.mem_read(self.symbols[name], 4), "little")

    def set_word(self, name: str, value: int) -> None:
        self.cpu.mem_write(self.symbols[name], value.to_bytes(4, "little"))


@pytest.mark.minutes
def test_what_the_driver_costs(tmp_path: Path) -> None:
    controller, native = Controller(tmp_path), servos_library()
    lib, spoken = native.lib, native.ffi.new("uint8_t[]", 256)
    servos = lib.brace_servos_create(3_000_000, 1)
    for index, identity in enumerate((11, 12, 13)):
        assert lib.brace_servos_add(servos, identity, 321) == index
        lib.brace_servos_shaft(servos, index, 3.0 + 0.1 * index, 0.1, 0.5, 30.0)
    assert controller.call("start") == OK
    served, reads, commands = [], [], []
    for now_us in range(0, SECONDS * 1_000_000, SERVE_US):
        held = controller.word("come_count")
        count = lib.brace_servos_give(servos, 1000 * now_us, spoken, 256 - held)
        controller.cpu.mem_write(controller.symbols["come"] + held, bytes(spoken[0:count]))
        controller.set_word("come_count", held + count)
        controller.set_word("sent_count", 0)
        controller.call("serve", now_us)
        served.append(controller.count)
        sent = bytes(controller.cpu.mem_read(controller.symbols["sent"], controller.word("sent_count")))
        if sent:
            lib.brace_servos_hear(servos, 1000 * now_us, sent, len(sent))
        if now_us % 1000 == 0 and now_us >= 500_000:
            reads.append(controller.cost("read_joint"))
            commands.append(controller.cost("command_joint"))
    lib.brace_servos_destroy(servos)
    a_millisecond = sum(served) * 1000 / (SECONDS * 1_000_000)
    print(f"\nin the tick: {max(reads)} instructions to read three joints, {max(commands)} to command them")
    print(f"between ticks: {max(served)} in the worst call, {a_millisecond:.0f} a millisecond")
    assert max(reads) <= 200 and max(commands) <= 200
    assert max(served) <= 4000 and a_millisecond <= 8000
