"""The edit loop: format, types, layers and generated files of the whole, and the unit tests of what differs from main.

    ./dev check     sets up what this needs and runs it

Compared with the commit at which this branch left main, or on main itself with origin/main; files that git does not
know yet count as changed. Every step prints what it ran. Exit codes: 0 all is well, 1 a step found something.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "discipline"))

import stored_numbers  # noqa: E402
from typed_folders import TYPED, mypy_command, mypy_environment  # noqa: E402

Step = tuple[str, Callable[[], bool]]
MOST_COLUMNS = 120
NO_TEST_IS_LEFT = 5  # pytest's exit code where every test of a file is marked `minutes`
INTERFACE_TESTS = ("test_wire_signals", "test_errors_page")  # begin first: what a page forgets shows there
PYTHON_TESTS_S = 40.0  # no further test file begins after so long, so that the whole takes about a minute
LEFT_OUT: list[str] = []  # files of tests that had no time
FAILURES: list[str] = []  # one line for each test that failed: they stand among hundreds, so they are said again last
FAILURES_SAID = 8
NAMED_TESTS_MOST = 12
BUILD = ROOT / "build" / "host"
ALL_LINES = (".c", ".h", ".cpp")  # where every line is judged, not only new ones
WRITTEN_BY_HAND = (*ALL_LINES, ".py", ".cmake")
C_PARTS = {  # changed folder: folder of its tests
    "firmware/core": "tests/unit/core",
    "firmware/interface": "tests/unit/interface",
    "firmware/app": "tests/unit/app",
    "firmware/boards": "tests/unit/boards",
    "firmware/store": "tests/unit/store",
    "hal": "tests/unit/hal",
    "host_sim": "tests/host_sim",
    "tools/client": "tests/client",
    "tools/stance": "tests/stance",
}
INTERFACE = ("firmware/interface", "tools/interface")  # the dictionary, and what writes all that follows from it
FRAMES = "firmware/interface/generated"
FRAMES_TEST = "test_wires"  # plays the whole controller and counts its frames, so a message that is added can break it
LAWS = "host_sim/effects"
LAWS_TESTS = ("test_effects_page", "test_what_laws_depend_on")


FAILURE = re.compile(r"^(FAILED|ERROR) tests/|:FAIL: ")  # as pytest and Unity say it


def run(*command: str, environment: dict[str, str] | None = None, also_well: tuple[int, ...] = ()) -> bool:
    """Runs a command in the project's folder. Prints its output only when it fails: when it ends neither with 0 nor
    with another code that means all is well."""
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, **(environment or {})}, capture_output=True, text=True,
        check=False,
    )  # fmt: skip
    is_well = done.returncode in (0, *also_well)
    if not is_well:
        said = done.stdout + done.stderr
        print(said, end="")
        FAILURES.extend(line for line in said.splitlines() if FAILURE.search(line))
    return is_well


def git(*arguments: str) -> str:
    """What git prints; nothing where it refuses."""
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False).stdout


def base() -> str:
    """The commit to compare with: the nearest one at which this branch left main or origin/main, as main itself does
    with commits of its own; or the last commit."""
    last = git("rev-parse", "HEAD").strip()
    left = {git("merge-base", "HEAD", main).strip() for main in ("main", "origin/main")} - {"", last}
    return git("merge-base", "--independent", *left).split()[0] if left else "HEAD"


def changed_files(since: str) -> list[Path]:
    """Files that differ from the commit, and new ones; paths relative to the project's folder."""
    names = git("diff", "--name-only", since).splitlines() + git("ls-files", "-o", "--exclude-standard").splitlines()
    return sorted({Path(name) for name in names})


# --- format, types, layers ------------------------------------------------------------------------------------


def is_generated(path: Path) -> bool:
    """Does its head say that a generator writes it?"""
    return "do not edit" in "".join((ROOT / path).read_text().splitlines(keepends=True)[:3])


