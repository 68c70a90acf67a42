"""K on the wires while the force sensor has its noise: judged by the reference at the true load.

The controller counts each reading as the load, so K follows the sensor's noise. To first order K is off by dK/dF times
the noise; the reference tells dK/dF."""

from __future__ import annotations

import json
import signal
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import FREE, LIMB, running

from brace.bus.lines import TcpLine
from brace.bus.modbus_controller import ModbusController
from brace.bus.slcan import SlcanBus
from brace.bus.snapshot import Joiner
from brace.bus.url import parse
from brace.model import LimbModel, load_limb
from brace.native.loaded import under_force
from brace.stiffness.at_rest import planar_limb

NOISE_N = 0.1  # sensor.noise_n's default, which the simulation takes
SAMPLES = 200
SIGMAS = 5.0  # 600 entries, each beyond it once in 1.7 million
SPREAD = 0.2  # of the root mean square of 200 samples: four of its own sigmas, 1 / sqrt(2 * 200)
ENCODER_STEP_RAD = 2e-5
STEP_N_PER_MM = 0.0005  # of K on CAN
K_RATIO = 0.0014  # docs/loaded.md: the estimator's worst error of K
HEAVY = LIMB + """
[gravity]
femur_n = 2.0
tibia_n = 1.5
knee_n = 3.0
"""


def entries(k: np.ndarray) -> np.ndarray:
    """xx, xz, zz."""
    return np.stack([k[..., 0, 0], k[..., 0, 1], k[..., 1, 1]], -1)


def true_k(limb: LimbModel, stands: np.ndarray, force_n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """K of the limb that stands at joint angles under a force, and the motors' angles, which the reference wants."""
    motors = stands.copy()
    for _ in range(5):  # each leaves a tenth of what it misses
        rest = under_force(limb, motors[0], motors[1], force_n)
        motors = stands - [rest["femur_rad"][0], -rest["tibia_rad"][0]]
    return entries(under_force(limb, motors[0], motors[1], force_n).k_n_per_mm[0]), motors


def over_can(place: str) -> list[list[float]]:
    url, joiner = parse(place), Joiner()
    bus = SlcanBus(url, TcpLine(url), 1_000_000)
    found: list[list[float]] = []
    until = time.monotonic() + 60.0
    while len(found) < SAMPLES and time.monotonic() < until:
        frame = bus.receive(0.1)
        snapshot = joiner.add(frame) if frame is not None else None
        if snapshot is not None and snapshot.adds == "stiffness":
            assert snapshot.is_valid and snapshot.flags == ()
            found.append([float(value or 0) for value in (snapshot.k_xx, snapshot.k_xz, snapshot.k_zz)])
    bus.close()
    return found


def over_modbus(place: str) -> list[list[float]]:
    device = ModbusController(parse(place))
    try:
        snapshots = [device.live() for _ in range(SAMPLES)]
    finally:
        device.close()
    assert all(s.is_valid and s.flags == () for s in snapshots)
    return [[float(value or 0) for value in (s.k_xx, s.k_xz, s.k_zz)] for s in snapshots]


WIRES = [("can", over_can, STEP_N_PER_MM), ("modbus_tcp", over_modbus, 0.0)]


@pytest.mark.parametrize(("wire", "listen", "step"), WIRES)
@pytest.mark.parametrize(("posture", "press"), [("0.3,0.6", "-2,-10"), ("1.0,1.4", "3,15")])
def test_k_under_the_sensor_s_noise(
    tmp_path: Path, wire: str, listen: Callable[[str], list[list[float]]], step: float, posture: str, press: str
) -> None:
    path = tmp_path / "limb.toml"
    path.write_text(HEAVY)
    limb = load_limb(path)
    assert limb.number("sensor.noise_n") == NOISE_N
    with running(path, *FREE, "--posture", posture, f"--press={press}") as (process, ready):
        time.sleep(0.5)  # the limb comes to rest
        told = np.array(listen(ready["limbs"][0][wire]))
        process.send_signal(signal.SIGTERM)
        out, _ = process.communicate(timeout=60)
    truth = json.loads(out.splitlines()[-1])["limbs"][0]["truth"]
    force_n = np.array([truth["force_x_n"], truth["force_z_n"]])
    stands = np.array([truth["theta1_rad"], truth["theta2_rad"]])
    assert np.linalg.norm(force_n) > 2.0 and len(told) == SAMPLES
    k, motors = true_k(limb, stands, force_n)

    reach = SIGMAS * NOISE_N
    forces = force_n + reach * np.array([[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]])
    around = entries(under_force(limb, motors[0], motors[1], forces).k_n_per_mm)
    slope = np.stack([around[0] - around[1], around[2] - around[3]]) / (2 * reach)  # per N along x and z
    sigma = NOISE_N * np.sqrt((slope**2).sum(0))
    # beyond the first order: what is left of K at the corners of five sigmas
    curved = np.abs(around - k - (forces - force_n) @ slope).max(0)
    turned = np.stack([
        entries(under_force(limb, motors[0] + d[0], motors[1] + d[1], force_n).k_n_per_mm[0]) - k
        for d in ENCODER_STEP_RAD * np.eye(2)
    ])  # fmt: skip
    size = float(np.sqrt(k[0] ** 2 + 2 * k[1] ** 2 + k[2] ** 2))
    floor = curved + np.abs(turned).sum(0) + K_RATIO * size + 0.5 * step

    off = told - k
    assert np.all(np.abs(off) <= SIGMAS * sigma + floor), np.abs(off).max(0) / (SIGMAS * sigma + floor)
    # no bias: the mean is known SAMPLES times better
    assert np.all(np.abs(off.mean(0)) <= SIGMAS * sigma / np.sqrt(SAMPLES) + floor), off.mean(0) / sigma
    # K follows the noise, no more and no less
    ratio = told.std(0) / np.hypot(sigma, 0.29 * step)
    assert np.all(np.abs(ratio - 1.0) <= SPREAD + curved / sigma), ratio

    # The tool works the uncertainty of K out from the parameters' trust alone. The load's noise is smaller than it.
    trusted = planar_limb(limb).sigma(*map(float, stands))
    told_sigma = np.array([trusted[f"sigma_{name}_n_per_mm"] for name in ("k_xx", "k_xz", "k_zz")])
    assert np.all(np.hypot(sigma, told_sigma) <= 1.02 * told_sigma), sigma / told_sigma
    assert np.all(np.abs(off) <= told_sigma)
    print("one sigma of the noise, of K's norm:", sigma / size, "of the told sigma:", sigma / told_sigma)
