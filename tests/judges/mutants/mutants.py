"""How many mistakes put into the firmware do its C suites find? `./dev mutants` runs it.

usage: mutants.py [--count N] [--seed S] [--only GLOB] [--afresh]

A mutant is a file of the firmware with one line changed by universalmutator's rules. Only lines that some suite runs
are mutated (./dev coverage lists the others). A mutant that the compiler refuses, or of which it makes the same
object as without, does not count. Every other one is given to the suites that run its line, until one fails: then it
is killed. A suite that includes a header is made anew with the header's mutant. The suites are the unit tests; power
cuts, fuzzers and TOO_LONG take too long for each mutant.
Outcomes are kept in build/mutants/outcomes.jsonl, so that a run that was stopped goes on.

exit codes: 0 enough are killed and every survivor is argued for in survivors.toml, 1 not so, 4 a tool failed.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import shutil
import sys
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import bench
import generate

HERE = Path(__file__).resolve().parent
KEPT = bench.WORK / "outcomes.jsonl"
COSTS = bench.WORK / "costs.json"
COUNTS = bench.BUILD / "counts.json"
KILLED_LEAST = 0.95
COUNT = 500
SEED = 1
TOO_LONG = ("test_app_wrap",)  # plays the clock once round
KILLED, SURVIVES, REFUSED, SAME = "killed", "survives", "refused by the compiler", "same object"


@dataclass(frozen=True)
class Outcome:
    """What came of a mutant. by: what the suite that killed it said."""

    mutant: generate.Mutant
    state: str
    by: str = ""


def read_counts() -> dict[str, dict[str, list[list[Any]]]]:
    """What ./dev coverage has counted of each suite."""
    if not COUNTS.is_file():
        raise bench.BuildError("build/coverage/counts.json is missing; run ./dev coverage first")
    counts: dict[str, dict[str, list[list[Any]]]] = json.loads(COUNTS.read_text())
    return counts


def suites_by_line() -> dict[tuple[str, int], list[str]]:
    """Line of the firmware: the suites that run it."""
    found = defaultdict(list)
    for suite, one in read_counts().items():
        for file, line, count in one["lines"]:
            if count:
                found[file, line].append(suite)
    return found


def read_costs() -> dict[str, float]:
    """Processor time [s] of a run of each suite that passed without a mutant."""
    costs: dict[str, float] = json.loads(COSTS.read_text()) if COSTS.is_file() else {}
    return costs


class Judge:
    """Compiles mutants and gives them to suites."""

    def __init__(self) -> None:
        self.bench = bench.Bench()
        self.suites = {suite.name: suite for suite in self.bench.build()}
        self.by_line = suites_by_line()
        counted, counted_s = read_counts().keys(), COUNTS.stat().st_mtime
        self.uncounted = [
            name
            for name, source in self.bench.source_of().items()
            if name not in counted or (bench.ROOT / source).stat().st_mtime > counted_s
        ]
        self.by_file: dict[str, set[str]] = defaultdict(set)
        for (file, _), names in self.by_line.items():
            self.by_file[file].update(names)
        self.kills: Counter[tuple[str, str]] = Counter()
        self.folder = bench.WORK / "mutant"
        costs, looked_at = read_costs(), COSTS.stat().st_mtime if COSTS.is_file() else 0.0
        for name, suite in self.suites.items():
            if name not in costs or self.bench.newest_of(name) > looked_at:
                ending = bench.run_suite(suite, bench.WORK, 300)
                if not ending.passes:
                    raise bench.BuildError(f"{name} fails without a mutant: {ending.words}")
                costs[name] = ending.cpu_s
                COSTS.write_text(json.dumps(costs))
            self.suites[name] = replace(suite, cpu_s=costs[name])

    def _compile(self, mutant: generate.Mutant) -> dict[str, Path] | None:
        """Objects that differ from those without the mutant; None: the compiler refuses it."""
        shutil.rmtree(self.folder, ignore_errors=True)
        tree = self.folder / "tree" / mutant.file
        tree.parent.mkdir(parents=True)
        lines = (bench.ROOT / mutant.file).read_text().splitlines(keepends=True)
        lines[mutant.line - 1] = mutant.new + "\n"
        tree.write_text("".join(lines))
        users = [mutant.file] if mutant.file.endswith(".c") else self.bench.users_of(mutant.file)
        objects = {}
        for user in users:
            output = self.folder / (user.replace("/", "+") + ".o")
            command = self.bench.commands[user]
            words = command.to(output)
            if user == mutant.file:
                words[words.index(str(bench.ROOT / user))] = str(tree)
                words[1:1] = [
                    "-iquote",
                    str((bench.ROOT / user).parent),
                    f"-ffile-prefix-map={tree}={bench.ROOT / user}",
                ]
            else:
                words = self._over(self._overlay(mutant, tree), words)
            try:
                bench.run(words, command.folder)
            except bench.BuildError:
                return None
            if output.read_bytes() != self.bench.object_of(user).read_bytes():
                objects[user] = output
        return objects

    def _overlay(self, mutant: generate.Mutant, tree: Path) -> Path:
        """A copy of firmware/ with the mutant in."""
        overlay = self.folder / "firmware"
        if not overlay.is_dir():
            shutil.copytree(bench.ROOT / "firmware", overlay)
            shutil.copy(tree, self.folder / mutant.file)
        return overlay

    def _over(self, overlay: Path, words: list[str]) -> list[str]:
        """A compiler's command with a header's mutant: its folder comes first, and quotes look there before the
        header's own folder."""
        words = [word.replace(str(bench.ROOT / "firmware"), str(overlay)) for word in words]
        return [*words, f"-ffile-prefix-map={overlay}={bench.ROOT / 'firmware'}"]

    def _with_header(self, suite: bench.Suite) -> bench.Suite:
        """A suite that includes the header whose mutant is judged, made anew with it."""
        command = self.bench.commands[self.bench.source_of()[suite.name]]
        made, program = self.folder / f"{suite.name}.o", self.folder / suite.name
        bench.run(self._over(self.folder / "firmware", command.to(made)), command.folder)
        self.bench.link_suite(made, program)
        return replace(suite, program=program)

    def _suites_of(self, mutant: generate.Mutant) -> Iterable[str]:
        """Those that run its line; those that run its file, where that has changed since the lines were counted; and
        those that have changed or come since."""
        is_counted = (bench.ROOT / mutant.file).stat().st_mtime < COUNTS.stat().st_mtime
        known = self.by_line[mutant.file, mutant.line] if is_counted else self.by_file[mutant.file]
        return [*known, *self.uncounted]

    def judge(self, mutant: generate.Mutant) -> Outcome:
        """One mutant."""
        objects = self._compile(mutant)
        if objects is None:
            return Outcome(mutant, REFUSED)
        if not objects:
            return Outcome(mutant, SAME)
        self.bench.link(self.folder, objects)
        with_header = self.bench.suites_with(mutant.file) if mutant.file.endswith(".h") else []
        wanted = {*self._suites_of(mutant), *with_header}
        names = [name for name in wanted if name in self.suites and name not in TOO_LONG]
        names.sort(key=lambda name: self.suites[name].cpu_s / (1.0 + 20.0 * self.kills[name, mutant.file]))
        for name in names:
            try:
                suite = self._with_header(self.suites[name]) if name in with_header else self.suites[name]
            except bench.BuildError:
                return Outcome(mutant, REFUSED)
            ending = bench.run_suite(suite, self.folder, int(3.0 + 10.0 * suite.cpu_s))
            if not ending.passes:
                self.kills[name, mutant.file] += 1
                return Outcome(mutant, KILLED, ending.words[:160])
        return Outcome(mutant, SURVIVES)


