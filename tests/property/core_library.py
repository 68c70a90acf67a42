"""The firmware's core as a shared library with the *_driver.c loops, built on demand for the accuracy sweeps."""
from __future__ import annotations

import ctypes
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "firmware" / "core"
FLAGS = ["-std=c11", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-shared"]


def core_library() -> ctypes.CDLL:
    """The library, from $BRACE_CORE_LIBRARY or compiled with $CC (cc) into a temporary folder."""
    given = os.environ.get("BRACE_CORE_LIBRARY")
    if given:
        return ctypes.CDLL(given)
    with tempfile.TemporaryDirectory(prefix="brace-core-") as folder:
        path = Path(folder) / "libcore.so"
        sources = [*map(str, sorted((CORE / "src").glob("*/*.c"))),
                   *map(str, sorted(Path(__file__).parent.glob("*_driver.c")))]
        command = [os.environ.get("CC", "cc"), *FLAGS, f"-I{CORE / 'include'}", f"-I{CORE / 'src'}", *sources]
        subprocess.run([*command, "-o", str(path), "-lm"], check=True)
        return ctypes.CDLL(str(path))


def floats_of(array: np.ndarray) -> ctypes._Pointer[ctypes.c_float]:
    """A float32 array as C sees it."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
