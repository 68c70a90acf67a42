"""What the tests of the `brace` command share: its processes, a limb, records of it, and K by the formula of physics."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from brace.ground import one_thread  # noqa: F401  before numpy is loaded
import numpy as np
import pytest

PROJECT = Path(__file__).resolve().parents[2]
DATA = PROJECT / "tools" / "brace" / "data"
FREE = ("--can", "tcp://127.0.0.1:0", "--modbus", "modbus-tcp://127.0.0.1:0")


def in_guest(script: str, timeout_s: float) -> dict[str, Any]:
    """What a script of tests/ prints last, run in a guest kernel that has vcan0; skips where there can be no guest."""
    pytest.importorskip("can")
    command = ["tests/socketcan/with_vcan", sys.executable, script]
    ran = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True, timeout=timeout_s)
    if ran.returncode == 4:
        pytest.skip(ran.stderr.strip())
    assert ran.returncode == 0, ran.stdout + ran.stderr
    told: dict[str, Any] = json.loads(ran.stdout.splitlines()[-1])
    return told


class Outcome:
    """Exit code and both streams of one command."""

    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err


def spawn(*arguments: object, **options: Any) -> subprocess.Popen[str]:
    """Starts the command as its users do, in a process of its own."""
    environment = {key: value for key, value in os.environ.items() if key != "BRACE_DEBUG"}
    return subprocess.Popen(
        [sys.executable, "-m", "brace", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        **options,
    )


@contextlib.contextmanager
def running(limb: Path, *options: object) -> Iterator[tuple[subprocess.Popen[str], dict[str, Any]]]:
    """A simulation with its 'ready' line read; ended by force if the test has not ended it."""
    process = spawn("sim", "--model", limb, "--json", *options)
    try:
        assert process.stdout is not None
        ready, _, _ = select.select([process.stdout], [], [], 60.0)
        line = process.stdout.readline() if ready else ""
        assert line, process.stderr.read() if process.poll() is not None and process.stderr else "silent"
        yield process, json.loads(line)
    finally:
        process.kill()
        process.wait()


def processor_s(*arguments: object) -> tuple[float, str]:
    """Processor time of a command that succeeds, start of Python included [s]; what it prints."""
    before = os.times()
    process = spawn(*arguments)
    out, err = process.communicate(timeout=300)
    after = os.times()
    assert process.returncode == 0, err
    return after.children_user + after.children_system - before.children_user - before.children_system, out


def assert_a_million_takes_two_seconds(spent_s: float, model: Path, folder: Path) -> None:
    """Processor time, so that other programs do not decide. They do make it dearer, and a machine may be slow: beyond
    two seconds a map of few postures, made now, says what a start costs; a million may cost as much again."""
    if spent_s >= 2.0:
        start_s, _ = processor_s("map", "--model", model, "--postures", 1000, "--out", folder)
        assert spent_s < 2.0 * start_s, f"{spent_s:.2f} s; {start_s:.2f} s for a thousand"


LIMB = """format = 1
name = "test"
[geometry]
coxa_mm = 57.0
femur_mm = 185.0
tibia_mm = 313.5
[link.femur]
axial_mm_per_n = 0.001
bending_mm_per_n = 0.06
[link.tibia]
axial_mm_per_n = 0.002
bending_mm_per_n = 0.25
[joint.femur]
compliance_rad_per_n_mm = 1.0e-5
[joint.tibia]
compliance_rad_per_n_mm = 1.6e-5
[uncertainty]
length_mm = 0.5
angle_rad = 0.003
compliance_rel = 0.05
gain_rel = 0.005
"""
# What LIMB lacks to be a limb in space.
ACROSS = """
[sensor]
noise_n = 0.0  # else K counts the load that it feigns, as it counts the drive's
[motor.coxa]
torque_noise_n_mm = 0.0
[link.coxa]
lateral_mm_per_n = 0.004
torsion_rad_per_n_mm = 1e-6
[joint.coxa]
compliance_rad_per_n_mm = 0.8e-5
"""


def physics_k(
    theta1: float,
    theta2: float,
    *,
    axial: tuple[float, float] = (0.001, 0.002),
    bending: tuple[float, float] = (0.06, 0.25),
    joint: tuple[float, float] = (1e-5, 1.6e-5),
    moment_transfer: float = 0.0,
    lengths: tuple[float, float] = (185.0, 313.5),
) -> np.ndarray:
    """K (2x2) from physics.md's a11, a12, a22 in double precision: shares no code with what it judges."""
    length1, length2 = lengths
    u1 = np.array([np.cos(theta1), np.sin(theta1)])
    u2 = np.array([np.cos(theta1 - theta2), np.sin(theta1 - theta2)])
    knee, tip = length1 * u1, length1 * u1 + length2 * u2
    p1 = np.array([-tip[1], tip[0]])
    p2 = np.array([-(tip - knee)[1], (tip - knee)[0]])
    b1, b2 = bending[0] / length1**2, bending[1] / length2**2
    a11, a22, a12 = joint[0] + b1, joint[1] + b1 + b2, b1 * (1.5 * moment_transfer - 1)
    c = (
        a11 * np.outer(p1, p1)
        + a12 * (np.outer(p1, p2) + np.outer(p2, p1))
        + a22 * np.outer(p2, p2)
        + axial[0] * np.outer(u1, u1)
        + axial[1] * np.outer(u2, u2)
    )
    return np.linalg.inv(c)


LOADING_HEADER = "run,config,theta1_rad,theta2_rad,axis,rep,step,t_s,temp_degc,dx_mm,dz_mm,fx_n,fz_n"
LOADING_META = """format = 1
kind = "loading"
title = "made by the tests"
zeroed = "never"
displacements = "small"
[sensor]
resolution_n = 0.0625
range_n = 145.0
[rig]
step_mm = 0.635
dwell_s = 4.0
"""
POSES = ((0.74, 1.0), (0.2, 1.6), (1.1, 2.2), (0.5, 0.6), (-0.3, 1.9))


def loading_rows(noise_n: float = 0.1, seed: int = 0, **limb: Any) -> list[list[str]]:
    """Rows of a linear limb's loading record, f = K d + noise; fields as text."""
    random = np.random.default_rng(seed)
    rows, run, clock = [], 0, 0.0
    for config, (theta1, theta2) in enumerate(POSES, start=1):
        k = physics_k(theta1, theta2, **limb)
        for axis in "xz":
            for rep in (1, 2):
                run += 1
                for step, place in enumerate((0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0)):
                    d = np.array([1.0, 0.0] if axis == "x" else [0.0, 1.0]) * place * 0.635
                    f = k @ d + noise_n * random.standard_normal(2)
                    rows.append(
                        [
                            str(run),
                            str(config),
                            f"{theta1:.6f}",
                            f"{theta2:.6f}",
                            axis,
                            str(rep),
                            str(step),
                            f"{clock:.3f}",
                            "22.0",
                            f"{d[0]:.6f}",
                            f"{d[1]:.6f}",
                            f"{f[0]:.6f}",
                            f"{f[1]:.6f}",
                        ]
                    )
                    clock += 4.0
                clock += 20.0
    return rows


def write_loading(
    folder: Path, rows: list[list[str]], header: str = LOADING_HEADER, meta: str = LOADING_META
) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "meta.toml").write_text(meta)
    (folder / "data.csv").write_text("\n".join([header, *(",".join(row) for row in rows)]) + "\n")
    return folder
