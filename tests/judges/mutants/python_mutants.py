"""How many mistakes put into the Python tools do their tests find? `./dev mutants --python` runs it.

usage: python_mutants.py [--count N] [--seed S] [--only GLOB] [--survivors] [--afresh] [--known] [--measure ROOM]

A mutant is a file of tools/brace or tools/interface with one line changed by universalmutator's rules. Generated
files, tools/brace/demo, imports, lines that remove files or end processes, and what is only a text or a type are left
out. Only lines that some test of tests/tools runs are mutated: coverage.py notes which, once, room by room. One line
of each file comes first. A mutant that Python refuses, that names what its file does not know, or whose bytecode is
the same does not count.
Every other one is given to the tests that run its line, then to those of the same modules that run its file, the
quickest first, TESTS_MOST_S together; a test fails also when it does not end. Tests marked minutes, and those that
take longer than TESTS_MOST_S, do not judge. A test that fails must pass without the mutant.
The mutant never lies in the working tree: swap/sitecustomize.py gives its text to whoever imports its file.
Outcomes are kept in build/mutants/python-outcomes.jsonl, so that a run that was stopped goes on.

exit codes: 0 judged, 4 a tool failed.
"""

from __future__ import annotations

import argparse
import ast
import fnmatch
import json
import math
import sys
import time
from collections import Counter, defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path

import python_bench
import python_generate
import python_lines
from generate import ROOT, Mutant
from python_lines import JudgeError, Measured, Candidate

KEPT = ROOT / "build" / "mutants" / "python-outcomes.jsonl"
COUNT = 150
SEED = 1
TESTS_MOST_S = 20.0
FIRST_S = 2.0  # of tests in the first run of a mutant: most are killed there, and a run has its start to pay
KILLED, SURVIVES, NOT_IMPORTED = "killed", "survives", "imported by none of its tests"


@dataclass(frozen=True)
class Outcome:
    """What came of a mutant. by: what the test that killed it said. tests: how many had it; left_out: how many that
    run its line did not, for lack of time."""

    mutant: Mutant
    state: str
    by: str = ""
    tests: int = 0
    left_out: int = 0


def importers(files: list[str]) -> dict[str, set[str]]:
    """File: those that import it."""
    by_module = {name.removeprefix("tools/").removesuffix(".py").replace("/", "."): name for name in files}
    by_module |= {module.removesuffix(".__init__"): name for module, name in by_module.items()}
    found: dict[str, set[str]] = defaultdict(set)
    for name in files:
        for node in ast.walk(ast.parse((ROOT / name).read_text())):
            asked: list[str] = []
            if isinstance(node, ast.ImportFrom) and node.module:
                asked = [node.module, *(f"{node.module}.{one.name}" for one in node.names)]
            elif isinstance(node, ast.Import):
                asked = [one.name for one in node.names]
            for module in asked:
                if module in by_module:
                    found[by_module[module]].add(name)
    return found


