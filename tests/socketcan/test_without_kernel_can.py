"""On the host itself, whose kernel need not know CAN: python-can's slcan and `cantools monitor` against TCP, a pty and
the emulated board's serial port."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from processes import emulated, simulated
from terminal import screen_of
from wire_by_hand import ANSWER, DBC, NODE, PROJECT, REQUEST, check, expected, k_of_answers, k_request

can = pytest.importorskip("can")
pytest.importorskip("cantools")
ASKED_RAD = (0.2, 1.9)
STANDS_RAD = (1.0, 1.4)


@pytest.fixture(params=["tcp", "pty", "board"])
def channel(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """What python-can calls the place."""
    if request.param == "board":
        with emulated(tmp_path) as places:
            yield places["slcan"]
    else:
        url = "slcan:pty" if request.param == "pty" else "tcp://127.0.0.1:0"
        with simulated("--can", url, "--modbus", "none") as ready:
            place = str(ready["limbs"][0]["can"])
            yield place.replace("tcp://", "socket://").removeprefix("slcan:")


def test_python_can_asks_and_is_answered(channel: str) -> None:
    request = can.Message(
        arbitration_id=REQUEST + NODE, data=k_request(7, *ASKED_RAD), is_extended_id=False
    )
    parts: list[bytes] = []
    with can.Bus(interface="slcan", channel=channel, bitrate=1_000_000, sleep_after_open=0.2) as bus:
        bus.send(request)
        end = time.monotonic() + 60.0
        while len(parts) < 4 and time.monotonic() < end:
            frame = bus.recv(0.2)
            if frame is not None and frame.arbitration_id == ANSWER + NODE and frame.data[1] == 7:
                parts.append(bytes(frame.data))
    check(k_of_answers(parts), *ASKED_RAD)


def test_cantools_monitor_shows_k(channel: str) -> None:
    program = shutil.which("cantools", path=str(Path(sys.executable).parent))
    assert program, "the test environment has cantools"
    true = expected(*STANDS_RAD)
    names = ("k_xx", "k_xz", "k_zz", "lambda_min")
    text = screen_of(
        [program, "monitor", "-s", "-i", "slcan", "-c", channel, "-b", "1000000", str(DBC)],
        [rf"\b{name}: -?\d+\.?\d* N/mm" for name in names],
    )
    for name, value in zip(names, (true.xx, true.xz, true.zz, true.low), strict=True):
        shown = re.search(rf"\b{name}: (-?\d+\.?\d*) N/mm", text)
        assert shown and float(shown[1]) == pytest.approx(value, abs=0.01), name


def test_cantools_decodes_a_log(channel: str, tmp_path: Path) -> None:
    """`candump`'s text through `cantools decode`, as one does without a terminal."""
    lines: list[str] = []
    with can.Bus(interface="slcan", channel=channel, bitrate=1_000_000, sleep_after_open=0.2) as bus:
        end = time.monotonic() + 60.0
        while len(lines) < 40 and time.monotonic() < end:
            if (frame := bus.recv(0.2)) is not None:
                lines.append(f"({time.time():.6f}) can0 {frame.arbitration_id:03X}#{frame.data.hex().upper()}")
    program = Path(sys.executable).parent / "cantools"
    run = subprocess.run(
        [program, "decode", "-s", str(DBC)], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True,
        cwd=PROJECT,
    )  # fmt: skip
    decoded = run.stdout.splitlines()
    assert len(decoded) == len(lines) == 40
    shown = [float(found[1]) for line in decoded if (found := re.search(r"\bk_zz: (-?\d+\.?\d*) N/mm", line))]
    assert len(shown) >= 10
    assert shown == pytest.approx([expected(*STANDS_RAD).zz] * len(shown), abs=0.01)