def long_lines(since: str) -> list[str]:
    """C and C++ lines that are too long, and Python and CMake lines that are too and are new since the commit, as
    FILE:LINE. Generated files and tables may have them. A tab reaches to the next multiple of four columns."""
    found = []
    new = new_lines(since)
    for path in git("ls-files", "-co", "--exclude-standard").splitlines():
        these = None if path.endswith(ALL_LINES) else new.get(path, set())
        if path.endswith(WRITTEN_BY_HAND) and (ROOT / path).is_file() and not is_generated(Path(path)):
            for line, text in enumerate((ROOT / path).read_text().splitlines(), 1):
                if (columns := len(text.expandtabs(4))) > MOST_COLUMNS and (these is None or line in these):
                    found.append(f"{path}:{line}: {columns} columns, {MOST_COLUMNS} at most: wrap it")
    return found


def new_lines(since: str) -> dict[str, set[int] | None]:
    """Numbers of the lines that are new since the commit, by file; None: all, because git does not know the file."""
    lines: dict[str, set[int] | None] = dict.fromkeys(git("ls-files", "-o", "--exclude-standard").splitlines())
    for part in git("diff", "-U0", "--no-color", "--no-prefix", since).split("\ndiff --git "):
        if name := re.search(r"^\+\+\+ (.*)$", part, re.MULTILINE):
            heads = re.findall(r"^@@ -\S+ \+(\d+)(?:,(\d+))? @@", part, re.MULTILINE)
            lines[name[1]] = {int(first) + more for first, count in heads for more in range(int(count or 1))}
    return lines


def formatted_by_clang(paths: Iterable[Path]) -> list[str]:
    """Those of the files that .clang-format is for: C and C++ that no generator writes, and no samples of bad form."""
    return [
        str(path)
        for path in paths
        if path.suffix in ALL_LINES and (ROOT / path).is_file() and not path.is_relative_to("tests/discipline/samples")
        if not is_generated(path)
    ]


def clang_format(files: list[str]) -> bool:
    """Whether they are as .clang-format says; prints what is not, and how to mend it."""
    tool = Path(sys.executable).parent / "clang-format"
    if not files or run(str(tool), "--dry-run", "-Werror", *files):
        return True
    print("try: .venv/bin/clang-format -i FILE...")
    return False


def check_format(since: str) -> bool:
    """ruff on all Python; lengths, trailing blanks and C's format of what changed."""
    wide = long_lines(since)
    print("\n".join(wide) + "\n" * bool(wide), end="")
    ruff = run(sys.executable, "-m", "ruff", "check", "--quiet", "--config", "tools/pyproject.toml", "tools", "tests")
    c = clang_format(formatted_by_clang(changed_files(since)))
    return run("git", "diff", "--check", since) and ruff and c and not wide


def check_types(changed: Iterable[Path]) -> bool:
    """mypy on the folders with changed files, and on the command's tests when the command changed."""
    touched = {path for path in changed if path.suffix == ".py"}
    folders = {
        line for line in TYPED if any(path.is_relative_to(folder) for folder in line.split() for path in touched)
    }
    if any(path.is_relative_to("tools/brace") for path in touched):
        folders.add("tests/tools")
    print(f"types of {', '.join(sorted(folders)) or 'nothing'}")
    return all([run(*mypy_command(folder), environment=mypy_environment(folder)) for folder in sorted(folders)])


def check_layers() -> bool:
    """Includes by docs/layers.toml, imports by tools/pyproject.toml."""
    tests = ("tests/discipline/test_c_layers.py", "tests/discipline/test_python_layers.py")
    return run(sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests)


# --- tests of what changed ------------------------------------------------------------------------------------