def read_kept() -> dict[generate.Mutant, Outcome]:
    """Outcomes of earlier runs of mutants whose line is still the same."""
    found = {}
    for text in KEPT.read_text().splitlines() if KEPT.is_file() else []:
        item = json.loads(text)
        mutant = generate.Mutant(**item["mutant"])
        found[mutant] = Outcome(mutant, item["state"], item["by"])
    return found


@dataclass(frozen=True)
class Argument:
    """Why no suite needs to find a mutant. behind: the line before it, where its own stands in the file twice."""

    behind: str
    why: str


Arguments = dict[tuple[str, str, str], list[Argument]]


def read_argued() -> Arguments:
    """survivors.toml: file, line without and with the mutant: the arguments."""
    found = defaultdict(list)
    for item in tomllib.loads((HERE / "survivors.toml").read_text()).get("survivor", []):
        key = (item["file"], item["old"].strip(), item["new"].strip())
        found[key].append(Argument(item.get("behind", ""), " ".join(item["why"].split())))
    return found


def argued(mutant: generate.Mutant, known: Arguments) -> str:
    """The argument for this mutant, or nothing."""
    before = (bench.ROOT / mutant.file).read_text().splitlines()[mutant.line - 2].strip()
    arguments = known.get((mutant.file, mutant.old.strip(), mutant.new.strip()), [])
    return next((argument.why for argument in arguments if argument.behind in ("", before)), "")


