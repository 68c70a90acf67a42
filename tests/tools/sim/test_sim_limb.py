"""The controller over a simulated limb: what is true, what it believes, what goes wrong. Simulated time throughout."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import DATA, physics_k

from brace.cli.sim_values import fault
from brace.ground.errors import BadFileError
from brace.model import LimbModel, load_limb
from brace.native.loaded import under_force
from brace.sim.node import MODES, LimbSetup, Node
from brace.sim.spec import Posture

P_SERVO_N_MM_PER_RAD = 6e4  # brace_node_limb_default
ENCODER_STEP_RAD = 2e-5
FRICTION_N_MM = 200.0


@pytest.fixture(scope="module")
def paper() -> LimbModel:
    return load_limb(DATA / "paper-limb.toml")


def node(model: LimbModel, plant: LimbModel | None = None, seed: int = 0, **options: Any) -> Node:
    return Node([LimbSetup(model, plant or model, **options)], "none", seed)


def k_of(snapshot: Any) -> np.ndarray:
    k = snapshot.stiffness.now
    return np.array([[k.k_xx_n_per_mm, k.k_xz_n_per_mm], [k.k_xz_n_per_mm, k.k_zz_n_per_mm]])


def loaded_k(model: LimbModel, motor_rad: np.ndarray, snapshot: Any) -> np.ndarray:
    """K of the reference at these motor angles under the force that the snapshot has counted."""
    assert snapshot.load.is_counted
    force_n = (snapshot.load.force_x_n, snapshot.load.force_z_n)
    return np.asarray(under_force(model, motor_rad[0], motor_rad[1], force_n).k_n_per_mm[0])


def levers(theta1: float, theta2: float) -> np.ndarray:
    """Columns: the tip's shift for a turn of theta1 and of theta2, in their own senses [mm/rad]."""
    tibia = 313.5 * np.array([math.cos(theta1 - theta2), math.sin(theta1 - theta2)])
    tip = 185.0 * np.array([math.cos(theta1), math.sin(theta1)]) + tibia
    return np.array([[-tip[1], tibia[1]], [tip[0], -tibia[0]]])


def tip_mm(theta1: float, theta2: float) -> np.ndarray:
    """The tip of the unbent limb, from the femur axis."""
    shin = theta1 - theta2
    return np.array(
        [
            185.0 * math.cos(theta1) + 313.5 * math.cos(shin),
            185.0 * math.sin(theta1) + 313.5 * math.sin(shin),
        ]
    )


FRICTIONLESS = {"friction_n_mm": 0.0}


# ------------------------------------------------------------------------------------ the limb itself


def test_the_same_seed_gives_the_same_bits(paper: LimbModel) -> None:
    def snapshot(seed: int) -> bytes:
        with node(paper, seed=seed, press_mm=(0.5, 1.0)) as one:
            one.step(0.5)
            return bytes(one.native.ffi.buffer(one.raw_snapshot()))

    assert snapshot(1) == snapshot(1)
    assert snapshot(1) != snapshot(2)


def test_a_pressed_limb_yields_with_its_servos_in_series(paper: LimbModel) -> None:
    """Without friction f = (C + J J'/P)^-1 d to first order, by numbers that know nothing of the simulation. Second
    order: the droop turns the limb by some 1e-4 rad, and K changes by a few of its own sizes a radian."""
    press = np.array([0.1, -0.05])
    with node(paper, press_mm=tuple(press), force_noise_n=0.0, drive=FRICTIONLESS) as one:
        one.step(0.5)
        truth = one.raw_truth()
        read = one.raw_snapshot()
    j = levers(1.0, 1.4)
    compliance = np.linalg.inv(physics_k(1.0, 1.4)) + j @ j.T / P_SERVO_N_MM_PER_RAD
    force = np.linalg.solve(compliance, press)
    assert [truth.force_x_n, truth.force_z_n] == pytest.approx(force, rel=3e-3)
    # The torque that each motor brings holds what the contact pushes with: virtual work.
    assert [truth.torque_n_mm[1], truth.torque_n_mm[2]] == pytest.approx(-j.T @ force, rel=3e-3)
    # Droop of a P servo.
    droop = [truth.set_rad[i] - truth.motor_rad[i] for i in (1, 2)]
    assert droop == pytest.approx([truth.torque_n_mm[i] / P_SERVO_N_MM_PER_RAD for i in (1, 2)], rel=1e-6)
    # The links stand at their motors, less the joints' wind-up.
    wound = [(truth.motor_rad[i] - truth.link_rad[i]) / truth.load_n_mm[i] for i in (1, 2)]
    assert wound == pytest.approx([1.0e-5, 1.6e-5], rel=1e-6)
    assert [read.force_x_n, read.force_z_n] == pytest.approx(force, rel=3e-3)