def c_tests(changed: Iterable[Path]) -> list[str]:
    """Names of the C and C++ tests in and below the folders that mirror the changed ones; changed tests themselves."""
    names: set[str] = set()
    for path in changed:
        if path.suffix not in (".c", ".h", ".cpp"):
            continue
        if path.name.startswith("test_") and path.parts[:2] in (("tests", "unit"), ("tests", "host_sim")):
            names.add(path.stem)
        if path.is_relative_to(FRAMES):
            names.add(FRAMES_TEST)
        for part, folder in C_PARTS.items():
            if path.is_relative_to(part):
                names |= {test.stem for test in (ROOT / folder).rglob("test_*.c*")}
    return sorted(name for name in names if list((ROOT / "tests").rglob(f"{name}.c*")))


def is_interface(path: Path) -> bool:
    """Does something generated follow from this file?"""
    return path.suffix in (".toml", ".py") and any(path.is_relative_to(folder) for folder in INTERFACE)


def generator_says() -> str:
    """Why a generated file is not what the dictionary says, or why the generator refuses the dictionary; else empty."""
    command = [sys.executable, "-m", "interface", "--check"]
    done = subprocess.run(command, cwd=ROOT / "tools", capture_output=True, text=True, check=False)
    drifted = "  try: cd tools && ../.venv/bin/python -m interface\n"
    return "" if done.returncode == 0 else done.stderr + drifted * (done.returncode == 1)


def moved_numbers(since: str) -> list[str]:
    """A sentence for each number of the dictionary that is another than in the commit, and must not be."""
    dictionary, messages = (
        git("show", f"{since}:{name}") for name in (stored_numbers.DICTIONARY, stored_numbers.MESSAGES)
    )
    return stored_numbers.moved_since((dictionary, messages))


def check_stored(since: str) -> bool:
    """Has no number moved that masters have stored?"""
    said = moved_numbers(since)
    print("\n".join(said) + "\n" * bool(said), end="")
    return not said


def reads_page(test: str, page: str) -> bool:
    """Does the text of a test name this page of docs/ as a file, read all pages, or do the page's steps?"""
    return any(said in test for said in (f'"{page}.md"', '"docs").glob(', f"from {page}_page import"))


def python_tests(changed: Iterable[Path]) -> list[str]:
    """Files of tests/tools that mirror changed modules, the closest first: changed themselves, named after a module,
    importing one or running its command. The generator's tests where the dictionary or the generator has changed, those
    of the laws where an effect's header has, and those that read a page of docs/ where the page has."""
    tests = {path: path.read_text() for path in sorted((ROOT / "tests" / "tools").rglob("test_*.py"))}
    closest: dict[Path, int] = {}
    for path in changed:
        if is_interface(path):
            closest |= {test: 0 for test in tests if test.stem.startswith("test_interface")}
            closest |= {test: -1 for test in tests if test.stem in INTERFACE_TESTS}
        if path.parent == Path("docs"):
            closest |= {test: 0 for test, text in tests.items() if reads_page(text, path.stem)}
        if path.is_relative_to(LAWS):
            closest |= {test: 0 for test in tests if test.stem in LAWS_TESTS}
        if path.suffix != ".py":
            continue
        if ROOT / path in tests:
            closest[ROOT / path] = 0
        elif path.is_relative_to("tools/brace"):
            distance = _distances(path.relative_to("tools").with_suffix("").parts)
            for test, text in tests.items():
                if (far := distance(test, text)) is not None:
                    closest[test] = min(far, closest.get(test, far))
    return [str(path.relative_to(ROOT)) for path in sorted(closest, key=lambda path: (closest[path], path))]


def _distances(module: tuple[str, ...]) -> Callable[[Path, str], int | None]:
    """How close a test file is to a module, given as ("brace", "bus", "slcan"); None: it is none of its tests."""
    own = module[-1].removesuffix("_command")
    name, package = re.escape(".".join(module)), re.escape(".".join(module[:-1]))
    imported = re.compile(rf"\b{name}\b|from {package} import .*\b{own}\b")
    command = re.compile(rf'\bbrace\(\s*"{own}"') if module[-1].endswith("_command") else None

    def distance(test: Path, text: str) -> int | None:
        words = [*test.parent.relative_to(ROOT / "tests" / "tools").parts, *test.stem.split("_")[1:]]
        if own in words or "_".join(module[1:]) in test.stem:
            return 1
        return 2 if imported.search(text) or (command and command.search(text)) else None

    return distance


