"""What the compiled code shows: library functions that must not be there, and floating point in interrupt handlers."""
from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from sources import CROSS, ROOT, Finding

LIBRARY = "library"
FLOATING_POINT = "floating point in an interrupt"
INDIRECT = "indirect call in an interrupt"

HEAP = {"malloc", "calloc", "realloc", "free", "aligned_alloc", "strdup", "_malloc_r", "_calloc_r", "_realloc_r",
        "_free_r", "sbrk", "_sbrk", "_sbrk_r", "alloca", "_Znwj", "_Znaj"}
STDIO = re.compile(r"^_?(v?[fs]?n?i?printf|v?[fs]?scanf|f?puts|f?putc(har)?|f?getc(har)?|fopen|fclose|fwrite|fread"
                   r"|fflush|perror|std(in|out|err))(_r)?$")
SETJMP = {"setjmp", "longjmp"}
UNKNOWN = {"system", "exit", "abort", "signal", "atexit"}


def forbidden(name: str) -> str:
    """Why a library function must not be used on the limb; empty when it may."""
    if name in HEAP:
        return "heap"
    if STDIO.match(name):
        return "stdio"
    return "leaves its caller" if name in SETJMP | UNKNOWN else ""


def _run(*command: str | Path) -> str:
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def library_findings(objects: Iterable[tuple[Path, Path]]) -> list[Finding]:
    """Of (source, object) pairs: forbidden functions that the object refers to."""
    sources = {str(compiled): source for source, compiled in objects}
    found = []
    listed = _run(CROSS + "nm", "-u", "--print-file-name", *sources) if sources else ""
    for line in listed.splitlines():
        name = line.split()[-1]
        if why := forbidden(name):
            source = sources[line.rpartition(":")[0]]
            text = source.read_text().splitlines()
            at = next((i for i, row in enumerate(text, 1) if re.search(rf"\b{re.escape(name)}\b", row)), 1)
            found.append(Finding(source, at, LIBRARY, f"{name}: {why}"))
    return found


@dataclass
class Machine:
    """A function as compiled."""

    name: str
    instructions: list[tuple[str, str]] = field(default_factory=list)
    calls: set[str] = field(default_factory=set)
    indirect: bool = False

    @property
    def frame_bytes(self) -> int:
        """What it pushes and takes off the stack pointer; of a library function, for which there is no other figure."""
        total = 0
        for mnemonic, operands in self.instructions:
            registers = operands[operands.find("{") + 1:operands.find("}")] if "{" in operands else ""
            if mnemonic.startswith("push") or (mnemonic.startswith("stmdb") and operands.startswith("sp!")):
                total += 4 * _count(registers)
            elif mnemonic.startswith("vpush"):
                total += (8 if "d" in registers else 4) * _count(registers)
            elif mnemonic.startswith("sub") and re.match(r"sp, (sp, )?#\d+", operands):
                total += int(operands.rpartition("#")[2].split()[0])
        return total


def _count(registers: str) -> int:
    """r4-r7, lr -> 5."""
    number = 0
    for part in filter(None, (p.strip() for p in registers.split(","))):
        if "-" in part:
            low, high = (int(re.sub(r"\D", "", end) or 0) for end in part.split("-"))
            number += high - low + 1
        else:
            number += 1
    return number


FUNCTION = re.compile(r"^([0-9a-f]+) <([^>]+)>:$")
INSTRUCTION = re.compile(r"^\s*[0-9a-f]+:\t(\S+)(?:\t(.*))?$")
SOFT_FLOAT = re.compile(r"__aeabi_([fd](add|r?sub|mul|div|cmp\w+|2\w+)|u?[il]2[fd])$")
TARGET = re.compile(r"<([^>+]+)>")