def report(outcomes: list[Outcome], seed: int) -> int:
    """Prints the figures and the survivors. returns the exit code"""
    known = read_argued()
    counted = [outcome for outcome in outcomes if outcome.state in (KILLED, SURVIVES)]
    alive = [outcome.mutant for outcome in counted if outcome.state == SURVIVES]
    for mutant in alive:
        print(f"{mutant}\n    {argued(mutant, known) or 'NOT ARGUED FOR'}")
    states = Counter(outcome.state for outcome in outcomes)
    share = 1.0 - len(alive) / max(1, len(counted))
    unargued = sum(not argued(mutant, known) for mutant in alive)
    print(
        f"seed {seed}: {len(counted)} mutants in {len({o.mutant.file for o in counted})} files, "
        f"{len(counted) - len(alive)} killed ({100.0 * share:.1f} %), {len(alive)} survive, "
        f"{unargued} of them not argued for; beside them {states[REFUSED]} that the compiler refuses and "
        f"{states[SAME]} with the same object"
    )
    return 1 if share < KILLED_LEAST or unargued else 0


def main() -> int:
    parser = argparse.ArgumentParser(description="how many mistakes put into the firmware its C suites find")
    parser.add_argument("--count", type=int, default=COUNT, help="mutants that count (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=SEED, help="of the sample (default: %(default)s)")
    parser.add_argument("--only", default="*", help="files of this pattern")
    parser.add_argument("--survivors", action="store_true", help="judge the survivors of earlier runs again")
    parser.add_argument("--afresh", action="store_true", help="judge again what was judged")
    parser.add_argument("--known", action="store_true", help="judge nothing, list what was judged")
    asked = parser.parse_args()
    bench.WORK.mkdir(parents=True, exist_ok=True)
    kept = {} if asked.afresh else read_kept()
    if asked.survivors:
        kept = {mutant: outcome for mutant, outcome in kept.items() if outcome.state != SURVIVES}
    lines = defaultdict(set)
    for (file, line), names in suites_by_line().items():
        if names:
            lines[file].add(line)
    by_file = {name: generate.mutants_of(name, lines[name]) for name in generate.files() if lines[name]}
    by_file = {name: found for name, found in by_file.items() if found and fnmatch.fnmatch(name, asked.only)}
    judge = None if asked.known else Judge()
    outcomes: list[Outcome] = []
    counted = 0
    with KEPT.open("w" if asked.afresh else "a") as log:
        for mutant in generate.order(by_file, asked.seed):
            if counted >= asked.count:
                break
            outcome = kept.get(mutant)
            if outcome is None and judge is not None:
                outcome = judge.judge(mutant)
                log.write(json.dumps(asdict(outcome)) + "\n")
                log.flush()
                if outcome.state == SURVIVES:
                    print(f"survives: {mutant}", flush=True)
            if outcome is not None:
                outcomes.append(outcome)
                counted += outcome.state in (KILLED, SURVIVES)
    return report(outcomes, asked.seed)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except bench.BuildError as error:
        print(f"mutants: {error}", file=sys.stderr)
        sys.exit(4)
