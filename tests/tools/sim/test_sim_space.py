"""A simulated limb with a coxa joint: K in space from the controller's own tick, against host_sim's reference."""

from __future__ import annotations

import math

import numpy as np
import pytest
from command_bench import DATA

from brace.cli.sim_values import fault
from brace.ground.errors import UsageError
from brace.model import LimbModel, load_limb
from brace.native import loaded
from brace.sim.node import LimbSetup, Node
from brace.sim.status import line_of
from brace.stiffness.names import SPATIAL_K

SPATIAL = {
    "link.coxa.bending_mm_per_n": 0.002,
    "link.coxa.lateral_mm_per_n": 0.004,
    "link.coxa.torsion_rad_per_n_mm": 1e-6,
    "link.femur.lateral_mm_per_n": 0.05,
    "link.femur.torsion_rad_per_n_mm": 2e-6,
    "link.tibia.lateral_mm_per_n": 0.2,
    "joint.coxa.compliance_rad_per_n_mm": 8e-6,
}
GAP_RAD = 0.006


@pytest.fixture(scope="module")
def spatial() -> LimbModel:
    return load_limb(DATA / "paper-limb.toml").with_values(SPATIAL)


def node(model: LimbModel, plant: LimbModel | None = None, **options: object) -> Node:
    return Node([LimbSetup(model, plant or model, **options)], "none", 3)  # type: ignore[arg-type]


def robot_frame(theta0_rad: float) -> np.ndarray:
    """From the limb's plane (x outwards, y to the left, z up) to the robot's frame."""
    cosine, sine = math.cos(theta0_rad), math.sin(theta0_rad)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def reference(one: Node, model: LimbModel) -> np.ndarray:
    """K at rest under the force that the controller counts and the weight, by host_sim/reference, which is no firmware.
    The angles are those of the motors, what the controller knows of the play added."""
    snapshot, truth = one.raw_snapshot(), one.raw_truth()
    theta_rad = [truth.motor_rad[i] + snapshot.play[i].offset_rad for i in range(3)]
    load = snapshot.load
    force_n = robot_frame(theta_rad[0]) @ [load.force_x_n, load.force_y_n, load.force_z_n]
    return np.asarray(loaded.space_under_force(model, [theta_rad], [force_n]).k_n_per_mm[0])


def plane_of(k_n_per_mm: np.ndarray, theta0_rad: float) -> np.ndarray:
    """The block of the limb's plane, of K in the robot's frame."""
    turned = robot_frame(theta0_rad).T @ k_n_per_mm @ robot_frame(theta0_rad)
    return np.asarray(turned[np.ix_((0, 2), (0, 2))])


def space_of(one: Node) -> dict[str, object]:
    space = one.state()["space"]
    assert isinstance(space, dict)
    return space


def k_of(space: dict[str, object]) -> np.ndarray:
    xx, xy, xz, yy, yz, zz = (space[name] for name in SPATIAL_K)
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], dtype=float)


def assert_k_of_the_reference(one: Node, model: LimbModel, within: float = 2e-4) -> None:
    """within: Frobenius norm, relative."""
    space, wanted = space_of(one), reference(one, model)
    assert np.linalg.norm(k_of(space) - wanted) < within * np.linalg.norm(wanted)
    values, axes = np.linalg.eigh(wanted)
    told = np.array([space[f"lambda_{name}_n_per_mm"] for name in ("min", "mid", "max")])
    assert told == pytest.approx(values, abs=within * float(np.linalg.norm(wanted)))
    axis = np.array([space[f"stiff_axis_{name}"] for name in "xyz"])
    assert abs(float(axis @ axes[:, 2])) == pytest.approx(1.0, abs=10 * within)


@pytest.mark.parametrize("theta_rad", [(0.0, 1.0, 1.4), (0.7, 0.6, 1.9), (-1.2, 1.2, 0.8)])
def test_k_in_space_is_that_of_the_reference(spatial: LimbModel, theta_rad: tuple[float, float, float]) -> None:
    with node(spatial, theta_rad=theta_rad) as one:
        one.step(0.5)
        space = space_of(one)
        assert space["k_is_valid"] and space["flag_names"] == []
        assert space["theta0_rad"] == pytest.approx(theta_rad[0], abs=2e-3)
        assert_k_of_the_reference(one, spatial)


