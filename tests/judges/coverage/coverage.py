"""Lines and branches of the firmware that the C suites run, judged by exceptions.toml. `./dev coverage` runs it.

What no suite runs has to be an exception with its reason. An exception for what does run fails too.

exit codes: 0 all lines and enough branches run or are exceptions, 1 not so, 4 a suite or gcov failed.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import counts

EXCEPTIONS = Path(__file__).resolve().parent / "exceptions.toml"
KEPT = counts.BUILD / "counts.json"  # by suite, for tests/judges/mutants
LINES_MOST_MISSED = 0
BRANCHES_LEAST = 0.98


@dataclass(frozen=True)
class Exception_:
    """Lines that need not run: in these files, with this text. Or so many of their branches that nothing takes."""

    files: str
    line: str
    why: str
    branches: int = 0

    def covers(self, file: str, text: str) -> bool:
        return fnmatch.fnmatch(file, self.files) and re.search(self.line, text) is not None


def read_exceptions(path: Path = EXCEPTIONS) -> list[Exception_]:
    """The list; an entry says why."""
    items = tomllib.loads(path.read_text()).get("exception", [])
    found = [
        Exception_(item["files"], item["line"], " ".join(item["why"].split()), item.get("branches", 0))
        for item in items
    ]
    for entry in found:
        if len(entry.why) < 20 or not entry.line:
            raise SystemExit(f"{path.name}: {entry.files}: name the line and say why")
    return found


def text_of(file: str, number: int, texts: dict[str, list[str]]) -> str:
    """The line as it is written."""
    if file not in texts:
        texts[file] = (counts.ROOT / file).read_text().splitlines()
    return texts[file][number - 1]


def count_of(entry: Exception_, branches: set[counts.Branch], texts: dict[str, list[str]]) -> int:
    """How many of these branches an entry covers."""
    return sum(entry.covers(file, text_of(file, number, texts)) for file, number, _ in branches)


def main() -> int:
    parser = argparse.ArgumentParser(description="what the C suites run of the firmware")
    parser.add_argument("--known", action="store_true", help="judge the counts of the last run")
    parser.add_argument("--branches", action="store_true", help="list the branches that nothing takes")
    asked = parser.parse_args()
    if not asked.known:
        each = counts.of_each_suite(counts.BUILD / "counts")
        KEPT.write_text(
            json.dumps(
                {
                    name: {
                        "lines": [[*k, n] for k, n in c.lines.items()],
                        "branches": [[*k, n] for k, n in c.branches.items()],
                    }
                    for name, c in each.items()
                }
            )
        )
    total = counts.Counts()
    for one in json.loads(KEPT.read_text()).values():
        total.add(
            counts.Counts({(f, n): c for f, n, c in one["lines"]}, {(f, n, i): c for f, n, i, c in one["branches"]})
        )
    texts: dict[str, list[str]] = {}
    listed = read_exceptions()
    exceptions = [entry for entry in listed if not entry.branches]
    missed = sorted(place for place, count in total.lines.items() if count == 0)
    excused = {place for place in missed if any(e.covers(place[0], text_of(*place, texts)) for e in exceptions)}
    idle = [e for e in exceptions if not any(e.covers(f, text_of(f, n, texts)) for f, n in excused)]
    not_taken = sorted(place for place, count in total.branches.items() if count == 0)
    for file, number in missed:
        if (file, number) not in excused:
            print(f"{file}:{number}: no suite runs this: {text_of(file, number, texts).strip()}")
    excused_branches = {
        place for place in not_taken for e in listed if e.branches and e.covers(place[0], text_of(*place[:2], texts))
    }
    wrong = [e for e in listed if e.branches and e.branches != count_of(e, excused_branches, texts)]
    if asked.branches:
        for file, number, index in sorted(set(not_taken) - excused_branches):
            print(f"{file}:{number}: branch {index}: {text_of(file, number, texts).strip()}")
    for entry in idle:
        print(f"exceptions.toml: {entry.files}, {entry.line!r}: the suites run it, or it is gone")
    for entry in wrong:
        count = count_of(entry, excused_branches, texts)
        print(f"exceptions.toml: {entry.files}, {entry.line!r}: nothing takes {count} branches, not {entry.branches}")
    judged = len(total.branches) - len(excused_branches)
    taken = 1.0 - (len(not_taken) - len(excused_branches)) / judged
    print(
        f"{len({f for f, _ in total.lines})} files; {len(total.lines)} lines, {len(total.lines) - len(missed)} run, "
        f"{len(excused)} are exceptions; {len(total.branches)} branches, "
        f"{len(excused_branches)} are exceptions, {100.0 * taken:.2f} % of the others taken"
    )
    return 1 if len(missed) - len(excused) > LINES_MOST_MISSED or taken < BRANCHES_LEAST or idle or wrong else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except counts.ToolError as error:
        print(f"coverage: {error}", file=sys.stderr)
        sys.exit(4)
