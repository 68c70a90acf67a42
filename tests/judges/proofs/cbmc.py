"""CBMC as a function: sources in, a verdict for each property out."""

from __future__ import annotations

import json
import pathlib
import resource
import shlex
import subprocess
import time
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parents[3]
MEMORY_BYTES = 8 << 30

# The processor that the firmware is for: its integers' sizes, its char, its libc's headers.
TARGET = ("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-std=c11")
INCLUDES = (
    "firmware/core/include",
    "firmware/core/src",
    "firmware/interface/include",
    "firmware/interface/generated",
    "firmware/interface/src",
    "firmware/store",
    "firmware/store/include",
    "firmware/app/include",
    "firmware/app/src",
    "hal/include",
    "tests/judges/proofs/harness",
)

# Beyond what CBMC checks by itself: bounds, pointers, division by zero, signed overflow, shifts, unwinding.
CHECKS = ("--pointer-overflow-check", "--object-bits", "12")
CONVERSIONS = "--conversion-check"


class ToolError(Exception):
    """Preprocessor or CBMC could not do its work; the text says what it said."""


@dataclass(frozen=True)
class Step:
    """One assignment on the way to a failure."""

    where: str
    what: str
    value: str


@dataclass(frozen=True)
class Verdict:
    """What CBMC says of one program."""

    holds: bool
    properties: int
    seconds: float
    failures: tuple[str, ...] = ()
    trace: tuple[Step, ...] = ()
    trouble: str = ""  # why there is no verdict


@dataclass(frozen=True)
class Program:
    """What CBMC is to look at: preprocessed files and how far loops go."""

    files: tuple[pathlib.Path, ...]
    unwind: int
    unwindset: dict[str, int] = field(default_factory=dict)
    conversions: bool = False
    options: tuple[str, ...] = ()


def preprocess(compiler: str, source: pathlib.Path, into: pathlib.Path) -> pathlib.Path:
    """The source as the target's own compiler sees it, in folder `into`."""
    out = into / ("_".join(source.relative_to(ROOT).with_suffix("").parts[-3:]) + ".i")
    command = [
        compiler,
        *TARGET,
        "-E",
        *(f"-I{folder}" for folder in INCLUDES),
        str(source.relative_to(ROOT)),
        "-o",
        str(out),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ToolError(f"{shlex.join(command)}\n{done.stderr.strip()}")
    return out


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))


def _run(cbmc: str, arguments: list[str], seconds_most: float) -> tuple[list[dict[str, object]], float, str]:
    """CBMC's messages, the seconds it took, and why there are none."""
    begun = time.monotonic()
    command = [cbmc, "--arch", "arm", "--os", "none", "--json-ui", *arguments]
    try:
        done = subprocess.run(
            command,
            cwd=ROOT,
            capture_output=True,
            text=True,
            timeout=seconds_most,
            check=False,
            preexec_fn=_limit_memory,
        )
    except subprocess.TimeoutExpired:
        return [], time.monotonic() - begun, f"not decided in {seconds_most:.0f} s"
    seconds = time.monotonic() - begun
    try:
        messages: list[dict[str, object]] = json.loads(done.stdout)
    except json.JSONDecodeError:
        return (
            [],
            seconds,
            f"CBMC ended with {done.returncode}: {(done.stderr or done.stdout)[-500:].strip()}",
        )
    if done.returncode not in (0, 10):
        errors = [str(m["messageText"]) for m in messages if m.get("messageType") == "ERROR"]
        return [], seconds, "; ".join(errors) or f"CBMC ended with {done.returncode}"
    return messages, seconds, ""


def _arguments(program: Program) -> list[str]:
    arguments = [*map(str, program.files), "--unwind", str(program.unwind), "--unwinding-assertions", *CHECKS]
    if program.unwindset:
        arguments += ["--unwindset", ",".join(f"{loop}:{most}" for loop, most in program.unwindset.items())]
    return [*arguments, *program.options]


def _float_conversions(cbmc: str, program: Program) -> list[str]:
    """All properties but conversions of integers to integers: those are defined in C, and meant."""
    messages, _, trouble = _run(cbmc, [*_arguments(program), CONVERSIONS, "--show-properties"], 300)
    if trouble:
        raise ToolError(trouble)
    chosen = []
    for message in messages:
        for found in _dicts(message.get("properties")):
            text = str(found["description"])
            integer = "type conversion" in text and "float" not in text
            if not integer:
                chosen += ["--property", str(found["name"])]
    return [CONVERSIONS, *chosen]


def _dicts(value: object) -> list[dict[str, object]]:
    return [item for item in value if isinstance(item, dict)] if isinstance(value, list) else []


def _place(item: dict[str, object]) -> str:
    where = item.get("sourceLocation")
    if not isinstance(where, dict) or "line" not in where:
        return "?"
    return f"{where.get('file', '?')}:{where['line']}"


def _failure(result: dict[str, object]) -> str:
    return f"{_place(result)}: {result['description']}"


def _trace(steps: list[dict[str, object]]) -> tuple[Step, ...]:
    """What the harness' own variables were given, in order; the last value of each."""
    last: dict[str, Step] = {}
    for step in steps:
        place = _place(step)
        if step.get("stepType") != "assignment" or step.get("hidden") or "tests/judges/proofs/harness" not in place:
            continue
        value = step.get("value")
        data = value.get("data", value.get("name", "?")) if isinstance(value, dict) else "?"
        name = str(step.get("lhs"))
        given = (
            not name.startswith("return_value") and "$" not in name and "!" not in str(data) and data != "?"
        )
        if given and name.split(".")[-1].split("[")[0] != "any":
            last.pop(name, None)
            last[name] = Step(place, name, str(data))
    return tuple(last.values())


def check(cbmc: str, program: Program, seconds_most: float) -> Verdict:
    """Every property of the program."""
    arguments = _arguments(program)
    if program.conversions:
        arguments += _float_conversions(cbmc, program)
    messages, seconds, trouble = _run(cbmc, arguments, seconds_most)
    if trouble:
        return Verdict(False, 0, seconds, trouble=trouble)
    results = [result for message in messages for result in _dicts(message.get("result"))]
    failures = tuple(_failure(result) for result in results if result["status"] != "SUCCESS")
    return Verdict(
        not failures and bool(results),
        len(results),
        seconds,
        failures,
        trouble="" if results else "CBMC found nothing to check",
    )


def refute(cbmc: str, program: Program, seconds_most: float) -> Verdict:
    """One property that does not hold, and how it comes to that."""
    arguments = [*_arguments(program), "--stop-on-fail", "--trace"]
    if program.conversions:
        arguments += _float_conversions(cbmc, program)
    messages, seconds, trouble = _run(cbmc, arguments, seconds_most)
    failed = [message for message in messages if message.get("status") == "failed"]
    if trouble or not failed:
        return Verdict(not trouble, 0, seconds, trouble=trouble)
    steps = _dicts(failed[0].get("trace"))
    place = next((_place(step) for step in reversed(steps) if step.get("stepType") == "failure"), "?")
    return Verdict(False, 0, seconds, (f"{place}: {failed[0]['description']}",), _trace(steps))
