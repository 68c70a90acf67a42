"""What `brace stance watch` costs, and how old what it shows is: eight limbs of a simulated robot on one CAN FD bus at
100 Hz, on this machine.

    .venv/bin/python tests/judges/stance/watch_cost.py

Run it while nothing else runs: the processor's time grows beside other work, and the robot then sends later.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

BRACE = (sys.executable, "-m", "brace")
LIMBS, RADIUS_MM = 8, 120.0
STARTS_MOST_S, SETTLES_S, MEASURED_S = 30.0, 3.0, 20.0
CONTROLLER = "[controller]\nstiffness_hz = 100\nload_hz = 100\ncan_fd_bit_rate = 5000000\nbus_load_ratio = 0.1\n"
MODEL = Path(__file__).parents[3] / "examples" / "stance" / "limb.toml"


def write(folder: Path) -> Path:
    """The stance, its eight limbs around a body on a floor."""
    model = MODEL.read_text().split("[controller]")[0]
    (folder / "limb.toml").write_text(model + CONTROLLER)
    text = 'format = 1\nname = "eight"\n[body]\nweight_n = 60.0\n[payload]\nforce_n = [8.0, 0.0, -4.0]\n'
    for limb in range(LIMBS):
        yaw = 2.0 * np.pi * limb / LIMBS
        x, y = RADIUS_MM * np.cos(yaw), RADIUS_MM * np.sin(yaw)
        text += (
            f'[[limb]]\nname = "limb {limb}"\nmodel = "limb.toml"\nmount_mm = [{x:.3f}, {y:.3f}, 0.0]\n'
            f"mount_rpy_rad = [0.0, 0.0, {yaw:.6f}]\ntheta_rad = [0.0, 0.4, 1.6]\n"
            "[limb.foothold]\nnormal = [0.0, 0.0, 1.0]\nfriction = 0.8\n"
        )
    (folder / "stance.toml").write_text(text)
    return folder / "stance.toml"


def used_s(process: int) -> float:
    """Of the processor, by the process and the kernel for it."""
    fields = Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> int:
    with tempfile.TemporaryDirectory() as name:
        stance = write(Path(name))
        robot = subprocess.Popen(
            [*BRACE, "sim", "--stance", stance, "--json", "--modbus", "none", "--can", "tcp://127.0.0.1:0"],
            stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            assert robot.stdout is not None
            bus = json.loads(robot.stdout.readline())["limbs"][0]["can"]
            out = Path(name) / "watch.jsonl"
            with out.open("w") as file:
                watch = subprocess.Popen(
                    [*BRACE, "stance", "watch", stance, "--bus", bus, "--json", "--every", "0.1"], stdout=file
                )
            until_s = time.monotonic() + STARTS_MOST_S
            while not out.stat().st_size and time.monotonic() < until_s:
                time.sleep(0.1)
            time.sleep(SETTLES_S)
            before_s, began_s, shown = used_s(watch.pid), time.monotonic(), out.stat().st_size
            time.sleep(MEASURED_S)
            after_s, lasted_s = used_s(watch.pid), time.monotonic() - began_s
            watch.terminate()
            watch.wait(timeout=10)
            said = out.read_text()[shown:].split("\n", 1)[1]
        finally:
            robot.kill()
            robot.wait()
    events = [json.loads(line) for line in said.splitlines()]
    ages_ms = [limb["age_ms"] for event in events if event["event"] == "stance" for limb in event["limbs"]]
    share = (after_s - before_s) / lasted_s
    middle, high = np.quantile(ages_ms, [0.5, 0.95])
    print(f"{LIMBS} limbs: {100 * share:.0f} % of a core (wanted: below 20)")
    print(f"age of {len(ages_ms)} shown: median {middle:.0f}, 95th percentile {high:.0f}, worst {max(ages_ms):.0f} ms "
          "(wanted: at most 30)")  # fmt: skip
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
