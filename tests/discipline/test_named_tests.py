"""Each test and program of tests that docs/security.md and docs/trust.md name exists."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SUITES = ROOT / "tests"


def named(page: str) -> set[str]:
    """Names of suites in backticks or in a command, without what ends a file's name."""
    text = (ROOT / "docs" / page).read_text()
    return set(re.findall(r"\b(test_\w+)", text)) | set(re.findall(r"build/host/tests/judges/\w+/(\w+)", text))


@pytest.mark.parametrize("page", ["security.md", "trust.md"])
def test_what_a_page_names_exists(page: str) -> None:
    there = {file.stem for kind in ("*.c", "*.cpp", "*.py") for file in SUITES.rglob(kind)}
    assert named(page), f"docs/{page} names no test"
    missing = sorted(named(page) - there)
    assert not missing, f"docs/{page} names tests that do not exist: {', '.join(missing)}; try: the suite's new name"


def test_each_sentence_of_the_page_of_security_has_its_test() -> None:
    text = (ROOT / "docs/security.md").read_text()
    for table in re.findall(r"^\| sentence \| test \|\n\|[-|]+\|\n((?:\|.*\n)+)", text, re.MULTILINE):
        for row in table.splitlines():
            assert re.search(r"`test_\w+`", row), f"docs/security.md: no test stands beside: {row}"