def test_dry_friction_holds_a_motor_until_the_servo_overcomes_it(paper: LimbModel) -> None:
    with node(paper, hold_n_per_mm=0.0) as one:
        stuck_rad = 0.9 * FRICTION_N_MM / P_SERVO_N_MM_PER_RAD
        one.add_posture(Posture(1.0 + stuck_rad, 1.4, 0.0))
        one.step(1.0)
        assert one.raw_truth().motor_rad[1] == 1.0
        one.add_posture(Posture(1.05, 1.4, 1.0))
        one.step(1.0)
        off = 1.05 - one.raw_truth().motor_rad[1]
        assert 0.5 * FRICTION_N_MM / P_SERVO_N_MM_PER_RAD < off <= FRICTION_N_MM / P_SERVO_N_MM_PER_RAD * 1.0001


def test_a_gears_friction_grows_with_the_load(paper: LimbModel) -> None:
    """A pressed limb's motors stand where friction holds them, and carry less than the load: by more than the constant,
    by no more than the shares of torque and load add to it. The controller's interval holds the load."""
    shares = {"friction_per_torque_ratio": 0.4, "friction_per_load_ratio": 0.1}
    geared = paper.with_values({f"motor.{joint}.{key}": v for joint in ("femur", "tibia") for key, v in shares.items()})
    with node(geared, press_mm=(0.0, 30.0), has_force_sensor=False) as one:
        one.step(1.0)
        truth, seen = one.raw_truth(), one.raw_snapshot()
    grew = False
    for joint in (1, 2):
        torque_n_mm, load_n_mm = truth.torque_n_mm[joint], truth.load_n_mm[joint]
        held_n_mm = FRICTION_N_MM + abs(0.4 * torque_n_mm + 0.1 * load_n_mm)
        assert abs(torque_n_mm - load_n_mm) <= 1.01 * held_n_mm
        grew = grew or abs(torque_n_mm - load_n_mm) > 1.2 * FRICTION_N_MM
        interval = seen.load_interval_n_mm[joint]
        assert interval.low <= load_n_mm <= interval.high
    assert grew


def test_a_wall_yields_in_series(paper: LimbModel) -> None:
    with node(
        paper, press_mm=(0.0, 0.1), hold_n_per_mm=0.5, force_noise_n=0.0, drive=FRICTIONLESS
    ) as one:
        one.step(0.5)
        force_n = one.raw_truth().force_z_n
    j = levers(1.0, 1.4)
    compliance = np.linalg.inv(physics_k(1.0, 1.4)) + j @ j.T / P_SERVO_N_MM_PER_RAD + 2.0 * np.eye(2)
    assert force_n == pytest.approx(np.linalg.solve(compliance, [0.0, 0.1])[1], rel=3e-3)


@pytest.mark.parametrize(("hold_n_per_mm", "press_mm"), [(math.inf, (-3.0, 12.0)), (0.5, (-10.0, 45.0))])
def test_a_limb_pressed_far_rests_as_the_reference_does(
    paper: LimbModel, hold_n_per_mm: float, press_mm: tuple[float, float]
) -> None:
    """At the motors' angles and under the contact's force the reference's tip stands where the contact holds it, less
    what the contact yields. Where its anchor is: from the tip at the angles without droop."""
    heavy = paper.with_values({"gravity.femur_n": 3.0, "gravity.tibia_n": 4.0, "gravity.knee_n": 2.0})
    with node(heavy, press_mm=press_mm, hold_n_per_mm=hold_n_per_mm, drive=FRICTIONLESS) as one:
        one.step(0.5)
        truth = one.raw_truth()
    force = np.array([truth.force_x_n, truth.force_z_n])
    rest = under_force(heavy, truth.motor_rad[1], truth.motor_rad[2], force)
    assert np.linalg.norm(rest.displacement_mm[0]) > 4.0
    moved = tip_mm(truth.motor_rad[1], truth.motor_rad[2]) - tip_mm(1.0, 1.4) + rest.displacement_mm[0]
    np.testing.assert_allclose(moved, np.array(press_mm) - force / hold_n_per_mm, rtol=0.0, atol=1e-6)
    opens = [-1.0, 1.0]  # against the senses of theta1 and theta2
    moment = np.array([rest["femur_n_mm"][0], rest["tibia_n_mm"][0]])
    np.testing.assert_allclose([truth.load_n_mm[1], truth.load_n_mm[2]], moment * opens, rtol=1e-6)
    turned = np.array([truth.link_rad[i] - truth.motor_rad[i] for i in (1, 2)])
    np.testing.assert_allclose(-turned * opens, [rest["femur_rad"][0], rest["tibia_rad"][0]], rtol=1e-6)


