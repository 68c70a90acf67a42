"""`brace query` and `brace monitor` against `brace sim`: right values, and every failure told in time."""

from __future__ import annotations

import io
import json
import os
import pty
import re
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from bus_bench import adapter, limb_on_tcp, obliging, timed, told_in_time
from command_bench import FREE, LIMB, PROJECT, Outcome, physics_k, running

from brace.bus.modbus_controller import ModbusController
from brace.bus.url import parse
from brace.ground.errors import NoDeviceError, UsageError, VersionMismatchError
from brace.model import load_limb
from brace.native.loaded import under_force
from brace.wire.frames import ANSWERS, DICTIONARY_HASH, MESSAGES

STEP_N_PER_MM = 0.0005
MATRIX = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")


FORCE_NOISE_N = 0.5  # five sigma of the simulated sensor, on each axis: the limb counts it as a load


def force_noise(tmp_path: Path, theta1: float, theta2: float) -> float:
    """How far a force of the sensor's noise turns K, by the reference [N/mm]."""
    model = tmp_path / "without-load.toml"
    model.write_text(LIMB)
    angle = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    force = FORCE_NOISE_N * np.sqrt(2.0) * np.stack([np.cos(angle), np.sin(angle)], 1)
    turned = under_force(load_limb(model), theta1, theta2, force).k_n_per_mm - physics_k(theta1, theta2)
    return float(np.abs(turned).max())


def assert_k(
    entry: dict[str, float], theta1: float, theta2: float, angle_step_rad: float = 0.0, load_n_per_mm: float = 0.0
) -> None:
    """Within the wire's half step, single precision (1e-5 of K), what the angle's own step makes, the load's part."""
    k = physics_k(theta1, theta2)
    turned = physics_k(theta1 + angle_step_rad, theta2 + angle_step_rad)
    bound = STEP_N_PER_MM / 2 + 1e-5 * np.abs(k).max() + np.abs(turned - k).max() + load_n_per_mm
    got = np.array([entry[name] for name in MATRIX])
    assert np.abs(got - np.array([k[0, 0], k[0, 1], k[1, 1]])).max() < bound


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB)
    return path


def test_values_are_those_of_physics(brace: Callable[..., Outcome], limb: Path, tmp_path: Path) -> None:
    with limb_on_tcp(limb, "--posture", "0.9,1.5") as url:
        live = json.loads(brace("query", "--bus", url, "--json").out)
        assert live["k_is_valid"] and live["mode"] == "monitor" and live["faults"] == []
        assert abs(live["theta1_rad"] - 0.9) < 2e-3 and abs(live["theta2_rad"] - 1.5) < 2e-3
        assert_k(live, live["theta1_rad"], live["theta2_rad"], 2e-3, force_noise(tmp_path, 0.9, 1.5))
        assert live["dictionary_hash"] == f"{DICTIONARY_HASH:08x}"
        assert 0.0 < live["sigma_k_xx_n_per_mm"] < live["k_xx_n_per_mm"] and 0.0 < live["sigma_stiff_axis_rad"] < 0.91
        for theta1, theta2 in ((0.2, 0.8), (1.3, 2.1), (-0.4, -1.0)):
            asked = brace("query", "--bus", url, "--theta1", theta1, "--theta2", theta2, "--json")
            assert asked.code == 0, asked.err
            assert_k(json.loads(asked.out), theta1, theta2)
        x = 185 * np.cos(0.7) + 313.5 * np.cos(0.7 - 1.2)
        z = 185 * np.sin(0.7) + 313.5 * np.sin(0.7 - 1.2)
        at_tip = json.loads(brace("query", "--bus", url, "--x", x, "--z", z, "--json").out)
        assert_k(at_tip, 0.7, 1.2, 1e-5)  # a position's step of 0.001 mm, at 185 mm
        down = json.loads(brace("query", "--bus", url, "--x", x, "--z", z, "--knee", "down", "--json").out)
        assert abs(down["k_xz_n_per_mm"] - at_tip["k_xz_n_per_mm"]) > 0.1
        entries = brace(
            "query",
            "--bus",
            url,
            "--entry",
            "probe_f32",
            "--entry",
            "geometry.tibia_mm",
            "--entry",
            "mode",
            "--json",
        )
        values = {name: entry["value"] for name, entry in json.loads(entries.out)["entries"].items()}
        assert values == {"probe_f32": 12345.5, "geometry.tibia_mm": 313.5, "mode": "monitor"}
        shown = brace("query", "--bus", url).out
        assert "K = [" in shown and re.search(r"^k_xx \S+ \+- \S+, k_xz .* N/mm \(one sigma\)$", shown, re.MULTILINE)


