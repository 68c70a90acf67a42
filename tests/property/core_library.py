"""The firmware's core as a shared library with the *_driver.c loops, put together on demand for the accuracy sweeps."""
from __future__ import annotations

import ctypes
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CORE = ROOT / "firmware" / "core"
BUILT = ROOT / "build" / "host" / "firmware" / "core" / "libbrace_core.a"
FLAGS = ["-std=c11", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-shared"]


def core_library() -> ctypes.CDLL:
    """The library, from $BRACE_CORE_LIBRARY. Without it the drivers are compiled into a temporary folder and joined to
    the core of the host build; $CC, or no such build, has the core compiled too."""
    given = os.environ.get("BRACE_CORE_LIBRARY")
    if given:
        return ctypes.CDLL(given)
    with tempfile.TemporaryDirectory(prefix="brace-core-") as folder:
        path = Path(folder) / "libcore.so"
        drivers = [*map(str, sorted(Path(__file__).parent.glob("*_driver.c")))]
        if BUILT.is_file() and "CC" not in os.environ:
            core = ["-Wl,--whole-archive", str(BUILT), "-Wl,--no-whole-archive"]
        else:
            core = [*map(str, sorted((CORE / "src").glob("*/*.c")))]
        command = [os.environ.get("CC", "cc"), *FLAGS, f"-I{CORE / 'include'}", f"-I{CORE / 'src'}", *drivers, *core]
        subprocess.run([*command, "-o", str(path), "-lm"], check=True)
        return ctypes.CDLL(str(path))


def floats_of(array: np.ndarray) -> ctypes._Pointer[ctypes.c_float]:
    """A float32 array as C sees it."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
