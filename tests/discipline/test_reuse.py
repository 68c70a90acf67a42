"""Every file has a licence and a holder, as the REUSE checker reads them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from sources import ROOT


def lint(folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "reuse", "--root", str(folder), "lint", "--quiet"]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_every_file_has_its_licence() -> None:
    done = lint(ROOT)
    assert done.returncode == 0, done.stdout + done.stderr + "reuse lint says more"


def test_a_file_without_is_found(tmp_path: Path) -> None:
    (tmp_path / "main.c").write_text("int main(void) { return 0; }\n")
    assert lint(tmp_path).returncode == 1