def test_a_free_tip_carries_nothing_and_gravity_chooses_the_flank(paper: LimbModel) -> None:
    heavy = paper.with_values(
        {"gravity.tibia_n": 8.0, "joint.femur.gap_rad": 0.004, "joint.tibia.gap_rad": 0.004}
    )
    with node(heavy, hold_n_per_mm=0.0) as one:
        one.step(1.0)
        truth, snapshot = one.raw_truth(), one.raw_snapshot()
    assert math.hypot(truth.force_x_n, truth.force_z_n) < 1e-4
    # theta1 is held up; flexion lowers the tibia: theta2 is held back. Both joints stand at the end of their play.
    force = [truth.force_x_n, truth.force_z_n]
    hung = under_force(heavy, truth.motor_rad[1] - 0.002, truth.motor_rad[2] + 0.002, force)
    assert truth.load_n_mm[1] == pytest.approx(-hung["femur_n_mm"][0], rel=1e-6)
    assert truth.load_n_mm[2] == pytest.approx(hung["tibia_n_mm"][0], rel=1e-6)
    assert hung["tibia_n_mm"][0] == pytest.approx(-8.0 * 156.75 * math.cos(-0.4), rel=0.1)  # before it turns
    assert [truth.flank[1], truth.flank[2]] == [1, -1]
    told = [snapshot.play[i].flank for i in (1, 2)]
    assert told == [1, -1]
    assert [snapshot.play[i].offset_rad for i in (1, 2)] == pytest.approx([-0.002, 0.002], abs=1e-6)
    # The zero-force shift at the tip: offsets times levers.
    shift = levers(snapshot.theta_rad[1], snapshot.theta_rad[2]) @ [-0.002, 0.002]
    assert [snapshot.play_shift_mm.x_mm, snapshot.play_shift_mm.z_mm] == pytest.approx(shift, abs=2e-3)


# ------------------------------------------------------------------------------- what the controller says


@pytest.mark.parametrize("posture", [(1.0, 1.4), (0.3, 0.8), (1.2, 2.3), (0.7, -1.1)])
def test_k_is_that_of_the_posture_behind_the_encoders(paper: LimbModel, posture: tuple[float, float]) -> None:
    """K under the force that was counted, by the reference. Tolerance: half an encoder step in each joint times K's
    slope over it, and 1e-5: the float path's 3e-6, and two of Newton's steps under a load of at most some newtons."""
    with node(paper, theta_rad=(0.0, *posture), press_mm=(0.3, 0.2)) as one:
        one.step(0.3)
        snapshot, truth = one.raw_snapshot(), one.raw_truth()
    assert snapshot.k_is_valid and snapshot.stiffness.now.flags == 0
    motor = np.array([truth.motor_rad[1], truth.motor_rad[2]])
    k = loaded_k(paper, motor, snapshot)
    slope = [
        np.abs(physics_k(*(motor + d)) - physics_k(*(motor - d))) / 2e-4 for d in np.eye(2) * 1e-4
    ]
    tolerance = 0.51 * ENCODER_STEP_RAD * (slope[0] + slope[1]) + 1e-5 * np.linalg.norm(k)
    assert np.all(np.abs(k_of(snapshot) - k) <= tolerance)


