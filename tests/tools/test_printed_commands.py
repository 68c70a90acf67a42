"""Every `brace` command that a page prints is one that the command line takes. Those of docs/bus.md also run, in its
order, on a simulated limb; of README.md and docs/your-limb.md those that take seconds run, in a folder of their own.
ONLY_PARSED says of all others where they run, or why they do not; OTHER_PROGRAMS says it of the commands of other
programs."""

from __future__ import annotations

import re
import shlex
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bus_bench import limb_on_tcp
from command_bench import ACROSS, LIMB, PROJECT, Outcome

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
    "README.md": (("k",), ("map",), ("plan",), ("stance",), ("simulate",), ("diagnose",)),
    "your-limb.md": (("new", "--out", "limb.toml", "--femur"), ("export",)),
}
ONLY_PARSED = {  # page, and how the commands begin: why
    ("README.md", "sim"): "runs until it is ended; tests/socketcan/test_readme_lines.py",
    ("README.md", "query"): "tests/socketcan/test_readme_lines.py",
    ("README.md", "monitor"): "tests/socketcan/test_readme_lines.py",
    ("README.md", "export"): "tests/tools/new/test_exported_c.py",
    ("README.md", "flash"): "needs the firmware's images; test_flash.py",
    ("adding.md", ""): "of an effect that the reader adds; tests/tools/effects/test_adding_an_effect.py",
    ("calibrate.md", ""): "test_pages_commands.py",
    ("datasets.md", "import"): "test_pages_commands.py",
    ("diagnose.md", ""): "the first two are the README's; a controller's record and fleets: tests/tools/diagnose",
    ("joint-tests.md", "diagnose"): "test_pages_commands.py",
    ("joints.md", "sim"): "test_pages_commands.py; the one with servos on /dev/ttyUSB0 needs them: tests/servo",
    ("plan.md", "plan"): "test_pages_commands.py",
    ("install.md", "doctor"): "tests/tools/doctor",
    ("porting.md", ""): "needs a board; test_doctor.py and test_flash.py",
    ("stance.md", "stance"): "the README's",
    ("stance.md", "sim"): "test_sim_stance.py",
    ("stance.md", "monitor"): "tests/tools/live/test_live_stance.py",
    ("your-limb.md", "new --out limb.toml --urdf"): "test_pages_commands.py",
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
    for folder in ("tools", "examples"):
        Path(folder).symlink_to(PROJECT / folder)
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
            answer = next(line for line in lines_of_code(PROJECT / "docs" / "diagnose.md") if line.startswith("Missing: "))
            assert words[0] != "diagnose" or answer in outcome.out, outcome.out
    assert ran == set(RUN[name])


PROGRAM = re.compile(
    r"(?:\w+=\S+ |\(|while [^;]*; do |cd tools && )*"
    r"((?:\.\./)?\.venv/bin/(?!brace )\S+|\./dev|python3?|pip|cmake|sudo|sed|umask|mbpoll|cantools|qemu-system-arm|cp|cansend"
    r"|ros2|ip|ctest|build/\S+)(?= |$)(.*)"
)
INLINE = re.compile(r"`([^`\n]+)`")
OTHER_PROGRAMS = {  # how a command begins, without .venv/bin/: where it runs, or why it does not
    "./dev": "minutes to hours; its verb is there (below)",
    "python -m pytest": "a test itself; its file is there (below)",
    "python tests/": "a measurement of minutes, or what a release keeps; its file is there (below)",
    "python tools/release/two_files.py": "test_pages_commands.py",
    "python examples/python_can/ask_k.py socketcan": "needs CAN in the kernel; over slcan: test_bus_query.py",
    "python examples/python_can/ask_k.py slcan": "test_bus_query.py",
    "python -m interface": "writes into the project; test_adding.py runs it in a copy",
    "python -m brace.effects": "writes into the project; test_effects_page.py compares what it writes",
    "python -m brace.sim.servos": "test_pages_commands.py",
    "pip install ./brace": "needs the files of ./dev release; test_release.py tries its parts",
    "pip install": "needs the network; tools/pyproject.toml has these packages",
    "python -m pip install -e 'tools[robots]'": "needs the network; ./dev judges installs it",
    "python tests/judges/robots/robots.py": "a minute; test_robots.py plays three legs of each kind",
    "sudo apt install": "needs root, and the files of ./dev release",
    "ip link": "needs root, and CAN in the kernel; tests/socketcan/with_vcan does it with vcan0",
    "sed": "runs with the commands beside it, above",
    "umask": "test_pages_commands.py",
    "cansend": "test_pages_commands.py sends these frames; tests/socketcan runs cansend itself",
    "mbpoll -m tcp -p 1502 -a 1 -0 -t": "tests/socketcan/test_readme_lines.py",
    "mbpoll $tcp": "test_bus_taking_up.py runs the page's loop with mbpoll itself",
    "cantools monitor": "tests/socketcan/test_readme_lines.py",
    "cmake -S firmware/core": "test_cmake_packages.py",
    "cmake -S tools/client": "tests/client/test_package.py",
    "cmake -S tools/stance": "tests/tools/stance/test_stance_alone.py",
    "python tools/release/library.py": "tests/release/test_library.py",
    "cmake -B build/aarch64": "tests/release/test_cross.py",
    "cmake --build build/aarch64": "tests/release/test_cross.py",
    "cmake --install build/aarch64": "tests/release/test_cross.py",
    "cmake --build build/client": "tests/client/test_package.py",
    "cmake --install build/client": "tests/client/test_package.py",
    "build/client/print_k": "tests/client",
    "build/host/tests/judges/memory/rotten_sets": "minutes; ./dev test plays each 23rd bit",
    "build/host/tests/judges/memory/bit_flips": "an hour; ./dev test plays each 61st bit",
    "build/host/tests/test_late": "a minute or two; ./dev test plays fewer bursts",
    "build/host/tests/test_flood": "minutes; ./dev test plays fewer floods",
    "build/host/tests/judges/soak/soak": "as long as the reader wants; ./dev test plays fewer ticks",
    "qemu-system-arm": "until it is ended; tests/emulated starts the images so",
    "cp -r": "<yours> is the reader's; tests/judges/mutants and the build take the blank board as it is",
    "ros2 run": "needs ROS 2; tests/client/test_ros_bridge.py runs what it starts",
}


def fenced(page: Path) -> Iterator[str]:
    """The lines of blocks between ``` that have no language."""
    is_code = False
    for line in page.read_text().splitlines():
        if line.startswith("```"):
            is_code = not is_code and line == "```"
        elif is_code:
            yield line


def other_programs() -> Iterator[tuple[Path, str]]:
    """Page, and command without .venv/bin/."""
    for page in PAGES:
        inline = [text for line in page.read_text().splitlines() for text in INLINE.findall(line) if " " in text]
        for line in [*lines_of_code(page), *fenced(page), *inline]:
            if match := PROGRAM.match(line):
                program = match[1].removeprefix("../").removeprefix(".venv/bin/").replace("python3", "python")
                yield page, (program + match[2]).strip()


OTHERS = sorted(set(other_programs()))


def test_each_other_program_has_its_place() -> None:
    used = set()
    for page, command in OTHERS:
        reasons = [begin for begin in OTHER_PROGRAMS if f"{command} ".startswith(begin)]
        assert reasons, f"{page.name}: {command}: run it, or say why not"
        used.add(max(reasons, key=len))
    assert used == set(OTHER_PROGRAMS), f"a reason for what no page prints: {set(OTHER_PROGRAMS) - used}"
    assert {page.name for page, _ in OTHERS} >= {"README.md", "adding.md", "client.md", "security.md", "trust.md"}


def test_a_remark_beside_a_command_is_one() -> None:
    """A shell would take its words for the command's."""
    for page in PAGES:
        for line in lines_of_code(page):
            if START.search(line) or PROGRAM.match(line):
                assert not re.search(r"\S {2,}(?![# ])", line.partition("#")[0].rstrip()), f"{page.name}: {line}"


def test_what_others_begin_is_there() -> None:
    """Verbs of ./dev, files that Python runs, names that -k chooses."""
    verbs = set(re.findall(r"[a-z]+", re.search(r"^verbs='?\"?([^\n]*)", (PROJECT / "dev").read_text(), re.M)[1]))  # type: ignore[index]
    for page, command in OTHERS:
        words = shlex.split(command, comments=True)
        where = f"{page.name}: {command}"
        if words[0] == "./dev" and len(words) > 1:
            assert words[1].rstrip(",") in verbs, where
        for word in words:
            if word.startswith(("tests/", "tools/", "examples/")) and ">" not in words[: words.index(word)]:
                assert (PROJECT / word).exists(), where
        if "-k" in words:
            assert words[words.index("-k") + 1] in (PROJECT / words[words.index("-k") - 1]).read_text(), where
