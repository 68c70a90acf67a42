"""`./dev bench`: what a K costs, side by side with its peers, on the same postures; PASS or MISS per limit.

Writes docs/bench.json and docs/bench.md. Exit codes: 0 every limit kept, 1 one missed, 4 something is missing here.
"""

import argparse
import subprocess
import sys
from pathlib import Path

BENCH = Path(__file__).resolve().parent
sys.path.insert(0, str(BENCH))

import fetch  # noqa: E402
import postures  # noqa: E402
import versions  # noqa: E402
from emulate import build_plugin  # noqa: E402
from measure import Measured, measure  # noqa: E402
from toolchain import BUILD, run  # noqa: E402


def say(text: str) -> None:
    """A line of progress."""
    print(text, file=sys.stderr, flush=True)


def generate() -> Path:
    """bench_data.h and CasADi's C; gives the folder of the latter."""
    generated = BUILD / "generated"
    generated.mkdir(parents=True, exist_ok=True)
    (BUILD / "images").mkdir(parents=True, exist_ok=True)
    (generated / "bench_data.h").write_text(postures.header())
    run(["env", f"PYTHONPATH={fetch.casadi()}", sys.executable, BENCH / "peers" / "casadi_generate.py", generated])
    return generated
