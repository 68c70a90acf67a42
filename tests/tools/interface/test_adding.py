"""The examples of docs/adding.md, done for real: a parameter, a message, a fault and a request are added to a copy of
the project, as the page says it. The generator runs, the copy's own suites are built and run, and without any one of
the steps something fails. effects/test_adding_an_effect.py does the same of the effect."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from adding_page import PROJECT, Step, steps

EXAMPLES = ("Adding a parameter", "Adding a message", "Adding a fault", "Adding a request")
STEPS = [step for example in EXAMPLES for step in steps(example)]
pytestmark = pytest.mark.skipif(any(step.is_done for step in STEPS), reason="the examples stand in the project itself")
SUITES = ("test_app_warmth", "test_generated", "test_can_process_data", "test_can_data", "test_can_codecs",
          "test_parameters", "test_code_names", "test_wires")  # fmt: skip
LEFT_BEHIND = ("build", ".git", ".venv", ".cache", "__pycache__", ".pytest_cache", ".mypy_cache", "*.egg-info")
NEEDED = ("firmware", "hal/include", "hal/fake", "tools/interface", "tools/brace", "tests/unit", "docs", "host_sim/api")
INCLUDES = (
    "firmware/core/include",
    "firmware/interface/include",
    "firmware/interface/generated",
    "firmware/app/include",
    "firmware/app/src",
    "firmware/store/include",
    "hal/include",
    "hal/fake/include",
    "tests/unit/bench",
)
LONG_S = 1500.0  # for a build on a busy machine: nobody waits for ever


def run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(folder / "tools")}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False,
                          timeout=LONG_S)  # fmt: skip


def done(command: list[str], folder: Path) -> str:
    ran = run(command, folder)
    assert ran.returncode == 0, f"{' '.join(command)}\n{ran.stdout[-3000:]}\n{ran.stderr[-3000:]}"
    return ran.stdout


def generate(project: Path) -> subprocess.CompletedProcess[str]:
    return run([sys.executable, "-m", "interface"], project / "tools")


def part_of_project(folder: Path) -> Path:
    """What the generator and a compiler's front end need."""
    for name in NEEDED:
        shutil.copytree(PROJECT / name, folder / name, ignore=shutil.ignore_patterns(*LEFT_BEHIND))
    return folder


@pytest.fixture(scope="module")
def unity() -> str:
    cache = (PROJECT / "build" / "host" / "CMakeCache.txt").read_text()
    (line,) = [line for line in cache.splitlines() if line.startswith("UNITY_ROOT")]
    return line.partition("=")[2]


@pytest.mark.minutes
def test_the_copy_s_own_suites_pass(tmp_path: Path, unity: str) -> None:
    project = tmp_path / "project"
    shutil.copytree(PROJECT, project, ignore=shutil.ignore_patterns(*LEFT_BEHIND), symlinks=True)
    for step in STEPS:
        step.do(project)
    assert generate(project).returncode == 0
    assert done([sys.executable, "-m", "interface", "--check"], project / "tools") == ""
    build = project / "build" / "host"
    done(["cmake", "--preset", "host", f"-DUNITY_ROOT={unity}"], project)
    done(["ninja", "-C", str(build), *(f"tests/{suite}" for suite in SUITES)], project)
    for suite in SUITES:
        done([str(build / "tests" / suite)], project)
    counted = project / "tests/unit/interface/test_generated.c"  # without the new frame in its list, it names the list
    counted.write_text(counted.read_text().replace("1, /* warmth */", ""))
    done(["ninja", "-C", str(build), "tests/test_generated"], project)
    assert "frames_of_details" in run([str(build / "tests" / "test_generated")], project).stdout


def faults_without(project: Path, unity: str) -> str:
    """The message that somebody gets who has left a step out: from the generator, from the compiler, or from the test
    that misses a row. Empty: nothing is missing."""
    generated = generate(project)
    if generated.returncode != 0:
        return generated.stderr
    test = project / "tests/unit/app/test_app_warmth.c"
    answer = project / "firmware/app/src/wire/answers/throw_away.c"
    missing = [f"no {path.name}" for path in (test, answer) if not path.is_file()]
    sources = [project / "firmware/app/src/app.c", *(path for path in (test, answer) if path.is_file())]
    flags = ["-std=c11", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", f"-I{unity}", "-DUNITY_INCLUDE_FLOAT"]
    includes = [f"-I{project / name}" for name in INCLUDES]
    compiled = run(["gcc", *flags, *includes, *map(str, sources)], project)
    listed = (project / "firmware/interface/generated/brace/answering.h").read_text()
    if answer.is_file() and "throw_away" not in listed:
        missing.append("no request throw_away")
    if (
        "| 16 | `TOO_WARM` |" not in (project / "docs/errors.md").read_text()
    ):  # as tests/tools/interface/test_errors_page.py
        missing.append("no row in errors.md")
    if "1, /* warmth */" not in (project / "tests/unit/interface/test_generated.c").read_text():
        missing.append("no count of the new frame")
    return compiled.stderr + "; ".join(missing)


def test_with_all_steps_nothing_is_missing(tmp_path: Path, unity: str) -> None:
    project = part_of_project(tmp_path)
    for step in STEPS:
        step.do(project)
    assert faults_without(project, unity) == ""


def test_no_test_takes_a_name_that_the_examples_add() -> None:
    """Who follows the page has both in one project."""
    added = {name for step in STEPS for name in re.findall(r'group\]\]\n *name = "(\w+)"', step.text)}
    assert "warmth" in added
    own = {Path(__file__).name, "test_adding_an_effect.py"}
    tests = [path for path in (PROJECT / "tests/tools").rglob("test_*.py") if path.name not in own]
    taken = [(path.name, name) for path in tests for name in added if f'name = "{name}' in path.read_text()]
    assert not taken


def test_the_examples_satisfy_the_check_of_columns() -> None:
    lines = [(step.file, line) for step in STEPS for line in step.text.splitlines()]
    assert not [at for at in lines if at[0].endswith((".c", ".h", ".cpp")) and len(at[1]) > 120]


@pytest.mark.parametrize("left_out", STEPS, ids=lambda step: f"{Path(step.file).name}-{step.line[:12].strip()}")
def test_without_a_step_something_fails(left_out: Step, tmp_path: Path, unity: str) -> None:
    project = part_of_project(tmp_path)
    for step in STEPS:
        if step is not left_out:
            step.do(project)
    assert faults_without(project, unity) != ""


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ('unit = "degC"\nrange', 'unit = "rad"\nrange', "warmest_degc: its name says 'degC', its unit is 'rad'"),
        ("register = 252", "register = 226", "interface: parameters: register 226 has two values"),
        ('from = "temperature"', 'from = "heat"', "interface: warmth.warmer: no measured value is named 'heat'"),
        ("number = 200\n[[multi", "number = 16\n[[multi", "interface: warmth: 16 is that of"),
        ('unit = "degC"\ndescription = "of', 'unit = "mm"\ndescription = "of', "temperature is f32 in 'degC'"),
    ],
)
def test_a_slip_is_refused_in_one_sentence(before: str, after: str, said: str, tmp_path: Path) -> None:
    project = part_of_project(tmp_path)
    slips = 0
    for step in STEPS:
        slips += step.text.count(before)
        Step(step.file, step.place, step.line, step.text.replace(before, after, 1)).do(project)
    ran = generate(project)
    assert slips and ran.returncode == 3
    assert said in ran.stderr.splitlines()[0]
