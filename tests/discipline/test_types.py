"""Python that is checked as strictly as tools/pyproject.toml says: the command, and most of what tests."""

from __future__ import annotations

import subprocess

import pytest
from sources import ROOT
from typed_folders import TYPED, mypy_command, mypy_environment


# ./dev check looks at the types of what differs from main, so that those of the tests can wait for ./dev judges.
FOLDERS = [pytest.param(one, marks=pytest.mark.minutes if one.startswith("tests/") else ()) for one in TYPED]


@pytest.mark.parametrize("folders", FOLDERS)
def test_types(folders: str) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        mypy_command(folders), cwd=ROOT, env=mypy_environment(folders), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
