"""The unit suites over a firmware that is one shared library: a changed file costs a compilation and a link."""

from __future__ import annotations

import json
import os
import resource
import shlex
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = ROOT / "build" / "coverage"  # its compile commands, without the counting
WORK = ROOT / "build" / "mutants"
FIRMWARE = ("firmware/core/", "firmware/interface/", "firmware/store/", "firmware/app/")
HALS = ("hal/fake/", "hal/blank/", "hal/selftest/", "hal/dynamixel/")
SUITES = ("tests/unit/", "tests/attack/")
NOT_OURS = "tests/unit/boards/"  # judges a board's files, which are not in the library
LIBRARY = "libunder_test.so"
LEVEL = "-O1"  # compiles quickly, and still gives the same object for many mutants that mean the same
# The compiler refuses a function that ends without its value, because what it returns is chance, and so is a suite's
# verdict. It refuses a call of a function that is not declared, because no such function exists.
NO_C = ("-Werror=return-type", "-Werror=implicit-function-declaration")


class BuildError(Exception):
    """What the compiler or the linker said."""


@dataclass(frozen=True)
class Command:
    """How a file is compiled."""

    source: str  # relative to the project's folder
    folder: Path
    words: tuple[str, ...]

    def to(self, output: Path) -> list[str]:
        """The command that writes the object there."""
        words = [word for word in self.words if word not in ("--coverage", "-O0", "-O2", "-fstack-usage", "-g")]
        words[words.index("-o") + 1] = str(output)
        return [*words, LEVEL, "-fPIC", *NO_C]


def run(words: list[str], folder: Path = ROOT) -> None:
    """Runs a tool. Raises BuildError with its words."""
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise BuildError(f"{shlex.join(words)}\n{done.stderr[-2000:]}")


def commands() -> dict[str, Command]:
    """The files of the firmware's libraries, of the hardware layers, and of the suites."""
    found = {}
    for item in json.loads((BUILD / "compile_commands.json").read_text()):
        source = Path(item["file"])
        is_ours = source.is_relative_to(ROOT) and source.name != "unity.c"
        name = str(source.relative_to(ROOT)) if is_ours else source.name
        words = tuple(shlex.split(item["command"]))
        is_copy = name.startswith("firmware/") and "/faults/" in words[words.index("-o") + 1]
        is_wanted = name.startswith((*FIRMWARE, *HALS, *SUITES)) or name == "unity.c"
        if is_wanted and not is_copy and not name.startswith(NOT_OURS):
            found[name] = Command(name, Path(item["directory"]), words)
    return found


@dataclass(frozen=True)
class Suite:
    """A test program, and the processor time of a run that passes."""

    name: str
    program: Path
    cpu_s: float = 0.0


class Bench:
    """The objects, the library and the suites, as they are without a mutant."""

    def __init__(self) -> None:
        self.commands = commands()
        self.linked = [name for name in self.commands if name.startswith((*FIRMWARE, *HALS))]

    def object_of(self, source: str) -> Path:
        return WORK / "objects" / (source.replace("/", "+") + ".o")

    def build(self) -> list[Suite]:
        """Builds what is older than its sources. returns the suites"""
        (WORK / "objects").mkdir(parents=True, exist_ok=True)
        (WORK / "suites").mkdir(exist_ok=True)
        folders = ("firmware", "hal", "tests/unit", "tests/attack")
        newest = max(path.stat().st_mtime for part in folders for path in (ROOT / part).rglob("*.h"))
        for name, command in self.commands.items():
            output = self.object_of(name)
            source_s = (ROOT / name).stat().st_mtime if name != "unity.c" else 0.0
            if not output.exists() or output.stat().st_mtime < max(source_s, newest):
                run([*command.to(output), "-MMD", "-MF", str(output.with_suffix(".d"))], command.folder)
        self.link(WORK, {})
        suites = []
        for name, source in self.source_of().items():
            program = WORK / "suites" / name
            self.link_suite(self.object_of(source), program)
            suites.append(Suite(name, program))
        return suites

    def source_of(self) -> dict[str, str]:
        """Name of a suite: its file."""
        tests = (name for name in self.commands if name.startswith(SUITES))
        return {Path(name).stem: name for name in tests if Path(name).stem.startswith("test_")}

    def newest_of(self, suite: str) -> float:
        """When the newest object was made that a suite runs."""
        sources = [*self.linked, self.source_of()[suite]]
        return max(self.object_of(name).stat().st_mtime for name in sources)

    def link_suite(self, test_object: Path, program: Path) -> None:
        """A suite; it takes the library that it finds when it runs."""
        objects = [str(test_object), str(self.object_of("unity.c"))]
        run(["cc", "-o", str(program), *objects, str(WORK / LIBRARY), "-lm"])

    def link(self, folder: Path, instead: dict[str, Path]) -> None:
        """The library, with some objects in place of others."""
        objects = [str(instead.get(name, self.object_of(name))) for name in self.linked]
        run(["cc", "-shared", f"-Wl,-soname,{LIBRARY}", "-o", str(folder / LIBRARY), *objects, "-lm"])

    def includes(self, source: str, header: str) -> bool:
        """Does a file include a header?"""
        words = self.object_of(source).with_suffix(".d").read_text().split()
        return str(ROOT / header) in [os.path.normpath(word) for word in words]

    def users_of(self, header: str) -> list[str]:
        """The files of the library that include a header."""
        return [name for name in self.linked if self.includes(name, header)]

    def suites_with(self, header: str) -> list[str]:
        """The suites that include a header: what they hold of it is not the library's."""
        return [name for name, source in self.source_of().items() if self.includes(source, header)]


@dataclass(frozen=True)
class Ending:
    """How a run of a suite ended."""

    passes: bool
    words: str
    cpu_s: float


def run_suite(suite: Suite, library: Path, cpu_most_s: int) -> Ending:
    """Runs a suite over a library, for so much processor time at most."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (cpu_most_s, cpu_most_s))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [str(suite.program)],
        capture_output=True,
        check=False,
        env={**os.environ, "LD_LIBRARY_PATH": str(library)},
        preexec_fn=limit,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = done.stdout.decode(errors="replace")
    failed = next((line.split("/")[-1] for line in words.splitlines() if ":FAIL" in line), "")
    if done.returncode < 0:
        failed = f"{suite.name}: {signal.Signals(-done.returncode).name}"
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Ending(done.returncode == 0, failed or f"{suite.name}: ended with {done.returncode}", cpu_s)


def clock() -> float:
    return time.monotonic()
