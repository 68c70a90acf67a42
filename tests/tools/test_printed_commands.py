"""Every `brace` command that a page prints is one that the command line takes. Those of docs/bus.md also run, in its
order, on a simulated limb; of README.md and docs/your-limb.md those that take seconds run, in a folder of their own.
ONLY_PARSED says of all others where they run, or why they do not."""

from __future__ import annotations

import re
import shlex
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bus_bench import limb_on_tcp
from conftest import LIMB, PROJECT, Outcome
from test_bus_space import ACROSS

from brace.cli.command_line import build_parser

PAGES = sorted([PROJECT / "README.md", *(PROJECT / "docs").glob("*.md"), *(PROJECT / "examples").glob("**/*.md")])
CODE = re.compile(r"^(?: {4}| {7})(?=\S)")  # seven: below a numbered step
START = re.compile(r"(?:^|(?<=; )|(?<=\$\()|(?<=\| )|(?<=do )|(?<=&& ))(?:\.venv/bin/|\S+/)?brace (?=[a-z])")


def lines_of_code(page: Path) -> Iterator[str]:
    """Indented lines, a line that ends with a backslash with the next."""
    whole = ""
    for line in page.read_text().splitlines():
        if not (CODE.match(line) or whole and line.startswith("    ")):  # what goes on may stand further in
            whole = ""
            continue
        whole = f"{whole} {line.strip().removesuffix(chr(92))}".strip()
        if not line.endswith("\\"):
            yield whole
            whole = ""


def commands_of(page: Path) -> list[list[str]]:
    """The words behind `brace` of each command."""
    found = []
    for line in lines_of_code(page):
        match = START.search(line)
        if match:
            text = re.split(r" (?:[|>&]|2>|&&|;) ?|; ", line[match.end() :])[0]
            found.append(shlex.split(text, comments=True))
    return found


PRINTED = [(page, words) for page in PAGES for words in commands_of(page)]


def test_there_are_commands() -> None:
    assert len(PRINTED) > 50
    assert {"README.md", "bus.md", "diagnose.md", "datasets.md", "your-limb.md"} <= {page.name for page, _ in PRINTED}


@pytest.mark.parametrize(("page", "words"), PRINTED, ids=[f"{page.name}: {' '.join(words)}" for page, words in PRINTED])
def test_the_command_line_takes_it(page: Path, words: list[str]) -> None:
    whole = [word for word in words if word != "..."]  # "and so on"
    arguments = build_parser(whole).parse_args(whole)
    assert callable(arguments.run)


SHORT_S = "1"
ELSEWHERE = {  # how such a command begins: where it runs
    ("monitor", "--bus", "can0", "--web"): "test_live_page.py",
    ("record", "--bus", "can0", "--loading-test"): "test_bus_logs.py",
    ("replay", "run.log", "--bus", "can1"): "test_bus_socketcan.py",
}


def on_this_bus(words: list[str], url: str) -> list[str]:
    """The printed words for a bus of the test, and for a second instead of a minute or for ever."""
    changed = [url if word == "can0" else word for word in words]
    if "--seconds" in changed:
        changed[changed.index("--seconds") + 1] = SHORT_S
    elif changed[0] == "monitor":
        changed += ["--seconds", SHORT_S]
    return changed


