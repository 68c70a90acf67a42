"""Every `brace` command that a page prints is one that the command line takes. Those of docs/bus.md also run, in its
order, on a simulated limb; the others run where their pages are tested (README, datasets, demo), or need files of the
reader's."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bus_bench import limb_on_tcp
from conftest import LIMB, PROJECT, Outcome
from test_bus_space import ACROSS

from brace.cli.command_line import build_parser

PAGES = sorted([PROJECT / "README.md", *(PROJECT / "docs").glob("*.md"), *(PROJECT / "examples").glob("**/*.md")])
CODE = re.compile(r"^ {4}(?=\S)")
START = re.compile(r"(?:^|(?<=; )|(?<=\$\()|(?<=\| )|(?<=do )|(?<=&& ))(?:\.venv/bin/|\S+/)?brace (?=[a-z])")


def lines_of_code(page: Path) -> Iterator[str]:
    """Indented lines, a line that ends with a backslash with the next."""
    whole = ""
    for line in page.read_text().splitlines():
        if not CODE.match(line):
            whole = ""
            continue
        whole += line.strip().removesuffix("\\")
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
            assert outcome.code == 0, f"brace {' '.join(words)}: {outcome.err}"
