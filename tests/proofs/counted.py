"""Claims about so few inputs that a processor goes through all: the harness, compiled for this machine and run."""

from __future__ import annotations

import os
import pathlib
import re
import shlex
import subprocess
import time

import cbmc

COMPILER = os.environ.get("CC", "cc")


def preprocess(source: pathlib.Path, into: pathlib.Path) -> pathlib.Path:
    """The harness as this machine's compiler sees it, in folder `into`."""
    out = into / source.with_suffix(".i").name
    _compile(["-E", *(f"-I{folder}" for folder in cbmc.INCLUDES), str(source.relative_to(cbmc.ROOT))], out)
    return out


def check(file: pathlib.Path, seconds_most: float) -> cbmc.Verdict:
    """Run it: it says what does not hold, and where, and nothing if all holds."""
    begun = time.monotonic()
    program = file.with_suffix("")
    _compile(["-O2", "-fno-math-errno", str(file), "-lm"], program)
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
    command = [COMPILER, "-std=gnu11", *arguments, "-o", str(out)]
    done = subprocess.run(command, cwd=cbmc.ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise cbmc.ToolError(f"{shlex.join(command)}\n{done.stderr.strip()}")
