"""Mutants of the firmware by universalmutator's rules for C, and a sample of them over all files."""

from __future__ import annotations

import contextlib
import io
import random
import re
from dataclasses import dataclass
from pathlib import Path

from universalmutator import mutator  # type: ignore[import-not-found,import-untyped,unused-ignore]

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = (
    "firmware/core/src",
    "firmware/interface/src",
    "firmware/interface/generated",
    "firmware/store/src",
    "firmware/app/src",
)
RULES = ["universal.rules", "c_like.rules", "c.rules"]
LEAST_A_FILE = 3
INSERTED = re.compile(r"\n\s*(break|continue);\n$")  # behind any line, which no compiler takes outside a loop


@dataclass(frozen=True)
class Mutant:
    """One line of a file, written otherwise."""

    file: str
    line: int
    old: str
    new: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: `{self.old.strip()}` -> `{self.new.strip()}`"


def code_lines(text: str) -> set[int]:
    """Numbers of the lines with code: not within a comment over several lines, no preprocessor's line, not blank."""
    bare = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.DOTALL)
    return {n for n, line in enumerate(bare.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")}


def mutants_of(file: str, run_lines: set[int]) -> list[Mutant]:
    """All mutants of the lines of a file that compile to something: run_lines, by gcov."""
    text = (ROOT / file).read_text()
    source = text.splitlines(keepends=True)
    wanted = code_lines(text) & run_lines
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutator.mutants_regexp(source, ruleFiles=RULES, ignorePatterns=[], ignoreStringOnly=False)
    return [
        Mutant(file, line, source[line - 1].rstrip("\n"), new.rstrip("\n"))
        for line, new, *_ in found
        if line in wanted and not INSERTED.search(new)
    ]


def files() -> list[str]:
    """Every file of the firmware that is built for a host."""
    return sorted(str(p.relative_to(ROOT)) for f in FOLDERS for p in (ROOT / f).rglob("*.[ch]"))


def order(by_file: dict[str, list[Mutant]], seed: int) -> list[Mutant]:
    """All mutants in a random order that begins with some of each file. Beyond those, each line has the same chance."""
    chance = random.Random(seed)
    first: list[Mutant] = []
    rest: list[Mutant] = []
    for name in sorted(by_file):
        mutants = by_file[name]
        lines = sorted({m.line for m in mutants})
        chance.shuffle(lines)
        for index, line in enumerate(lines):  # one mutant a line: neighbours on a line live and die together
            chosen = chance.choice([m for m in mutants if m.line == line])
            (first if index < LEAST_A_FILE else rest).append(chosen)
    chance.shuffle(rest)
    return first + rest
