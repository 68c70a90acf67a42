"""One thread a process for linear algebra, unless the environment asks for more. To be imported before numpy.

A fit's matrices are small: more threads only wait for one another, and burn several times the processor time."""

from __future__ import annotations

import os

NAMES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

for _name in NAMES:
    os.environ.setdefault(_name, "1")
