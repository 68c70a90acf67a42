"""Compiles, links and takes apart the bench's images. Flags are those of the firmware's own build."""

import re
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fetch import ROOT, Missing

BENCH = Path(__file__).resolve().parent
BUILD = ROOT / "build" / "bench"
BOARDS = ROOT / "firmware" / "boards"
CORE = ROOT / "firmware" / "core"

PREFIX = "arm-none-eabi-"


@dataclass(frozen=True)
class Processor:
    """An emulated controller: its compiler flags, its machine's name in the emulator, its names for LLVM."""

    name: str
    flags: tuple[str, ...]
    machine: str
    triple: str
    mca_cpu: str


M4F = Processor("Cortex-M4F", ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"), "mps2-an386",
                "thumbv7em-none-eabihf", "cortex-m4")
M3 = Processor("Cortex-M3", ("-mcpu=cortex-m3", "-mthumb"), "mps2-an385", "thumbv7m-none-eabi", "cortex-m3")

SECTIONS = ("-ffunction-sections", "-fdata-sections")
REGISTERS = ("-fno-schedule-insns", "-flive-range-shrinkage", "-frename-registers")  # firmware/core/CMakeLists.txt
CORE_FLAGS = ("-std=c11", "-O2", *REGISTERS, "-ffp-contract=off", "-fno-math-errno", *SECTIONS, "-Wall", "-Wextra")
C_FLAGS = ("-std=gnu11", *SECTIONS, "-Wall")
CXX_FLAGS = ("-std=c++17", "-fno-exceptions", "-fno-rtti", *SECTIONS, "-Wall")
HARNESS_FLAGS = ("-O2", "-fno-optimize-sibling-calls")  # a call that is counted must be a call
INCLUDES = tuple(f"-I{folder}" for folder in
                 (BENCH / "image", BENCH / "peers", BUILD / "generated", CORE / "include", CORE / "src"))


def run(command: Sequence[str | Path]) -> str:
    """Run a tool, give its standard output; what it says on failure is the exception."""
    try:
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise Missing(f"no program '{command[0]}'") from error
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def compile_source(source: Path, output: Path, processor: Processor, flags: tuple[str, ...]) -> Path:
    """One object file; the stack figures of its functions are left beside it (.ci, by -fcallgraph-info)."""
    is_cxx = source.suffix == ".cpp"
    language = CXX_FLAGS if is_cxx else C_FLAGS
    output.parent.mkdir(parents=True, exist_ok=True)
    base = CORE_FLAGS if source.is_relative_to(CORE) else language
    run([PREFIX + ("g++" if is_cxx else "gcc"), *processor.flags, *base, *flags, "-fcallgraph-info=su", *INCLUDES,
         "-c", source, "-o", output])
    return output


def link_image(objects: list[Path], output: Path, processor: Processor) -> Path:
    """An image for the emulated board, with semihosting."""
    run([PREFIX + "gcc", *processor.flags, "-nostartfiles", "--specs=nano.specs", "--specs=rdimon.specs",
         "-Wl,--gc-sections", f"-L{BOARDS / 'common'}", f"-T{BOARDS / 'mps2' / 'memory.ld'}", *objects, "-lm",
         "-o", output])
    return output


def flash_bytes(objects: list[Path], functions: tuple[str, ...], output: Path, processor: Processor) -> int:
    """Bytes of code, constants and initialised data that the functions pull in, and nothing else [B]."""
    keep = [f"-Wl,-u,{name}" for name in functions]
    run([PREFIX + "gcc", *processor.flags, "-nostartfiles", "--specs=nano.specs", "--specs=nosys.specs",
         "-Wl,--gc-sections", f"-Wl,-e,{functions[0]}", *keep, *objects, "-lm", "-o", output])
    sizes = section_sizes(output)
    stored = (".text", ".rodata", ".data", ".ARM.extab", ".ARM.exidx", ".init_array", ".fini_array")
    return sum(sizes.get(name, 0) for name in stored)


def section_sizes(image: Path) -> dict[str, int]:
    """Section name -> bytes."""
    rows = re.findall(r"^(\.\S+)\s+(\d+)\s+\d+$", run([PREFIX + "size", "-A", image]), re.MULTILINE)
    return {name: int(size) for name, size in rows}


def symbol_address(image: Path, name: str) -> int:
    """Address of a function in an image."""
    found = re.search(rf"^([0-9a-f]+) [TtWw] {re.escape(name)}$", run([PREFIX + "nm", image]), re.MULTILINE)
    if not found:
        raise RuntimeError(f"{image.name} has no function '{name}'")
    return int(found[1], 16)


def type_sizes(types: tuple[str, ...], headers: tuple[str, ...], processor: Processor) -> dict[str, int]:
    """sizeof of C types on a processor, from the compiler [B]."""
    source = BUILD / "generated" / "sizes.c"
    lines = [f'#include "{header}"' for header in headers]
    lines += [f"char size_{index}[sizeof({name})];" for index, name in enumerate(types)]
    source.write_text("\n".join(lines) + "\n")
    table = compiled_symbols(compile_source(source, source.with_suffix(".o"), processor, ("-O2",)))
    return {name: table[f"size_{index}"] for index, name in enumerate(types)}


def compiled_symbols(objectfile: Path) -> dict[str, int]:
    """Symbol name -> size in an object file [B]."""
    rows = re.findall(r"^[0-9a-f]+ ([0-9a-f]+) \w (\S+)$", run([PREFIX + "nm", "-S", objectfile]), re.MULTILINE)
    return {name: int(size, 16) for size, name in rows}
