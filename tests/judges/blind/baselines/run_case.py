"""All baselines on one case: what each says, and the gap that it leaves on configurations never seen."""

from __future__ import annotations

import hashlib
import json
import time
import traceback
from pathlib import Path
from typing import Any

from baselines import gaussian_process
from baselines.methods import NAMING, PROCESS, TUNED, tuned_knobs
from baselines.play import Unseen, fitted_numbers
from baselines.signatures import Signatures, cached, prepared
from scoring import VISIBLE_GAP_N

STOPPED = {"verdict": "data_fault", "effects": [], "indistinguishable": []}  # by the tool's gate, before any choice


def version() -> str:
    """Hash of the baselines and of what they were tuned to."""
    here = Path(__file__).resolve().parent
    digest = hashlib.sha256()
    for path in (*sorted(here.glob("*.py")), TUNED):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:8]


def folder_of(results: Path) -> Path:
    """Where the answers of these baselines lie; `results` is the run's."""
    return results / f"baselines-{version()}"


def job(job: tuple[str, str, str]) -> str:
    """Runs all baselines on a case (set's folder, run's folder, name) unless they have been."""
    root, results, name = Path(job[0]), Path(job[1]), job[2]
    path = folder_of(results) / f"{name}.json"
    if not path.exists():
        path.parent.mkdir(exist_ok=True)
        try:
            found = answers(root, results / "signatures", name)
        except Exception:  # counted in the report: a case that a baseline lost by our fault is no case won
            found = {"naming": {}, "after_n": {}, "seconds": 0.0, "crashed": traceback.format_exc(limit=-3)}
        part = path.with_suffix(".part")
        part.write_text(json.dumps(found))
        part.replace(path)
    return name


def answers(root: Path, keep: Path, name: str) -> dict[str, Any]:
    """`naming`: per method what a diagnosis.json would hold; `after_n`: per method the gap left [N], where there is a
    visible one; `seconds` for all of them. A refused record leaves `refused`."""
    from brace.ground.errors import BadFileError

    begun = time.perf_counter()
    out: dict[str, Any] = {"naming": {}, "after_n": {}}
    try:
        sig = cached(root / "cases" / name, keep)
        if sig is None:
            out["naming"] = {method: STOPPED for method in NAMING}
        else:
            said = {method: entry.choose(sig, tuned_knobs(method)) for method, entry in NAMING.items()}
            out["naming"] = {method: one.found for method, one in said.items()}
            out["chosen_seconds"] = time.perf_counter() - begun
            truth = json.loads((root / "answers" / name / "truth.json").read_text())
            if truth["kind"] in ("single", "pair"):
                out["after_n"] = _gaps(root, name, sig, said)
    except BadFileError as error:
        out["refused"] = str(error)
        out["naming"] = {method: {} for method in NAMING}
    out["seconds"] = time.perf_counter() - begun
    return out


def _gaps(root: Path, name: str, sig: Signatures, said: dict[str, Any]) -> dict[str, float]:
    """Per method the rms of force on the hold-out [N]; nothing where the believed limb leaves no visible gap."""
    ready = prepared(root / "cases" / name)
    unseen = Unseen(root / "answers" / name / "holdout")
    _, _, trust, _ = ready
    before_n = unseen.gap_n(unseen.played(trust.numbers))
    if before_n <= VISIBLE_GAP_N:
        return {}
    known: dict[tuple[int, ...], float] = {}
    out = {}
    for method, one in said.items():
        if one.chosen not in known:
            known[one.chosen] = unseen.gap_n(unseen.played(fitted_numbers(ready, sig, one)))
        out[method] = known[one.chosen]
    discrepancy = gaussian_process.discrepancy_of(ready, unseen)
    out[PROCESS] = before_n * (1.0 - gaussian_process.closed(discrepancy, tuned_knobs(PROCESS)))
    return out
