"""How far the batch K is from extended precision, limb by limb over the whole workspace.

K and the eigenvalues within 2e-6, or the limb is refused. Exit code 1 beyond that.
"""
from __future__ import annotations

import ctypes
import sys

import numpy as np

import planar_oracle as oracle
from core_library import core_library, floats_of
from planar_judge import Columns, sweep

LIMITS = np.array([2e-6, 2e-6, 2e-6, 1e-6])  # K, lambda_min, lambda_max, axis [rad]


def main() -> int:
    library = core_library()
    library.batch_columns.restype = ctypes.c_long

    def batch(limb: oracle.Limb, theta1: np.ndarray, theta2: np.ndarray) -> tuple[Columns, bool] | None:
        columns = np.empty((6, theta1.size), np.float32)
        angles = [t.astype(np.float32) for t in (theta1, theta2)]
        refused = library.batch_columns(limb.floats(), ctypes.c_size_t(theta1.size), *map(floats_of, angles),
                                        floats_of(columns))
        assert refused <= 0, "a posture of the workspace was refused"
        return None if refused < 0 else (columns, False)

    return sweep(__doc__, batch, LIMITS, None)


if __name__ == "__main__":
    sys.exit(main())
