"""The six machines on which somebody may want K, and how a program runs on each."""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
EXAMPLES = PROJECT / "examples"
BOARDS = "firmware/boards/toolchain/"
REFERENCE_K = (3.96389818, -0.63872477, 0.42806022)  # docs/physics.md, k_xx k_xz k_zz [N/mm]
# brace/planar.h promises each entry within 2e-6 of lambda_max, here 4.08 N/mm; five digits are printed.
TOLERANCE_N_PER_MM = 2e-6 * 4.08 + 0.5e-5
_EMULATED = ("-display", "none", "-monitor", "none", "-serial", "null", "-chardev", "file,id=out,path=/dev/stdout",
             "-semihosting-config", "enable=on,target=native,chardev=out")  # fmt: skip


@dataclass(frozen=True)
class Target:
    """A machine; `toolchain` is its toolchain file, `emulator` what stands before a program's name."""

    name: str
    compiler: str
    toolchain: str = ""
    emulator: tuple[str, ...] = ()

    def skip_without(self) -> None:
        """Skips the test where a tool is not installed."""
        for tool in (self.compiler, *self.emulator[:1], "cmake", "ninja", "make"):
            if shutil.which(tool) is None:
                pytest.skip(f"no {tool}")

    def run(self, program: Path) -> str:
        """What the program prints."""
        return output_of(*self.emulator, program)


ARM = ("qemu-system-arm", *_EMULATED)
TARGETS = (
    Target("host-gcc", "gcc"),
    Target("host-clang", "clang"),
    Target("aarch64", "aarch64-linux-gnu-gcc", "tools/client/cmake/aarch64-linux-gnu.cmake",
           ("qemu-aarch64-static", "-L", "/usr/aarch64-linux-gnu")),
    Target("m4f", "arm-none-eabi-gcc", f"{BOARDS}cortex-m4f.cmake", (*ARM, "-machine", "mps2-an386", "-kernel")),
    Target("m3", "arm-none-eabi-gcc", f"{BOARDS}cortex-m3.cmake", (*ARM, "-machine", "mps2-an385", "-kernel")),
    Target("riscv32", "riscv64-unknown-elf-gcc", f"{BOARDS}riscv32.cmake",
           ("qemu-system-riscv32", *_EMULATED, "-machine", "virt", "-cpu", "rv32", "-bios", "none", "-kernel")),
)  # fmt: skip


def output_of(*command: object, cwd: Path | None = None) -> str:
    """Standard output of a command that has to succeed."""
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}"
    return done.stdout


def k_values(text: str) -> list[tuple[float, ...]]:
    """The lines k_xx ... k_xz ... k_zz ... of an example's output."""
    number = r"(-?\d+\.\d+)"
    lines = re.findall(rf"^k_xx {number} k_xz {number} k_zz {number} N/mm$", text, re.MULTILINE)
    return [tuple(float(value) for value in line) for line in lines]


def children_cpu_s() -> float:
    """Processor time of all commands so far [s]. Other work on the machine does not change it."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
