"""Python that is checked as strictly as tools/pyproject.toml says: the command, and most of what tests."""

from __future__ import annotations

import subprocess

import pytest
from sources import ROOT
from typed_folders import TYPED, mypy_command, mypy_environment


@pytest.mark.parametrize("folders", TYPED)
def test_types(folders: str) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        mypy_command(folders), cwd=ROOT, env=mypy_environment(folders), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