@pytest.mark.parametrize("press_mm", [(0.0, 40.0), (-4.0, -40.0), (4.0, 0.0)])
def test_k_under_a_pressed_force_is_the_reference_s(paper: LimbModel, press_mm: tuple[float, float]) -> None:
    """Beams for links, weights that pull aside, a foot pressed by several newtons: K, displacement and buckling factor
    of the reference at the motors' angles under the force that was counted. Tolerance: what brace/loaded.h promises of
    K is 0.6 %; two of Newton's steps leave 1e-4 where the tip moves by 30 mm, an encoder's step some 1e-5."""
    heavy = paper.with_values({
        "link.femur.moment_transfer": 1.0, "link.tibia.moment_transfer": 1.0, "gravity.femur_n": 1.0,
        "gravity.tibia_n": 1.5, "gravity.knee_n": 0.5, "gravity.direction_rad": -1.1,
    })
    with node(heavy, press_mm=press_mm, force_noise_n=0.0, drive=FRICTIONLESS) as one:
        one.step(0.5)
        snapshot, truth = one.raw_snapshot(), one.raw_truth()
    load = snapshot.load
    assert load.is_counted and math.hypot(load.force_x_n, load.force_z_n) > 3.0
    assert [load.force_x_n, load.force_z_n] == pytest.approx([truth.force_x_n, truth.force_z_n], rel=1e-4, abs=1e-4)
    exact = under_force(heavy, truth.motor_rad[1], truth.motor_rad[2], (load.force_x_n, load.force_z_n), -1.1)
    k = exact.k_n_per_mm[0]
    assert np.abs(k_of(snapshot) - k).max() <= 1e-3 * np.linalg.norm(k)
    assert [load.moved_x_mm, load.moved_z_mm] == pytest.approx(exact.displacement_mm[0], abs=0.05)
    unloaded = load.unloaded
    without = physics_k(truth.motor_rad[1], truth.motor_rad[2], moment_transfer=1.0)
    assert [unloaded.k_xx_n_per_mm, unloaded.k_zz_n_per_mm] == pytest.approx([without[0, 0], without[1, 1]], rel=1e-3)
    assert np.linalg.norm(k - without) > 0.01 * np.linalg.norm(k)


def test_k_is_the_belief_and_not_the_truth(paper: LimbModel) -> None:
    soft = paper.with_values({"link.tibia.bending_mm_per_n": 0.5, "joint.femur.zero_offset_rad": 0.05})
    with node(paper, soft) as one:
        one.step(0.3)
        assert one.raw_truth().link_rad[1] == pytest.approx(1.05, abs=1e-3)
        snapshot, truth = one.raw_snapshot(), one.raw_truth()
        motor = np.array([truth.motor_rad[1], truth.motor_rad[2]])
        assert k_of(snapshot) == pytest.approx(loaded_k(paper, motor, snapshot), rel=1e-4)


def test_play_that_nothing_loads_leaves_the_joint_carrying_nothing(paper: LimbModel) -> None:
    play = paper.with_values({"joint.tibia.gap_rad": 0.01})
    with node(play) as one:
        one.step(0.5)
        snapshot, truth = one.raw_snapshot(), one.raw_truth()
    assert truth.flank[2] == 0
    assert snapshot.k_is_valid and one_flag(snapshot, "GAP_OPEN")
    engaged = snapshot.stiffness.engaged
    assert engaged.k_xx_n_per_mm == pytest.approx(physics_k(1.0, 1.4)[0, 0], rel=0.02)
    # What is left of K: a force through the free knee and nothing else.
    along = np.array([math.cos(-0.4), math.sin(-0.4)])
    expected = np.outer(along, along) / (along @ np.linalg.inv(physics_k(1.0, 1.4)) @ along)
    assert k_of(snapshot) == pytest.approx(expected, rel=0.03, abs=1e-3)


def one_flag(snapshot: Any, name: str) -> bool:
    from brace.stiffness.at_rest import flag_names

    return name in flag_names(snapshot.stiffness.now.flags)


def test_a_loaded_flank_is_told_and_turns_with_the_load(paper: LimbModel) -> None:
    play = paper.with_values({"joint.tibia.gap_rad": 0.01})
    with node(play) as one:
        for press in (20.0, -20.0, 20.0):
            one.press(press, 0.0)
            one.step(1.0)
            snapshot, truth = one.raw_snapshot(), one.raw_truth()
            assert abs(truth.load_n_mm[2]) > 1000.0
            assert snapshot.play[2].valid
            assert snapshot.play[2].flank == truth.flank[2] == math.copysign(1, truth.load_n_mm[2])
            assert not one_flag(snapshot, "GAP_OPEN")


