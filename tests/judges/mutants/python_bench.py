"""Tests of tests/tools with a mutant in place of a file. The working tree stays as it is."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import python_lines
from python_generate import with_mutant
from generate import ROOT, Mutant

FAILED = re.compile(r"^(?:FAILED|ERROR) (\S.*)$", re.MULTILINE)  # of pytest's summary


@dataclass(frozen=True)
class Ending:
    """How a run of tests ended. failed: pytest's line of the test that failed. seen: the mutant was imported."""

    passes: bool
    failed: str
    words: str
    seen: bool

    def is_by(self, test: python_lines.Candidate) -> bool:
        """Is this the test that failed, or the module that it lies in?"""
        return self.failed == test.name or self.failed.startswith((f"{test.name} ", f"{test.name}::"))


def limit_s(normal_s: float) -> float:
    return 3.0 + 10.0 * normal_s


def run_tests(tests: list[python_lines.Candidate], mutant: Mutant | None) -> Ending:
    """Runs tests until one fails. Each has its own limit in time by pytest, and so have all together. What they leave
    behind goes with a folder of their own; its name is short, because sockets lie in it."""
    with tempfile.TemporaryDirectory(prefix="mutant", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        given = {**python_lines.environment(), "TMPDIR": name}
        if mutant is not None:
            given |= replacing(mutant, folder)
        return run_in(folder, tests, given)


def replacing(mutant: Mutant, folder: Path) -> dict[str, str]:
    """Environment variables: they tell swap/sitecustomize.py which file the mutant replaces, and with which text."""
    text = folder / "mutant.py"
    text.write_text(with_mutant(mutant))
    return {
        "BRACE_MUTANT": str(ROOT / mutant.file),
        "BRACE_MUTANT_TEXT": str(text),
        "BRACE_MUTANT_SEEN": str(folder / "seen"),
    }


def run_in(folder: Path, tests: list[python_lines.Candidate], given: dict[str, str]) -> Ending:
    """The run itself, in a session of its own, of which nothing is left."""
    longest_s = max(test.wall_s for test in tests)
    whole_s = 10.0 + limit_s(sum(test.wall_s for test in tests))
    late = ("-o", f"faulthandler_timeout={limit_s(longest_s):.1f}", "-o", "faulthandler_exit_on_timeout=true")
    words = python_lines.pytest_words("-x", "--tb=line", *late, *(test.name for test in tests))
    with (folder / "words").open("w") as out:
        process = subprocess.Popen(
            words,
            cwd=ROOT,
            env=given,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        try:
            code = process.wait(whole_s)
        except subprocess.TimeoutExpired:
            code = -signal.SIGKILL
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    said = (folder / "words").read_text(errors="replace")
    found = FAILED.search(said)
    if code == 0 or found:
        failed = found[1] if found else ""
        return Ending(code == 0, failed, " ".join(failed.split())[:200], (folder / "seen").exists())
    is_late = "Timeout (" in said or code == -signal.SIGKILL
    last = said.strip().splitlines()[-1] if said.strip() else f"ended with {code}"
    return Ending(False, "", "no end in time" if is_late else last[:200], (folder / "seen").exists())