@dataclass
class Image:
    """A linked image, taken apart."""

    path: Path

    @cached_property
    def symbols(self) -> dict[str, tuple[int, int]]:
        """Name -> (address, size)."""
        out = {}
        for line in _run(CROSS + "nm", "-S", self.path).splitlines():
            parts = line.split()
            out[parts[-1]] = (int(parts[0], 16), int(parts[1], 16) if len(parts) == 4 else 0)
        return out

    @cached_property
    def functions(self) -> dict[str, Machine]:
        """Every function of the image."""
        found: dict[str, Machine] = {}
        now: Machine | None = None
        for line in _run(CROSS + "objdump", "-d", "--no-show-raw-insn", self.path).splitlines():
            if head := FUNCTION.match(line):
                now = found[head[2]] = Machine(head[2])
            elif now is not None and (match := INSTRUCTION.match(line)):
                mnemonic, operands = match[1], match[2] or ""
                now.instructions.append((mnemonic, operands))
                if mnemonic.startswith("b") and (to := TARGET.search(operands)) and to[1] != now.name:
                    now.calls.add(to[1])
                elif mnemonic.startswith("blx") or (mnemonic.startswith("bx") and operands.strip() != "lr"):
                    now.indirect = True
        return found

    def handlers(self, table: str = "vectors") -> set[str]:
        """Functions of the vector table but the reset handler."""
        start, size = self.symbols[table]
        # debug sections begin at 0 as well
        dump = _run(CROSS + "objdump", "-s", "-j", f".{table}", f"--start-address={start}",
                    f"--stop-address={start + size}", self.path)
        rows = re.findall(r"^ [0-9a-f]+ ((?:[0-9a-f]{8} ){1,4}) ", dump, re.M)
        words = [int.from_bytes(bytes.fromhex(word), "little") for row in rows for word in row.split()]
        at = {address & ~1: name for name, (address, _) in self.symbols.items() if name in self.functions}
        return {at[word & ~1] for word in words[1:] if word & 1 and word & ~1 in at} - {"reset_handler"}

    def reached(self, root: str, pointed: Callable[[str], set[str]] = lambda _: set()) -> list[str]:
        """Everything a function calls, itself first; `pointed`: what it calls through pointers."""
        seen, pending = [], [root]
        while pending:
            name = pending.pop()
            if name not in seen and name in self.functions:
                seen.append(name)
                pending += sorted(self.functions[name].calls
                                  | (pointed(name) if self.functions[name].indirect else set()))
        return seen

    def library_stack_bytes(self, name: str) -> int:
        """Deepest stack of a function of the C library, all it calls on top of one another;
        0 for what is no function."""
        return sum(self.functions[f].frame_bytes for f in self.reached(name))


def interrupt_findings(image: Image, where: dict[str, tuple[Path, int]],
                       pointed: Callable[[str], set[str]] = lambda _: set()) -> list[Finding]:
    """Floating-point instructions in any handler or what it calls; `where`: function -> source and line; `pointed`:
    what a function calls through pointers."""
    found = []
    for handler in sorted(image.handlers()):
        for name in image.reached(handler, pointed):
            path, line = where.get(name.split(".")[0], (image.path, 0))
            machine = image.functions[name]
            floating = next((m for m, _ in machine.instructions if m.startswith("v")), None)
            soft = [c for c in machine.calls if SOFT_FLOAT.match(c)]
            if floating or soft:
                found.append(Finding(path, line, FLOATING_POINT,
                                     f"{name} ({floating or soft[0]}), called from {handler}"))
            if machine.indirect and not pointed(name):
                found.append(Finding(path, line, INDIRECT,
                                     f"{name}, called from {handler}: what it reaches is not known"))
    return found


def forbidden_in_image(image: Image) -> list[Finding]:
    """Heap and stdio that came in with the C library."""
    return [Finding(image.path, 0, LIBRARY, f"{name}: {why}") for name in image.functions if (why := forbidden(name))]


def controller_images(build: Path) -> list[Image]:
    """What is flashed; not the images that crash on purpose."""
    return [Image(path) for path in sorted((build / "images").glob("brace-*.elf")) if "crash-test" not in path.name]


def exemptions() -> set[tuple[Path, str]]:
    """Of exempt.txt: file and rule."""
    rows = (line.split("\t") for line in Path(__file__).with_name("exempt.txt").read_text().splitlines()
            if line.strip() and not line.startswith("#"))
    return {(ROOT / row[0], row[1]) for row in rows}
