"""Judges a planar variant limb by limb against extended precision and prints a table; shared by the sweeps."""
from __future__ import annotations

import argparse
from collections.abc import Callable

import numpy as np

import planar_oracle as oracle

Columns = np.ndarray  # (6, n): K_xx, K_xz, K_zz, lambda_min, lambda_max [N/mm], stiff axis [rad]
# theta1, theta2 [rad] as the variant gets them -> columns, whether flagged; None for a refused limb
Variant = Callable[[oracle.Limb, np.ndarray, np.ndarray], "tuple[Columns, bool] | None"]


def errors(limb: oracle.Limb, theta1: np.ndarray, theta2: np.ndarray, columns: Columns) -> np.ndarray:
    """Worst errors [K over lambda_max, lambda_min, lambda_max relative, axis (rad) where C is not round]."""
    truth = oracle.planar(limb, theta1, theta2)
    got = columns.astype(np.longdouble)
    largest = truth.lambda_max
    k = np.max([abs(got[0] - truth.k_xx), abs(got[1] - truth.k_xz), abs(got[2] - truth.k_zz)], axis=0)
    turned = np.remainder(got[5] - truth.axis + np.pi / 2, np.pi) - np.pi / 2
    # C's own rounding turns the axis the more, the rounder C is
    anisotropy = 1 - truth.lambda_min / largest
    return np.array([np.max(k / largest), np.max(abs(got[3] / truth.lambda_min - 1)),
                     np.max(abs(got[4] / largest - 1)), np.max(abs(turned) * anisotropy)], float)


def sweep(title: str, variant: Variant, limits: np.ndarray, step_rad: float | None) -> int:
    """Prints worst errors for every limb; 1 if one is beyond limits without being flagged or refused.

    step_rad: the resolution the angles are rounded to first; None for float32.
    """
    parser = argparse.ArgumentParser(description=title)
    parser.add_argument("--postures", type=int, default=10000)
    parser.add_argument("--random", type=int, default=60, help="random limbs besides the named ones")
    options = parser.parse_args()
    rng = np.random.default_rng(7)
    named = oracle.limbs()
    print(f"{'limb':16s} {'K':>9s} {'l_min':>9s} {'l_max':>9s} {'axis':>9s}")
    failed, worst_random = 0, np.zeros(4)
    tally = {"flagged": 0, "refused": 0}
    for index, limb in enumerate(named + [oracle.random_limb(rng) for _ in range(options.random)]):
        theta1, theta2 = (t.astype(float) for t in oracle.postures(rng, options.postures))
        if step_rad is not None:
            theta1, theta2 = (np.rint(t / step_rad) * step_rad for t in (theta1, theta2))
        result = variant(limb, theta1, theta2)
        found = None if result is None else errors(limb, theta1, theta2, result[0])
        text = "" if found is None else " ".join(f"{e:9.1e}" for e in found)
        if result is None or found is None or result[1]:
            tally["refused" if found is None else "flagged"] += 1
            verdict = "refused" if found is None else "flagged"
        elif np.all(found <= limits):
            verdict = ""
            if index >= len(named):
                worst_random = np.maximum(worst_random, found)
        else:
            verdict = "FAIL"
            failed += 1
        if index < len(named) or verdict:
            print(f"{limb.name:16s} {text}  {verdict}")
    print(f"{options.random:4d} random      " + " ".join(f"{e:9.1e}" for e in worst_random))
    print(f"refused {tally['refused']}, flagged {tally['flagged']} of {len(named) + options.random}; "
          f"{failed} beyond the limits")
    return 1 if failed else 0
