"""Cycles of a sequence of executed Cortex-M4 instructions by the processor's manual, and by llvm-mca.

Manual: Cortex-M4 Technical Reference Manual r0p1, tables 3-1 (instructions) and 7-1 (floating point). Every load
and store is taken at its full cost (the manual lets neighbouring ones overlap), a taken branch refills for
REFILL cycles. The careful figure adds the manual's one cycle where a floating-point result is used by the very
next instruction.
"""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from fetch import Missing
from toolchain import Processor

REFILL = 2  # the manual's P: 1 to 3, by alignment and width of the target

FLOAT_CYCLES = {"vdiv": 14, "vsqrt": 14, "vfma": 3, "vfms": 3, "vfnma": 3, "vfnms": 3, "vmla": 3, "vmls": 3,
                "vnmla": 3, "vnmls": 3, "vldr": 2, "vstr": 2}
INTEGER_CYCLES = {"ldr": 2, "ldrb": 2, "ldrh": 2, "ldrsb": 2, "ldrsh": 2, "str": 2, "strb": 2, "strh": 2,
                  "ldrd": 3, "strd": 3, "udiv": 12, "sdiv": 12}
FLOAT_WRITES_NOTHING = ("vstr", "vcmp", "vcmpe", "vmrs", "vpush", "vstmia", "vstmdb")
BRANCHES = ("b", "bl", "bx", "blx", "cbz", "cbnz", "tbb", "tbh")
CONDITIONS = "eq ne cs cc hs lo mi pl vs vc hi ls ge lt gt le".split()


@dataclass(frozen=True)
class Instruction:
    """One disassembled instruction."""

    address: int
    mnemonic: str
    operands: str


@dataclass(frozen=True)
class Cycles:
    """Estimates for one executed sequence: the manual's timings, the same with result-use delays, llvm-mca's."""

    manual: int
    careful: int
    mca: int


def _llvm(tool: str, arguments: list[str | Path], text: str = "") -> str:
    """Standard output of one of LLVM's tools, by its plain or its Debian 12 name."""
    for program in (tool, f"{tool}-14"):
        try:
            done = subprocess.run([program, *map(str, arguments)], input=text, capture_output=True, text=True,
                                  check=False)
        except FileNotFoundError:
            continue
        if done.returncode != 0 or "error:" in done.stderr:
            raise RuntimeError(f"{program}: {done.stderr[:1000]}")
        return done.stdout
    raise Missing(f"no program '{tool}' (Debian package llvm)")


def disassemble(image: Path, processor: Processor) -> dict[int, Instruction]:
    """Address -> instruction, the whole image."""
    listing = _llvm("llvm-objdump", ["-d", "--no-show-raw-insn", f"--mcpu={processor.mca_cpu}", image])
    rows = re.findall(r"^ *([0-9a-f]+): +\t(\S+)(?:[ \t]+([^\n]*))?$", listing, re.MULTILINE)
    return {int(a, 16): Instruction(int(a, 16), m, o.split("@")[0].strip()) for a, m, o in rows}


def _registers_listed(operands: str) -> int:
    inside = re.search(r"\{([^}]*)\}", operands)
    total = 0
    for part in (inside[1] if inside else "").split(","):
        ends = re.findall(r"(\d+)", part)
        total += int(ends[1]) - int(ends[0]) + 1 if "-" in part and len(ends) == 2 else 1
    return total * (2 if inside and inside[1].strip().startswith("d") else 1)


def _stem(mnemonic: str) -> str:
    """The operation without width, type and condition: vadd.f32 -> vadd, ldr.w -> ldr, bne.n -> b."""
    stem = mnemonic.split(".")[0]
    for base in (*FLOAT_CYCLES, *INTEGER_CYCLES, *BRANCHES):
        if stem == base or (stem.startswith(base) and stem[len(base):] in CONDITIONS):
            return base
    return stem


def _cost(instruction: Instruction, taken: bool) -> int:
    stem = _stem(instruction.mnemonic)
    loads_program_counter = stem in ("pop", "ldmia", "ldm") and "pc" in instruction.operands
    refill = REFILL if taken and (stem in BRANCHES or loads_program_counter) else 0
    if stem.startswith(("push", "pop", "ldm", "stm", "vpush", "vpop", "vldm", "vstm")):
        return 1 + _registers_listed(instruction.operands) + refill
    if stem in ("vldr", "vstr") and instruction.operands.startswith("d"):
        return 3
    if stem == "vmov" and instruction.operands.count(",") == 2:
        return 2
    return FLOAT_CYCLES.get(stem, INTEGER_CYCLES.get(stem, 1)) + refill


def _float_result(instruction: Instruction) -> str | None:
    """The FPU register an instruction computes, if any."""
    stem = _stem(instruction.mnemonic)
    if not stem.startswith("v") or stem in FLOAT_WRITES_NOTHING or stem in ("vldr", "vpop", "vldmia"):
        return None
    first = instruction.operands.split(",")[0].strip()
    return first if first.startswith("s") and first != "sp" else None


def _uses(instruction: Instruction, register: str) -> bool:
    operands = instruction.operands.split(",")
    reads_first = _stem(instruction.mnemonic) in (*FLOAT_WRITES_NOTHING, "vfma", "vfms", "vfnma", "vfnms", "vmla",
                                                  "vmls")
    return register in [o.strip() for o in (operands if reads_first else operands[1:])]


def by_manual(executed: list[Instruction], after: int | None = None) -> tuple[int, int]:
    """Cycles by the manual's tables, plain and with result-use delays. after: address executed next, if known."""
    plain, delays = 0, 0
    for index, instruction in enumerate(executed):
        following = executed[index + 1].address if index + 1 < len(executed) else after
        taken = following is None or not 0 < following - instruction.address <= 4
        plain += _cost(instruction, taken)
        result = _float_result(instruction)
        if result and index + 1 < len(executed) and _uses(executed[index + 1], result):
            delays += 1
    return plain, plain + delays


def _for_mca(instruction: Instruction) -> str:
    """An executed instruction as llvm-mca 14 takes it.

    Branch targets mean nothing in a trace; the assembler refuses .w where no other form exists; and a call costs a
    flat 100 cycles there for the callee it cannot see, which here is in the sequence: it becomes a branch.
    """
    mnemonic = re.sub("[.][wn]$", "", instruction.mnemonic)
    stem = _stem(mnemonic)
    if stem in ("bl", "blx"):
        return f"b{mnemonic[len(stem):]} elsewhere"
    operands = re.sub(r"0x[0-9a-f]+ <[^>]*>", "elsewhere", instruction.operands)
    return f"{mnemonic} {re.sub(' <[^>]*>$', '', operands)}"


def by_mca(executed: list[Instruction], processor: Processor) -> int:
    """Total cycles by llvm-mca on the executed sequence, run once."""
    sequence = "".join(_for_mca(instruction) + "\n" for instruction in executed)
    report = _llvm("llvm-mca", [f"-mtriple={processor.triple}", f"-mcpu={processor.mca_cpu}", "-iterations=1"],
                   sequence)
    total = re.search(r"^Total Cycles:\s+(\d+)$", report, re.MULTILINE)
    assert total is not None
    return int(total[1])


def estimate(image: Path, addresses: list[int], processor: Processor) -> Cycles:
    """All estimates for one traced call."""
    listing = disassemble(image, processor)
    executed = [listing[address] for address in addresses]
    manual, careful = by_manual(executed)
    return Cycles(manual, careful, by_mca(executed, processor))