def test_c(names: list[str]) -> bool:
    """Builds these tests alone, and the library that Python loads; and runs them."""
    build = run("cmake", "--build", "--preset", "host", "--target", "brace_host", *names)
    pattern = f"/({'|'.join(names)})$"
    return build and (not names or run("ctest", "--test-dir", str(BUILD), "-j2", "--output-on-failure", "-R", pattern))


def test_python(files: list[str]) -> bool:
    """Runs two files at a time; says which ones it had no time for, and keeps them in LEFT_OUT."""
    until = time.monotonic() + PYTHON_TESTS_S

    def one(file: str) -> bool | None:
        if time.monotonic() > until:
            return None
        return run(sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-m", "not minutes", file,
                   also_well=(NO_TEST_IS_LEFT,))  # fmt: skip

    with ThreadPoolExecutor(2) as pool:
        results = dict(zip(files, pool.map(one, files)))
    print(f"ran {' '.join(file for file, result in results.items() if result is not None)}")
    left = [file for file, result in results.items() if result is None]
    LEFT_OUT.extend(left)
    if left:
        print(f"no time for {' '.join(left)}: ./dev test runs them")
    return False not in results.values()


def main() -> int:
    """Runs every step; the exit code."""
    begun = time.monotonic()
    since = base()
    changed = changed_files(since)
    print(f"{len(changed)} files differ from {since[:12]}")
    wrong = generator_says() if any(map(is_interface, changed)) else ""
    in_c = any(path.suffix in (".c", ".h", ".cpp", ".txt", ".cmake") for path in changed)
    units, files = c_tests(changed), python_tests(changed)
    looks: list[Step] = [
        ("format: ruff; columns; trailing blanks of changed lines", lambda: check_format(since)),
        ("types: mypy", lambda: check_types(changed)),
        ("layers: docs/layers.toml, tools/pyproject.toml", check_layers),
    ]
    if any(map(is_interface, changed)):
        looks.append(("numbers that masters have stored", lambda: check_stored(since)))
    tests: list[Step] = []
    if in_c:
        which = " ".join(units) if len(units) <= NAMED_TESTS_MOST else f"{len(units)} suites"
        tests.append((f"build and C tests: {which or 'none mirrors what changed'}", lambda: test_c(units)))
    if files:
        tests.append(("Python tests of what changed", lambda: test_python(files)))
    with ThreadPoolExecutor(2) as pool:  # a look takes one processor, a test's build all of them
        done = [*pool.map(timed, looks)] + [timed(step) for step in tests if not wrong]
    failed = [name.partition(":")[0] for name, ok in done if not ok]
    print(f"{time.monotonic() - begun:.0f} s; {summary(failed, bool(changed), bool(wrong))}")
    print("".join(f"  {line}\n" for line in FAILURES[:FAILURES_SAID]), end="")
    print(wrong, end="")
    return 1 if failed or wrong else 0


def summary(failed: list[str], is_changed: bool, is_wrong: bool) -> str:
    """The last line: what failed, and what was not tested."""
    if is_wrong:
        failed = [*failed, "generated files, so no test was run"]
    if failed:
        return f"failed: {', '.join(failed)}"
    if not is_changed:
        return "nothing differs from main, so nothing was tested. Run this before you commit, or on a branch"
    return f"well, but {len(LEFT_OUT)} files of tests had no time" if LEFT_OUT else "all is well"


def timed(step: Step) -> tuple[str, bool]:
    """Runs a step and says how it went: its name, and whether all is well."""
    name, run_step = step
    started = time.monotonic()
    ok = run_step()
    print(f"{'ok    ' if ok else 'FAILED'} {time.monotonic() - started:5.1f} s  {name}", flush=True)
    return name, ok


if __name__ == "__main__":
    sys.exit(main())
