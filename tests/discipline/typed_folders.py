"""Python folders that mypy checks, and how it is called; tests/discipline/test_types.py and ./dev check share them."""

from __future__ import annotations

import os
import shutil
import sys

from sources import ROOT

SMALL = ("emulated", "examples", "judges/coverage", "judges/misra", "judges/mutants", "judges/proofs", "modbus", "release", "servo", "socketcan")

# Folders that are checked at once, since no two of their modules have the same name: where imports are looked for.
TYPED = {
    "tools/brace tools/interface tools/release": "tools",
    "tests/judges/bench": "tools:tests/judges/bench:tests/property",
    "tests/judges/blind": "tools:tests/judges/blind",
    "tests/judges/engine": "tools:tests/judges/engine:tests/judges/blind",
    "tests/judges/exported": "tools:tests/judges/exported",
    "tests/judges/foreign": "tools:tests/judges/foreign:tests/judges/blind:tests/judges/engine",
    "tests/judges/robots": "tools:tests/judges/robots",
    "tests/judges/stance": "tools:tests/judges/stance",
    "tests/property": "tools:tests/property",
    "tests/tools": "tools:tests/tools:tests/tools/diagnose:tests/tools/importing:tests/tools/new:tests/judges/bench",
    " ".join(f"tests/{name}" for name in SMALL): ":".join(["tools", *(f"tests/{name}" for name in SMALL)]),
}


def mypy_command(folders: str) -> list[str]:
    """Each line of the table has a cache of its own: modules of the same name mean different files from line to line.
    It begins with what is known of tools/brace, which all of them import, with numpy's types behind it."""
    files = sorted(str(path) for folder in folders.split() for path in (ROOT / folder).rglob("*.py"))
    caches = ROOT / ".cache" / "mypy"
    cache, first = (caches / line.replace("/", "-").replace(" ", "+") for line in (folders, next(iter(TYPED))))
    if first.is_dir() and not cache.exists():
        shutil.copytree(first, cache)
    return [sys.executable, "-m", "mypy", "--config-file", "tools/pyproject.toml", "--explicit-package-bases",
            "--follow-imports", "silent", "--cache-dir", str(cache), *files]  # fmt: skip


def mypy_environment(folders: str) -> dict[str, str]:
    """For subprocess.run."""
    return {**os.environ, "MYPYPATH": TYPED[folders]}
