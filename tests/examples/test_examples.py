"""The examples as somebody would use them: built from installed packages, run against a simulated limb. tests/release
has bare_loop and your_cmake, on five machines."""

from __future__ import annotations

import json
import math
import runpy
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

PROJECT = Path(__file__).resolve().parents[2]
EXAMPLES = PROJECT / "examples"
LIMB = PROJECT / "tools" / "brace" / "data" / "paper-limb.toml"
INTERFACE = PROJECT / "firmware" / "interface"
REFERENCE_K = (3.96389818, -0.63872477, 0.42806022)  # docs/physics.md [N/mm], at brace sim's posture
PRINTED_N_PER_MM = 3e-4  # half a step of the frames, 0.0005, and half a printed digit


def run(*command: object, cwd: Path | None = None) -> str:
    done = subprocess.run([str(part) for part in command], cwd=cwd, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, f"{command}\n{done.stdout}{done.stderr}"
    return done.stdout


def k_of(line: str) -> tuple[float, ...]:
    """k_xx 1.2 k_xz -0.3 k_zz 0.4 N/mm"""
    words = line.split()
    return tuple(float(words[words.index(name) + 1]) for name in ("k_xx", "k_xz", "k_zz"))


@dataclass
class Ports:
    """Of a `brace sim`."""

    can: str
    modbus: str


@pytest.fixture(scope="module")
def sim(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ports]:
    """The paper's limb at (1.0, 1.4) rad, nothing pressing on it, its force sensor free of noise."""
    quiet = tmp_path_factory.mktemp("sim") / "quiet.toml"
    quiet.write_text(LIMB.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    ports = ("--can", "tcp://127.0.0.1:0", "--modbus", "modbus-tcp://127.0.0.1:0", "--seconds", "600", "--json")
    command = [sys.executable, "-m", "brace", "sim", "--model", LIMB, "--plant", quiet, *ports]
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    ready: dict[str, Any] = json.loads(process.stdout.readline())
    yield Ports(*(str(ready["limbs"][0][name]) for name in ("can", "modbus_tcp")))
    process.terminate()
    process.wait(timeout=30)


def test_python_can(sim: Ports) -> None:
    channel = sim.can.replace("tcp://", "socket://")
    said = run(sys.executable, EXAMPLES / "python_can" / "read_k.py", INTERFACE / "brace.dbc", "slcan", channel)
    assert k_of(said) == pytest.approx(REFERENCE_K, abs=PRINTED_N_PER_MM)


def test_pymodbus(sim: Ports) -> None:
    host, _, port = sim.modbus.removeprefix("modbus-tcp://").partition("/")[0].partition(":")
    said = run(sys.executable, EXAMPLES / "pymodbus" / "read_k.py", INTERFACE / "modbus.csv", host, port)
    assert k_of(said) == pytest.approx(REFERENCE_K, abs=PRINTED_N_PER_MM)


def installed(preset: str, prefix: Path, *parts: str) -> Path:
    """What ./dev setup has built, installed."""
    built = PROJECT / "build" / preset
    if not (built / "build.ninja").is_file():
        pytest.skip(f"no build/{preset}; ./dev setup makes it")
    for part in parts:
        run("cmake", "--install", built, "--prefix", prefix, "--component", part)
    return prefix


def test_c_client(sim: Ports, tmp_path: Path) -> None:
    prefix = installed("host", tmp_path / "prefix", "client")
    run("cmake", "-G", "Ninja", "-S", EXAMPLES / "c_client", "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", tmp_path / "build")
    lines = run(tmp_path / "build" / "print_k", sim.can, "1").splitlines()
    assert len(lines) == 10
    assert k_of(lines[-1]) == pytest.approx(REFERENCE_K, abs=PRINTED_N_PER_MM)


def test_stance_cpp(tmp_path: Path) -> None:
    """K is alike in all directions and the feet are at the body's height, so all forces are vertical, and the lever
    rule holds: 30 N in the middle, 10 N half-way to the rear feet, so 17.5 N on the front pair and 20 N on each side.
    The rear left foot cannot leave: the load is then outside the triangle of the others."""
    library = PROJECT / "build" / "host" / "tools" / "stance" / "libbrace_stance.a"
    if not library.is_file():
        pytest.skip("no build/host/tools/stance; ./dev setup makes it")
    prefix = tmp_path / "prefix"  # laid out as `cmake --install` of tools/stance lays it out
    (prefix / "lib").mkdir(parents=True)
    shutil.copy(library, prefix / "lib")
    shutil.copytree(PROJECT / "tools" / "stance" / "include", prefix / "include")
    source, build = EXAMPLES / "stance_cpp", tmp_path / "build"
    strict = "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Wconversion -Werror"
    run("cmake", "-G", "Ninja", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", strict)
    run("cmake", "--build", build)
    lines = run(build / "who_carries").splitlines()
    forces = [[float(word) for word in line.split("force ")[1].split()[:3]] for line in lines if "force " in line]
    margins = [float(line.split("margin ")[1].split()[0]) for line in lines if "margin " in line]
    expected_n = (7.5,) * 4 + (8.75, 8.75, 11.25, 11.25) + (0.0, 17.5, 20.0, 2.5)
    printed_n = 0.0005 + 1e-6  # half the last digit
    assert len(forces) == len(expected_n)
    for force, vertical in zip(forces, expected_n, strict=True):
        assert force == pytest.approx((0.0, 0.0, vertical), abs=printed_n)
    friction = (0.6, 0.5, 0.6, 0.6) * 3
    assert margins == pytest.approx([mu * n for mu, n in zip(friction, expected_n, strict=True)], abs=printed_n)
    assert lines[8] == "first to move: front right, at a pull of 17.500 N"  # 4 feet x 0.5 x 8.75 N
    assert lines[-1].startswith("rear left: the limbs cannot bear this")


def test_own_board(tmp_path: Path) -> None:
    if shutil.which("qemu-system-arm") is None:
        pytest.skip("no qemu-system-arm")
    prefix = installed("m4f", tmp_path / "prefix", "core", "app")
    toolchain = PROJECT / "firmware" / "boards" / "toolchain" / "cortex-m4f.cmake"
    cache = (f"-DCMAKE_TOOLCHAIN_FILE={toolchain}", f"-Dbrace_DIR={prefix / 'lib/cmake/brace'}")
    run("cmake", "-G", "Ninja", "-S", EXAMPLES / "own_board", "-B", tmp_path / "build", *cache)
    run("cmake", "--build", tmp_path / "build")
    semihosting = ("-semihosting-config", "enable=on,target=native")
    clock = ("-icount", "shift=3,sleep=off")  # the board's clock goes by instructions, whatever the host's load
    board = ("qemu-system-arm", "-machine", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "null")
    lines = run(*board, *clock, *semihosting, "-kernel", tmp_path / "build" / "controller").splitlines()
    assert len(lines) == 6 and all(line.startswith("valid 1 flags 0x01") for line in lines[::2])
    assert k_of(lines[-1]) == pytest.approx(REFERENCE_K, abs=2e-5)


@pytest.mark.parametrize("flags", [(), ("-fsanitize=thread",)], ids=["plain", "thread sanitizer"])
def test_rtos(flags: tuple[str, ...], tmp_path: Path) -> None:
    """K of the limb, and after the change K of one with a knee half as stiff; no data race."""
    run(sys.executable, PROJECT / "tools" / "release" / "two_files.py", "--out", tmp_path)
    limb = EXAMPLES / "bare_loop"
    strict = ("-std=c11", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-pthread")
    files = (EXAMPLES / "rtos" / "main.c", limb / "limb.c", tmp_path / "brace_core.c")
    run("gcc", *strict, *flags, f"-I{tmp_path}", f"-I{limb}", *files, "-lm", "-o", tmp_path / "rtos")
    lines = run(tmp_path / "rtos").splitlines()
    assert k_of(lines[0]) == pytest.approx(REFERENCE_K, abs=2e-5)
    assert lines[1] == lines[2] and k_of(lines[1])[0] < k_of(lines[0])[0]
    assert lines[3].startswith("1200 ticks, ")


def test_ros2_node(monkeypatch: pytest.MonkeyPatch) -> None:
    """Against a stand-in for rclpy. No test here says that it runs under ROS."""
    heard: list[tuple[str, Any]] = []
    warned: list[str] = []

    class Node:
        def __init__(self, name: str) -> None:
            self.name = name

        def create_subscription(self, _kind: object, topic: str, callback: object, _depth: int) -> None:
            heard.append((topic, callback))

        def get_logger(self) -> SimpleNamespace:
            return SimpleNamespace(warning=warned.append)

    stand_ins: dict[str, dict[str, object]] = {
        "rclpy": {}, "rclpy.node": {"Node": Node}, "brace_msgs": {}, "brace_msgs.msg": {"LimbStiffness": object},
    }  # fmt: skip
    for name, members in stand_ins.items():
        module = ModuleType(name)
        module.__dict__.update(members)
        monkeypatch.setitem(sys.modules, name, module)
    runpy.run_path(str(EXAMPLES / "ros2" / "limb_guard.py"))["LimbGuard"]()
    (topic, hear), fields = heard[0], (PROJECT / "tools/client/ros2/brace_msgs/msg/LimbStiffness.msg").read_text()
    assert topic == "limb_1/stiffness"
    values = {"node": 1, "k_is_valid": True, "k_xx": 3964.0, "k_xz": -639.0, "k_zz": 428.0}
    assert all(f" {name} " in fields for name in values)  # the message has what the node reads
    hear(SimpleNamespace(**values))
    assert warned == []
    for valid, k_zz in ((True, 200.0), (True, 200.0), (False, math.nan), (True, 428.0), (False, 428.0)):
        hear(SimpleNamespace(**{**values, "k_is_valid": valid, "k_zz": k_zz}))
    assert len(warned) == 2 and "limb 1: 94 N/m" in warned[0] and "not valid" in warned[1]