def test_a_planar_limb_tells_nothing_of_space() -> None:
    paper = load_limb(DATA / "paper-limb.toml")
    with node(paper) as one:
        one.step(0.2)
        state, truth = one.state(), one.truth()
        assert "space" not in state and "space" not in line_of(state)
        assert not {"theta0_rad", "load_coxa_n_mm", "flank_coxa", "force_y_n"} & truth.keys()
        assert math.isnan(one.raw_snapshot().theta_rad[0]) and not one.has_coxa_joint()
        with pytest.raises(UsageError, match="limb 1") as refusal:
            one.add_fault(fault("sensor_dead:coxa@1"))
        assert "coxa" in refusal.value.why


def test_a_load_across_the_plane_comes_from_the_contact(spatial: LimbModel) -> None:
    with node(spatial, press_y_mm=4.0) as one:
        one.step(1.0)
        state, truth = one.state(), one.truth()
        theta = list(one.raw_truth().motor_rad)
        alone = loaded.space_under_force(spatial, [(0.0, theta[1], theta[2])], [(0.0, 0.0, 0.0)]).k_n_per_mm[0][1, 1]
        told = state["load"]
        assert isinstance(told, dict) and told["unloaded_k_across_n_per_mm"] == pytest.approx(alone, rel=1e-4)
        force_y_n, load_n_mm = truth["force_y_n"], truth["load_coxa_n_mm"]
        assert isinstance(force_y_n, float) and isinstance(load_n_mm, float)
        lever_mm = 57.0 + 185.0 * math.cos(1.0) + 313.5 * math.cos(-0.4)
        # The motor gives way too: its servo is in series with the limb, held within its friction.
        droop_rad = one.raw_truth().motor_rad[0]
        assert force_y_n == pytest.approx(alone * (4.0 - lever_mm * droop_rad), rel=1e-3)
        assert load_n_mm == pytest.approx(-lever_mm * force_y_n, rel=1e-3)


@pytest.mark.parametrize("press_mm", [(2.0, 3.0, -4.0), (-3.0, -8.0, 6.0), (0.0, 12.0, 0.0)])
def test_k_in_space_is_the_one_under_the_load(spatial: LimbModel, press_mm: tuple[float, float, float]) -> None:
    theta_rad = (0.4, 0.8, 1.5)
    weights = {"gravity.femur_n": 2.0, "gravity.knee_n": 1.0, "gravity.tibia_n": 3.0}
    model = spatial.with_values(weights)
    x_mm, y_mm, z_mm = press_mm
    with node(model, theta_rad=theta_rad, press_mm=(x_mm, z_mm), press_y_mm=y_mm) as one:
        one.step(1.0)
        truth, snapshot = one.raw_truth(), one.raw_snapshot()  # load is a part of it, and lives as long
        load = snapshot.load
        assert load.is_counted
        # The sensor's noise is 0.1 N; the coxa drive's torque is known to its bias over a lever of some 400 mm.
        assert load.force_x_n == pytest.approx(truth.force_x_n, abs=0.4)
        assert load.force_z_n == pytest.approx(truth.force_z_n, abs=0.4)
        assert load.force_y_n == pytest.approx(truth.force_y_n, abs=0.4)
        assert_k_of_the_reference(one, model, within=2e-3)
        without = loaded.space_under_force(spatial, [theta_rad], [(0.0, 0.0, 0.0)]).k_n_per_mm[0]
        change = np.linalg.norm(reference(one, model) - without) / np.linalg.norm(without)
        assert change > 0.01  # five times what is allowed above
        assert load.buckling_factor > 1.0
        assert load.unloaded.k_xx_n_per_mm == pytest.approx(plane_of(without, theta_rad[0])[0, 0], rel=5e-3)


def gravity_of(model: LimbModel, theta0_rad: float) -> np.ndarray:
    """Where the weights pull, in the robot's frame."""
    direction_rad, lean_rad = (model.number(f"gravity.{name}") for name in ("direction_rad", "lean_rad"))
    within = math.cos(lean_rad)
    down = [within * math.cos(direction_rad), math.sin(lean_rad), within * math.sin(direction_rad)]
    return np.asarray(robot_frame(theta0_rad) @ down)


