"""What ./dev check compares with, which tests it picks, and what it says last."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "tests"))

import check  # noqa: E402


def picked(*changed: str) -> set[str]:
    return {Path(name).stem for name in check.python_tests(map(Path, changed))}


def test_a_generated_file_may_have_long_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever it lies: its head says so."""
    monkeypatch.setattr(check, "ROOT", tmp_path)
    monkeypatch.setattr(check, "git", lambda *arguments: "a.h\nb.h\n" if arguments[0] == "ls-files" else "")
    (tmp_path / "a.h").write_text(f"/* Written by tools/interface; do not edit. */\n/* {'-' * 130} */\n")
    (tmp_path / "b.h").write_text(f"/* By hand. */\n/* {'-' * 130} */\n")
    assert check.long_lines("HEAD") == ["b.h:2: 136 columns, 120 at most: wrap it"]
    assert check.formatted_by_clang([Path("a.h"), Path("b.h")]) == ["b.h"]


@pytest.mark.parametrize(
    ("main", "origin", "wanted"),
    [
        (1, None, 1),  # on a branch that left main at commit 1
        (1, 0, 1),
        (0, 1, 1),  # main here is old
        (2, 1, 1),  # on main, with a commit of its own
        (2, 2, None),
        (2, None, None),
    ],
)
def test_what_differs_is_told_from_where_the_branch_left(
    main: int, origin: int | None, wanted: int | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(check, "ROOT", tmp_path)
    check.git("init", "-q", "-b", "work")
    author = ("-c", "user.name=a", "-c", "user.email=a@example.org")
    commits = []
    for _ in range(3):
        check.git(*author, "commit", "-q", "--allow-empty", "-m", "one")
        commits.append(check.git("rev-parse", "HEAD").strip())
    check.git("update-ref", "refs/heads/main", commits[main])
    if origin is not None:
        check.git("update-ref", "refs/remotes/origin/main", commits[origin])
    assert check.base() == ("HEAD" if wanted is None else commits[wanted])


def test_where_nothing_differs_nobody_is_told_that_all_is_well() -> None:
    assert "nothing was tested" in check.summary([], is_changed=False, is_wrong=False)
    assert check.summary([], is_changed=True, is_wrong=False) == "all is well"
    assert check.summary(["types"], is_changed=False, is_wrong=False) == "failed: types"


def test_what_the_generator_refuses_stands_last_and_no_test_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for look in ("check_format", "check_types", "check_layers"):
        monkeypatch.setattr(check, look, lambda *_: True)
    for test in ("test_c", "test_python"):
        monkeypatch.setattr(check, test, lambda *_: pytest.fail("a test ran"))
    monkeypatch.setattr(check, "changed_files", lambda _: [Path("firmware/interface/dictionary.toml"), Path("hal/a.c")])
    monkeypatch.setattr(check, "generator_says", lambda: "interface: it contradicts itself\n  try: mend it\n")
    assert check.main() == 1
    said = capsys.readouterr().out.splitlines()
    assert said[-2:] == ["interface: it contradicts itself", "  try: mend it"]
    assert said[-3].endswith("failed: generated files, so no test was run")


def test_the_sentence_of_a_failed_test_stands_last(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    failed = ["a.c:9:test_that:FAIL: Expected 2 Was 3", "FAILED tests/tools/test_b.py::test_c - no"]
    said = "\n".join(["a.c:3:test_it:PASS", *failed, "much more"])
    for look in ("check_format", "check_types", "check_layers"):
        monkeypatch.setattr(check, look, lambda *_: True)
    monkeypatch.setattr(check, "FAILURES", [])
    monkeypatch.setattr(check, "python_tests", lambda _: [])
    monkeypatch.setattr(check, "test_c", lambda _: check.run("sh", "-c", f"echo '{said}'; false"))
    monkeypatch.setattr(check, "changed_files", lambda _: [Path("hal/a.c")])
    assert check.main() == 1
    last = capsys.readouterr().out.splitlines()[-3:]
    assert last[0].endswith("failed: build and C tests") and last[1:] == [f"  {line}" for line in failed]


def test_the_generator_has_nothing_to_say_of_what_is_checked_in() -> None:
    assert check.generator_says() == ""


def test_a_page_starts_the_tests_that_read_it() -> None:
    assert "test_errors_page" in picked("docs/errors.md")
    assert "test_adding" in picked("docs/adding.md")
    assert "test_printed_commands" in picked("docs/errors.md")
    assert "test_errors_page" not in picked("docs/joints.md")
