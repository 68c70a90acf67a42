"""The simulated robot of `brace sim --stance` against the judge's truth: two mechanics that share no code."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth import Siconos, payload, stand
from world import Hidden, Stance, draw, write

from brace.sim.node import LimbSetup
from brace.sim.robot import Robot, RobotTruth
from brace.sim.spec import JOINTS
from brace.stance.simulated import SimulatedStance
from brace.stance.stance_file import load_stance

# Servos that hold their angles, without friction: the judge has none.
DRIVE = {"servo_n_mm_per_rad": 1e9, "friction_n_mm": 0.0}
RAMP_S = 2.0  # 500 of the body's time constants
SEED, STANCES = 5, 6  # a slope, three floors, a ceiling and a wall; feet slide in four of them
FACTOR = 2.0
OFF_N = 0.3  # 1 % of the weight; the judge's weight comes in 8 steps and its payload in 20, the robot's in hundreds
OFF_MM = 0.1


def simulated(stance: Stance, folder: Path) -> SimulatedStance:
    """What stance.toml says, and beside it the limbs, zeros and footholds that are true."""
    believed = load_stance(write(stance, folder / "believed"))
    world = stance.world
    true = load_stance(write(replace(stance, nominal=world.limbs, friction=world.friction), folder / "true"))
    limbs = tuple(
        replace(
            limb,
            model=limb.model.with_values(
                {f"joint.{joint}.zero_offset_rad": float(zero) for joint, zero in zip(JOINTS, zeros)}
            ),
            offset_mm=offset,
        )
        for limb, zeros, offset in zip(true.limbs, world.zero_rad, world.offset_mm)
    )
    return SimulatedStance(believed, replace(true, limbs=limbs))


def forces_n(truth: RobotTruth) -> np.ndarray:
    """In the world, as the judge has them."""
    turn = Rotation.from_rotvec(truth["rotation_rad"]).as_matrix()
    return np.asarray(np.array([limb["force_n"] for limb in truth["limbs"]]) @ turn.T)


@pytest.mark.parametrize("number", range(STANCES))
def test_the_robot_stands_as_the_judge_says(number: int, solver: Siconos, tmp_path: Path) -> None:
    """Zeros, footholds and compliances off; no play, which closes in the judge's world by a law of its own."""
    stance = draw(SEED, number, Hidden(play_rad=0.0))
    limbs = simulated(stance, tmp_path)
    before = stand(stance.world, solver)
    after = payload(stance.world, solver, before, 0.0, FACTOR, 20)
    setups = [LimbSetup(limb.believed, limb.plant, theta_rad=limb.theta_rad, drive=DRIVE) for limb in limbs.limbs]
    with Robot(limbs.body, setups) as robot:
        assert np.abs(forces_n(robot.robot_truth()) - before.force_n).max() < OFF_N
        robot.set_payload(0.0, FACTOR, RAMP_S)
        robot.step(RAMP_S + 0.5)
        truth = robot.robot_truth()
        assert robot.fall() is None and truth["unbalanced_ratio"] < 1e-6
    assert np.abs(forces_n(truth) - after.force_n).max() < OFF_N
    assert np.abs(np.array(truth["displacement_mm"]) - after.moved_mm).max() < OFF_MM
    for limb, slid in zip(truth["limbs"], np.linalg.norm(after.away_mm - before.away_mm, axis=1) > 0.3, strict=True):
        way = np.array(limb["foot_mm"]) - next(one.foothold_mm for one in limbs.body.feet if one.name == limb["name"])
        assert not slid or np.linalg.norm(way) > 0.2
