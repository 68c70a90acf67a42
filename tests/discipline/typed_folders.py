"""Python folders that mypy checks, and how it is called; tests/discipline/test_types.py and ./dev check share them."""

from __future__ import annotations

import os
import shutil
import sys

from sources import ROOT

TYPED = {  # folder: where its imports are looked for
    "tools/brace": "tools",
    "tools/interface": "tools",
    "tools/release": "tools",
    "tests/bench": "tools:tests/bench:tests/property",
    "tests/blind": "tools:tests/blind",
    "tests/coverage": "tools:tests/coverage",
    "tests/emulated": "tools:tests/emulated",
    "tests/engine": "tools:tests/engine:tests/blind",
    "tests/examples": "tools:tests/examples",
    "tests/foreign": "tools:tests/foreign:tests/blind:tests/engine",
    "tests/misra": "tools:tests/misra",
    "tests/modbus": "tools:tests/modbus:tests/socketcan",
    "tests/proofs": "tools:tests/proofs",
    "tests/mutants": "tools:tests/mutants",
    "tests/property": "tools:tests/property",
    "tests/release": "tools:tests/release",
    "tests/servo": "tools:tests/servo:tests/emulated",
    "tests/socketcan": "tools:tests/socketcan",
    "tests/tools": "tools:tests/tools:tests/tools/diagnose:tests/tools/importing:tests/tools/new:tests/bench",
}


def mypy_command(folder: str) -> list[str]:
    """Each folder has a cache of its own: modules of the same name mean different files from folder to folder. It begins
    with what is known of tools/brace, which all of them import, with numpy's types behind it."""
    files = sorted(str(path) for path in (ROOT / folder).rglob("*.py"))
    caches = ROOT / ".cache" / "mypy"
    cache, first = caches / folder.replace("/", "-"), caches / next(iter(TYPED)).replace("/", "-")
    if first.is_dir() and not cache.exists():
        shutil.copytree(first, cache)
    return [sys.executable, "-m", "mypy", "--config-file", "tools/pyproject.toml", "--explicit-package-bases",
            "--follow-imports", "silent", "--cache-dir", str(cache), *files]  # fmt: skip


def mypy_environment(folder: str) -> dict[str, str]:
    """For subprocess.run."""
    return {**os.environ, "MYPYPATH": TYPED[folder]}
