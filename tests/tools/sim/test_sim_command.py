"""`brace sim` as its users start it: ports, what it prints, how it ends; and the ecosystem's tools on the other end."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import signal
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from command_bench import FREE, Outcome, running, spawn

from brace.cli import sim_command, sim_values
from brace.cli.bus_options import ended_by_signal
from brace.cli.options import RefusedValue
from brace.model import load_limb

LOOPBACK = "127.0.0.1"


def connected(place: str) -> socket.socket:
    host, _, port = place.rpartition("/")[2].rpartition(":")
    client = socket.create_connection((host, int(port)), timeout=30.0)
    return client


class Slcan:
    """An SLCAN client that speaks the text itself."""

    def __init__(self, place: str) -> None:
        self.socket = connected(place)
        self.rest = b""

    def send(self, text: bytes) -> None:
        self.socket.sendall(text)

    def line(self, timeout: float = 20.0) -> bytes:
        """The next answer: up to CR, or BEL alone."""
        until = time.monotonic() + timeout
        while True:
            for index, byte in enumerate(self.rest):
                if byte in b"\r\a":
                    found, self.rest = self.rest[: index + 1], self.rest[index + 1 :]
                    return found
            self.socket.settimeout(max(until - time.monotonic(), 0.01))
            try:
                part = self.socket.recv(4096)
            except TimeoutError:
                return b""
            if not part:
                return b""
            self.rest += part

    def ask(self, text: bytes) -> bytes:
        """The answer to a command; frames that come between are passed over."""
        self.send(text + b"\r")
        while (line := self.line()).startswith(b"t"):
            pass
        return line


# ------------------------------------------------------------------------------------------- how it ends


def test_it_says_where_to_connect_runs_and_ends_by_itself(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    outcome = brace("sim", "--model", paper_limb, "--seconds", 0.3, "--limbs", 2, *FREE)
    assert outcome.code == 0, outcome.err
    lines = outcome.out.splitlines()
    assert lines[0].startswith("limb 1: node 1, can tcp://127.0.0.1:") and "modbus-tcp://127.0.0.1:" in lines[0]
    assert lines[1].startswith("limb 2: node 2, ")
    assert lines[2].startswith("limb 1: monitor, K 3.9")


def test_it_starts_without_numpy(paper_limb: Path) -> None:
    """Importing it would take as long as all else that a simulation does before it is ready."""
    code = "import sys; sys.modules['numpy'] = None; from brace.cli import main; sys.exit(main(sys.argv[1:]))"
    given = ("sim", "--model", str(paper_limb), "--seconds", "0.01", *FREE)
    ran = subprocess.run([sys.executable, "-c", code, *given], capture_output=True, text=True, check=False, timeout=60)
    assert ran.returncode == 0, ran.stderr


def test_fast_is_the_same_for_the_same_seed(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    def end(seed: int) -> Any:
        given = ("--seconds", 30, "--fast", "--press", "1,2", "--json", "--seed", seed, *FREE)
        outcome = brace("sim", "--model", paper_limb, *given)
        assert outcome.code == 0, outcome.err
        return json.loads(outcome.out.splitlines()[-1])

    first = end(3)
    assert first["time_us"] == 30_000_000 and first["limbs"][0]["sequence"] >= 30_000
    assert first == end(3)
    assert first != end(4)


def test_sigterm_ends_it_with_0_and_ctrl_c_with_130(paper_limb: Path) -> None:
    for number, code in ((signal.SIGTERM, 0), (signal.SIGINT, 130)):
        with running(paper_limb, *FREE) as (process, _):
            process.send_signal(number)
            out, err = process.communicate(timeout=60)
            assert process.returncode == code, err
            assert json.loads(out.splitlines()[-1])["event"] == "end"
            assert "Traceback" not in err


def test_ctrl_c_ends_it_where_an_exception_would_be_lost(
    brace: Callable[..., Outcome], paper_limb: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in a module that is just being imported, where Python may drop what a handler raises."""

    def interrupted(_arguments: object, _node: object) -> None:
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("brace.cli.sim_command._say_ready", interrupted)
    assert brace("sim", "--model", paper_limb, "--seconds", 1, *FREE).code == 130