def test_sag_and_force_are_k_s(brace: Callable[..., Outcome], limb: Path, tmp_path: Path) -> None:
    """With the K of now: what a load moves, that displacement meets again."""
    noise_n_per_mm = force_noise(tmp_path, 1.0, 1.4)
    with limb_on_tcp(limb) as url:
        live = json.loads(brace("query", "--bus", url, "--json").out)
        k = np.array([[live[MATRIX[0]], live[MATRIX[1]]], [live[MATRIX[1]], live[MATRIX[2]]]])
        sag = json.loads(brace("query", "--bus", url, "--load", 1.0, -2.0, "--json").out)
        expected = np.linalg.solve(k, [1.0, -2.0])
        # two snapshots: the sensor's noise on the load that K counts turns K; its smaller eigenvalue makes 12 times it
        assert (
            np.abs(np.array([sag["dx_mm"], sag["dz_mm"]]) - expected).max()
            < 1e-4 + 3e-2 * np.abs(expected).max()
        )
        force = json.loads(brace("query", "--bus", url, "--sag", sag["dx_mm"], sag["dz_mm"], "--json").out)
        # each entry of K may be off by the noise, and each adds to the force what the displacement makes of it
        bound_n = noise_n_per_mm * np.abs(expected).sum()
        assert abs(force["fx_n"] - 1.0) < bound_n and abs(force["fz_n"] + 2.0) < bound_n
        values = np.linalg.eigvalsh(k) * np.hypot(*expected)
        assert abs(force["low_n"] - values[0]) < 0.06 and abs(force["high_n"] - values[1]) < 0.6
        outcome = brace("query", "--bus", url, "--load", 1, 2, "--theta1", 1, "--theta2", 1)
        assert outcome.code == 2 and "one question" in outcome.err


def test_an_unreachable_tip_is_the_question_s_fault(brace: Callable[..., Outcome], limb: Path) -> None:
    with limb_on_tcp(limb) as url:
        outcome = brace("query", "--bus", url, "--x", 600, "--z", 0)
        assert outcome.code == 2 and "reach" in outcome.err, outcome.err
        assert brace("query", "--bus", url, "--theta1", 1).code == 2
        outcome = brace("query", "--bus", url, "--entry", "lambda_mni")
        assert outcome.code == 2 and "lambda_min" in outcome.err
        outcome = brace("query", "--bus", url, "--entry", "femur_mm")
        assert outcome.code == 2 and "did you mean geometry.femur_mm?" in outcome.err


def test_several_nodes_need_a_number(brace: Callable[..., Outcome], limb: Path) -> None:
    with limb_on_tcp(limb, "--limbs", 3) as url:
        outcome = brace("query", "--bus", url)
        assert outcome.code == 2 and "nodes 1, 2, 3" in outcome.err
        assert json.loads(brace("query", "--bus", url, "--node", 2, "--json").out)["node"] == 2
        lines = brace("monitor", "--bus", url, "--seconds", 1.3).out.splitlines()
        assert [line.split(":")[0] for line in lines[-3:]] == ["node 1", "node 2", "node 3"]


def test_a_k_that_is_not_valid_is_5(brace: Callable[..., Outcome], limb: Path) -> None:
    with limb_on_tcp(limb, "--fault", "sensor_dead:femur@0.3") as url:
        brace("monitor", "--bus", url, "--seconds", 0.8)
        outcome = brace("query", "--bus", url, "--json")
        entry = json.loads(outcome.out)
        assert outcome.code == 5 and entry["k_xx_n_per_mm"] is None and not entry["k_is_valid"]
        assert "sensor_femur" in outcome.err and "try:" in outcome.err
        outcome = brace("monitor", "--bus", url, "--seconds", 1.2)
        assert outcome.code == 5 and "K not valid" in outcome.out and "fault sensor_femur" in outcome.out


def test_a_pty_is_a_bus_too(brace: Callable[..., Outcome], limb: Path) -> None:
    with limb_on_tcp(limb, "--can", "slcan:pty") as url:
        assert url.startswith("slcan:/dev/")
        outcome = brace("query", "--bus", url, "--json")
        assert outcome.code == 0, outcome.err
        assert_k(json.loads(outcome.out), 1.0, 1.4, 2e-3)


# ---------------------------------------------------------------------------------- failures, each in its words


