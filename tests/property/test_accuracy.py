"""Every arithmetic of K against extended precision, ten limbs and more over the whole workspace, straight and folded
knees included: within the limits stated in the headers, or flagged, or refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


@pytest.mark.parametrize("arithmetic", ["planar", "fixed", "spatial", "batch"])
def test_within_the_stated_accuracy(arithmetic: str) -> None:
    sweep = subprocess.run([sys.executable, HERE / f"accuracy_{arithmetic}.py"], capture_output=True, text=True,
                           timeout=300)
    assert sweep.returncode == 0, sweep.stdout + sweep.stderr
