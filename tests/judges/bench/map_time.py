"""Processor time of `brace map` over a million postures, start of Python and pictures included."""

import os
import subprocess
import tempfile

from fetch import ROOT, Missing

POSTURES = 1_000_000


def map_seconds() -> float:
    """User and system time of the whole command, all its threads [s]; the best of two."""
    command = ROOT / ".venv" / "bin" / "brace"
    model = ROOT / "tools" / "brace" / "data" / "paper-limb.toml"
    best = float("inf")
    for _ in range(2):
        with tempfile.TemporaryDirectory() as folder:
            before = os.times()
            try:
                done = subprocess.run([command, "map", "--model", model, "--postures", str(POSTURES),
                                       "--out", f"{folder}/map"], capture_output=True, text=True,
                                      check=False)
            except FileNotFoundError as error:
                raise Missing("no .venv/bin/brace (./dev setup makes it)") from error
            after = os.times()
            if done.returncode != 0:
                raise RuntimeError(f"brace map: {done.stderr[-500:]}")
        spent = after.children_user + after.children_system - before.children_user - before.children_system
        best = min(best, spent)
    return best