def detection_us(one: Node, joint: int) -> int:
    """What the controller promises of a joint, by its parameters."""
    ffi, lib = one.native.ffi, one.native.lib
    believed = lib.brace_app_parameters(one.app())
    drive = believed.drive[joint]
    params = ffi.new("brace_backlash_params_t *")
    params.tick_us = believed.controller.tick_us
    params.gap_rad = believed.limb.joint[joint].gap_rad
    params.friction_n_mm = drive.motor_friction_n_mm
    params.friction_tolerance_ratio = drive.motor_friction_tolerance_ratio
    params.inertia_n_mm_s2_per_rad = drive.motor_inertia_n_mm_s2_per_rad
    for name in ("torque_range_n_mm", "torque_noise_n_mm", "torque_bias_n_mm", "angle_step_rad"):
        setattr(params, name, getattr(drive, name))
    params.takeup.torque_max_n_mm = drive.takeup_torque_n_mm
    params.takeup.travel_max_rad = params.takeup.reach_max_rad = 0.1
    params.takeup.rate_rad_per_s = 0.1
    params.takeup.time_max_us, params.takeup.verify_us = 8_000_000, 100_000
    machine = ffi.new("brace_backlash_t *")
    assert lib.brace_backlash_init(machine, params) == 0
    return int(lib.brace_backlash_detection_us(machine))


def test_an_open_gap_is_never_called_carried(paper: LimbModel) -> None:
    """The load is taken away and given back: no tick calls the flank valid later than the stated detection time."""
    play = paper.with_values({"joint.femur.gap_rad": 0.012, "joint.tibia.gap_rad": 0.012})
    with node(play, press_mm=(20.0, 0.0), seed=5) as one:
        one.step(1.0)
        detection_ms = detection_us(one, 2) / 1000
        seen_valid = 0
        for _ in range(4):
            open_ms = 0
            one.press(0.0, 0.0, hold_n_per_mm=0.0)
            for _ in range(600):
                one.step(0.001)
                truth, snapshot = one.raw_truth(), one.raw_snapshot()
                open_ms = open_ms + 1 if truth.flank[2] == 0 else 0
                assert not (snapshot.play[2].valid and open_ms > detection_ms + 1)
            one.press(20.0, 0.0)
            one.step(0.8)
            seen_valid += one.raw_snapshot().play[2].valid
        assert seen_valid == 4


def test_take_up_closes_a_gap_that_the_controller_does_not_see(paper: LimbModel) -> None:
    believed = paper.with_values({"joint.tibia.gap_rad": 0.008})
    true = paper.with_values({"joint.tibia.gap_rad": 0.0096})
    with node(believed, true) as one:
        one.step(0.5)
        assert one.raw_truth().flank[2] == 0
        lib, app = one.native.lib, one.app()
        for flank in (1, -1):
            assert lib.brace_app_take_up(app, 2, flank) == 0
            one.step(3.0)
            snapshot, truth = one.raw_snapshot(), one.raw_truth()
            assert MODES[snapshot.mode] == "taking_up"
            assert snapshot.play[2].takeup == 2 and snapshot.play[2].flank == flank == truth.flank[2]
            assert abs(snapshot.play[2].preload_n_mm - truth.load_n_mm[2]) <= 1.2 * FRICTION_N_MM + 80.0 + 60.0
            assert not one_flag(snapshot, "GAP_OPEN")
            assert lib.brace_app_let_go(app) == 0
            one.step(3.0)
            assert MODES[one.raw_snapshot().mode] == "monitor"
            assert one.raw_truth().set_rad[2] == pytest.approx(1.4, abs=1e-6)


# --------------------------------------------------------------------------------------- the loading test


SOFT_KNEE = {"joint.tibia.compliance_rad_per_n_mm": 4e-5}


def loading_test(one: Node, axis: int, step_mm: float = 0.4) -> Any:
    setup = one.native.ffi.new("brace_loading_setup_t *")
    setup.axis, setup.steps_per_side, setup.step_mm = axis, 4, step_mm
    setup.dwell_us, setup.rate_mm_per_s = 200_000, 10.0
    setup.force_max_n, setup.torque_max_n_mm = 60.0, 8000.0
    assert one.native.lib.brace_app_loading_start(one.app(), setup) == 0
    for _ in range(1200):  # against dry friction a step may take a second
        one.step(0.1)
        result = one.native.lib.brace_app_loading_result(one.app())
        if result.outcome != 1 and MODES[one.raw_snapshot().mode] == "monitor":
            return one.native.ffi.new("brace_loading_result_t *", result[0])  # a copy outlives the node
    raise AssertionError("the loading test does not end")


