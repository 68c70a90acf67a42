"""How far the fixed-point K is from extended precision, limb by limb over the whole workspace.

K within 2e-6 of lambda_max, lambda_min within 5e-6, or the limb is flagged or refused. Exit code 1 beyond that.
"""
from __future__ import annotations

import ctypes
import sys

import numpy as np

import planar_oracle as oracle
from core_library import core_library, floats_of
from planar_judge import Columns, sweep

LIMITS = np.array([2e-6, 5e-6, 2e-6, 5e-7])  # K, lambda_min, lambda_max, axis [rad]
STEP_RAD = 1.0 / (1 << 28)
NEAR_SINGULAR = 2


def main() -> int:
    library = core_library()

    def fixed(limb: oracle.Limb, theta1: np.ndarray, theta2: np.ndarray) -> tuple[Columns, bool] | None:
        angles = [np.rint(t / STEP_RAD).astype(np.int32) for t in (theta1, theta2)]
        rows = np.empty((theta1.size, 7), np.float32)
        status = library.fixed_rows(limb.floats(), ctypes.c_size_t(theta1.size), *(a.ctypes for a in angles),
                                    floats_of(rows))
        return None if status else (rows[:, :6].T, bool(int(rows[0, 6]) & NEAR_SINGULAR))

    return sweep(__doc__, fixed, LIMITS, STEP_RAD)


if __name__ == "__main__":
    sys.exit(main())
