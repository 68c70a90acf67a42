"""How far the float K is from extended precision, limb by limb over the whole workspace: tick, general path.

K within 2e-6 of lambda_max and eigenvalues within 2e-6 of themselves, or the limb is flagged or refused. Exit code 1
beyond that. --path picks tick or general (default: both).
"""
from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable

import numpy as np

import planar_oracle as oracle
from core_library import core_library, floats_of
from planar_judge import Columns, Variant, sweep

LIMITS = np.array([2e-6, 2e-6, 2e-6, 1e-6])  # K, lambda_min, lambda_max, axis [rad]
NEAR_SINGULAR = 2
PATHS = {"tick": ("planar_rows", LIMITS), "general": ("planar_general_rows", LIMITS)}


def variant(rows_function: Callable[..., int]) -> Variant:
    """One of the driver's loops as the judge wants it."""
    def columns(limb: oracle.Limb, theta1: np.ndarray, theta2: np.ndarray) -> tuple[Columns, bool] | None:
        angles = [t.astype(np.float32) for t in (theta1, theta2)]
        rows = np.empty((theta1.size, 7), np.float32)
        status = rows_function(limb.floats(), ctypes.c_size_t(theta1.size), *(floats_of(a) for a in angles),
                               floats_of(rows))
        flags = rows[:, 6].copy().view(np.uint32)
        return None if status else (rows[:, :6].T, bool(np.any(flags & NEAR_SINGULAR)))

    return columns


def main() -> int:
    chosen = list(PATHS)
    if "--path" in sys.argv:
        at = sys.argv.index("--path")
        chosen = [sys.argv[at + 1]]
        del sys.argv[at:at + 2]
    library = core_library()
    failed = 0
    for path in chosen:
        function, limits = PATHS[path]
        print(f"{path}:")
        failed |= sweep(str(__doc__), variant(getattr(library, function)), limits, None)
    return failed


if __name__ == "__main__":
    sys.exit(main())
