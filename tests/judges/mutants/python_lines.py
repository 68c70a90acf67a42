"""Which test of tests/tools runs which line of the Python tools, measured room by room and kept in build/mutants."""

from __future__ import annotations

import ast
import contextlib
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import warnings
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

import python_trace

ROOT = Path(__file__).resolve().parents[3]
HERE = Path(__file__).resolve().parent
WORK = ROOT / "build" / "mutants" / "python"
TESTS = ROOT / "tests" / "tools"
FOLDERS = ("tools/brace", "tools/interface")
NOT_JUDGED = ("tools/brace/demo/",)
ROOM_MOST_S = 600.0  # no test of a room begins after so long
MEASURING_MOST_S = 1200.0
SETTINGS = """[run]
parallel = true
data_file = {data}/lines
source =
    {sources}
context = ${{BRACE_MUTANT_CONTEXT-}}
sigterm = true
patch = _exit
disable_warnings = no-data-collected, module-not-imported, module-not-measured
"""


class JudgeError(Exception):
    """Why mutants cannot be judged."""


@dataclass(frozen=True)
class Candidate:
    """A test that passes without a mutant, and what a run of it takes while lines are counted."""

    name: str
    cpu_s: float
    wall_s: float


@dataclass
class Measured:
    """tests: by name. lines: file, line: the tests that run it. digests: of each file when it was measured."""

    tests: dict[str, Candidate] = field(default_factory=dict)
    lines: dict[tuple[str, int], set[str]] = field(default_factory=lambda: defaultdict(set))
    at_import: set[tuple[str, int]] = field(default_factory=set)  # lines that run while their module is imported
    digests: dict[str, str] = field(default_factory=dict)
    rooms: list[str] = field(default_factory=list)
    stopped: list[str] = field(default_factory=list)  # rooms of which some tests were not run


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def judged_files() -> list[str]:
    """Every Python file of the tools that somebody wrote."""
    found = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            name = str(path.relative_to(ROOT))
            if not name.startswith(NOT_JUDGED) and not is_generated(path.read_text()):
                found.append(name)
    return found


def is_generated(text: str) -> bool:
    return "do not edit" in text.partition("\n")[0]


def rooms() -> list[str]:
    """Folders of tests/tools with tests, the quickest to measure first by their number of files."""
    found = [path for path in TESTS.iterdir() if path.is_dir() and any(path.rglob("test_*.py"))]
    return [path.name for path in sorted(found, key=lambda path: (len(list(path.rglob("test_*.py"))), path.name))]


def environment() -> dict[str, str]:
    """Of a run of pytest: every Python process below it looks at swap/sitecustomize.py."""
    given = {key: value for key, value in os.environ.items() if not key.startswith(("BRACE_MUTANT", "COVERAGE_"))}
    path = [str(HERE / "swap"), given.get("PYTHONPATH", "")]
    return {**given, "PYTHONPATH": os.pathsep.join(part for part in path if part), "OPENBLAS_NUM_THREADS": "1"}


def pytest_words(*words: str) -> list[str]:
    """A run of pytest. Files named *_test.py are no tests here: pytest would load those of the tools itself, from the
    working tree."""
    plain = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-o", "python_files=test_*.py")
    return [sys.executable, "-m", "pytest", *plain, *words]


def on_one_core() -> None:
    """With two, a diagnosis works in a copy of its process, too, and ends it before its lines are written."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def measure_room(room: str, most_s: float) -> None:
    """Runs a room's tests, but for those marked minutes, and keeps what they run."""
    data = WORK / "data"
    shutil.rmtree(data, ignore_errors=True)
    data.mkdir(parents=True)
    settings, times = WORK / "coverage.ini", WORK / "times.jsonl"
    sources = "\n    ".join(str(ROOT / folder) for folder in FOLDERS)
    settings.write_text(SETTINGS.format(data=data, sources=sources))
    times.unlink(missing_ok=True)
    own = {
        python_trace.SETTINGS: str(settings),
        python_trace.TIMES: str(times),
        python_trace.MOST: str(most_s),
    }
    given = environment()
    given["PYTHONPATH"] = os.pathsep.join([given["PYTHONPATH"], str(HERE)])
    words = pytest_words("-p", "python_trace", "-m", "not minutes", str((TESTS / room).relative_to(ROOT)))
    log = WORK / "words.txt"
    with log.open("w") as out:
        process = subprocess.Popen(
            words,
            cwd=ROOT,
            env={**given, **own},
            stdout=out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=on_one_core,
        )
        try:
            code = process.wait(2.0 * most_s)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)  # the session begun above, and what it left behind
            process.wait()
    said = log.read_text(errors="replace")
    if code is None:
        print(f"measuring {room}: no end after {2.0 * most_s:.0f} s; its tests are left out", flush=True)
        (WORK / f"{room}.json").write_text(json.dumps({"tests": [], "lines": {}, "digests": {}, "stopped": True}))
        return
    if code not in (0, 1, 2):
        raise JudgeError(f"tests/tools/{room} cannot be run:\n{said[-2000:]}")
    keep_room(room, times, data, "the time for this room is over" in said)