@pytest.mark.parametrize("axis", [0, 1])
def test_the_limbs_own_loading_test_measures_the_plant(paper: LimbModel, axis: int) -> None:
    """The slope is the true limb's K, not the believed one's. Tolerance: four of its own sigma, plus what turning the
    limb by the test's few milliradians does to K."""
    soft = paper.with_values(SOFT_KNEE)
    with node(paper, soft, press_mm=(0.5, 1.0)) as one:
        one.step(0.5)
        motor = [one.raw_truth().motor_rad[i] for i in (1, 2)]
        preload = [one.raw_truth().force_x_n, one.raw_truth().force_z_n]
        result = loading_test(one, axis)
    assert result.outcome == 2 and result.rows == 17
    true = physics_k(*motor, joint=(1e-5, 4e-5))[:, axis]
    believed = under_force(paper, motor[0], motor[1], preload).k_n_per_mm[0][:, axis]
    column = result.least_squares
    measured = np.array([column.k_x_n_per_mm, column.k_z_n_per_mm])
    sigma = np.array([column.sigma_k_x_n_per_mm, column.sigma_k_z_n_per_mm])
    assert np.all(np.abs(measured - true) <= 4 * sigma + 0.01 * np.abs(true).max())
    assert [result.model_k_x_n_per_mm, result.model_k_z_n_per_mm] == pytest.approx(believed, rel=1e-2)  # noise
    assert np.linalg.norm(measured - true) < np.linalg.norm(measured - believed)


@pytest.mark.parametrize(("friction_n_mm", "longest_s"), [(0.0, 10.0), (FRICTION_N_MM, 25.0)])
@pytest.mark.parametrize("axis", [0, 1])
def test_the_loading_test_waits_for_no_finer_than_encoders_and_comes_back(
    paper: LimbModel, axis: int, friction_n_mm: float, longest_s: float
) -> None:
    """Seventeen steps with a dwell of 0.2 s: their way and dwell take 4.2 s. An encoder step at a lever of 450 mm is
    0.009 mm; with friction each motor is left alone within three times an encoder step and a hundredth of the step of
    the joint that goes further. A tenth more, because the load changes the levers."""
    arms = levers(1.0, 1.4)
    alone_rad = 3.0 * (0.01 * 0.4 * np.abs(np.linalg.inv(arms)[:, axis]).max() + ENCODER_STEP_RAD)
    along_most_mm, across_most_mm = 1.1 * alone_rad * np.abs(arms).sum(1)[[axis, 1 - axis]]
    with node(paper, press_mm=(0.5, 1.0), drive={"friction_n_mm": friction_n_mm}) as one:
        one.step(0.5)
        assert loading_test(one, axis).outcome == 2
        lib, row = one.native.lib, one.native.ffi.new("brace_row_t *")
        rows = []
        for index in range(17):
            assert lib.brace_app_row(one.app(), index, row) == 0
            rows.append((row.t_s, row.dx_mm, row.dz_mm))
    t_s, along_mm, across_mm = (
        np.array(column) for column in zip(*((r[0], r[1 + axis], r[2 - axis]) for r in rows), strict=True)
    )
    assert t_s[-1] < longest_s
    places = 0.4 * np.array([0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0])
    assert np.abs(along_mm - places).max() < along_most_mm and np.abs(across_mm).max() < across_most_mm


def test_the_loading_test_tells_a_soft_limb_from_the_believed_one(paper: LimbModel) -> None:
    soft = paper.with_values(SOFT_KNEE)
    with node(paper, soft, press_mm=(0.0, 1.0)) as changed, node(paper, press_mm=(0.0, 1.0)) as same:
        changed.step(0.5)
        same.step(0.5)
        results = [loading_test(one, 0, 1.0) for one in (changed, same)]
        assert [result.outcome for result in results] == [2, 2]
        assert abs(results[0].z_x) > 3.0 > 2.0 > abs(results[1].z_x)


