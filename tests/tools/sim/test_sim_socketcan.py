"""`brace sim` on real SocketCAN: a guest kernel's vcan0, python-can on the other end."""

from __future__ import annotations

from command_bench import in_guest


def test_the_limbs_are_on_vcan0() -> None:
    seen = in_guest("tests/socketcan/sim_on_vcan.py", timeout_s=300)
    assert seen["place"] == "vcan0" and seen["code"] == 0
    assert min(seen["beats"].values()) >= 1
    # The request to one of ours: their filters keep out extended frames and each other's heartbeats.
    assert seen["end"]["can_received"] == 1
