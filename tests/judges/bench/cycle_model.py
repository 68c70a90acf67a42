#!/usr/bin/env python3
"""Instructions and datasheet cycles of a straight-line Cortex-M4F function, from its disassembly.

    cycle_model.py OBJECT FUNCTION [--objdump arm-none-eabi-objdump] [--listing]

Walks from the entry along the path on which no forward conditional branch is taken (the range check's branch
to the error exit) and follows unconditional ones until the return. Cycles are those of the Cortex-M4 Technical
Reference Manual (DDI 0439, tables 3-1 and 7-1) with zero wait states and no pairing credited: loads and stores
2, double-word or multiple 1 + N, divide and square root 14, fused multiply-add 3, taken branch 3, the rest 1.
`stalls` is the manual's footnote: a floating-point result used by the very next instruction costs one more.
"""
from __future__ import annotations

import argparse
import json
import re
import subprocess
from dataclasses import dataclass

LINE = re.compile(r"^\s*([0-9a-f]+):\s+(\S+)\s*(.*?)(?:\s*[@;].*)?$")


@dataclass
class Step:
    """One executed instruction: address, mnemonic, operand text, datasheet cycles."""

    address: int
    mnemonic: str
    operands: str
    cycles: int


def _registers(text: str) -> int:
    """How many registers a {list} names."""
    count = 0
    for part in text.partition("{")[2].partition("}")[0].split(","):
        low, _, high = part.strip().partition("-")
        count += int(high[1:]) - int(low[1:]) + 1 if high else 1
    return count


def cycles_of(mnemonic: str, operands: str) -> int:
    """Datasheet cycles of one instruction."""
    base = mnemonic.split(".")[0]
    if base in ("push", "pop", "ldmia", "stmia", "ldm", "stm", "ldmfd", "stmdb", "vpush", "vpop", "vldmia", "vstmia"):
        words = _registers(operands)
        return 1 + words + (2 if "pc" in operands and base in ("pop", "ldmia", "ldm", "ldmfd") else 0)
    if base in ("ldrd", "strd"):
        return 3
    if base.startswith(("ldr", "str")) or base in ("vldr", "vstr"):
        return 2
    if base in ("vdiv", "vsqrt"):
        return 14
    if base in ("vfma", "vfms", "vfnma", "vfnms", "vmla", "vmls", "vnmla", "vnmls"):
        return 3
    if base in ("sdiv", "udiv"):
        return 12
    if base in ("bx", "b", "bl", "blx"):
        return 3
    if base == "vmov" and re.match(r"s\d+, s\d+, r|r\d+, r\d+, ", operands):
        return 2
    return 1


def listing(obj: str, function: str, objdump: str) -> dict[int, tuple[str, str]]:
    """Address -> (mnemonic, operands) of one function."""
    text = subprocess.run([objdump, "-d", "--no-show-raw-insn", f"--disassemble={function}", obj],
                          check=True, capture_output=True, text=True).stdout
    found = (LINE.match(line) for line in text.splitlines())
    return {int(m[1], 16): (m[2], m[3]) for m in found if m and not m[2].startswith(".")}


def walk(code: dict[int, tuple[str, str]]) -> tuple[list[Step], int]:
    """The executed steps of the good path, and the conditional branches met (none taken)."""
    addresses = sorted(code)
    following = dict(zip(addresses, addresses[1:]))
    at, steps, conditional = addresses[0], [], 0
    while True:
        mnemonic, operands = code[at]
        base = mnemonic.split(".")[0]
        cost = cycles_of(mnemonic, operands)
        jump = re.match(r"(?:\w+, )?([0-9a-f]+)\b", operands) if base[0] == "b" or base.startswith("cb") else None
        target = int(jump[1], 16) if jump else -1
        conditionally = len(base) == 3 and base[0] == "b" and base not in ("bic", "bfi", "bfc")
        branches = base in ("b", "cbz", "cbnz") or conditionally
        if branches and base != "b":
            conditional += 1
            cost = 1
            if target <= at:
                raise SystemExit(f"{at:x}: a loop; this model is for straight-line code")
        steps.append(Step(at, mnemonic, operands, cost))
        if base in ("bl", "blx"):
            raise SystemExit(f"{at:x}: a call; this model is for straight-line code")
        if base == "bx" or (base in ("pop", "ldmia", "ldm", "ldmfd") and "pc" in operands):
            return steps, conditional
        at = target if base == "b" else following[at]


def stalls(steps: list[Step]) -> int:
    """Floating-point results consumed by the instruction right after."""
    count = 0
    for first, second in zip(steps, steps[1:]):
        moves = first.mnemonic.startswith(("vldr", "vstr", "vmov", "vmrs", "vcmp"))
        arithmetic = first.mnemonic.startswith("v") and not moves
        result = first.operands.split(",")[0].strip()
        sources = second.operands if second.mnemonic.startswith(("vstr", "vcmp", "vfma", "vfms", "vfnm")) \
            else second.operands.partition(",")[2]
        count += arithmetic and re.search(rf"\b{result}\b", sources) is not None
    return count


def measure(obj: str, function: str, objdump: str = "arm-none-eabi-objdump") -> dict[str, int]:
    """{"instructions", "cycles", "stalls", "conditional_branches"} of one straight-line function."""
    steps, conditional = walk(listing(obj, function, objdump))
    return {"instructions": len(steps), "cycles": sum(s.cycles for s in steps), "stalls": stalls(steps),
            "conditional_branches": conditional}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("object")
    parser.add_argument("function")
    parser.add_argument("--objdump", default="arm-none-eabi-objdump")
    parser.add_argument("--listing", action="store_true")
    args = parser.parse_args()
    if args.listing:
        for step in walk(listing(args.object, args.function, args.objdump))[0]:
            print(f"{step.address:5x} {step.cycles:3d}  {step.mnemonic:12s} {step.operands}")
    print(json.dumps(measure(args.object, args.function, args.objdump)))


if __name__ == "__main__":
    main()
