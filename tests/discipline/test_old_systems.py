"""What a wheel promises of old systems, asked of the native library before a release is made."""

from __future__ import annotations

import re
import subprocess
import sys

from sources import ROOT

sys.path.insert(0, str(ROOT / "tools"))
from release.python_packages import MANYLINUX  # noqa: E402

LIBRARY = ROOT / "build/host/host_sim/libbrace_host.so"


def test_no_function_is_newer_than_the_c_library_that_the_wheels_promise() -> None:
    """Where this fails: glibc has renewed that function (hypot in 2.35). Another one does the same."""
    promised = tuple(map(int, re.findall(r"\d+", MANYLINUX)))
    needed = subprocess.run(["objdump", "-T", LIBRARY], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"\(GLIBC_(\d+)\.(\d+)[.\d]*\)\s+(\w+)", needed)
    assert found
    newer = [f"{name} of {major}.{minor}" for major, minor, name in found if (int(major), int(minor)) > promised]
    assert not newer
