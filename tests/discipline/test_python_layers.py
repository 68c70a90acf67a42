"""Python packages import only from the layers below them; tools/pyproject.toml lists the layers."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from sources import ROOT

CONTRACTS = ROOT / "tools" / "pyproject.toml"


def lint_imports(config: Path) -> subprocess.CompletedProcess[str]:
    """Checks the contracts of `config`; a broken one is printed as 'importing module -> imported module (line)'."""
    return subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports_command; lint_imports_command()",
         "--config", str(config), "--no-cache"],
        cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT / "tools"), "NO_COLOR": "1"},
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip


def test_layers() -> None:
    done = lint_imports(CONTRACTS)
    assert done.returncode == 0, done.stdout[done.stdout.find("Broken contracts"):] + done.stderr


def test_an_import_from_a_higher_layer_is_found_and_its_line_is_named(tmp_path: Path) -> None:
    lower, upper = '    "dataset | effects | native",\n', '    "model",\n'
    text = CONTRACTS.read_text()
    assert lower + upper in text
    swapped = tmp_path / "pyproject.toml"
    swapped.write_text(text.replace(lower + upper, upper + lower))
    done = lint_imports(swapped)
    assert done.returncode == 1
    source = ROOT / "tools" / "brace" / "native" / "limb.py"
    lines = source.read_text().splitlines()
    line = next(number for number, text in enumerate(lines, 1) if text.startswith("from brace.model import "))
    assert f"brace.native.limb -> brace.model (l.{line}" in done.stdout