def test_an_ignored_ctrl_c_stays_ignored() -> None:
    """A script's shell has its background jobs ignore it, so that Ctrl-C ends what is in the foreground alone."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with ended_by_signal(signal.SIGTERM, signal.SIGINT) as ended:
            signal.raise_signal(signal.SIGINT)
            assert not ended.is_set()
            signal.raise_signal(signal.SIGTERM)
            assert ended.by == signal.SIGTERM
    finally:
        signal.signal(signal.SIGINT, before)


def test_ctrl_c_in_the_middle_of_a_run_waits_for_the_limbs(paper_limb: Path) -> None:
    """Their thread ticks on until it has seen the order; nothing it uses may go before."""
    for _ in range(2):
        with spawn("sim", "--model", paper_limb, *FREE) as process:
            assert process.stdout is not None
            assert process.stdout.readline().startswith("limb 1: node")
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
            assert process.returncode == 130, (process.returncode, err)
            assert "monitor" in out


def test_a_port_in_use_is_4_with_a_way_out(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    with socket.create_server((LOOPBACK, 0)) as taken:
        port = taken.getsockname()[1]
        for option, url in (("--can", f"tcp://127.0.0.1:{port}"), ("--modbus", f"modbus-tcp://127.0.0.1:{port}")):
            outcome = brace("sim", "--model", paper_limb, "--seconds", 1, *FREE, option, url)
            assert outcome.code == 4
            assert url in outcome.err and "in use" in outcome.err and "try:" in outcome.err


def test_default_ports_that_are_in_use_give_way_to_free_ones_and_it_says_so(
    brace: Callable[..., Outcome], paper_limb: Path
) -> None:
    with running(paper_limb):  # on the default ports, unless somebody else has them
        outcome = brace("sim", "--model", paper_limb, "--seconds", 0.1)
        assert outcome.code == 0 and "tcp://127.0.0.1:29536 is taken" in outcome.err, outcome.err
    with running(paper_limb) as (_, first), running(paper_limb) as (_, second):
        assert first["limbs"][0]["can"] != second["limbs"][0]["can"]
        assert first["limbs"][0]["modbus_tcp"] != second["limbs"][0]["modbus_tcp"]
        assert "127.0.0.1" in second["limbs"][0]["can"]


def test_what_is_not_there_is_4(brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path) -> None:
    for options, word in (
        (("--can", "nocan7"), "nocan7"),
        (("--can", "slcan:/dev/ttyNONE9"), "/dev/ttyNONE9"),
        (("--modbus", "modbus:/dev/ttyNONE9@9600/3"), "/dev/ttyNONE9"),
        (("--nvm", tmp_path / "no" / "folder"), "folder"),
    ):
        outcome = brace("sim", "--model", paper_limb, "--seconds", 1, *FREE, *options)
        assert outcome.code == 4, outcome.err
        assert word in outcome.err and "try:" in outcome.err


@pytest.mark.parametrize(
    "options",
    [
        ("--fast",),
        ("--fault", "encoder_stuk:femur@2"),
        ("--fault", "encoder_stuck@2"),
        ("--fault", "bus_off:femur"),
        ("--fault", "current_offset:tibia@1"),
        ("--fault", "joint_soft:tibia@1"),
        ("--fault", "joint_soft:tibia=0@1", "--seconds", "0.1"),
        ("--fault", "encoder_stuck:femur@-1"),
        ("--fault", "bus_off:3", "--seconds", "0.1"),
        ("--posture", "1.0"),
        ("--posture", "1.0,1.4@x"),
        ("--contact", "glued"),
        ("--contact", "wall:-3"),
        ("--press", "1"),
        ("--modbus", "tcp://127.0.0.1:0"),
        ("--modbus", "modbus-tcp://127.0.0.1:0/300"),
        ("--can", "tcp://127.0.0.1:notaport"),
        ("--serial", "keyboard=stderr"),
        ("--limbs", "0"),
        ("--node", "127", "--limbs", "2"),
    ],
)
def test_what_cannot_be_is_2_with_a_way_out(
    brace: Callable[..., Outcome], paper_limb: Path, options: tuple[str, ...]
) -> None:
    outcome = brace("sim", "--model", paper_limb, *FREE, *options)
    assert outcome.code == 2 and "try:" in outcome.err, outcome.err
    assert not outcome.out or "ready" not in outcome.out


def test_faults_from_the_command_line_show(brace: Callable[..., Outcome], paper_limb: Path) -> None:
    given = ("--seconds", 2, "--fast", "--json", "--limbs", 2, "--fault", "sensor_dead:2.femur@1+5", *FREE)
    limbs = json.loads(brace("sim", "--model", paper_limb, *given).out.splitlines()[-1])["limbs"]
    assert limbs[0]["faults"] == [] and limbs[0]["k_is_valid"]
    assert limbs[1]["faults"] == ["sensor_femur"] and limbs[1]["k_xx_n_per_mm"] is None


def test_fault_specs() -> None:
    stuck = sim_values.fault("encoder_stuck:femur@2.0+1.5")
    assert (stuck.limb, stuck.joint, stuck.at_s, stuck.for_s) == (None, 1, 2.0, 1.5)
    offset = sim_values.fault("current_offset:3.tibia=-500@1e-1")
    assert (offset.limb, offset.joint, offset.value, offset.at_s) == (2, 2, -500.0, 0.1)
    assert sim_values.fault("bus_off:2@1").limb == 1
    assert sim_values.fault("tick_late").value == 5.0


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("current_offset:femur=0.5Nm@2", 500.0),
        ("current_offset:femur=500N mm", 500.0),
        ("force_offset=1.5N@2+1", 1.5),
        ("force_offset=-1kgf", -9.80665),
        ("tick_late=3@1", 3.0),  # ms
        ("tick_late=3ms", 3.0),
        ("tick_late=0.002s", 2.0),
    ],
)
def test_a_faults_value_may_have_a_unit(text: str, value: float) -> None:
    assert sim_values.fault(text).value == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("text", ["force_offset=2mm", "current_offset:femur=3N", "tick_late=3N", "tick_late=-3ms"])
def test_a_faults_value_in_a_wrong_unit_is_refused(text: str) -> None:
    with pytest.raises(RefusedValue) as caught:
        sim_values.fault(text)
    assert "wanted" in caught.value.why and f"OPTION {text.partition('=')[0]}=" in caught.value.way


def test_the_plant_may_differ_from_the_model(
    brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    true = tmp_path / "true.toml"
    true.write_text(paper_limb.read_text().replace("bending_mm_per_n = 0.25", "bending_mm_per_n = 2.5"))
    forces = []
    for plant in (paper_limb, true):
        given = ("--plant", plant, "--press", "5,0", "--seconds", 1, "--fast", "--json", *FREE)
        limb = json.loads(brace("sim", "--model", paper_limb, *given).out.splitlines()[-1])["limbs"][0]
        forces.append(limb["truth"]["force_x_n"])
        assert limb["k_is_valid"]
    assert forces[1] < 0.9 * forces[0]


# ------------------------------------------------------------------------------------------- on the wire


def test_slcan_answers_as_an_adapter_does(paper_limb: Path) -> None:
    with running(paper_limb, *FREE) as (_, ready):
        client = Slcan(ready["limbs"][0]["can"])
        assert client.ask(b"") == b"\r"
        assert client.ask(b"V") == b"V1013\r"
        assert client.ask(b"N").startswith(b"N")
        assert client.ask(b"t7010") == b"\a"  # not open
        assert client.ask(b"S9") == b"\a"
        assert client.ask(b"S8") == b"\r"
        assert client.ask(b"O") == b"\r"
        assert client.ask(b"O") == b"\a"
        assert client.ask(b"Vx") == b"\a"  # a refusal and nothing else
        assert client.ask(b"S6") == b"\a"  # open
        assert client.ask(b"nonsense") == b"\a"
        assert client.ask(b"x" * 1000) == b"\a"
        assert client.ask(b"t8001") == b"\a"  # eleven bits end at 7FF
        assert client.ask(b"t10011") == b"\a"  # half a byte
        lines = (client.line() for _ in range(5000))  # K comes hundreds of times a second, the heartbeat once
        beat = next(line for line in lines if line.startswith(b"t701"))
        assert len(beat) == 1 + 3 + 1 + 16 + 1
        assert client.ask(b"t7FF2ABCD") == b"z\r"


def test_all_clients_share_one_bus_and_a_lazy_one_stalls_nobody(paper_limb: Path) -> None:
    with running(paper_limb, *FREE) as (process, ready):
        place = ready["limbs"][0]["can"]
        sender, reader, lazy = (Slcan(place) for _ in range(3))
        for client in (sender, reader, lazy):
            assert client.ask(b"O") == b"\r"
        received: list[int] = []
        for start in range(0, 10_000, 100):  # 270 kB: far more than what waits for the lazy client
            sender.send(b"".join(b"t7F04%08X\r" % number for number in range(start, start + 100)))
            answers = 0
            while answers < 100:
                answers += sender.line() == b"z\r"
            while len(received) < start + 100:
                line = reader.line()
                assert line, f"{len(received)} frames came"
                if line.startswith(b"t7F04"):
                    received.append(int(line[5:13], 16))
        assert received == list(range(10_000))
        assert process.poll() is None
        lazy.socket.close()
        assert Slcan(place).ask(b"V") == b"V1013\r"


def test_another_bit_rate_hears_nothing_and_is_told_so(paper_limb: Path) -> None:
    with running(paper_limb, *FREE) as (_, ready):
        client = Slcan(ready["limbs"][0]["can"])
        assert client.ask(b"S4") == b"\r"
        assert client.ask(b"O") == b"\r"
        assert client.line(1.5) == b""
        assert client.ask(b"F") == b"F80\r"


def test_python_can_sees_the_heartbeats_over_tcp_and_pty(paper_limb: Path) -> None:
    can = pytest.importorskip("can")
    for url in ("tcp://127.0.0.1:0", "slcan:pty"):
        with running(paper_limb, "--limbs", 4, *FREE, "--can", url) as (_, ready):
            place = ready["limbs"][0]["can"]
            channel = place.replace("tcp://", "socket://").removeprefix("slcan:")
            with can.Bus(interface="slcan", channel=channel, sleep_after_open=0.1) as bus:
                seen: dict[int, bytes] = {}
                until = time.monotonic() + 30.0
                while len(seen) < 4 and time.monotonic() < until:
                    frame = bus.recv(0.5)
                    if frame is not None and 0x700 < frame.arbitration_id < 0x780:
                        seen[frame.arbitration_id] = bytes(frame.data)
            assert sorted(seen) == [0x701, 0x702, 0x703, 0x704]
            assert all(data[0] == 5 and data[1] == 1 for data in seen.values())  # operational, monitor


def test_modbus_tcp_takes_connections_and_drops_what_is_no_modbus(paper_limb: Path) -> None:
    with running(paper_limb, *FREE) as (process, ready):
        place = ready["limbs"][0]["modbus_tcp"]
        with connected(place) as client:
            client.sendall(struct.pack(">HHHBB", 1, 7, 2, 1, 3))  # protocol 7
            client.settimeout(30.0)
            assert client.recv(100) == b""
        many = [connected(place) for _ in range(12)]
        assert process.poll() is None
        for client in many:
            client.close()


def test_a_memory_file_serves_one_simulation_at_a_time(
    brace: Callable[..., Outcome], paper_limb: Path, tmp_path: Path
) -> None:
    memory = tmp_path / "memory"
    with running(paper_limb, *FREE, "--nvm", memory):
        outcome = brace("sim", "--model", paper_limb, "--seconds", 1, *FREE, "--nvm", memory)
        assert outcome.code == 4 and "in use" in outcome.err
    assert memory.stat().st_size == 2 * 16384


def test_a_terminal_gets_a_live_line(paper_limb: Path) -> None:
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "brace", "sim", "--model", str(paper_limb), "--seconds", "1.2", *FREE],
        stdout=subprocess.PIPE,
        stderr=theirs,
        text=True,
    )
    process.communicate(timeout=60)
    os.close(theirs)
    shown = b""
    with contextlib.suppress(OSError):
        while part := os.read(ours, 4096):
            shown += part
    os.close(ours)
    assert process.returncode == 0
    assert b"monitor, K 3.9" in shown


def test_the_first_posture_lies_within_the_travel(paper_limb: Path, tmp_path: Path) -> None:
    """A limb that cannot reach the usual posture begins in the middle of its travel, so its K holds at once."""
    limb = tmp_path / "limb.toml"
    limb.write_text(paper_limb.read_text() + "\n[motor.femur]\nangle_min_rad = -1.5\nangle_max_rad = 0.5\n")
    model = load_limb(limb)
    posture = sim_command._usual_posture(model)
    assert (posture.theta1_rad, posture.theta2_rad) == (-0.5, 1.4)
    assert sim_command._usual_posture(load_limb(paper_limb)).theta1_rad == 1.0
