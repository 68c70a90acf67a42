"""Run where the kernel has vcan0: `brace sim` on it, python-can on the other end. Prints what each saw as JSON."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import can

LIMB = Path(__file__).resolve().parents[2] / "tools" / "brace" / "data" / "paper-limb.toml"


def main() -> None:
    options = ["--model", str(LIMB), "--json", "--can", "vcan0", "--modbus", "none", "--limbs", "2"]
    sim = subprocess.Popen([sys.executable, "-m", "brace", "sim", *options], stdout=subprocess.PIPE, text=True)
    assert sim.stdout is not None
    ready = json.loads(sim.stdout.readline())
    seen: dict[str, int] = {}
    with can.Bus(interface="socketcan", channel="vcan0") as bus:
        request = bytes([1, 7, 0x34, 0x10, 0, 0, 0, 0])  # read_entry; the first of these frames alone is for one of ours
        for identifier, extended in ((0x601, False), (0x601, True), (0x603, False)):
            bus.send(can.Message(arbitration_id=identifier, data=request, is_extended_id=extended))
        # The controllers beat once a second of their own time; a busy machine may need many of its seconds for that.
        until = time.monotonic() + 120.0
        while time.monotonic() < until and not {"701", "702"} <= seen.keys():
            if (frame := bus.recv(0.2)) is not None:
                name = f"{frame.arbitration_id:x}"
                seen[name] = seen.get(name, 0) + 1
    sim.send_signal(signal.SIGTERM)
    out, _ = sim.communicate(timeout=20)
    end = json.loads(out.splitlines()[-1])
    beats = {"701": seen.get("701", 0), "702": seen.get("702", 0)}
    print(json.dumps({"place": ready["limbs"][0]["can"], "beats": beats, "code": sim.returncode, "end": end}))


if __name__ == "__main__":
    main()