@pytest.mark.parametrize("gap_rad", [0.0, 0.006], ids=["without play", "with play"])
def test_the_page_of_the_bus_runs(
    brace: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, gap_rad: float
) -> None:
    """On a limb in space; what takes up play, and lets go, on a limb with play. The page's limb is `limb.toml`."""
    page = next(page for page in PAGES if page.name == "bus.md")
    printed = [words for words in commands_of(page) if not any(tuple(words[: len(skip)]) == skip for skip in ELSEWHERE)]
    printed = [words for words in printed if (words[0] in ("take-up", "let-go")) == (gap_rad > 0.0)]
    assert len(printed) == 2 if gap_rad > 0.0 else len(printed) > 20
    monkeypatch.chdir(tmp_path)
    limb = LIMB.replace("bending_mm_per_n = 0.25", "bending_mm_per_n = 0.25\nlateral_mm_per_n = 0.2")
    for joint in ("femur", "tibia"):
        limb = limb.replace(f"[joint.{joint}]", f"[joint.{joint}]\ngap_rad = {gap_rad}")
    Path("limb.toml").write_text(limb + ACROSS)
    with limb_on_tcp(Path("limb.toml")) as url:
        for words in printed:
            outcome = brace(*on_this_bus(words, url))
            assert outcome.code == 0, f"brace {' '.join(words)}: {outcome.out[-1500:]}{outcome.err}"


RUN = {  # page: how the commands begin that run here, in the page's order
    "README.md": (("k",), ("simulate",)),
    "your-limb.md": (("new", "--out", "limb.toml", "--femur"), ("export",)),
}
ONLY_PARSED = {  # page, and how the commands begin: why
    ("README.md", "sim"): "runs until it is ended; tests/socketcan/test_readme_lines.py",
    ("README.md", "query"): "tests/socketcan/test_readme_lines.py",
    ("README.md", "monitor"): "tests/socketcan/test_readme_lines.py",
    ("README.md", "map"): "half a minute on a busy machine; test_map_and_process.py maps less",
    ("README.md", "plan"): "seconds of search; test_plan.py",
    ("README.md", "diagnose"): "a minute on a busy machine; tests/tools/diagnose",
    ("README.md", "flash"): "needs the firmware's images; test_flash.py",
    ("calibrate.md", ""): "minutes of fits; test_identify.py and test_plays.py run such commands on small records",
    ("datasets.md", "import"): "files of the reader's; tests/tools/importing",
    ("diagnose.md", ""): "the first two are the README's; a controller's record and fleets: tests/tools/diagnose",
    ("joint-tests.md", "diagnose"): "a record of the reader's; tests/tools/diagnose",
    ("joints.md", "sim"): "needs servos; tests/servo",
    ("plan.md", "plan"): "as the README's; test_plan.py",
    ("porting.md", ""): "needs a board; test_doctor.py and test_flash.py",
    ("your-limb.md", "new --out limb.toml --urdf"): "a URDF of the reader's; tests/tools/new",
    ("bus.md", ""): "below",
}


def _runs_here(page: Path, words: list[str]) -> bool:
    return any(tuple(words[: len(begin)]) == begin for begin in RUN.get(page.name, ()))


def test_each_printed_command_runs_or_has_its_reason() -> None:
    used = set()
    for page, words in PRINTED:
        reasons = [key for key in ONLY_PARSED if key[0] == page.name and " ".join(words).startswith(key[1])]
        assert _runs_here(page, words) or reasons, f"{page.name}: brace {' '.join(words)}: run it, or say why not"
        used |= set(reasons)
    assert used == set(ONLY_PARSED), "a reason for what no page prints"


@pytest.mark.parametrize("name", RUN)
def test_a_page_runs_in_its_order(
    brace: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """With the lines of sed between them, in a folder that has the project's limb where the page says."""
    monkeypatch.chdir(tmp_path)
    Path("tools").symlink_to(PROJECT / "tools")
    page = next(page for page in PAGES if page.name == name)
    ran = set()
    for line in lines_of_code(page):
        if line.startswith("sed "):
            subprocess.run(line, shell=True, check=True)
        if (match := START.search(line)) is None:
            continue
        words = shlex.split(line[match.end() :], comments=True)
        if _runs_here(page, words):
            outcome = brace(*words)
            assert outcome.code == 0, f"brace {' '.join(words)}: {outcome.out[-1500:]}{outcome.err}"
            ran |= {begin for begin in RUN[name] if tuple(words[: len(begin)]) == begin}
    assert ran == set(RUN[name])
