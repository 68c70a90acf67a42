"""Run where the kernel has CAN (test_vcan.py does): snapshots as frames of CAN FD, from `brace sim` to other people's
tools, to ours, and to the C client."""

from __future__ import annotations

import json
import re
import signal
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import cantools
import pytest
from conftest import LIMB, PROJECT

from brace.cli import main as brace_main

INTERFACE = PROJECT / "firmware" / "interface"
PROBE_ALL = 7
LINE = re.compile(r"\((\d+\.\d+)\) vcan0 501##[15]([0-9A-F]{128})(?: [RT])?")


@pytest.fixture(scope="module")
def limb(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The paper's limb, with CAN FD on."""
    path = tmp_path_factory.mktemp("fd") / "limb.toml"
    text = LIMB.read_text()
    keys = "can_fd_bit_rate = 4000000\nstiffness_hz = 100\nbus_load_ratio = 0.5\n"
    whole = text if "[controller]" in text else text + "\n[controller]\n"
    path.write_text(whole.replace("[controller]\n", "[controller]\n" + keys))
    return path


@pytest.fixture(scope="module")
def sim(limb: Path) -> Iterator[dict[str, Any]]:
    """`brace sim` on vcan0, for all tests here: its start is most of their work. The limb's sensor is free of noise: K
    counts the force that it reads."""
    quiet = limb.with_name("quiet.toml")
    quiet.write_text(limb.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    command = [sys.executable, "-m", "brace", "sim", "--model", str(limb), "--plant", str(quiet), "--json", "--can",
               "vcan0", "--modbus", "none"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    yield json.loads(process.stdout.readline())
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)


def test_an_interface_for_classic_frames_gets_classic_ones(limb: Path) -> None:
    # The first test: two simulations at once would be slow.
    subprocess.run(["ip", "link", "add", "vcan8", "type", "vcan"], check=True)
    subprocess.run(["ip", "link", "set", "vcan8", "mtu", "16"], check=True)
    subprocess.run(["ip", "link", "set", "vcan8", "up"], check=True)
    command = [sys.executable, "-m", "brace", "sim", "--model", str(limb), "--json", "--can", "vcan8", "--modbus",
               "none"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline()
    done = subprocess.run(["candump", "-L", "-T", "1500", "-n", "100", "vcan8"], capture_output=True, text=True,
                          timeout=90)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=60)
    subprocess.run(["ip", "link", "del", "vcan8"], check=True)
    assert " 181#" in done.stdout and "##" not in done.stdout


def test_candump_shows_two_hashes(sim: dict[str, Any]) -> None:
    done = subprocess.run(["candump", "-L", "-T", "5000", "-n", "120", "vcan0"], capture_output=True, text=True,
                          timeout=90)
    whole = [found for line in done.stdout.splitlines() if (found := LINE.fullmatch(line))]
    assert len(whole) > 60, done.stdout[:600]
    assert not re.search(r" (181|281|381|481)#", done.stdout)
    database = cantools.database.load_file(INTERFACE / "brace_fd.dbc")
    ticks = [database.decode_message(0x501, bytes.fromhex(found[2]))["sequence"] for found in whole]
    steps = [other - one for one, other in zip(ticks, ticks[1:], strict=False)]
    assert 6 <= statistics.median(steps) <= 12, steps  # 100 Hz, counted on the controller's clock of 1 kHz


def test_python_can_and_cantools_read_the_k_that_brace_reads(
    sim: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    database = cantools.database.load_file(INTERFACE / "brace_fd.dbc")
    assert brace_main(["query", "--bus", "vcan0", "--json"]) == 0
    asked = json.loads(capsys.readouterr().out)
    with can.Bus(interface="socketcan", channel="vcan0", fd=True) as bus:
        until = time.monotonic() + 30
        decoded: list[dict[str, Any]] = []
        while time.monotonic() < until and len(decoded) < 100:
            message = bus.recv(1)
            if message is not None and message.arbitration_id == 0x501:
                assert message.is_fd and message.bitrate_switch and message.dlc == 64
                decoded.append(dict(database.decode_message(0x501, message.data, decode_choices=False)))
    assert len(decoded) == 100
    sequences = [d["sequence"] for d in decoded]
    assert sequences == sorted(sequences)
    for d in decoded:
        for name in ("k_xx", "k_xz", "k_zz", "lambda_min", "lambda_max"):
            assert d[name] == pytest.approx(asked[f"{name}_n_per_mm"], rel=2e-3, abs=2e-3), (name, asked)
        # the eigenvalues are those of the same K: one tick
        assert d["lambda_min"] * d["lambda_max"] == pytest.approx(d["k_xx"] * d["k_zz"] - d["k_xz"] ** 2, rel=1e-4)
        assert d["lambda_min"] + d["lambda_max"] == pytest.approx(d["k_xx"] + d["k_zz"], rel=1e-5)
        assert 0 <= d["age"] < 5 and d["mode"] == 1


def test_the_c_client_reads_them(sim: dict[str, Any], probe: Any) -> None:
    answer = probe("vcan0", "read", PROBE_ALL, 20)
    assert answer.code == 0, answer.err
    assert len(answer.snapshots) == 20 and all(int(s["parts"]) & PROBE_ALL == PROBE_ALL for s in answer.snapshots)
    assert all(s["valid"] == 1 for s in answer.snapshots)
    assert len({s["snapshot"] for s in answer.snapshots}) > 10
    posture = probe("vcan0", "posture", 0.5, 1.2)  # requests stay classic
    assert posture.code == 0 and posture.values["k_xx"] > 0


def test_brace_records_and_replays_them(
    sim: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "fd.log"
    assert brace_main(["record", "--bus", "vcan0", "--out", str(log), "--seconds", "2"]) == 0
    assert sum(LINE.fullmatch(line) is not None for line in log.read_text().splitlines()) > 60
    capsys.readouterr()
    assert brace_main(["replay", str(log), "--json"]) == 0
    again = capsys.readouterr().out
    snapshots = [entry for line in again.splitlines() if "k_xx_n_per_mm" in (entry := json.loads(line))]
    assert len(snapshots) > 60 and all(entry["k_is_valid"] and "theta1_rad" in entry for entry in snapshots)