def test_the_loading_test_leaves_its_rows(paper: LimbModel) -> None:
    with node(paper, has_link_encoder=True) as one:
        one.step(0.5)
        loading_test(one, 1)
        lib, row = one.native.lib, one.native.ffi.new("brace_row_t *")
        assert lib.brace_app_row_count(one.app()) == 17
        rows = []
        for index in range(17):
            assert lib.brace_app_row(one.app(), index, row) == 0
            rows.append((row.step, row.t_s, row.dz_mm, row.fz_n, row.enc1_rad))
    steps, t_s, dz_mm, fz_n, enc1_rad = (np.array(column) for column in zip(*rows, strict=True))
    assert list(steps) == list(range(17)) and np.all(np.diff(t_s) > 0)
    assert np.corrcoef(dz_mm, fz_n)[0, 1] > 0.99
    assert np.all(np.isfinite(enc1_rad))


# ------------------------------------------------------------------------------------------------- faults


@pytest.mark.parametrize(
    ("spec", "bit", "mode"),
    [
        ("sensor_dead:femur@1+0.5", "sensor_femur", "fault"),
        ("sensor_nan:tibia@1+0.5", "sensor_tibia", "fault"),
        ("tick_late=9@1+0.5", "tick_late", None),
    ],
)
def test_faults_show_while_they_last_and_are_over_afterwards(
    paper: LimbModel, spec: str, bit: str, mode: str | None
) -> None:
    with node(paper) as one:
        one.add_fault(fault(spec))
        one.step(0.99)
        assert one.state()["faults"] == []
        one.step(0.4)
        during = one.state()
        assert bit in during["faults"]
        if mode is not None:
            assert during["mode"] == mode and not during["k_is_valid"]
        one.step(1.9)  # 100 ms for a sensor, 1 s for lateness
        after = one.state()
        assert after["faults"] == [] and after["mode"] == "monitor" and after["k_is_valid"]


def test_a_stuck_encoder_is_seen_by_the_torque_that_works(paper: LimbModel) -> None:
    with node(paper, hold_n_per_mm=math.inf) as one:
        one.add_fault(fault("encoder_stuck:femur@0.5+2.5"))
        for i in range(8):  # the limb is moved against its contact
            one.add_posture(Posture(1.0 + 0.06 * (i % 2), 1.4, 0.6 + 0.3 * i))
        one.step(2.9)
        assert "encoder_stuck" in one.state()["faults"]
        one.step(2.0)
        assert one.state()["faults"] == []


def test_a_current_offset_shifts_the_torque_only(paper: LimbModel) -> None:
    with node(paper) as one:
        one.add_fault(fault("current_offset:tibia=700@0.5+0.5"))
        means = []
        for _ in range(3):
            torque = []
            for _ in range(490):
                one.step(0.001)
                torque.append(one.raw_snapshot().torque_n_mm[2])
            one.step(0.01)
            means.append(float(np.mean(torque)))
        # 400 N mm of noise over 490 samples: one sigma 18 N mm.
        assert means == pytest.approx([0.0, 700.0, 0.0], abs=80.0)
        assert one.raw_truth().torque_n_mm[2] == pytest.approx(0.0, abs=1.0)


def test_a_lost_tip_carries_nothing_and_is_planted_again(paper: LimbModel) -> None:
    with node(paper, press_mm=(0.0, 5.0)) as one:
        one.add_fault(fault("tip_lost@0.5+0.5"))
        one.step(0.4)
        assert abs(one.raw_truth().force_z_n) > 0.3
        one.step(0.5)
        assert abs(one.raw_truth().force_z_n) < 1e-4
        one.step(1.0)
        assert one.raw_truth().solved


def test_a_soft_joint_turns_further_under_its_load_for_as_long_as_it_lasts(paper: LimbModel) -> None:
    with node(paper, press_mm=(0.0, 5.0)) as one:
        one.add_fault(fault("joint_soft:tibia=0.5@0.5+0.5"))
        yields, forces = [], []
        for _ in range(3):
            one.step(0.48)
            truth = one.raw_truth()
            yields.append([(truth.link_rad[i] - truth.motor_rad[i]) / truth.load_n_mm[i] for i in (1, 2)])
            forces.append(truth.force_z_n)
        femur, tibia = np.array(yields).T
        assert tibia == pytest.approx(tibia[0] * np.array([1.0, 2.0, 1.0]), rel=1e-6)
        assert femur == pytest.approx(femur[0], rel=1e-6)
        assert abs(forces[1]) < 0.95 * abs(forces[0]) and forces[2] == pytest.approx(forces[0], rel=1e-3)


