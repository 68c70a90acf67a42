"""How far the fixed-point K is from extended precision, limb by limb over the whole workspace.

K within 2e-6 of lambda_max, lambda_min within 5e-6, or the limb is flagged or refused. Exit code 1 beyond that.
"""
from __future__ import annotations

import argparse
import ctypes
import sys

import numpy as np

import planar_oracle as oracle
from core_library import core_library, floats_of

K_LIMIT, LAMBDA_MIN_LIMIT, LAMBDA_MAX_LIMIT = 2e-6, 5e-6, 2e-6
AXIS_LIMIT_RAD = 2e-6  # per unit of (lambda_max - lambda_min)/lambda_max: C's own rounding turns a rounder K further
NEAR_SINGULAR = 2


def errors(library: ctypes.CDLL, limb: oracle.Limb, theta1: np.ndarray, theta2: np.ndarray) -> np.ndarray | None:
    """Worst errors [K, lambda_min, lambda_max, axis], relative as the limits are; None for a refused limb.

    theta1, theta2: int32 [rad * 2^28], shape (n,). A flagged limb's errors are returned negative.
    """
    rows = np.empty((theta1.size, 7), np.float32)
    if library.fixed_rows(limb.floats(), ctypes.c_size_t(theta1.size), theta1.ctypes, theta2.ctypes, floats_of(rows)):
        return None
    truth = oracle.planar(limb, theta1 / np.float64(1 << 28), theta2 / np.float64(1 << 28))
    got = rows.astype(np.longdouble)
    largest = truth.lambda_max
    k = np.max([abs(got[:, 0] - truth.k_xx), abs(got[:, 1] - truth.k_xz), abs(got[:, 2] - truth.k_zz)], axis=0)
    turned = np.remainder(got[:, 5] - truth.axis + np.pi / 2, np.pi) - np.pi / 2
    anisotropy = 1 - truth.lambda_min / largest
    worst = np.array([np.max(k / largest), np.max(abs(got[:, 3] / truth.lambda_min - 1)),
                      np.max(abs(got[:, 4] / largest - 1)), np.max(abs(turned) * anisotropy)], float)
    return -worst if int(rows[0, 6]) & NEAR_SINGULAR else worst


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--postures", type=int, default=20000)
    parser.add_argument("--random", type=int, default=60, help="random limbs besides the named ones")
    options = parser.parse_args()
    rng = np.random.default_rng(7)
    library = core_library()
    limits = np.array([K_LIMIT, LAMBDA_MIN_LIMIT, LAMBDA_MAX_LIMIT, AXIS_LIMIT_RAD])
    print(f"{'limb':16s} {'K':>9s} {'l_min':>9s} {'l_max':>9s} {'axis':>9s}")
    failed, worst_random = 0, np.zeros(4)
    tally = {"flagged": 0, "refused": 0}
    named = oracle.limbs()
    for index, limb in enumerate(named + [oracle.random_limb(rng) for _ in range(options.random)]):
        theta1, theta2 = oracle.postures(rng, options.postures)
        q28 = [np.rint(t.astype(float) * (1 << 28)).astype(np.int32) for t in (theta1, theta2)]
        found = errors(library, limb, *q28)
        if found is None or found[0] < 0:
            tally["refused" if found is None else "flagged"] += 1
            if index < len(named):
                print(f"{limb.name:16s} " + ("refused" if found is None else
                                             " ".join(f"{-e:9.1e}" for e in found) + "  flagged"))
            continue
        bad = bool(np.any(~(found <= limits)))
        failed += bad
        if index < len(named) or bad:
            print(f"{limb.name:16s} " + " ".join(f"{e:9.1e}" for e in found) + ("  FAIL" if bad else ""))
        if index >= len(named):
            worst_random = np.maximum(worst_random, found)
    print(f"{options.random:4d} random      " + " ".join(f"{e:9.1e}" for e in worst_random))
    print(f"refused {tally['refused']}, flagged {tally['flagged']} of {len(named) + options.random}; "
          f"{failed} beyond the limits")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