class Candidates:
    """Which tests judge a line."""

    def __init__(self, measured: Measured) -> None:
        self.measured = measured
        self.files = python_lines.judged_files()
        self.importers = importers(self.files)
        self.inside = {name: python_lines.inside_functions((ROOT / name).read_text()) for name in self.files}
        self.heads = {name: python_lines.heads((ROOT / name).read_text()) for name in self.files}
        self.by_file: dict[str, set[str]] = defaultdict(set)
        for (file, line), tests in measured.lines.items():
            if line in self.inside.get(file, ()):
                self.by_file[file].update(tests)
        self.changed = {name for name, old in measured.digests.items() if self._digest(name) != old}
        modules = {test.split("::")[0] for test in measured.tests}
        self.changed_tests = modules & self.changed
        self.kills: Counter[tuple[str, str]] = Counter()
        self.failing: set[str] = set()  # without a mutant

    def _digest(self, name: str) -> str:
        return python_lines.digest(ROOT / name) if (ROOT / name).is_file() else ""

    def lines(self) -> dict[str, set[int]]:
        """Of each file, the lines that some test runs. Of one that has changed since it was measured: all."""
        found: dict[str, set[int]] = defaultdict(set)
        for file, line in self.measured.lines:
            if file in self.inside and self.running(file, line):
                found[file].add(line)
        known = {}
        for file, lines in found.items():
            text = (ROOT / file).read_text()
            code = python_generate.code_lines(text)
            known[file] = code if file in self.changed else code & lines
        return {file: lines for file, lines in known.items() if lines}

    def running(self, file: str, line: int) -> set[str]:
        """The tests that run a line. For one that runs at the import, they are those that call its function, or something
        of the file, or of a file that imports it. So they are where the file has changed since."""
        known = set(self.measured.lines.get((file, line), ()))
        is_within = line in self.inside[file] and (file, line) not in self.measured.at_import
        if file not in self.changed and is_within:
            return known
        body = self.heads[file].get(line, range(0))
        called = {test for one in body for test in self.measured.lines.get((file, one), ())}
        if called and file not in self.changed:
            return called
        users = {test for user in self.importers[file] for test in self.by_file[user]}
        return known | self.by_file[file] | (set() if self.by_file[file] else users)

    def beside(self, file: str, tests: set[str]) -> set[str]:
        """The other tests of the same modules that run the file: what a test keeps for the next one, a table that is
        made once, runs in the first only."""
        modules = {test.split("::")[0] for test in tests}
        return {test for test in self.by_file[file] if test.split("::")[0] in modules} - tests

    def chosen(self, mutant: Mutant) -> tuple[list[Candidate], int]:
        """The tests that judge a mutant, in order, and how many that run its line are left out."""
        first = self.running(mutant.file, mutant.line)
        second = self.beside(mutant.file, first)
        room = "/".join(Path(mutant.file).parts[2:3])

        def cost(name: str) -> float:
            near = 0.2 if name.startswith(f"tests/tools/{room}/") else 1.0
            return near * self.measured.tests[name].wall_s / (1.0 + 20.0 * self.kills[name, mutant.file])

        chosen: list[Candidate] = []
        left_out, sum_s = 0, 0.0
        # What a module that has changed runs is not known: it judges as a whole.
        modules = sorted(self.changed_tests & {test.split("::")[0] for test in first | second})
        for module in modules:
            parts = [test for test in self.measured.tests.values() if test.name.startswith(f"{module}::")]
            whole = Candidate(module, sum(test.cpu_s for test in parts), sum(test.wall_s for test in parts))
            if sum_s + whole.wall_s <= TESTS_MOST_S:
                sum_s += whole.wall_s
                chosen.append(whole)
        as_a_whole = {test.name for test in chosen}
        for name in [*sorted(first, key=cost), *sorted(second, key=cost)]:
            test = self.measured.tests[name]
            if name in self.failing or name.split("::")[0] in as_a_whole:
                continue
            if sum_s + test.wall_s <= TESTS_MOST_S:
                sum_s += test.wall_s
                chosen.append(test)
            elif name in first:
                left_out += 1
        return chosen, left_out


class Judge:
    """Gives mutants to tests."""

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        self.good: set[str] = set()  # failed with a mutant, and pass without

    def _fail_without(self, tests: list[Candidate]) -> bool:
        """Do tests fail without a mutant, too? Those judge no more."""
        if all(test.name in self.good for test in tests):
            return False
        ending = python_bench.run_tests(tests, None)
        if ending.passes:
            self.good.update(test.name for test in tests)
            return False
        guilty = [test.name for test in tests if ending.is_by(test)] or [test.name for test in tests]
        self.candidates.failing.update(guilty)
        print(f"fails without a mutant, judges no more: {', '.join(guilty)}", flush=True)
        return True

    def judge(self, mutant: Mutant) -> Outcome:
        """One mutant."""
        tests, left_out = self.candidates.chosen(mutant)
        begun, seen = 0, False
        while begun < len(tests):
            most_s, part = FIRST_S if begun == 0 else math.inf, tests[begun : begun + 1]
            for test in tests[begun + 1 :]:
                if sum(one.wall_s for one in part) + test.wall_s > most_s:
                    break
                part.append(test)
            ending = python_bench.run_tests(part, mutant)
            seen = seen or ending.seen
            if ending.passes:
                begun += len(part)
                continue
            suspects = [test for test in part if ending.is_by(test)] or part
            if ending.seen and not self._fail_without(suspects):
                if len(suspects) == 1:
                    self.candidates.kills[suspects[0].name, mutant.file] += 1
                return Outcome(mutant, KILLED, ending.words, begun + len(part), left_out)
            # Without having seen the mutant it failed for another reason.
            tests = [t for t in tests if t.name not in self.candidates.failing and (ending.seen or t not in suspects)]
        return Outcome(mutant, SURVIVES if seen else NOT_IMPORTED, "", len(tests), left_out)


def read_kept() -> dict[Mutant, Outcome]:
    """Outcomes of earlier runs of mutants whose line is still the same."""
    found = {}
    for text in KEPT.read_text().splitlines() if KEPT.is_file() else []:
        item = json.loads(text)
        mutant = Mutant(**item.pop("mutant"))
        found[mutant] = Outcome(mutant, **item)
    return found


