"""The limb's own loading test, and the drift check that it feeds, with the foot pressed by 5, 10 and 20 N.

The simulated limb turns as the load turns it, and its links are beams. The reference's tangent K at the rest judges. A
slope may be off by four of its own sigma, and by what a step of the encoders makes of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from command_bench import DATA

from brace.model import LimbModel, load_limb
from brace.native.loaded import under_force
from brace.sim.node import MODES, LimbSetup, Node
from brace.sim.spec import Posture

STRONG = {"friction_n_mm": 0.0, "torque_range_n_mm": 20_000.0}  # 20 N at half a metre, and a test besides
STRONG_BELIEVED = {f"motor.{joint}.torque_range_n_mm": 20_000.0 for joint in ("coxa", "femur", "tibia")}
ENCODER_STEP_RAD = 2e-5
POSTURES_RAD = ((1.0, 1.4), (0.3, 0.6), (0.5, 2.0))
WATCHED_RAD = ((1.0, 1.4), (0.7, 1.8), (0.5, 2.0))
PRESSES_N = (5.0, 10.0, 20.0)
TOWARDS_RAD = (math.pi / 2, -math.pi / 2, 0.0, math.pi)
STEP_MM, STEPS = 0.4, 4
STRING_N_PER_MM = 0.02
X, Z = 0, 1
DONE = 2
TESTS = 280  # of 16 readings each; the check learns from 4,096 at most
WATCHING, ALARM_EVIDENCE = 1, 20.0


@pytest.fixture(scope="module")
def limb() -> LimbModel:
    return load_limb(DATA / "paper-limb.toml").with_values(
        {"link.femur.moment_transfer": 1.0, "link.tibia.moment_transfer": 1.0}
    )


def force_of(one: Node) -> np.ndarray:
    truth = one.raw_truth()
    return np.array([truth.force_x_n, truth.force_z_n])


def press(one: Node, limb: LimbModel, press_n: float, towards_rad: float) -> None:
    """A soft string pulls the tip until all rests; then the ground holds the tip where it is."""
    wanted_n = press_n * np.array([math.cos(towards_rad), math.sin(towards_rad)])
    pulled_n = wanted_n
    for _ in range(8):  # the tip goes with the string, which then pulls less
        if np.linalg.norm(force_of(one) - wanted_n) < 0.1 * press_n:
            break
        pull_mm = pulled_n / STRING_N_PER_MM
        one.press(pull_mm[0], pull_mm[1], hold_n_per_mm=STRING_N_PER_MM)
        one.step(1.0)
        pulled_n = pulled_n + wanted_n - force_of(one)
    truth = one.raw_truth()
    rest = under_force(limb, truth.motor_rad[1], truth.motor_rad[2], force_of(one))
    one.press(rest.displacement_mm[0, 0], rest.displacement_mm[0, 1])
    one.step(0.5)
    assert np.linalg.norm(force_of(one)) == pytest.approx(press_n, rel=0.3)


def loading_test(one: Node, axis: int, dwell_us: int = 200_000, step_mm: float = STEP_MM) -> Any:
    setup = one.native.ffi.new("brace_loading_setup_t *")
    setup.axis, setup.steps_per_side, setup.step_mm = axis, STEPS, step_mm
    setup.dwell_us, setup.rate_mm_per_s = dwell_us, 20.0
    setup.force_max_n, setup.torque_max_n_mm = 100.0, 20_000.0
    assert one.native.lib.brace_app_loading_start(one.app(), setup) == 0
    for _ in range(600):
        one.step(0.1)
        result = one.native.lib.brace_app_loading_result(one.app())
        if result.outcome != 1 and MODES[one.raw_snapshot().mode] == "monitor":
            return one.native.ffi.new("brace_loading_result_t *", result[0])
    raise AssertionError("the loading test does not end")


def by_an_encoder_step(k_n_per_mm: np.ndarray, theta_rad: list[float]) -> float:
    """What a step of both encoders between the test's ends does to a slope [N/mm]."""
    shin_rad = theta_rad[0] - theta_rad[1]
    tip_mm = math.hypot(*(185.0 * f(theta_rad[0]) + 313.5 * f(shin_rad) for f in (math.cos, math.sin)))
    moved_mm = ENCODER_STEP_RAD * (tip_mm + 313.5)
    return float(np.linalg.eigvalsh(k_n_per_mm)[-1]) * moved_mm / (2.0 * STEP_MM * STEPS)


