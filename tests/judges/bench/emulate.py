"""Runs an image on the emulated controller under the instruction-counting plugin."""

import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import fetch
from toolchain import BENCH, BUILD, Processor, run, symbol_address

RUN_IMAGE = BENCH.parents[1] / "emulated" / "run_image"


@dataclass(frozen=True)
class Counted:
    """One image's run: per run of the job the instructions and a digest of the path taken; the job's numbers
    (runs, outs); the depth its stack reached [B]; how many calls its set-up had made before."""

    instructions: tuple[int, ...]
    paths: tuple[str, ...]
    results: np.ndarray
    stack_bytes: int
    calls_before: int


def build_plugin(source: Path = BENCH / "plugin" / "count_instructions.c") -> Path:
    """A counting plugin, compiled for this machine's emulator."""
    output = BUILD / f"{source.stem}.so"
    output.parent.mkdir(parents=True, exist_ok=True)
    run(["gcc", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", f"-I{fetch.plugin_header()}", source,
         "-o", output])
    return output


def _emulate(image: Path, processor: Processor, plugin: Path, function: str, options: str) -> tuple[str, str]:
    """The image's output and the plugin's."""
    record = image.with_suffix(".count")
    entry = symbol_address(image, function) & ~1
    done = subprocess.run(
        [RUN_IMAGE, processor.machine, image, "-plugin", f"{plugin},entry={entry:#x},out={record}{options}"],
        capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{image.name}: exit code {done.returncode}\n{done.stdout[-500:]}{done.stderr[-500:]}")
    return done.stdout, record.read_text()


def count(image: Path, processor: Processor, plugin: Path, function: str) -> Counted:
    """Every call of `function` in the image counted, callees included."""
    output, record = _emulate(image, processor, plugin, function, "")
    calls = [line.split() for line in record.splitlines()]
    wrong = [line for line in calls if line[0] != "call"]
    if wrong:
        raise RuntimeError(f"{image.name}: {' '.join(wrong[0])}")
    rows = [line.split()[1:] for line in output.splitlines() if line.startswith("run")]
    stack = next(int(line.split()[1]) for line in output.splitlines() if line.startswith("stack"))
    before = len(calls) - len(rows)
    if before < 0:
        raise RuntimeError(f"{image.name}: {len(rows)} runs but {len(calls)} calls of {function}")
    calls = calls[before:]
    numbers = [[struct.unpack(">f", bytes.fromhex(word))[0] for word in row] for row in rows]
    return Counted(tuple(int(c[1]) for c in calls), tuple(c[2] for c in calls), np.array(numbers, dtype=np.float64),
                   stack, before)


def trace(image: Path, processor: Processor, plugin: Path, function: str, call: int) -> list[int]:
    """Addresses of the instructions that call number `call` executed, in order."""
    _, record = _emulate(image, processor, plugin, function, f",trace={call}")
    return [int(line.split()[1], 16) for line in record.splitlines() if line.startswith("at")]
