"""Harnesses that are compiled for this machine and run: claims about so few inputs that a processor goes through all,
in C, and claims about ranges of numbers, in C++ (harness/ranged.h)."""

from __future__ import annotations

import os
import pathlib
import re
import shlex
import subprocess
import time

import cbmc

# The harness's suffix chooses the compiler. ranged.h names a place in the firmware by the addresses of its calls, so a
# compiler must not inline them. -fpermissive: a C++ compiler refuses some of the firmware's C without it.
C = (os.environ.get("CC", "cc"), "-std=gnu11")
CXX = (os.environ.get("CXX", "c++"), "-std=gnu++20", "-fpermissive", "-w")
PREPROCESSED = {".c": ".i", ".cpp": ".ii"}
COMPILERS = {".c": C, ".i": C, ".cpp": CXX, ".ii": CXX}
OPTIONS = {
    ".i": ("-O2", "-fno-math-errno"),
    ".ii": ("-O2", "-g", "-no-pie", "-fno-inline", "-fno-optimize-sibling-calls"),
}


def source_of(name: str) -> pathlib.Path:
    """A proof's harness."""
    harness = cbmc.ROOT / "tests" / "judges" / "proofs" / "harness"
    return next(path for suffix in PREPROCESSED if (path := harness / f"{name}{suffix}").is_file())


def preprocess(source: pathlib.Path, into: pathlib.Path) -> pathlib.Path:
    """The harness as this machine's compiler sees it, in folder `into`."""
    out = into / source.with_suffix(PREPROCESSED[source.suffix]).name
    include = [f"-I{folder}" for folder in cbmc.INCLUDES]
    _compile([*COMPILERS[source.suffix], "-E", *include, str(source.relative_to(cbmc.ROOT))], out)
    return out


def check(file: pathlib.Path, seconds_most: float) -> cbmc.Verdict:
    """Run it: it says what does not hold, and where, and nothing if all holds."""
    begun = time.monotonic()
    program = file.with_suffix("")
    _compile([*COMPILERS[file.suffix], *OPTIONS[file.suffix], str(file), "-lm"], program)
    try:
        done = subprocess.run(
            [str(program)], capture_output=True, text=True, timeout=seconds_most, check=False
        )
    except subprocess.TimeoutExpired:
        return cbmc.Verdict(False, 0, seconds_most, trouble=f"not decided in {seconds_most:.0f} s")
    seconds, said = time.monotonic() - begun, done.stdout.strip()
    claims = len(re.findall(r"\bPROVED\b", file.read_text()))
    if done.returncode == 0:
        return cbmc.Verdict(True, claims, seconds)
    return cbmc.Verdict(False, claims, seconds, (said,) if said else (), trouble="" if said else "it crashed")


def _compile(arguments: list[str], out: pathlib.Path) -> None:
    command = [*arguments, "-o", str(out)]
    done = subprocess.run(command, cwd=cbmc.ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise cbmc.ToolError(f"{shlex.join(command)}\n{done.stderr.strip()}")