def interval(killed: int, counted: int) -> tuple[float, float]:
    """Wilson's interval of 95 % for a share [%]."""
    z, n = 1.96, max(1, counted)
    p = killed / n
    middle, half = p + z * z / (2 * n), z * math.sqrt(p * (1.0 - p) / n + z * z / (4 * n * n))
    return 100.0 * (middle - half) / (1.0 + z * z / n), 100.0 * (middle + half) / (1.0 + z * z / n)


def report(outcomes: list[Outcome], before: Counter[str], seed: int) -> None:
    """Prints the figures and the survivors."""
    counted = [outcome for outcome in outcomes if outcome.state in (KILLED, SURVIVES)]
    alive = [outcome for outcome in counted if outcome.state == SURVIVES]
    for outcome in alive:
        left_out = f", {outcome.left_out} that run the line left out" if outcome.left_out else ""
        print(f"{outcome.mutant}\n    passes {outcome.tests} tests{left_out}")
    killed = len(counted) - len(alive)
    low, high = interval(killed, len(counted))
    states = Counter(outcome.state for outcome in outcomes)
    print(
        f"seed {seed}: {len(counted)} mutants in {len({o.mutant.file for o in counted})} files, {killed} killed "
        f"({100.0 * killed / max(1, len(counted)):.1f} %, 95 % interval {low:.1f} to {high:.1f} %), {len(alive)} "
        f"survive; for {sum(o.left_out > 0 for o in counted)} some test was left out; beside them "
        + ", ".join(f"{before[name]} {name}" for name in sorted(before))
        + f", {states[NOT_IMPORTED]} {NOT_IMPORTED}"
    )


def ask() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="how many mistakes put into the Python tools their tests find")
    parser.add_argument("--python", action="store_true", help="the word of ./dev mutants that asks for this")
    parser.add_argument("--count", type=int, default=COUNT, help="mutants that count (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=SEED, help="of the sample (default: %(default)s)")
    parser.add_argument("--only", default="*", help="files of this pattern")
    parser.add_argument("--survivors", action="store_true", help="judge the survivors of earlier runs again")
    parser.add_argument("--afresh", action="store_true", help="judge again what was judged")
    parser.add_argument("--known", action="store_true", help="judge nothing, list what was judged")
    parser.add_argument("--measure", metavar="ROOM", help="note anew which tests of a folder of tests/tools run what")
    return parser.parse_args()


def main() -> int:
    asked = ask()
    rooms = python_lines.rooms()
    if asked.measure:
        if asked.measure not in rooms:
            raise JudgeError(f"there is no tests/tools/{asked.measure} with tests")
        python_lines.measure([asked.measure], True)
        return 0
    if not asked.known:
        python_lines.measure(rooms, False)
    measured = python_lines.read(rooms)
    lacking = [room for room in rooms if room not in measured.rooms]
    print(
        f"{len(measured.tests)} tests of {len(measured.rooms)} rooms"
        + (f"; not measured: {', '.join(lacking)}" if lacking else "")
        + (f"; in part: {', '.join(measured.stopped)}" if measured.stopped else "")
    )
    kept = {} if asked.afresh else read_kept()
    if asked.survivors:
        kept = {mutant: outcome for mutant, outcome in kept.items() if outcome.state != SURVIVES}
    candidates = Candidates(measured)
    lines = {name: found for name, found in candidates.lines().items() if fnmatch.fnmatch(name, asked.only)}
    judge = Judge(candidates)
    outcomes: list[Outcome] = []
    before: Counter[str] = Counter()
    counted, began_s = 0, time.monotonic()
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    with KEPT.open("w" if asked.afresh else "a") as log:
        for file, line in python_generate.order(lines, asked.seed):
            if counted >= asked.count:
                break
            mutant, others = python_generate.choose(file, line, asked.seed)
            if mutant is None:
                before.update(others)
                continue
            outcome = kept.get(mutant)
            if outcome is None and not asked.known:
                outcome = judge.judge(mutant)
                log.write(json.dumps(asdict(outcome)) + "\n")
                log.flush()
                if outcome.state == SURVIVES:
                    print(f"survives: {mutant}", flush=True)
            if outcome is not None:
                before.update(others)
                outcomes.append(outcome)
                counted += outcome.state in (KILLED, SURVIVES)
                if counted % 10 == 0:
                    print(f"{counted} of {asked.count} after {time.monotonic() - began_s:.0f} s", flush=True)
    report(outcomes, before, asked.seed)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except JudgeError as error:
        print(f"mutants: {error}", file=sys.stderr)
        sys.exit(4)
