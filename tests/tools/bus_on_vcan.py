"""Runs in a guest kernel that has CAN: brace's bus commands on vcan0. Prints one JSON object: command -> code,
seconds, text."""

from __future__ import annotations

import contextlib
import io
import json
import subprocess
import sys
import time
from pathlib import Path

from brace.cli import main as brace_main

BRACE = [sys.executable, "-m", "brace"]
LIMB = "tools/brace/data/paper-limb.toml"


def run(*arguments: str) -> dict[str, object]:
    """In this process: a new one spends two of the guest's slow seconds on imports."""
    started = time.monotonic()
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2))
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = brace_main(list(arguments))
        except SystemExit as stop:  # argparse
            code = int(stop.code or 0)
    texts = (stream.buffer.getvalue().decode() for stream in (out, err))
    return {"code": code, "s": time.monotonic() - started, **dict(zip(("out", "err"), texts))}


def run_alone(*arguments: str) -> dict[str, object]:
    """As a user calls it."""
    started = time.monotonic()
    done = subprocess.run([*BRACE, *arguments], capture_output=True, text=True, timeout=90)
    return {"code": done.returncode, "s": time.monotonic() - started, "out": done.stdout, "err": done.stderr}


def main() -> None:
    sim = subprocess.Popen(
        [*BRACE, "sim", "--model", LIMB, "--can", "vcan0", "--modbus", "none", "--json"],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert sim.stdout is not None
    sim.stdout.readline()
    subprocess.run(["ip", "link", "add", "vcan1", "type", "vcan"], check=True)
    log = Path("/run/a.log")
    results = {
        "live": run("query", "--bus", "vcan0", "--json"),
        "asked": run("query", "--bus", "vcan0", "--theta1", "0.5", "--theta2", "1.2", "--json"),
        "record": run("record", "--bus", "vcan0", "--out", str(log), "--seconds", "0.5", "--json"),
        "replay": run("replay", str(log), "--bus", "vcan0", "--json"),
        "push": run("params", "push", LIMB, "--bus", "vcan0"),
        "wrong node": run("query", "--bus", "vcan0", "--node", "4"),
    }
    sim.terminate()  # what follows has no node, and a simulation is most of what this guest works at
    sim.wait(60)
    results |= {
        "no interface": run_alone("query", "--bus", "can7"),
        "no can": run("query", "--bus", "lo"),
        "down": run("query", "--bus", "vcan1"),
    }
    subprocess.run(["ip", "link", "set", "vcan1", "up"], check=True)
    results["silent"] = run("query", "--bus", "vcan1")
    print(json.dumps(results))


if __name__ == "__main__":
    main()
