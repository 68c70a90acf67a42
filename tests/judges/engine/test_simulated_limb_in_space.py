"""The simulated limb in space, between motors and a contact, against a physics engine.

The engine pushes its own limb, at the angles of the simulated motors, with the force of the simulated contact: its tip has
to come to the place where the contact holds the simulated one."""

from __future__ import annotations

import numpy as np
import pytest

try:
    import mujoco  # noqa: F401
except ImportError as missing:
    pytest.skip(f"no physics engine ({missing}): .venv/bin/python -m pip install mujoco", allow_module_level=True)

from brace.model import LimbModel  # noqa: E402
from brace.sim.node import LimbSetup, Node  # noqa: E402
from cases import Case, limb_model, random_cases  # noqa: E402
from engine_chain import Array  # noqa: E402
from test_loaded_reference import engine_of, yaw  # noqa: E402

SEGMENTS = 24
# Of the displacement. The engine's 24 segments leave 1/(4 24^2) = 4e-4, and a load of half the buckling one doubles that.
# The two hinges in each of the simulated beam's four parts leave a tenth of it.
WITHIN = 1e-3


def straight_tip_mm(model: LimbModel, theta_rad: Array) -> Array:
    """From the yaw axis, in the robot's frame."""
    coxa, femur, tibia = (model.number(f"geometry.{name}_mm") for name in ("coxa", "femur", "tibia"))
    theta0, theta1, shin = theta_rad[0], theta_rad[1], theta_rad[1] - theta_rad[2]
    out = coxa + femur * np.cos(theta1) + tibia * np.cos(shin)
    up = femur * np.sin(theta1) + tibia * np.sin(shin)
    return np.array([out * np.cos(theta0), out * np.sin(theta0), up])


@pytest.mark.parametrize("case", list(random_cases(31, 6, in_space=True)))
def test_the_tip_is_where_the_engine_pushes_it(case: Case) -> None:
    down = yaw(case).T @ case.gravity  # in the limb's plane
    weighs = {"gravity.direction_rad": float(np.arctan2(down[2], down[0])),
              "gravity.lean_rad": float(np.arcsin(np.clip(down[1], -1.0, 1.0)))}  # fmt: skip
    model = limb_model(case.keys).with_values(weighs)
    engine, force_n = engine_of(case, SEGMENTS)
    press_mm = engine.push(force_n).tip_mm
    setup = LimbSetup(
        model, model, theta_rad=case.theta_rad, press_mm=(press_mm[0], press_mm[2]), press_y_mm=press_mm[1]
    )
    with Node([setup]) as node:
        node.step(0.3)
        truth = node.raw_truth()
        assert truth.solved and truth.has_coxa_joint
        motor_rad = np.array(list(truth.motor_rad))
        pressed_n = np.array([truth.force_x_n, truth.force_y_n, truth.force_z_n])
    turn = yaw(Case(case.keys, tuple(motor_rad), pressed_n, down))
    there = Case(case.keys, tuple(motor_rad), turn @ pressed_n, turn @ down)
    engine, force_n = engine_of(there, SEGMENTS)
    rest = engine.push(force_n)
    assert rest.stable
    place = straight_tip_mm(model, motor_rad) + turn @ rest.tip_mm
    held = straight_tip_mm(model, np.array(case.theta_rad)) + yaw(case) @ press_mm
    print(f"off by {np.linalg.norm(place - held) / np.linalg.norm(rest.tip_mm):.1e} of the displacement")
    assert np.linalg.norm(place - held) < WITHIN * np.linalg.norm(rest.tip_mm) + 1e-6
    assert np.linalg.norm(rest.tip_mm) > 1.0 and np.linalg.norm(pressed_n) > 0.5