def at_rest(one: Node, model: LimbModel) -> tuple[np.ndarray, np.ndarray]:
    """The contact's force in the limb's plane's frame, and K by the reference under it: nothing of the controller's."""
    truth = one.raw_truth()
    motor_rad, force_n = list(truth.motor_rad), np.array([truth.force_x_n, truth.force_y_n, truth.force_z_n])
    found = loaded.space_under_force(
        model, [motor_rad], [robot_frame(motor_rad[0]) @ force_n], gravity=gravity_of(model, motor_rad[0])
    )
    return force_n, np.asarray(found.k_n_per_mm[0])


def press_for(model: LimbModel, theta_rad: tuple[float, float, float], force_n: np.ndarray) -> np.ndarray:
    """Where a contact holds the tip so that it presses with about this force: the motors droop, too."""
    droop_rad_per_n_mm = 1.0 / 6e4
    keys = [f"joint.{joint}.compliance_rad_per_n_mm" for joint in ("coxa", "femur", "tibia")]
    drooping = model.with_values({key: model.number(key) + droop_rad_per_n_mm for key in keys})
    found = loaded.space_under_force(
        drooping, [(0.0, *theta_rad[1:])], [force_n], gravity=gravity_of(model, 0.0)
    )
    return np.asarray(found.displacement_mm[0])


SIDES = [
    (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 1, 0), (-1, 1, 0), (0, -1, 1), (-1, -1, -1)
]  # fmt: skip
NO_FRICTION = {f"motor.{joint}.friction_n_mm": 0.0 for joint in ("coxa", "femur", "tibia")}
WEIGHS = {"gravity.femur_n": 2.0, "gravity.knee_n": 1.0, "gravity.tibia_n": 3.0, "gravity.lean_rad": 0.6,
          "gravity.direction_rad": -1.9}  # fmt: skip
BEAMS = {f"link.{link}.moment_transfer": True for link in ("femur", "tibia")}


# With the defaults' noise of sensor and drives, and their friction. A limb without a sensor at its tip knows the force
# from its motors' torques, which friction of 200 N mm hides by up to 1 N: without friction there.
@pytest.mark.parametrize("theta_rad", [(0.4, 0.8, 1.5), (-0.6, 0.4, 0.9)])
@pytest.mark.parametrize(
    ("more", "has_sensor"), [({}, True), ({**BEAMS, **WEIGHS}, True), ({**WEIGHS, **NO_FRICTION}, False)]
)
def test_k_under_a_force_from_any_side_is_the_limbs_own(
    spatial: LimbModel, theta_rad: tuple[float, float, float], more: dict[str, float], has_sensor: bool
) -> None:
    """The controller knows its model, its motors' angles and torques, and the sensor's force in its plane."""
    model = spatial.with_values(more)
    off = []
    for newtons in (5.0, 10.0, 20.0):
        for side in SIDES:
            wanted_n = newtons * np.array(side) / np.linalg.norm(side)
            x_mm, y_mm, z_mm = press_for(model, theta_rad, wanted_n)
            pressed = {"press_mm": (x_mm, z_mm), "press_y_mm": y_mm, "has_force_sensor": has_sensor}
            with node(model, theta_rad=theta_rad, **pressed) as one:
                one.step(0.4)
                force_n, wanted = at_rest(one, model)
                # The motors' friction leaves the force near the one that is wanted.
                assert np.linalg.norm(force_n - wanted_n) < 0.6 * newtons and one.raw_truth().solved
                space = space_of(one)
                assert space["k_is_valid"] and one.raw_snapshot().load.is_counted
                off.append(np.linalg.norm(k_of(space) - wanted) / np.linalg.norm(wanted))
    print(f"K told under 5, 10, 20 N from {len(SIDES)} sides: off by at most {max(off):.2%}")
    assert max(off) < 0.01