def test_nobody_there(limb: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    said = told_in_time(4, "query", "--bus", f"tcp://127.0.0.1:{port}")
    assert "nobody listens there" in said and "brace sim" in said
    assert "there is no /dev/ttyNONE" in told_in_time(4, "query", "--bus", "slcan:/dev/ttyNONE")
    assert "there is no /dev/ttyNONE" in told_in_time(4, "query", "--bus", "modbus:/dev/ttyNONE@115200/1")
    assert "nobody listens" in told_in_time(4, "monitor", "--bus", f"modbus-tcp://127.0.0.1:{port}/1")
    said = told_in_time(4, "query", "--bus", "modbus-tcp://127.0.0.253")  # the port that was not named is told
    assert "nobody listens there, on port 502" in said


def test_no_can_in_the_kernel_or_no_such_interface() -> None:
    said = told_in_time(4, "query", "--bus", "can7")
    try:
        socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
        assert "no such CAN interface" in said
    except OSError:
        assert "this kernel has no CAN" in said and "tcp://" in said


def test_what_is_no_adapter(limb: Path) -> None:
    with adapter(lambda _line: b"") as url:
        assert "does not answer as an SLCAN adapter" in told_in_time(4, "query", "--bus", url)
    with adapter(lambda _line: b"", sends=b"HTTP/1.1 400 Bad Request and so on\n") as url:
        assert "does not answer as an SLCAN adapter" in told_in_time(4, "query", "--bus", url)
    with adapter(lambda line: b"\a" if line == b"O" else obliging(line)) as url:
        assert "refuses 'O'" in told_in_time(4, "query", "--bus", url)
    ours, theirs = pty.openpty()
    try:
        assert "does not answer" in told_in_time(4, "query", "--bus", f"slcan:{os.ttyname(theirs)}")
    finally:
        os.close(ours)
        os.close(theirs)


def test_the_other_protocol_s_port(limb: Path) -> None:
    with running(limb, *FREE) as (_, ready):
        can, modbus = (ready["limbs"][0][name] for name in ("can", "modbus_tcp"))
        said = told_in_time(4, "query", "--bus", modbus.replace("modbus-tcp://", "tcp://"))
        assert "a Modbus port is modbus-tcp://" in said
        said = told_in_time(4, "query", "--bus", can.replace("tcp://", "modbus-tcp://"))
        assert "an SLCAN port is tcp://" in said


def test_modbus_on_a_serial_line_has_the_controller_s_parity(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """8E1 (docs/modbus.md). Pseudo-terminals, which the other tests run on, have no parity: there it would not show."""
    asked: list[tuple[str, dict[str, object]]] = []

    class Nobody:
        def __init__(self, place: str, **how: object) -> None:
            asked.append((place, how))

        def connect(self) -> bool:
            return False

    monkeypatch.setattr("pymodbus.client.ModbusSerialClient", Nobody)
    monkeypatch.setattr("brace.bus.lines.SerialLine", lambda _url: io.BytesIO())
    _, theirs = pty.openpty()
    (tmp_path / "link").symlink_to(os.ttyname(theirs))
    for place, parity in (("/dev/ttyUSB7", "E"), (os.ttyname(theirs), "N"), (str(tmp_path / "link"), "N")):
        with pytest.raises(NoDeviceError):
            ModbusController(parse(f"modbus:{place}@19200/1"))
        assert asked[-1][0] == place and asked[-1][1]["parity"] == parity and asked[-1][1]["baudrate"] == 19200
        assert {"bytesize", "stopbits"}.isdisjoint(asked[-1][1])  # 8 and 1 unless told


def test_over_modbus_another_master_s_answer_is_not_taken(limb: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """There is one place for all masters' questions: another one asks between our question and its answer."""
    with running(limb, *FREE) as (_, ready):
        ours, theirs = (ModbusController(parse(ready["limbs"][0]["modbus_tcp"])) for _ in range(2))
        read, between = ours._read, [(1.3, 2.1), (0.2, 0.8)]

        def late(table: str, address: int, count: int) -> tuple[int, ...]:
            if table == "input" and between:
                theirs.k_at_posture(*between.pop())
            return read(table, address, count)

        monkeypatch.setattr(ours, "_read", late)
        answer = ours.k_at_posture(0.9, 1.5)
        assert not between
        # a float's rounding in K and in the angles
        k = np.array([answer.k_xx, answer.k_xz, answer.k_zz], dtype=float)
        assert np.allclose(k, physics_k(0.9, 1.5).ravel()[[0, 1, 3]], rtol=1e-5)
        ours.close()
        theirs.close()


def test_over_modbus_a_controller_without_a_dictionary_is_told_with_zeros(monkeypatch: pytest.MonkeyPatch) -> None:
    blank = ModbusController.__new__(ModbusController)
    blank.url = "modbus-tcp://somewhere"
    monkeypatch.setattr(blank, "_read", lambda _table, _address, count: (0,) * count)
    with pytest.raises(VersionMismatchError, match=f"dictionary is 00000000, ours {DICTIONARY_HASH:08x}"):
        blank.identify()


@pytest.mark.parametrize("question", ["--load", "--sag"])
def test_an_open_gap_is_what_is_told(brace: Callable[..., Outcome], limb: Path, question: str) -> None:
    """No number of the question's was wrong."""
    limb.write_text(LIMB.replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.006"))
    with limb_on_tcp(limb) as url:
        outcome = brace("query", "--bus", url, question, 0, -2)
        assert outcome.code == 5 and "play is open" in outcome.err, outcome.err


def test_a_silent_bus(limb: Path) -> None:
    with adapter(obliging) as url:
        for command in ("query", "monitor", "params pull", "params rollback"):
            said = told_in_time(4, *command.split(), "--bus", url)
            assert "nothing is on the bus at 1000000 bit/s" in said
        assert "node 3 does not answer" in told_in_time(4, "query", "--bus", url, "--node", 3)
        assert "node 3 is not heard" in told_in_time(4, "monitor", "--bus", url, "--node", 3)


def test_another_bit_rate_and_another_node(limb: Path) -> None:
    with limb_on_tcp(limb) as url:
        for command in ("query", "monitor"):
            said = told_in_time(4, command, "--bus", url, "--bit-rate", 250000)
            assert "another bit rate than 250000" in said and "--bit-rate 1000000, 500000 or 125000;" in said
        said = told_in_time(4, "query", "--bus", url, "--node", 9)
        assert "node 9 does not answer" in said and "nodes on this bus: 1" in said and "--node 1" in said
        assert "SLCAN knows" in told_in_time(2, "query", "--bus", url, "--bit-rate", 123456)


def test_a_bus_that_goes_away(limb: Path) -> None:
    beat = MESSAGES["heartbeat"].encode(
        {"state": 5, "mode": 1, "setting": 1, "protocol": 2, "dictionary_hash": DICTIONARY_HASH}
    )
    with adapter(obliging, sends=b"t7058" + beat.hex().encode() + b"\r") as url:
        said = told_in_time(4, "query", "--bus", url)  # it beats, and answers nothing
        assert "it sends, and does not answer 'identify'" in said


def test_another_dictionary_is_6_with_both(limb: Path) -> None:
    other = DICTIONARY_HASH ^ 0xFFFF
    parts = (
        {"major": 9, "minor": 8, "patch": 7, "protocol": 2, "node": 5},
        {"dictionary_hash": other},
        {"schema_hash": 0},
        {"parameter_crc": 0, "origin": 0},
        {"faults": 0, "mode": 1, "setting": 1},
    )

    def answer(line: bytes) -> bytes:
        if not line.startswith(b"t605"):
            return obliging(line)
        token = int(line[7:9], 16)
        frames = [layout.encode(values, token) for layout, values in zip(ANSWERS["identify"], parts)]
        return b"z\r" + b"".join(b"t5858" + frame.hex().encode() + b"\r" for frame in frames)

    beat = MESSAGES["heartbeat"].encode(
        {"state": 5, "mode": 1, "setting": 1, "protocol": 2, "dictionary_hash": other}
    )
    with adapter(answer, sends=b"t7058" + beat.hex().encode() + b"\r") as url:
        for command in (("query",), ("monitor",), ("params", "pull"), ("params", "push", limb)):
            said = told_in_time(6, *command, "--bus", url)
            assert f"{other:08x}" in said and f"{DICTIONARY_HASH:08x}" in said
        assert "9.8.7" in told_in_time(6, "query", "--bus", url)


def test_a_controller_of_protocol_1_is_6() -> None:
    """Its answer to identify, code 20, as protocol 1 had it: the first byte is the code and 32 times the part."""
    parts = ("140100010001050000", "34010dd0fe0a0000", "5401000000000000", "7401000000000000")

    def answer(line: bytes) -> bytes:
        if not line.startswith(b"t605"):
            return obliging(line)
        token = line[7:9]
        return b"z\r" + b"".join(b"t5858" + part[:2].encode() + token + part[4:16].encode() + b"\r" for part in parts)

    with adapter(answer, sends=b"t7058" + b"05010040" + b"0dd0fe0a" + b"\r") as url:
        assert "0afed00d" in told_in_time(6, "query", "--bus", url)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("can0", ("can", "can0", 0, 115200, 1)),
        ("slcan:/dev/ttyACM0", ("slcan", "/dev/ttyACM0", 0, 115200, 1)),
        ("slcan:/dev/pts/3@1000000", ("slcan", "/dev/pts/3", 0, 1000000, 1)),
        ("tcp://robot:29536", ("tcp", "robot", 29536, 115200, 1)),
        ("tcp://[::1]:29536", ("tcp", "::1", 29536, 115200, 1)),
        ("modbus:/dev/ttyUSB0@19200/7", ("modbus", "/dev/ttyUSB0", 0, 19200, 7)),
        ("modbus:/dev/ttyUSB0", ("modbus", "/dev/ttyUSB0", 0, 115200, 1)),
        ("modbus:/dev/pts/3", ("modbus", "/dev/pts/3", 0, 115200, 1)),
        ("modbus:/dev/pts/3@9600/2", ("modbus", "/dev/pts/3", 0, 9600, 2)),
        ("modbus-tcp://127.0.0.1:1502/4", ("modbus-tcp", "127.0.0.1", 1502, 115200, 4)),
        ("modbus-tcp://robot", ("modbus-tcp", "robot", 502, 115200, 1)),
        ("log:some/a.log", ("log", "some/a.log", 0, 115200, 1)),
    ],
)
def test_urls(text: str, expected: tuple[object, ...]) -> None:
    url = parse(text)
    assert (url.kind, url.place, url.port, url.baud, url.unit) == expected


@pytest.mark.parametrize(
    "text",
    [
        "",
        "/dev/ttyACM0",
        "tcp://host",
        "tcp://host:0",
        "tcp://:1",
        "modbus-tcp://h:1/300",
        "http://x",
        "log:",
        "a b",
    ],
)
def test_what_is_no_url(text: str) -> None:
    with pytest.raises(UsageError) as refused:
        parse(text)
    assert refused.value.next_step


def test_a_terminal_gets_a_picture(limb: Path) -> None:
    with limb_on_tcp(limb) as url:
        ours, theirs = pty.openpty()
        process = subprocess.Popen(
            [sys.executable, "-m", "brace", "monitor", "--bus", url, "--seconds", "4"],
            stdout=theirs,
            stderr=subprocess.PIPE,
            env={**os.environ, "TERM": "xterm", "COLUMNS": "100", "LINES": "40"},
        )
        os.close(theirs)
        shown = b""
        try:
            while part := os.read(ours, 4096):
                shown += part
        except OSError:
            pass
        os.close(ours)
        assert process.wait(60) == 0
        text = shown.decode(errors="replace")
        assert "node 1" in text and "N/mm" in text and "stiff axis" in text
        rates = [int(rate) for rate in re.findall(r"(\d+) Hz", text)]
        assert rates and 50 < rates[-1] < 250  # 200, of a machine that keeps up
        assert sum(0x2800 < ord(character) < 0x2900 for character in text) > 50  # the ellipse


def test_the_python_example_prints_k(limb: Path) -> None:
    example = PROJECT / "examples" / "python_can" / "ask_k.py"
    assert len(example.read_text().splitlines()) <= 40
    with limb_on_tcp(limb) as url:
        channel = url.replace("tcp:", "socket:")
        done = subprocess.run(
            [sys.executable, example, "slcan", channel],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    k = physics_k(0.5, 1.2)
    numbers = [float(text) for text in re.findall(r"-?\d+\.\d+", done.stdout)]
    assert done.returncode == 0 and done.stdout.endswith("N/mm\n"), done.stderr
    assert np.abs(np.array(numbers) - k.ravel()).max() < STEP_N_PER_MM


def test_the_readme_s_lines_work_as_printed(limb: Path, paper_limb: Path) -> None:
    """Their ports are free only where no simulation runs already."""
    lines = [line.strip() for line in (PROJECT / "README.md").read_text().splitlines()]
    printed = [
        line
        for line in lines
        if line.startswith((".venv/bin/brace query --bus", ".venv/bin/brace monitor --bus"))
    ]
    assert len(printed) == 2
    with limb_on_tcp(paper_limb) as url:
        for line in printed:
            given = line.replace("tcp://127.0.0.1:29536", url).split()[1:]
            outcome, _ = timed(*given)
            assert outcome.code == 0 and "N/mm" in outcome.out, outcome.err
