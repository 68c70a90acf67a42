"""What each C suite runs of the firmware, counted by gcov in build/coverage."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = ROOT / "build" / "coverage"
ARGUMENTS = {"power_cuts": ("--in-turn",), "journal_cuts": ("--in-turn",)}  # each step and manner, not each pair
FUZZED = ("100000", "1")  # requests or ticks, and where the random sequence begins
SECONDS_MOST = 600.0

Line = tuple[str, int]  # file of the firmware, number
Branch = tuple[str, int, int]  # file, line, number of the branch on the line


class ToolError(Exception):
    """A suite failed, or gcov could not read what it left."""


@dataclass
class Counts:
    """How often lines and branches ran. A line or branch that is there and did not run has 0."""

    lines: dict[Line, int] = field(default_factory=dict)
    branches: dict[Branch, int] = field(default_factory=dict)

    def add(self, other: Counts) -> None:
        """Adds what another suite ran."""
        for line, count in other.lines.items():
            self.lines[line] = self.lines.get(line, 0) + count
        for branch, count in other.branches.items():
            self.branches[branch] = self.branches.get(branch, 0) + count


def suites() -> list[Path]:
    """The programs of target c_suites: unit tests, the enumerated power cuts, and short runs of the fuzzers."""
    programs = [path for path in (BUILD / "tests").glob("test_*") if path.is_file() and os.access(path, os.X_OK)]
    programs += (BUILD / "tests" / "judges" / "fuzz").glob("*_fuzz")
    programs += [BUILD / "tests" / "judges" / "memory" / name for name in ARGUMENTS]
    return sorted(program for program in programs if program.is_file())


def run(program: Path, counts: Path) -> None:
    """Runs a suite. What it counts goes to a folder of its own."""
    strip = len(BUILD.parts) - 1
    is_fuzzer = program.parent.name == "fuzz"
    command = [str(program), *(FUZZED if is_fuzzer else ARGUMENTS.get(program.name, ()))]
    environment = {**os.environ, "GCOV_PREFIX": str(counts), "GCOV_PREFIX_STRIP": str(strip)}
    done = subprocess.run(
        command, cwd=BUILD, env=environment, capture_output=True, text=True, check=False, timeout=SECONDS_MOST
    )
    if done.returncode:
        raise ToolError(f"{program.name} fails: {done.stdout[-800:]}{done.stderr[-800:]}")


def _documents(counts: Path) -> Iterator[dict[str, object]]:
    """What gcov makes of a folder of counts, one document for each object: of the firmware, and of the suite itself,
    which may include its headers."""
    paths = (path.relative_to(counts) for path in counts.rglob("*.gcda"))
    data = sorted(str(path) for path in paths if "firmware" in path.parts or path.parts[0] == "tests")
    if not data:
        return  # a suite of hal/ alone
    for name in data:
        shutil.copy(BUILD / Path(name).with_suffix(".gcno"), (counts / name).parent)
    done = subprocess.run(
        ["gcov", "--json-format", "--stdout", "--branch-probabilities", *data],
        cwd=counts,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise ToolError(f"gcov: {done.stderr[-800:]}")
    yield from (json.loads(text) for text in done.stdout.splitlines() if text.startswith("{"))


def read(counts: Path) -> Counts:
    """The counts of one suite."""
    found = Counts()
    for document in _documents(counts):
        for file in document["files"]:  # type: ignore[attr-defined]
            path = Path(os.path.normpath(BUILD / file["file"]))
            if not path.is_relative_to(ROOT / "firmware") or path.is_relative_to(ROOT / "firmware" / "boards"):
                continue  # tests/emulated judges the boards' own files
            name = str(path.relative_to(ROOT))
            one = Counts()
            for line in file["lines"]:
                number = int(line["line_number"])
                one.lines[name, number] = one.lines.get((name, number), 0) + int(line["count"])
                for index, branch in enumerate(line["branches"]):
                    place = (name, number, index)
                    one.branches[place] = one.branches.get(place, 0) + int(branch["count"])
            found.add(one)
    return found


def of_each_suite(work: Path) -> dict[str, Counts]:
    """Runs every suite alone. Name of the suite: what it ran."""
    found = {}
    for program in suites():
        counts = work / program.name
        shutil.rmtree(counts, ignore_errors=True)
        counts.mkdir(parents=True)
        run(program, counts)
        found[program.name] = read(counts)
        shutil.rmtree(counts)
    if not found:
        raise ToolError("there are no suites in build/coverage; ./dev coverage builds them")
    return found