@pytest.mark.parametrize("has_sensor", [True, False])
def test_the_force_across_counts_where_the_tip_stands(spatial: LimbModel, has_sensor: bool) -> None:
    """Pressed outwards and to the left, the tip stands beside its plane: the force outwards turns the coxa joint, too,
    by a tenth of the moment. Without noise and friction nothing hides it. A limb without a sensor at its tip does not
    count that the femur, bent sideways, has turned the axis of the knee: by 0.02 rad here, 0.3 N."""
    model = spatial.with_values({**BEAMS, **NO_FRICTION, "sensor.noise_n": 0.0,
                                 **{f"motor.{joint}.torque_noise_n_mm": 0.0 for joint in ("coxa", "femur", "tibia")}})
    theta_rad = (-0.6, 0.4, 0.9)
    x_mm, y_mm, z_mm = press_for(model, theta_rad, np.array([14.0, 14.0, 0.0]))
    pressed = {"press_mm": (x_mm, z_mm), "press_y_mm": y_mm, "has_force_sensor": has_sensor}
    with node(model, theta_rad=theta_rad, **pressed) as one:
        one.step(0.6)
        truth, snapshot = one.raw_truth(), one.raw_snapshot()
        told = np.array([snapshot.load.force_x_n, snapshot.load.force_y_n, snapshot.load.force_z_n])
        assert truth.force_y_n > 10.0 and snapshot.load.moved_y_mm > 20.0
        wanted = [truth.force_x_n, truth.force_y_n, truth.force_z_n]
        assert told == pytest.approx(wanted, abs=0.05 if has_sensor else 0.5)


def test_a_plane_that_leans_to_the_left_has_weight_across_it(spatial: LimbModel) -> None:
    """Nothing presses: the coxa joint carries the weight's part across the plane, and the controller tells no force."""
    lean_rad, knee_n = 0.4, 3.0
    model = spatial.with_values({"gravity.lean_rad": lean_rad, "gravity.knee_n": knee_n, "sensor.noise_n": 0.0,
                                 "motor.coxa.torque_noise_n_mm": 0.0, **NO_FRICTION})
    with node(model, theta_rad=(0.0, 1.0, 1.4), hold_n_per_mm=0.0) as one:
        one.step(0.5)
        # The levers are those of the limb that sags by some millimetres.
        load_n_mm = -knee_n * math.sin(lean_rad) * (57.0 + 185.0 * math.cos(1.0))
        assert one.raw_truth().load_n_mm[0] == pytest.approx(load_n_mm, rel=0.01)
        tip_mm = 57.0 + 185.0 * math.cos(1.0) + 313.5 * math.cos(-0.4)
        assert one.raw_snapshot().load.force_y_n == pytest.approx(0.0, abs=0.02 * abs(load_n_mm) / tip_mm)


def test_play_and_friction_of_the_coxa_joint_act_in_the_turned_joint(spatial: LimbModel) -> None:
    """Pressed across the plane against a flank, the controller still tells the K of a limb whose joint stands there."""
    theta_rad = (0.3, 0.8, 1.5)
    model = spatial.with_values({"joint.coxa.gap_rad": 0.02, "joint.coxa.coulomb_n_mm": 100.0})
    x_mm, y_mm, z_mm = press_for(spatial, theta_rad, np.array([3.0, 9.0, 4.0]))
    with node(model, theta_rad=theta_rad, press_mm=(x_mm, z_mm), press_y_mm=y_mm + 4.0) as one:
        one.step(1.0)
        truth, snapshot = one.raw_truth(), one.raw_snapshot()
        assert truth.flank[0] == -1 == snapshot.play[0].flank and space_of(one)["flag_names"] == []
        turn_rad = truth.link_rad[0] - truth.motor_rad[0] - 0.01  # the spring's, less what friction holds
        compliance = model.number("joint.coxa.compliance_rad_per_n_mm")
        assert abs(turn_rad + compliance * truth.load_n_mm[0]) <= compliance * 100.0 * 1.001
        motor_rad = [truth.motor_rad[0] + 0.01, truth.motor_rad[1], truth.motor_rad[2]]
        # The sensor's frame is that of the motor's plane, which stands turned from the reference's by the play.
        force_n = robot_frame(truth.motor_rad[0]) @ [truth.force_x_n, truth.force_y_n, truth.force_z_n]
        wanted = loaded.space_under_force(spatial, [motor_rad], [force_n]).k_n_per_mm[0]
        assert np.linalg.norm(k_of(space_of(one)) - wanted) < 0.01 * np.linalg.norm(wanted)