def keep_room(room: str, times: Path, data: Path, stopped: bool) -> None:
    """Writes WORK/<room>.json."""
    import coverage

    notes = [json.loads(line) for line in times.read_text().splitlines()] if times.is_file() else []
    known = {note["test"]: index for index, note in enumerate(notes)}
    sharing = defaultdict(list)
    for index, note in enumerate(notes):
        for fixture in note["fixtures"]:
            sharing[fixture].append(index)
    lines: dict[str, dict[int, list[int]]] = {}
    # mypy takes our own coverage.py for it
    counted = coverage.Coverage(config_file=str(WORK / "coverage.ini"))  # type: ignore[attr-defined]
    with warnings.catch_warnings():  # a process that was killed has left half a file
        warnings.simplefilter("ignore")
        counted.combine([str(data)])
    found = counted.get_data()
    for file in found.measured_files():
        if not Path(file).is_relative_to(ROOT) or not Path(file).is_file():
            continue
        by_line: dict[int, list[int]] = {}
        for line, contexts in found.contexts_by_lineno(file).items():
            indexes = {known[context] for context in contexts if context in known}
            for context in contexts:
                indexes.update(sharing.get(context, []))
            by_line[line] = sorted(indexes)
        lines[str(Path(file).relative_to(ROOT))] = by_line
    seen = {*lines, *(note["test"].split("::")[0] for note in notes)}
    digests = {name: digest(ROOT / name) for name in sorted(seen)}
    kept = {"tests": notes, "lines": lines, "digests": digests, "stopped": stopped}
    (WORK / f"{room}.json").write_text(json.dumps(kept))


def measure(wanted: list[str], afresh: bool) -> None:
    """Measures what is not measured, within MEASURING_MOST_S."""
    WORK.mkdir(parents=True, exist_ok=True)
    began_s = time.monotonic()
    for room in wanted:
        if (WORK / f"{room}.json").is_file() and not afresh:
            continue
        left_s = MEASURING_MOST_S - (time.monotonic() - began_s)
        if left_s < 10.0:
            print(f"not measured, for lack of time: tests/tools/{room}", flush=True)
            continue
        room_s = time.monotonic()
        measure_room(room, min(ROOM_MOST_S, left_s))
        print(f"measured tests/tools/{room}: {time.monotonic() - room_s:.0f} s", flush=True)


def read(wanted: list[str]) -> Measured:
    """What was measured of the rooms."""
    found = Measured()
    for room in wanted:
        path = WORK / f"{room}.json"
        if not path.is_file():
            continue
        kept = json.loads(path.read_text())
        names = [note["test"] for note in kept["tests"]]
        good = {note["test"] for note in kept["tests"] if note["passes"]}
        found.tests.update(
            {n["test"]: Candidate(n["test"], n["cpu_s"], n["wall_s"]) for n in kept["tests"] if n["test"] in good}
        )
        for file, by_line in kept["lines"].items():
            for line, indexes in by_line.items():
                found.lines[file, int(line)].update({names[i] for i in indexes} & good)
                if not indexes:
                    found.at_import.add((file, int(line)))
        found.digests.update(kept["digests"])
        found.rooms.append(room)
        if kept["stopped"]:
            found.stopped.append(room)
    return found


def inside_functions(text: str) -> set[int]:
    """Lines that run when a function is called: its body, without its head, whose defaults run at the import."""
    found: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            found.update(range(node.body[0].lineno, (node.end_lineno or node.lineno) + 1))
    return found


def heads(text: str) -> dict[int, range]:
    """Line of a function's head, with its decorators: the lines of its body. It runs at the import, and those notice
    its change who call the function."""
    found: dict[int, range] = {}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            first, begin = node.body[0].lineno, min([node.lineno, *(one.lineno for one in node.decorator_list)])
            found.update(dict.fromkeys(range(begin, first), range(first, (node.end_lineno or first) + 1)))
    return found
