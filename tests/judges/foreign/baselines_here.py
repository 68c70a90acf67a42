"""The baselines on a foreign case: forward selection by BIC (tests/judges/blind/baselines, as tuned there) on loading records,
the terms that BIC keeps of the five-parameter fit on joint tests. Neither gives a probability: each name counts as one
said with 0.95, just what a name must be worth."""

from __future__ import annotations

import hashlib
import importlib.util
import json
import traceback
from pathlib import Path
from typing import Any

import five
import joints
from measured import columns_of

SAYS = 0.95


def version() -> str:
    """Hash of what they are."""
    here = Path(__file__).resolve().parent
    folder = here.parent / "blind" / "baselines"
    paths = [here / "five.py", here / "baselines_here.py", *sorted(folder.glob("*.py"))]
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:8]


def said(case: Path, truth: dict[str, Any], keep: Path) -> dict[str, Any]:
    """As a diagnosis.json has it."""
    if truth["part"] == "joint":
        centred = truth["group"] == "positions"
        names = five.named(five.points_of(columns_of(case), centred=centred))
        effects = [{"name": name, "where": joints.WHERE, "confidence": SAYS} for name in names]
        return {"verdict": "effect" if names else "none", "effects": effects}
    if any(importlib.util.find_spec(library) is None for library in ("sklearn", "pysindy")):
        return {}
    from baselines.methods import NAMING, tuned_knobs
    from baselines.run_case import STOPPED
    from baselines.signatures import cached

    method = "forward selection, BIC"
    sig = cached(case, keep)
    if sig is None:
        return dict(STOPPED)
    found: dict[str, Any] = NAMING[method].choose(sig, tuned_knobs(method)).found
    return {**found, "effects": [{**e, "confidence": SAYS} for e in found.get("effects", [])]}


def job(job: tuple[str, str, str]) -> str:
    """One case, unless it has been."""
    root, results, name = Path(job[0]), Path(job[1]), job[2]
    out = results / "main" / name
    if not (out / "run.json").exists():
        out.mkdir(parents=True, exist_ok=True)
        note = {}
        try:
            truth = json.loads((root / "answers" / name / "truth.json").read_text())
            found = said(root / "cases" / name, truth, results / "signatures")
            (out / "diagnosis.json").write_text(json.dumps(found))
        except Exception:  # written into judged.json
            note["crashed"] = traceback.format_exc(limit=-3)
        (out / "run.json").write_text(json.dumps(note))
    return name
