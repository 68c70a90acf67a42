"""The judge of the Python tools' tests: a planted mistake is killed, the same written otherwise survives, and what is
imported is the mutant, also by a `brace` that a test starts."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("universalmutator", reason="./dev mutants installs it")

import python_bench
import python_generate
import python_mutants
from generate import ROOT, Mutant
from python_lines import Measured, Candidate, environment, heads, inside_functions, judged_files

FILE = "tools/brace/model/limb.py"
LINE = "        return float(toml.number(self.values, key))"
VERSION = '__version__ = "'
LIMB_TEST = "tests/tools/model/test_limb_files.py::test_missing_tables_mean_no_effect"

pytestmark = pytest.mark.minutes  # each begins a run of pytest


def planted(new: str, file: str = FILE, old: str = LINE) -> Mutant:
    lines = (ROOT / file).read_text().splitlines()
    number = next(n for n, line in enumerate(lines, 1) if line.startswith(old))
    return Mutant(file, number, lines[number - 1], new)


def judge_of(*tests: str) -> python_mutants.Judge:
    mutant = planted("")
    known = {name: Candidate(name, 0.1, 0.1) for name in tests}
    measured = Measured(known)
    measured.lines[mutant.file, mutant.line] = set(tests)
    return python_mutants.Judge(python_mutants.Candidates(measured))


def test_a_planted_mistake_is_killed() -> None:
    outcome = judge_of(LIMB_TEST).judge(planted(LINE + " * 2.0"))
    assert outcome.state == python_mutants.KILLED
    assert outcome.by.startswith(LIMB_TEST)


def test_the_same_written_otherwise_survives() -> None:
    outcome = judge_of(LIMB_TEST).judge(planted(LINE + " + 0.0"))
    assert (outcome.state, outcome.tests) == (python_mutants.SURVIVES, 1)


def test_a_file_of_the_tools_that_is_named_like_a_test_is_replaced_too(tmp_path: Path) -> None:
    file = "tools/brace/dataset/check_joint_test.py"
    test = tmp_path / "test_it.py"
    test.write_text("def test_it() -> None:\n    import brace.dataset.check_joint_test\n")
    mutant = planted("raise ValueError", file, "TORQUE_SLIPS")
    ending = python_bench.run_tests([Candidate(f"{test}::test_it", 0.1, 0.1)], mutant)
    assert (ending.passes, ending.seen) == (False, True)


def test_what_never_ends_is_killed() -> None:
    outcome = judge_of(LIMB_TEST).judge(planted("        while True: pass"))
    assert (outcome.state, outcome.by) == (python_mutants.KILLED, "no end in time")


def test_a_test_that_does_not_import_the_file_says_nothing() -> None:
    outcome = judge_of("tests/judges/coverage/test_judging.py").judge(planted(LINE + " * 2.0"))
    assert outcome.state == python_mutants.NOT_IMPORTED


def test_a_test_that_fails_anyway_kills_nothing(tmp_path: Path) -> None:
    failing = tmp_path / "test_failing.py"
    failing.write_text("import brace.model.limb\n\ndef test_it() -> None:\n    assert False\n")
    outcome = judge_of(f"{failing}::test_it").judge(planted(LINE + " * 2.0"))
    assert outcome.state != python_mutants.KILLED


@pytest.mark.parametrize("command", [[str(Path(sys.executable).parent / "brace")], [sys.executable, "-m", "brace"]])
def test_a_brace_that_a_test_starts_is_the_mutant(command: list[str], tmp_path: Path) -> None:
    mutant = planted(f'{VERSION}of a mutant"', "tools/brace/__init__.py", VERSION)
    given = {**environment(), **python_bench.replacing(mutant, tmp_path)}
    done = subprocess.run([*command, "--version"], env=given, capture_output=True, text=True, check=True)
    assert "of a mutant" in done.stdout
    assert (tmp_path / "seen").read_text().endswith(" brace\n")
    assert "of a mutant" not in (ROOT / mutant.file).read_text()
    plain = subprocess.run([*command, "--version"], env={**os.environ}, capture_output=True, text=True, check=True)
    assert "of a mutant" not in plain.stdout


def test_what_no_run_can_tell_apart_does_not_count() -> None:
    mutant = planted("")
    of = {
        LINE.replace("self.values, key)", "key, self.values)"): python_generate.COUNTS,
        LINE.replace("float(", "(float)("): python_generate.SAME,
        LINE.replace("))", ")"): python_generate.REFUSED,
        LINE.replace("toml.number", "toml.numbers"): python_generate.REFUSED,
    }
    assert {new: python_generate.verdict(Mutant(FILE, mutant.line, mutant.old, new)) for new in of} == of
    annotated = planted("    def number(self, key: int) -> float:", old="    def number(self")
    assert python_generate.verdict(annotated) == python_generate.SAME
    said, other = 'x = f"{key} is a number of the limb"', 'x = f"{key} is no number of the limb"'
    assert python_generate.bare_code(said, True) == python_generate.bare_code(other, True)
    said, other = 'x = f"{key:.3f}"', 'x = f"{key:.4f}"'
    assert python_generate.bare_code(said, True) != python_generate.bare_code(other, True)


def test_every_file_as_it_is_has_its_own_names_only() -> None:
    for file in judged_files():
        assert python_generate.names_in(python_generate.text_of(file)) <= python_generate.own_names(file), file


def test_the_body_of_a_function_is_inside_and_its_head_is_not() -> None:
    text = "A = 1\n@cache\ndef f(\n    b=A,\n):\n    return b\n"
    assert inside_functions(text) == {6}
    assert heads(text) == dict.fromkeys((2, 3, 4, 5), range(6, 7))


def test_the_order_begins_with_a_line_of_each_file() -> None:
    wanted = {FILE: inside_functions((ROOT / FILE).read_text()), "tools/brace/__init__.py": {3}}
    found = list(python_generate.order(wanted, 3))
    assert len({file for file, _ in found}) == 2
    assert len(found) == len(set(found))
    assert list(python_generate.order(wanted, 3)) == found


def test_the_interval_holds_the_share() -> None:
    low, high = python_mutants.interval(140, 150)
    assert low < 100.0 * 140 / 150 < high
    assert (round(low, 1), round(high, 1)) == (88.2, 96.3)