def test_bus_off_shows_and_ends_with_the_heartbeat_back(paper: LimbModel) -> None:
    with node(paper, changes={"controller.node_id": 3}) as one:
        one.add_fault(fault("bus_off@1+1.5"))
        one.step(2.4)
        assert "can_bus_off" in one.state()["faults"]
        sent = one.stats()["can_sent"]
        one.step(3.0)
        assert "can_bus_off" not in one.state()["faults"]
        assert one.stats()["can_sent"] >= sent + 2


def test_every_fault_of_the_command_line_is_known_to_the_node(paper: LimbModel) -> None:
    from brace.sim.spec import FAULTS

    with node(paper) as one:
        names = [
            one.native.ffi.string(one.native.lib.brace_node_fault_name(i)).decode()
            for i in range(one.native.lib.BRACE_NODE_FAULT_COUNT)
        ]
    assert names == list(FAULTS)


# ------------------------------------------------------------------------------------------------- memory


def commit(one: Node, **members: float) -> int:
    """A new set through the controller's own requests; the seconds it took."""
    ffi, lib, app = one.native.ffi, one.native.lib, one.app()
    assert lib.brace_app_configuration_enter(app) == 0
    one.step(0.01)
    wanted = ffi.new("brace_parameters_t *", lib.brace_app_parameters(app)[0])
    for name, value in members.items():
        setattr(wanted.controller, name, int(value))
    status = int(lib.brace_app_parameters_commit(app, wanted))
    one.step(2.0)
    lib.brace_app_configuration_leave(app)
    one.step(0.5)
    return status


def test_stored_parameters_outlive_a_restart(paper: LimbModel) -> None:
    with node(paper) as one:
        one.step(0.3)
        before = one.state()
        assert commit(one, modbus_address=42) == 0
        after = one.state()
        assert after["parameter_crc"] != before["parameter_crc"] and after["faults"] == []
        one.restart()
        one.step(0.3)
        again = one.state()
        assert again["parameter_crc"] == after["parameter_crc"]
        assert again["parameters"] == after["parameters"] != "default"


def test_a_memory_file_is_found_again_and_goes_before_the_model(paper: LimbModel, tmp_path: Path) -> None:
    path = str(tmp_path / "memory")
    with node(paper, nvm_path=path) as one:
        one.step(0.2)
        assert commit(one, modbus_address=17) == 0
        kept = one.state()["parameter_crc"]
    other = paper.with_values({"link.tibia.bending_mm_per_n": 0.3})
    with node(other, nvm_path=path) as one:
        one.step(0.2)
        assert one.state()["parameter_crc"] == kept
    with node(other, nvm_path=path, block_replaces=True) as one:
        one.step(0.2)
        assert one.state()["parameter_crc"] != kept


def test_a_memory_file_of_another_size_is_refused(paper: LimbModel, tmp_path: Path) -> None:
    path = tmp_path / "memory"
    path.write_bytes(b"something else")
    with pytest.raises(BadFileError):
        node(paper, nvm_path=str(path))
    assert path.read_bytes() == b"something else"


@pytest.mark.parametrize("kind", ["nvm_fails", "nvm_forgets"])
def test_a_memory_that_does_not_keep_leaves_the_old_set_and_is_told(paper: LimbModel, kind: str) -> None:
    with node(paper) as one:
        one.step(0.3)
        before = one.state()["parameter_crc"]
        one.add_fault(fault(f"{kind}@0.3+5"))
        commit(one, modbus_address=9)
        assert one.state()["parameter_crc"] == before
        assert "store" in one.state()["faults"]
        one.step(5.0)
        assert commit(one, modbus_address=9) == 0
        assert one.state()["parameter_crc"] != before
        assert "store" not in one.state()["faults"]


def test_an_empty_memory_is_said_and_flagged(paper: LimbModel) -> None:
    with node(paper, no_block=True) as one:
        one.step(0.3)
        state = one.state()
    assert state["parameters"] == "default" and "parameters" in state["faults"]
    assert "UNCALIBRATED" in state["flag_names"]


# --------------------------------------------------------------------------------------------- real time


def test_four_limbs_keep_up_with_the_clock(paper: LimbModel) -> None:
    """A limb's tick costs microseconds; what the machine's other work takes is given up after 50 ms, and counted."""
    with Node([LimbSetup(paper, paper) for _ in range(4)], "none") as one:
        one.start(until_s=1.0)
        assert one.wait(10.0)
        stats = one.stats()
    assert stats["ticks"] == pytest.approx(4 * 1000, abs=8)
    assert stats["slipped_us"] < 500_000
