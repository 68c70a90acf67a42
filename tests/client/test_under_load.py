"""The C client's calls for K under a load, against a limb with weights and a foot that is pressed; the double-precision
reference judges."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import LIMB, PROBE, Answer, Sim, motors_of, simulated

from brace.model import LimbModel, load_limb
from brace.native.loaded import under_force

STEP = 0.0005  # of K on CAN [N/mm]
STEP_MM, STEP_N = 0.001, 0.001
# The estimator's own, as docs/loaded.md promises it: K within 0.14 %, the buckling factor within 0.1 % below 10.
K_RATIO, FACTOR_RATIO = 0.0014, 0.001
LOAD_HZ = 20
POSTURE = (1.0, 1.4)
BENT = (0.5, 2.0)
K_NAMES = ("k_xx", "k_xz", "k_zz")
LOAD, ALL_OF_IT = 16, 1 + 16
USAGE, TIMEOUT, REFUSED = 1, 5, 11
SOFTENED = 0x80
Probe = Callable[..., Answer]
MORE = f"""
[gravity]
femur_n = 2.0
tibia_n = 1.5
knee_n = 3.0
[controller]
load_hz = {LOAD_HZ}
[sensor]
noise_n = 0.0
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("loaded") / "heavy.toml"
    path.write_text(LIMB.read_text() + MORE)
    return path


@pytest.fixture(scope="module")
def heavy(model: Path) -> Iterator[Sim]:
    with simulated(model.parent, model, "--press", "3,-6") as running:
        yield running


@pytest.fixture(params=["can", "modbus"])
def url(request: pytest.FixtureRequest, heavy: Sim) -> str:
    return str(getattr(heavy, request.param))


def leaning(limb: LimbModel, lean_rad: float) -> LimbModel:
    """The limb as its weights pull in its plane where down leans out of it."""
    ratio = math.cos(lean_rad)
    weights = [f"gravity.{name}" for name in ("femur_n", "tibia_n", "knee_n")]
    return limb.with_values({name: ratio * limb.number(name) for name in weights})


def check(answer: Answer, limb: LimbModel, posture: tuple[float, float], force_n: tuple[float, float],
          down_rad: float = -math.pi / 2) -> None:
    """K, the tip's displacement and the buckling factor against the reference."""
    assert answer.code == 0, answer.err
    reported = answer.values
    rest = under_force(limb, *posture, [force_n], down_rad)
    k, moved, factor = rest.k_n_per_mm[0], rest.displacement_mm[0], float(rest["buckling_factor"][0])
    size = float(np.linalg.norm(k))
    for name, wanted in zip(K_NAMES, (k[0, 0], k[0, 1], k[1, 1]), strict=True):
        assert reported[name] == pytest.approx(wanted, abs=0.5 * STEP + K_RATIO * size), name
    # the tip moves as K's error lets it: by K_RATIO of what it moves
    room_mm = 0.5 * STEP_MM + K_RATIO * float(np.linalg.norm(moved))
    assert (reported["moved_x"], reported["moved_z"]) == pytest.approx(tuple(moved), abs=room_mm)
    if factor < 10.0:
        assert reported["buckling_factor"] == pytest.approx(factor, rel=FACTOR_RATIO)
    assert bool(int(reported["flags"]) & SOFTENED) == (factor < 3.0)


@pytest.mark.parametrize("force_n", [(0.0, 0.0), (0.0, 10.0), (-20.0, 0.0), (12.0, -8.0)])
@pytest.mark.parametrize("posture", [POSTURE, BENT])
def test_k_at_a_posture_under_a_force(
    probe: Probe, url: str, model: Path, posture: tuple[float, float], force_n: tuple[float, float]
) -> None:
    check(probe(url, "under_load", *posture, *force_n), load_limb(model), posture, force_n)


@pytest.mark.parametrize(("knee_up", "sign"), [(1, 1.0), (0, -1.0)])
def test_k_at_a_place_of_the_tip_under_a_force(probe: Probe, url: str, model: Path, knee_up: int, sign: float) -> None:
    first, second = 185.0, 313.5
    theta1, theta2 = 0.7, sign * 1.3
    place = (first * math.cos(theta1) + second * math.cos(theta1 - theta2),
             first * math.sin(theta1) + second * math.sin(theta1 - theta2))  # fmt: skip
    force_n = (4.0, 9.0)
    check(probe(url, "under_load_at_tip", *place, knee_up, *force_n), load_limb(model), (theta1, theta2), force_n)
    unloaded = probe(url, "tip", *place, knee_up)  # over Modbus too
    check_k_alone(unloaded, load_limb(model), (theta1, theta2))


def check_k_alone(answer: Answer, limb: LimbModel, posture: tuple[float, float]) -> None:
    """K without a force, under the weight."""
    assert answer.code == 0, answer.err
    k = under_force(limb, *posture, [(0.0, 0.0)]).k_n_per_mm[0]
    room = 0.5 * STEP + K_RATIO * float(np.linalg.norm(k))
    for name, wanted in zip(K_NAMES, (k[0, 0], k[0, 1], k[1, 1]), strict=True):
        assert answer.values[name] == pytest.approx(wanted, abs=room), name