@pytest.mark.parametrize("theta_rad", [(0.2, 0.9, 1.6), (-0.5, 0.3, 0.9)])
def test_the_buckling_factor_of_a_load_across_is_told_in_time(
    spatial: LimbModel, theta_rad: tuple[float, float, float]
) -> None:
    soft = spatial.with_values({"link.tibia.lateral_mm_per_n": 2.0, "link.tibia.bending_mm_per_n": 2.0})
    with node(soft, theta_rad=theta_rad, press_mm=(-6.0, 2.0), press_y_mm=4.0) as one:
        one.step(1.0)
        snapshot = one.raw_snapshot()
        load = snapshot.load
        unbent_rad = [one.raw_truth().motor_rad[i] for i in range(3)]
        force_n = robot_frame(unbent_rad[0]) @ [load.force_x_n, load.force_y_n, load.force_z_n]
        wanted = loaded.space_under_force(soft, [unbent_rad], [force_n])["buckling_factor"][0]
        # 4 % is the core's promise for nine of ten; the factor is up to 80 ms old, of a force with noise.
        assert wanted < 11.0 and load.buckling_factor == pytest.approx(wanted, rel=0.08)


def test_taking_up_the_coxa_gives_k_across_its_plane_back(spatial: LimbModel) -> None:
    play = spatial.with_values({"joint.coxa.gap_rad": GAP_RAD})
    with node(play, theta_rad=(0.3, 1.0, 1.4)) as one:
        one.step(0.5)
        before = space_of(one)
        assert one.raw_truth().flank[0] == 0 and before["k_is_valid"]
        assert before["flag_names"] == ["GAP_OPEN"] and before["k_across_n_per_mm"] == 0.0
        assert one.state()["flag_names"] == []  # the plane has no play
        lib, app = one.native.lib, one.app()
        for flank in (1, -1):
            assert lib.brace_app_take_up(app, 0, flank) == 0
            one.step(3.0)
            snapshot, truth = one.raw_snapshot(), one.raw_truth()
            assert snapshot.play[0].takeup == 2 and snapshot.play[0].flank == flank == truth.flank[0]
            assert space_of(one)["flag_names"] == []
            # The controller counts the play, and what the load that it knows turns the joint by.
            turn_rad = SPATIAL["joint.coxa.compliance_rad_per_n_mm"] * snapshot.play[0].load_n_mm
            wanted_rad = truth.motor_rad[0] - 0.5 * flank * GAP_RAD - turn_rad
            assert abs(turn_rad) > 5e-3 and snapshot.theta_rad[0] == pytest.approx(wanted_rad, abs=0.02 * abs(turn_rad))
            assert_k_of_the_reference(one, spatial, within=2e-3)
            assert lib.brace_app_let_go(app) == 0
            one.step(3.0)
            assert one.state()["mode"] == "monitor"


def test_a_take_up_with_nothing_to_press_against_says_why(spatial: LimbModel) -> None:
    play = spatial.with_values({"joint.coxa.gap_rad": GAP_RAD})
    with node(play, hold_n_per_mm=0.0) as one:
        one.step(0.5)
        assert one.native.lib.brace_app_take_up(one.app(), 0, 1) == 0
        one.step(9.0)
        assert one.raw_snapshot().play[0].takeup == -2  # travel: nothing holds the link


def test_a_coxa_joint_without_samples_leaves_k_in_the_plane(spatial: LimbModel) -> None:
    with node(spatial) as one:
        one.add_fault(fault("sensor_dead:coxa@0.5+0.5"))
        one.step(0.9)
        state, space = one.state(), space_of(one)
        assert state["faults"] == ["sensor_coxa"] and state["mode"] == "monitor" and state["k_is_valid"]
        assert not space["k_is_valid"] and space["k_xx_n_per_mm"] is None
        assert "K in space not valid" in line_of(state)
        one.step(1.0)
        assert space_of(one)["k_is_valid"] and one.state()["faults"] == []
        assert "K in space " in line_of(one.state())


def test_friction_and_creep_across_the_plane_are_the_plants(spatial: LimbModel) -> None:
    soft = spatial.with_values({"creep.ratio": 0.5, "creep.time_constant_s": 0.5})
    with node(spatial, soft, press_y_mm=8.0) as one:
        one.step(0.1)
        early_n = one.raw_truth().force_y_n
        one.step(5.0)
        assert one.raw_truth().force_y_n < 0.97 * early_n
