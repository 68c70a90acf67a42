"""The plant against another simulator's records, where $BRACE_PRACTICE says that there are some."""
from __future__ import annotations

import os

import pytest

import plant_vs_practice

FOLDER = os.environ.get("BRACE_PRACTICE", "")


@pytest.mark.skipif(not os.path.isdir(FOLDER), reason="BRACE_PRACTICE names no folder of practice records")
def test_every_record_is_reproduced(capsys: pytest.CaptureFixture[str]) -> None:
    """Held out: to print rounding. Measured: to white noise. Effects that limb.toml lacks: seen to disagree."""
    failed = plant_vs_practice.main(FOLDER)
    assert failed == 0, capsys.readouterr().out