@pytest.mark.parametrize("posture_rad", POSTURES_RAD)
@pytest.mark.parametrize("press_n", PRESSES_N)
def test_slopes_of_a_pressed_limb_are_its_K(
    limb: LimbModel, posture_rad: tuple[float, float], press_n: float
) -> None:
    for towards_rad in TOWARDS_RAD:
        with Node([LimbSetup(limb, limb, theta_rad=(0.0, *posture_rad), changes=STRONG_BELIEVED, drive=STRONG)]) as one:
            one.step(0.3)
            press(one, limb, press_n, towards_rad)
            for axis in (X, Z):
                truth, force_n = one.raw_truth(), force_of(one)
                motor_rad = [truth.motor_rad[1], truth.motor_rad[2]]
                result = loading_test(one, axis)
                assert result.outcome == DONE
                k = under_force(limb, motor_rad[0], motor_rad[1], force_n).k_n_per_mm[0]
                column = result.least_squares
                measured = np.array([column.k_x_n_per_mm, column.k_z_n_per_mm])
                sigma = np.array([column.sigma_k_x_n_per_mm, column.sigma_k_z_n_per_mm])
                allowed = 4.0 * sigma + by_an_encoder_step(k, motor_rad)
                case = (posture_rad, press_n, round(towards_rad, 2), "xz"[axis], measured, k[:, axis], allowed)
                assert np.all(np.abs(measured - k[:, axis]) <= allowed), case
                assert abs(result.z_x) < 4.0 and abs(result.z_z) < 4.0, case


def test_the_model_s_k_is_that_of_the_mean_force(limb: LimbModel) -> None:
    """The sensor's noise turns K of each tick. A test's first reading is the mean of a hundred ticks, so a tenth of that
    is left in the K that the test compares with; a quarter is allowed, since an encoder's step turns K, too."""
    setup = LimbSetup(limb, limb, theta_rad=(0.0, 1.0, 1.4), changes=STRONG_BELIEVED, drive=STRONG, force_noise_n=0.5)
    with Node([setup]) as one:
        one.step(0.3)
        one.press(-3.0, -8.0)
        one.step(0.5)
        of_ticks, of_tests = [], []
        for _ in range(12):
            for _ in range(500):  # of 6,000 ticks the mean is known to 0.03 %
                one.step(0.001)
                snapshot = one.raw_snapshot()  # k is a part of it, and lives as long
                k = snapshot.stiffness.engaged
                of_ticks.append([k.k_xx_n_per_mm, k.k_xz_n_per_mm])
            result = loading_test(one, X)
            assert result.outcome == DONE
            of_tests.append([result.model_k_x_n_per_mm, result.model_k_z_n_per_mm])
        assert np.all(np.std(of_tests, axis=0) < 0.25 * np.std(of_ticks, axis=0))
        assert np.mean(of_tests, axis=0) == pytest.approx(np.mean(of_ticks, axis=0), rel=2e-3)


def test_the_levers_are_those_of_the_mean_force(limb: LimbModel) -> None:
    """A sound limb's slopes scatter from test to test by what they tell as their own sigma. Levers worked out under one
    noisy sample of the force turn a whole test's displacements, and make the slope across three times as uncertain; a
    diagnosis of two such tests names a link that changed between them. Twelve tests whose slopes are right scatter by
    1.7 sigma once in a thousand times."""
    setup = LimbSetup(limb, limb, theta_rad=(0.0, 1.0, 1.4), changes=STRONG_BELIEVED, drive=STRONG, force_noise_n=0.5)
    with Node([setup]) as one:
        one.step(0.5)
        found = [loading_test(one, Z, step_mm=1.5).least_squares for _ in range(12)]
    told = float(np.mean([column.sigma_k_x_n_per_mm for column in found]))
    assert np.std([column.k_x_n_per_mm for column in found], ddof=1) < 1.7 * told


@pytest.mark.minutes
def test_a_pressed_foot_raises_no_alarm(limb: LimbModel) -> None:
    """The drift check learns from tests with 5 N, and goes on watching with other feet, presses and directions."""
    with Node([LimbSetup(limb, limb, changes=STRONG_BELIEVED, drive=STRONG)]) as one:
        one.step(0.3)
        app = one.app()
        for turn in range(TESTS):
            press_n = 5.0 if turn < 256 else PRESSES_N[turn % 3]
            one.press(0.0, 0.0, hold_n_per_mm=STRING_N_PER_MM)
            one.add_posture(Posture(*WATCHED_RAD[turn % 3], at_s=one.step(0.1)))
            one.step(2.0)
            press(one, limb, press_n, TOWARDS_RAD[turn % 4])
            assert loading_test(one, turn // 12 % 2, 20_000, step_mm=0.635).outcome == DONE
            assert one.raw_snapshot().faults == 0
        report = one.native.lib.brace_app_drift_report(app)
        assert report.state == WATCHING and report.evidence < ALARM_EVIDENCE / 2.0