def test_what_the_load_does_to_k_is_reported(probe: Probe, url: str, model: Path) -> None:
    """The reference, at the angles where the limb stands and under the force that is counted, moves as far and has the
    same K without load."""
    answer = probe(url, "load")
    assert answer.code == 0, answer.err
    load = answer.values
    assert load["is_counted"] == 1 and load["gravity_direction"] == pytest.approx(-math.pi / 2, abs=1e-4)
    assert load["gravity_lean"] == 0.0
    force_n = (load["force_x"], load["force_z"])
    assert math.hypot(*force_n) > 2.0
    now = probe(url, "read", 7, 1).snapshots[0]
    limb = load_limb(model)
    motors = motors_of(limb, (now["theta1"], now["theta2"]), force_n)
    rest = under_force(limb, *motors, [force_n])
    moved = rest.displacement_mm[0]
    # the limb stands still; its angles are known to half of the wire's step of 2e-5 rad, lengths of 500 mm turn by it
    room_mm = 500.0 * 2e-5 + K_RATIO * float(np.linalg.norm(moved))
    assert (load["moved_x"], load["moved_z"]) == pytest.approx(tuple(moved), abs=room_mm)
    without = under_force(leaning(limb, math.pi / 2), *motors, [(0.0, 0.0)]).k_n_per_mm[0]
    # K's slope is below 20 N/mm/rad here
    reported = (load["unloaded_k_xx"], load["unloaded_k_xz"], load["unloaded_k_zz"])
    assert reported == pytest.approx((without[0, 0], without[0, 1], without[1, 1]), abs=20 * 2e-5 + 3e-5)
    factor = float(rest["buckling_factor"][0])
    assert load["buckling_factor"] == (pytest.approx(factor, rel=2 * FACTOR_RATIO) if factor < 10.0 else math.inf)


def test_the_load_comes_with_its_k(probe: Probe, url: str) -> None:
    """A snapshot has its load, and it is what the controller says when it is asked."""
    answer = probe(url, "read", ALL_OF_IT, 3)
    assert answer.code == 0, answer.err
    for reported in answer.snapshots:
        assert int(reported["parts"]) & ALL_OF_IT == ALL_OF_IT and reported["is_counted"] == 1 and reported["valid"] == 1
        assert math.hypot(reported["force_x"], reported["force_z"]) > 2.0
    asked = probe(url, "load").values
    last = answer.snapshots[-1]
    for name in ("force_x", "force_z", "moved_x", "moved_z", "unloaded_k_xx", "gravity_direction"):
        # the limb stands still and its sensor is free of noise; its motors' control leaves a thousandth
        assert last[name] == pytest.approx(asked[name], rel=2e-3, abs=STEP_N), name


def test_a_controller_that_sends_no_load(probe: Probe, sim: Sim) -> None:
    """controller.load_hz is 0: no frame has it, and the call says which parameter it is; asked, it reports the load."""
    answer = probe(sim.can, "read", ALL_OF_IT, 1, timeout_ms=600)
    assert answer.code == TIMEOUT and "controller.load_hz" in answer.err
    assert probe(sim.can, "load").values["is_counted"] == 1
    assert probe(sim.modbus, "read", ALL_OF_IT, 1).snapshots[0]["is_counted"] == 1


def test_a_force_that_folds_the_limb_or_is_no_force(probe: Probe, url: str) -> None:
    folds = probe(url, "under_load", 0.3, 0.6, -2000.0, 0.0)
    assert folds.code == REFUSED and "folds the limb" in folds.err and "refusal -6" in folds.err
    assert probe(url, "under_load", 0.3, 0.6, math.nan, 0.0).code == USAGE
    assert probe(url, "under_load", 0.3, 0.6, 9000.0, 0.0).code == USAGE
    assert probe(url, "under_load", 9.0, 0.6, 1.0, 0.0).code == USAGE
    assert probe(url, "under_load", 0.3, 0.6, 8000.0, 8000.0).code == REFUSED  # together beyond 10000 N


def test_down_is_where_it_is_said_to_be(probe: Probe, url: str, model: Path) -> None:
    limb, force_n = load_limb(model), (0.0, 5.0)
    try:
        assert probe(url, "gravity", 0.4, 0.9).code == 0
        check(probe(url, "under_load", *POSTURE, *force_n), leaning(limb, 0.9), POSTURE, force_n, 0.4)
        load = probe(url, "load").values
        assert (load["gravity_direction"], load["gravity_lean"]) == pytest.approx((0.4, 0.9), abs=1e-6)
        assert probe(url, "gravity", 3.5, 0.0).code == REFUSED  # beyond its range
        assert probe(url, "gravity", 0.1, math.nan).code == USAGE  # one alone
        load = probe(url, "load").values
        assert load["gravity_direction"] == pytest.approx(0.4, abs=1e-6)
    finally:
        assert probe(url, "gravity", math.nan, math.nan).code == 0
    assert probe(url, "load").values["gravity_direction"] == pytest.approx(-math.pi / 2, abs=1e-6)
    check(probe(url, "under_load", *POSTURE, *force_n), limb, POSTURE, force_n)


def test_clients_that_ask_under_other_forces_at_once(url: str, model: Path) -> None:
    """A controller counts the force that was sent last. Whom another client comes between asks again."""
    forces = [(0.0, 10.0), (12.0, -8.0), (-6.0, 2.0)]
    processes = [
        subprocess.Popen(
            [PROBE, url, "1", "30000", "under_load", *map(str, (*POSTURE, *force)), "60"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for force in forces
    ]  # fmt: skip
    for force, process in zip(forces, processes, strict=True):
        out, said = process.communicate(timeout=120)
        check(Answer(process.returncode, out, said, 0), load_limb(model), POSTURE, force)
