"""Python that is checked as strictly as tools/pyproject.toml says: the command, and most of what tests."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from sources import ROOT

# Folder: where its imports are looked for.
CHECKED = {
    "tools/brace": "tools",
    "tools/interface": "tools",
    "tests/bench": "tools:tests/bench:tests/property",
    "tests/blind": "tools:tests/blind",
    "tests/emulated": "tools:tests/emulated",
    "tests/modbus": "tools:tests/modbus:tests/socketcan",
    "tests/proofs": "tools:tests/proofs",
    "tests/property": "tools:tests/property",
    "tests/socketcan": "tools:tests/socketcan",
    "tests/tools": "tools:tests/tools:tests/tools/diagnose:tests/bench",
}


@pytest.mark.parametrize("folder", CHECKED)
def test_types(folder: str) -> None:
    pytest.importorskip("mypy")
    files = sorted(str(path) for path in (ROOT / folder).rglob("*.py"))
    assert files
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", "tools/pyproject.toml", "--explicit-package-bases",
         "--follow-imports", "silent", *files],
        cwd=ROOT, env={**os.environ, "MYPYPATH": CHECKED[folder]},
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
