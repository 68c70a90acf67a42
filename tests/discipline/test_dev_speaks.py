"""./dev says what it does while it takes long, and passes on how it ended."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from sources import ROOT


def spoken(what: str) -> subprocess.CompletedProcess[str]:
    """What ./dev's functions do, five times a second instead of every ten seconds."""
    script = f"set -- help; source ./dev > /dev/null 2>&1; {what}"
    environment = {"DEV_SPEAK_EVERY_S": "0.2", "PATH": "/usr/bin:/bin"}
    return subprocess.run(
        ["bash", "-c", script], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=30, check=False
    )


def test_a_long_step_is_heard_and_a_short_one_is_not() -> None:
    lines = spoken('speak "a step" - sleep 1.5').stderr.splitlines()
    assert 2 <= len(lines) <= 8 and all(re.fullmatch(r"a step: \d+ s so far", line) for line in lines)
    assert spoken('speak "a step" - true').stderr == ""


def test_it_says_how_far_a_build_is(tmp_path: Path) -> None:
    build = "echo '[1/590] Building'; echo '[12/590] Building C object'; sleep 1"
    said = spoken(f'speak build {tmp_path}/log bash -c "{build}"')
    assert re.search(r"build: \d+ s so far, \[12/590\]", said.stderr) and (tmp_path / "log").read_text().count("\n") == 2


def test_how_it_ended_is_passed_on() -> None:
    done = spoken("speak step - bash -c 'exit 7' || echo $?")
    assert done.stdout == "7\n"


def test_it_falls_silent_with_the_command() -> None:
    assert spoken("speak step - sleep 0.5; jobs -p | wc -l").stdout == "0\n"
