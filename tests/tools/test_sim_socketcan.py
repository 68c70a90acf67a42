"""`brace sim` on real SocketCAN: a guest kernel's vcan0, python-can on the other end."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]


def test_the_limbs_are_on_vcan0() -> None:
    pytest.importorskip("can")
    run = subprocess.run(
        ["tests/socketcan/with_vcan", sys.executable, "tests/socketcan/sim_on_vcan.py"],
        cwd=PROJECT,
        capture_output=True,
        text=True,
        timeout=300,
    )
    if run.returncode == 4:
        pytest.skip(run.stderr.strip())
    assert run.returncode == 0, run.stdout + run.stderr
    seen = json.loads(run.stdout.splitlines()[-1])
    assert seen["place"] == "vcan0" and seen["code"] == 0
    assert min(seen["beats"].values()) >= 1
    # One of ours, plus each other's heartbeats; the extended frame reached no controller.
    sent, received = seen["end"]["can_sent"], seen["end"]["can_received"]
    assert received == sent + 2
