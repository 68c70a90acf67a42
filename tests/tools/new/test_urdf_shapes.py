"""Legs of a URDF that are not the model's shape: refused with the true reason, or a planar limb that says so."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_bench import Outcome

Brace = Callable[..., Outcome]
PLANE = ("--femur-link", "rigid", "--tibia-link", "rigid", "--femur-joint", 60, "--tibia-joint", 60)
SPACE = (*PLANE, "--coxa-link", "rigid", "--coxa-joint", 60)
LINK = (
    '<link name="{}"><inertial><mass value="0.3"/>'
    '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)


def _joint(name: str, at: str, axis: str, kind: str = "revolute", limit: str = "-1.5 1.5", more: str = "") -> str:
    low, high = limit.split()
    return (
        f'{{before}}<joint name="{name}" type="{kind}"><parent link="{{parent}}"/><child link="{name}_link"/>'
        f'<origin xyz="{at.partition("|")[0]}" rpy="{at.partition("|")[2] or "0 0 0"}"/><axis xyz="{axis}"/>'
        f'<limit lower="{low}" upper="{high}" effort="20" velocity="5"/>{more}</joint>'
    )


def _robot(path: Path, *joints: str) -> Path:
    text, parent = LINK.format("body"), "body"
    for joint in joints:
        name = joint.partition('name="')[2].partition('"')[0]
        text += LINK.format(f"{name}_link") + joint.format(parent=parent, before="")
        parent = f"{name}_link"
    path.write_text(f'<robot name="leg">{text}</robot>')
    return path


YAW, HIP = _joint("yaw", "0.1 0 0", "0 0 1"), _joint("hip", "0.05 0 0", "0 1 0")
KNEE = _joint("knee", "0.1 0 0", "0 1 0", limit="0 2.4")
FOOT = _joint("foot", "0.15 0 0", "1 0 0", kind="fixed")
ROLL = (_joint("abad", "0.2 0.05 0", "1 0 0"), _joint("hip", "0 0.09 0", "0 1 0"),
        _joint("knee", "0 0 -0.2", "0 1 0", limit="-2.6 -0.8"),
        _joint("foot", "0 0 -0.2", "1 0 0", kind="fixed"))  # fmt: skip
REFUSED = {
    "abad turns about (1, 0, 0), 90 deg from the vertical": ROLL,
    "yaw turns about (0.479, 0, 0.878), 28.6 deg": (_joint("yaw", "0.1 0 0|0 0.5 0", "0 0 1"), HIP, KNEE, FOOT),
    "the hip stands 30 mm beside": (YAW, _joint("hip", "0.05 0.03 0", "0 1 0"), KNEE, FOOT),
    "the knee stands 60 mm beside": (YAW, HIP, _joint("knee", "0.1 0.06 0", "0 1 0"), FOOT),
    "turn in one plane": (_joint("first", "0.1 0 0", "0 1 0"), HIP, KNEE, FOOT),
    "shock: a slide": (YAW, HIP, KNEE, _joint("shock", "0.1 0 0", "1 0 0", kind="prismatic"), FOOT),
    "lift: a slide": (_joint("lift", "0 0 0", "0 0 1", kind="prismatic"), HIP, KNEE, FOOT),
    "knee mimics another joint": (YAW, HIP, _joint("knee", "0.1 0 0", "0 1 0", more='<mimic joint="hip"/>'), FOOT),
}


@pytest.mark.parametrize("words", REFUSED)
def test_another_shape_is_refused_in_space_by_name(brace: Brace, tmp_path: Path, words: str) -> None:
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", *REFUSED[words])
    done = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *SPACE)
    assert done.code == 3 and words in done.err, done.err


def test_a_quadrupeds_leg_is_a_planar_limb_and_says_so(brace: Brace, tmp_path: Path) -> None:
    """K in the plane by the levers of MuJoCo's Jacobian, with the hip roll held by the plane."""
    pytest.importorskip("mujoco")
    out, robot = tmp_path / "limb.toml", _robot(tmp_path / "leg.urdf", *ROLL)
    done = brace("new", "--out", out, "--urdf", robot, *PLANE, "--json")
    assert done.code == 0, done.err
    told = " ".join(json.loads(done.out)["guesses"])
    assert "planar limb" in told and "x (outwards) is the robot's (1, 0, 0)" in told
    assert "coxa_mm" not in out.read_text()
    k = json.loads(brace("k", "--model", out, "--theta1", -2.0708, "--theta2", -1.0, "--json").out)
    found = [k[f"k_{entry}_n_per_mm"] for entry in ("xx", "xz", "zz")]
    assert found == pytest.approx(_truth_of_roll_leg(robot), rel=1e-5)


def _truth_of_roll_leg(robot: Path) -> list[float]:
    import mujoco

    spec = mujoco.MjSpec.from_file(str(robot))
    spec.compiler.fusestatic = False
    model = spec.compile()
    data = mujoco.MjData(model)
    # The leg hangs at zero; theta1 = -pi/2 - hip, and theta2 is the knee's angle here.
    data.qpos[:] = 0.0, 2.0708 - np.pi / 2, -1.0
    mujoco.mj_forward(model, data)
    jacobian = np.zeros((3, 3))
    mujoco.mj_jacBody(model, data, jacobian, None, model.body("foot_link").id)
    inverse = np.linalg.inv(1e3 * jacobian)  # rad/mm
    k = inverse.T @ np.diag([60e3] * 3) @ inverse
    return [k[0, 0], k[0, 2], k[2, 2]]


def test_wide_limits_are_none_and_a_lean_or_offset_is_told(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    wide = _joint("hip", "0.05 0.002 0", "0 1 0", limit="-9.42 9.42")
    robot = _robot(tmp_path / "leg.urdf", _joint("yaw", "0.1 0 0|0 0.02 0", "0 0 1"), wide, KNEE, FOOT)
    done = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *SPACE)
    assert done.code == 0, done.err
    assert "limits beyond a whole turn each way" in done.out
    assert "leans by 1.1 deg" in done.out and "2, 2, 2 mm aside" in done.out
    assert "[motor.femur]" not in (tmp_path / "limb.toml").read_text()


@pytest.mark.parametrize("sign", [1, -1])
def test_a_leg_that_hangs_straight_is_one_limb(brace: Brace, tmp_path: Path, sign: int) -> None:
    """One mechanism, its axes written either way."""
    pytest.importorskip("mujoco")
    axis = f"0 {sign} 0"
    hip = _joint("hip", "0 0 0", axis, limit="-0.5 1.2" if sign > 0 else "-1.2 0.5")
    knee = _joint("knee", "0 0 -0.2", axis, limit="-2.4 0" if sign > 0 else "0 2.4")
    robot = _robot(tmp_path / "leg.urdf", hip, knee, _joint("foot", "1e-10 0 -0.2", axis, kind="fixed"))
    told = json.loads(brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *PLANE, "--json").out)
    assert (told["theta1_rad"], told["theta2_rad"]) == pytest.approx((-1.9208, -1.2), abs=1e-3)


def test_comments_are_no_shapes(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", YAW, HIP, KNEE, FOOT)
    text = robot.read_text().replace('<joint name="knee"', '<!-- no <collision> --><joint name="knee"')
    robot.write_text(text.replace('<link name="foot_link">', "<!-- no </collision> -->" + '<link name="foot_link">'))
    assert brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *SPACE).code == 0
