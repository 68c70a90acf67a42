"""The client on the kernel's own CAN: its tests run again in a guest kernel that has vcan0."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest
from conftest import PROJECT

NEEDS = {"linux.uml": "user-mode-linux", "insmod": "kmod", "ip": "iproute2"}


def test_socketcan() -> None:
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    missing = [package for tool, package in NEEDS.items() if shutil.which(tool, path=path) is None]
    if missing:
        pytest.skip(f"no guest kernel: Debian packages {', '.join(missing)} are missing")
    environment = dict(
        os.environ, BRACE_TEST_CAN="vcan0", BRACE_GUEST_TIMEOUT_S="500", BRACE_GUEST_MEMORY="512M",
        PYTHONDONTWRITEBYTECODE="1",
    )  # fmt: skip
    done = subprocess.run(
        [PROJECT / "tests" / "socketcan" / "with_vcan", "env", "TMPDIR=/dev/shm", sys.executable, "-m", "pytest", "-q",
         "-p", "no:cacheprovider",
         "tests/client/on_vcan.py", "tests/client/fd_on_vcan.py", "tests/client/test_against_sim.py", "-k",
         "not modbus"],
        cwd=PROJECT, env=environment, capture_output=True, text=True, timeout=540,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-6000:] + done.stderr[-2000:]
    assert " passed" in done.stdout and "skipped" not in done.stdout
