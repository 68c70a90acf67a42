"""How many cases it takes to show that the diagnosis is better than a baseline, line by line, at p < 0.01.

usage: power.py FILE [N ...]     FILE: blind.json or blind-finite.json of an earlier run
From that run: the shares of cases that only one of the two has right. Prints, for each number of cases, the chance that
the exact McNemar test comes out below 0.01 if those shares are the true ones."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from baselines.compare import SIGNIFICANT, mcnemar_p
from scipy.stats import binom

def chance(cases: int, ours: float, theirs: float) -> float:
    """Of p < 0.01 in our favour, when each case is right for us alone with probability `ours`, for them alone with
    `theirs`."""
    apart = np.arange(cases + 1)
    weight = binom.pmf(apart, cases, ours + theirs)
    share = ours / (ours + theirs)
    return float(sum(w * _above(int(n), share) for n, w in zip(apart, weight, strict=True) if w > 1e-9))


def _above(apart: int, share: float) -> float:
    """Chance that so many cases on which the two differ fall significantly to our side."""
    least = next((k for k in range(apart // 2 + 1, apart + 1) if mcnemar_p(k, apart - k) < SIGNIFICANT), apart + 1)
    return float(binom.sf(least - 1, apart, share))


def main(earlier: Path, sizes: list[int]) -> int:
    found: dict[str, Any] = json.loads(earlier.read_text())
    print("line; baseline; ours:theirs of; chance at " + ", ".join(map(str, sizes)))
    for row in found["baselines"]:
        ours, theirs = row["only_diagnose_right"], row["only_baseline_right"]
        chances = [chance(size, ours / row["of"], theirs / row["of"]) for size in sizes]
        shown = " ".join(f"{value:.2f}" for value in chances)
        print(f"{row['line']}; {row['baseline']}; {ours}:{theirs} of {row['of']}; {shown}")
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: power.py FILE [N ...]")
    sys.exit(main(Path(sys.argv[1]), [int(text) for text in sys.argv[2:]] or [216, 480, 1200]))
