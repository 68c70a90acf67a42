"""The judge of coverage: what no suite runs is reported, and an exception needs its reason."""

from __future__ import annotations

from pathlib import Path

import counts
import coverage
import pytest


def test_counts_of_suites_add_up() -> None:
    total = counts.Counts()
    total.add(counts.Counts({("a.c", 1): 0, ("a.c", 2): 3}, {("a.c", 2, 0): 0, ("a.c", 2, 1): 3}))
    total.add(counts.Counts({("a.c", 1): 2}, {("a.c", 2, 0): 1}))
    assert total.lines == {("a.c", 1): 2, ("a.c", 2): 3}
    assert total.branches == {("a.c", 2, 0): 1, ("a.c", 2, 1): 3}


def test_an_exception_covers_its_lines_only() -> None:
    entry = coverage.Exception_("firmware/app/*", r"return BRACE_E_NULL;", "a reason of some length")
    assert entry.covers("firmware/app/src/app.c", "        return BRACE_E_NULL;")
    assert not entry.covers("firmware/core/src/a.c", "        return BRACE_E_NULL;")
    assert not entry.covers("firmware/app/src/app.c", "        return BRACE_OK;")


def test_an_exception_of_branches_counts_them() -> None:
    entry = coverage.Exception_("a.c", "if", "a reason of some length", branches=2)
    texts = {"a.c": ["if (b && c) {", "x = 1;"]}
    assert coverage.count_of(entry, {("a.c", 1, 0), ("a.c", 1, 3), ("a.c", 2, 0)}, texts) == 2


@pytest.mark.parametrize(
    "entry", ['files = "*"\nline = "x"\nwhy = "so"', 'files = "*"\nline = ""\nwhy = "a reason of some length"']
)
def test_what_may_not_be_an_exception(tmp_path: Path, entry: str) -> None:
    path = tmp_path / "exceptions.toml"
    path.write_text(f"[[exception]]\n{entry}\n")
    with pytest.raises(SystemExit):
        coverage.read_exceptions(path)


def test_every_exception_is_in_a_file_that_is_there() -> None:
    for entry in coverage.read_exceptions():
        assert list(counts.ROOT.glob(entry.files)), entry.files
