"""brace/brace.h is the first header to read: it names every public header of the core, and brings in all but the batches."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ROOT / "firmware" / "core" / "include" / "brace"
FIRST = HEADERS / "brace.h"
ELSEWHERE = {"app.h", "client.h"}  # of the controller and of the client, named as where to go on


def included(path: Path, seen: set[str]) -> set[str]:
    """Names of the public headers that a header brings in, itself among them."""
    if path.name not in seen:
        seen.add(path.name)
        for name in re.findall(r'^#include "brace/(\w+\.h)"', path.read_text(), re.MULTILINE):
            included(HEADERS / name, seen)
    return seen


def test_it_names_every_header_and_no_other() -> None:
    words = FIRST.read_text().partition("#ifndef")[0]
    named = set(re.findall(r"\b\w+\.h\b", words)) - ELSEWHERE
    assert named | {FIRST.name} == {path.name for path in HEADERS.glob("*.h")}


def test_it_brings_in_all_but_the_batches() -> None:
    wanted = {path.name for path in HEADERS.glob("*.h") if not path.stem.endswith("_batch")}
    assert included(FIRST, set()) == wanted
