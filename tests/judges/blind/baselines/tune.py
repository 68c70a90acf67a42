"""Tunes every baseline on the development set: the same number of random trials each, the first the textbook's.

usage: python tests/judges/blind/baselines/tune.py [--cases N] [--set FOLDER] [--method NAME]
Writes tuned.json beside this file, method by method. What a trial is worth: the mean of the shares of
single effects of s = 8 and more named right first, of pairs named right with nothing else, and of healthy records without an alarm; a
tenth of the share of outsiders called unknown decides between equals. For the Gaussian process: the mean share of the
gap closed, each case's within 0 to 1."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import one_thread  # noqa: E402, F401, I001

import argparse  # noqa: E402
import json  # noqa: E402
import pickle  # noqa: E402
import time  # noqa: E402
from typing import Any  # noqa: E402

import numpy as np  # noqa: E402

from baselines import gaussian_process  # noqa: E402
from baselines.gaussian_process import Discrepancy, discrepancy_of  # noqa: E402
from baselines.knobs import Knobs, Space  # noqa: E402
from baselines.methods import NAMING, PROCESS, TUNED, spaces, tuned  # noqa: E402
from baselines.play import Unseen  # noqa: E402
from baselines.signatures import Signatures, cached, prepared  # noqa: E402
import diagnoser  # noqa: E402
from generate import default_folder, generator_hash  # noqa: E402
from plant import BUILD  # noqa: E402
from scoring import VISIBLE_GAP_N, Judged, judge, must_be_named, share  # noqa: E402
from seeds import DEVELOPMENT_SEED, TUNING_CASES  # noqa: E402

TRIALS = 24
GAP_CASES = 20  # that the Gaussian process is tuned on
TRIAL_SEED = 20_011


def worth(judged: list[Judged]) -> float:
    """Of a trial of a naming baseline."""
    pairs = [j for j in judged if j.kind == "pair"]
    shares = [
        share(judged, "exact", must_be_named).value or 0.0,
        share(pairs, "set").value or 0.0,
        1.0 - (share(judged, "false_alarm").value or 0.0),
    ]
    return float(np.mean(shares)) + 0.1 * (share(judged, "unknown").value or 0.0)


def _counts(truth: dict[str, Any]) -> bool:
    """Whether a case is of a kind that a trial's worth looks at."""
    return truth["kind"] in ("none", "pair", "outside") or (
        truth["kind"] == "single" and must_be_named(judge(truth, {}))
    )


def _read(
    root: Path, keep: Path, names: list[str]
) -> tuple[list[tuple[dict[str, Any], Signatures]], list[Discrepancy]]:
    from brace.ground.errors import BadFileError

    keep.mkdir(parents=True, exist_ok=True)
    named, gaps = [], []
    for done, name in enumerate(names, start=1):
        truth = json.loads((root / "answers" / name / "truth.json").read_text())
        print(f"\rreading {done}/{len(names)}", end="", file=sys.stderr, flush=True)
        try:
            if _counts(truth) and (sig := cached(root / "cases" / name, keep)) is not None:
                named.append((truth, sig))
            if truth["kind"] in ("single", "pair"):
                found = _gap_of(root, keep, name)
                if found is not None and found.before_n > VISIBLE_GAP_N:
                    gaps.append(found)
        except BadFileError as error:
            print(f"\n{name} is refused: {error}", file=sys.stderr)
    print(file=sys.stderr)
    return named, gaps


def _gap_of(root: Path, keep: Path, name: str) -> Discrepancy | None:
    path = keep / f"{name}.gap.pickle"
    if path.exists():
        kept: Discrepancy | None = pickle.loads(path.read_bytes())
        return kept
    ready = prepared(root / "cases" / name)
    found = discrepancy_of(ready, Unseen(root / "answers" / name / "holdout")) if ready is not None else None
    path.write_bytes(pickle.dumps(found))
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, help="only so many of the set: for a quick look; writes nothing")
    parser.add_argument("--set", type=Path, default=default_folder(DEVELOPMENT_SEED, TUNING_CASES))
    parser.add_argument("--method", help="only those whose name has this in it")
    options = parser.parse_args()
    if not (options.set / "cases").is_dir():
        print(f"there is no such set yet: python tests/judges/blind/generate.py --development --cases {TUNING_CASES}", file=sys.stderr)
        return 3
    stamp = json.loads((options.set / "set.json").read_text())
    if stamp["seed"] != DEVELOPMENT_SEED:
        print("only the development set is for tuning", file=sys.stderr)
        return 2
    names = sorted(path.name for path in (options.set / "cases").iterdir())[: options.cases]
    keep = BUILD / "baselines-tuning" / diagnoser.version()
    named, gaps = _read(options.set, keep, names)
    gaps = gaps[:GAP_CASES]
    content: dict[str, Any] = {
        "command": "python tests/judges/blind/baselines/tune.py",
        "seed": stamp["seed"],
        "generator_sha256": stamp["generator"],
        "trials": TRIALS,
        "trial_seed": TRIAL_SEED,
        "cases": {"naming": len(named), "gap": len(gaps)},
    }
    if stamp["generator"] != generator_hash():
        print("the set was made by another version of the generator", file=sys.stderr)
    for name, space in spaces().items():
        if options.method and options.method not in name:
            continue
        found = _tuned(name, space, named, gaps)
        if options.cases:
            print(name, json.dumps(found))
            continue
        before = tuned() if TUNED.exists() else {}
        kept = before.get("methods", {}) if {**before, "methods": 0} == {**content, "methods": 0} else {}
        TUNED.write_text(json.dumps({**content, "methods": {**kept, name: found}}, indent=1) + "\n")
    return 0


def _tuned(
    name: str, space: Space, named: list[tuple[dict[str, Any], Signatures]], gaps: list[Discrepancy]
) -> dict[str, Any]:
    """The best of a method's trials."""
    tried: list[tuple[float, Knobs]] = []
    begun = time.monotonic()
    for number, knobs in enumerate(space.trials(TRIAL_SEED, TRIALS), start=1):
        if name == PROCESS:
            value = float(np.mean([min(max(gaussian_process.closed(gap, knobs), 0.0), 1.0) for gap in gaps]))
        else:
            value = worth([judge(truth, NAMING[name].choose(sig, knobs).found) for truth, sig in named])
        tried.append((value, knobs))
        spent = time.monotonic() - begun
        print(f"{name}, trial {number}: {value:.4f} {knobs} ({spent:.0f} s)", file=sys.stderr, flush=True)
    best = max(tried, key=lambda pair: pair[0])
    return {"knobs": best[1], "worth": round(best[0], 4), "textbook_worth": round(tried[0][0], 4)}


if __name__ == "__main__":
    sys.exit(main())
