"""brace's bus commands on real SocketCAN: a guest kernel's vcan0."""

from __future__ import annotations

import json

from conftest import in_guest, physics_k


def test_query_record_replay_push_and_failures_on_vcan0() -> None:
    results = in_guest("tests/tools/bus_on_vcan.py", timeout_s=400)
    for name in ("live", "asked", "record", "replay", "push"):
        assert results[name]["code"] == 0, results[name]
    live, asked = json.loads(results["live"]["out"]), json.loads(results["asked"]["out"])
    # The controller takes the sensor's noise for a load, and K of now counts it. So K without load is compared.
    unloaded = {name.removeprefix("unloaded_"): value for name, value in live["load"].items()}
    for entry, k in ((unloaded, physics_k(1.0, 1.4)), (asked, physics_k(0.5, 1.2))):
        got = [entry[f"{name}_n_per_mm"] for name in ("k_xx", "k_xz", "k_zz")]
        assert max(abs(a - b) for a, b in zip(got, (k[0, 0], k[0, 1], k[1, 1]))) < 0.003
    recorded, replayed = json.loads(results["record"]["out"]), json.loads(results["replay"]["out"])
    assert replayed["frames"] == recorded["frames"] > 100
    for name, words in {
        "wrong node": "nodes on this bus: 1",
        "no interface": "CAN interfaces here: vcan0, vcan1",
        "no can": "not a CAN interface",
        "down": "ip link set vcan1 up",
        "silent": "vcan1 is up, and nothing is on the bus",
    }.items():
        told = results[name]
        assert told["code"] == 4 and words in told["err"] and "try:" in told["err"], told
        # The guest is slower than the machine it runs on, by how much a failure that waits for nothing says. The machine
        # itself may be half as fast from one command to the next, when something else begins to run on it.
        assert told["s"] < 3.0 + 4.0 * results["no interface"]["s"], told
