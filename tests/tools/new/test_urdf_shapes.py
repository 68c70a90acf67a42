"""Legs of a URDF that are not the model's shape: refused with the true reason, or a planar limb that says so."""

from __future__ import annotations

import json
import tomllib
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


def test_a_xacro_file_is_named(brace: Brace, tmp_path: Path) -> None:
    robot = _robot(tmp_path / "leg.urdf", YAW, HIP, KNEE, FOOT)
    robot.write_text(robot.read_text().replace("0.15 0 0", "${shank} 0 0"))
    refused = brace("new", "--out", tmp_path / "o.toml", "--urdf", robot, *SPACE)
    assert refused.code == 3 and "this is a xacro file" in refused.err, refused.err


def test_what_xacro_left_in_comments_is_no_xacro(brace: Brace, tmp_path: Path) -> None:
    """The URDFs of Tiago, Talos and xArm have such comments."""
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", YAW, HIP, KNEE, FOOT)
    left = '<!-- <link name="${prefix}eef"/>\n <xacro:caster side="${side}"/> -->'
    robot.write_text(robot.read_text().replace("</robot>", f"{left}</robot>"))
    made = brace("new", "--out", tmp_path / "o.toml", "--urdf", robot, *SPACE)
    assert made.code == 0, made.err


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
    # The leg hangs at zero; theta1 = -pi/2 - hip, and theta2 is the knee's angle here.
    inverse = np.linalg.inv(_jacobian(robot, 0.0, 2.0708 - np.pi / 2, -1.0))  # rad/mm
    k = inverse.T @ np.diag([60e3] * 3) @ inverse
    return [k[0, 0], k[0, 2], k[2, 2]]


def _jacobian(robot: Path, *angles_rad: float) -> np.ndarray:
    """3 x joints at the foot's link [mm]."""
    import mujoco

    spec = mujoco.MjSpec.from_file(str(robot))
    spec.compiler.fusestatic = False
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[:] = angles_rad
    mujoco.mj_forward(model, data)
    jacobian = np.zeros((3, len(angles_rad)))
    mujoco.mj_jacBody(model, data, jacobian, None, model.body("foot_link").id)
    return 1e3 * jacobian


def test_a_roll_in_the_legs_plane_is_a_limb_in_space_along_the_legs_axes(brace: Brace, tmp_path: Path) -> None:
    """A hip roll without a way aside: z of the limb is its axis. K is compared in the robot's frame."""
    pytest.importorskip("mujoco")
    hip = _joint("hip", "0.08 0 0", "0 1 0")
    out, robot = tmp_path / "limb.toml", _robot(tmp_path / "leg.urdf", ROLL[0], hip, *ROLL[2:])
    refused = brace("new", "--out", out, "--urdf", robot, *SPACE)
    assert refused.code == 3 and "90 deg from the vertical" in refused.err and "--urdf-frame leg" in refused.err
    told = json.loads(brace("new", "--out", out, "--urdf", robot, "--urdf-frame", "leg", *SPACE, "--json").out)
    assert "z is the robot's (1, 0, 0), 90 deg from its vertical" in " ".join(told["guesses"])
    q = {"abad": 0.4, "hip": 0.7, "knee": -1.3}
    theta = {name: each["zero_rad"] + each["sign"] * q[each["joint"]] for name, each in told["urdf"]["angles"].items()}
    options = [f"--theta{number}={theta[name]!r}" for number, name in enumerate(("coxa", "femur", "tibia"))]
    k = json.loads(brace("k", "--model", out, *options, "--json").out)
    ours = np.array([[k[f"k_{''.join(sorted(one + other))}_n_per_mm"] for one in "xyz"] for other in "xyz"])
    axes = np.array([told["urdf"]["axes_of_robot"][name] for name in "xyz"]).T
    inverse = np.linalg.inv(_jacobian(robot, *q.values()))
    assert axes @ ours @ axes.T == pytest.approx(inverse.T @ np.diag([60e3] * 3) @ inverse, rel=2e-5, abs=1e-5)
    down = tomllib.loads(out.read_text())["gravity"]  # x of the limb, with the roll at zero
    assert down["direction_rad"] == pytest.approx(0.0) and down["lean_rad"] == pytest.approx(0.0)


@pytest.mark.parametrize("axis", ["1 0 0", "-1 0 0"])
def test_along_the_legs_axes_z_points_forwards_either_way_the_roll_counts(
    brace: Brace, tmp_path: Path, axis: str
) -> None:
    pytest.importorskip("mujoco")
    roll, hip = _joint("abad", "0.2 0.05 0", axis), _joint("hip", "0.08 0 0", "0 1 0")
    robot = _robot(tmp_path / "leg.urdf", roll, hip, *ROLL[2:])
    told = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, "--urdf-frame", "leg", *SPACE)
    assert told.code == 0 and "z is the robot's (1, 0, 0), 90 deg from its vertical" in told.out, told.err
    assert f"theta0 = {'-' * axis.startswith('-')}abad," in told.out, "an angle that is no offset is not written as one"


def test_two_hinges_are_no_limb_in_space_until_the_coxa_is_given(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    out, robot = tmp_path / "limb.toml", _robot(tmp_path / "leg.urdf", HIP, KNEE, FOOT)
    done = brace("new", "--out", out, "--urdf", robot, *SPACE)
    assert done.code == 3 and "hip and knee are all hinges up to foot_link" in done.err and "--coxa MM" in done.err
    assert brace("new", "--out", out, "--urdf", robot, *SPACE, "--coxa", 57).code == 0
    assert tomllib.loads(out.read_text())["geometry"]["coxa_mm"] == 57.0


def test_what_hangs_on_the_body_is_counted_by_name(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", YAW, HIP, KNEE, _joint("ankle", "0.1 0 0", "0 1 0"), FOOT)
    new = "new", "--out", tmp_path / "limb.toml", "--urdf", robot, *PLANE
    counted = "4 hinges lie between body and foot_link: yaw, hip, knee, ankle"
    assert counted in brace(*new, "--urdf-tip", "foot_link").err
    assert "hinges up to each end: foot_link 4" in brace(*new).err
    assert "no link 'foot'" in (done := brace(*new, "--urdf-tip", "foot")).err and "--urdf-tip foot_link" in done.err
    assert "knee_link lies on an axis" in brace(*new, "--urdf-tip", "knee_link").err


def test_a_travel_given_by_hand_is_not_read(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", YAW, HIP, _joint("knee", "0.1 0 0", "0 1 0", limit="0 120"), FOOT)
    new = "new", "--out", tmp_path / "limb.toml", "--urdf", robot, *PLANE
    assert "give --tibia-travel" in (done := brace(*new)).err and done.code == 3
    assert brace(*new, "--tibia-travel", "0deg", "120deg").code == 0


def test_a_leaning_knee_is_said_with_its_share_of_k(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    robot = _robot(tmp_path / "leg.urdf", HIP, _joint("knee", "0.1 0 0|0.02 0 0", "0 1 0"), FOOT)
    told = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *PLANE).out
    assert "knee's axis leans by 1.1 deg from hip's" in told and "2 x 0.05 / sin(theta2)" in told


def test_wide_limits_are_none_and_a_lean_or_offset_is_told(brace: Brace, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    wide = _joint("hip", "0.05 0.002 0", "0 1 0", limit="-9.42 9.42")
    robot = _robot(tmp_path / "leg.urdf", _joint("yaw", "0.1 0 0|0 0.02 0", "0 0 1"), wide, KNEE, FOOT)
    done = brace("new", "--out", tmp_path / "limb.toml", "--urdf", robot, *SPACE)
    assert done.code == 0, done.err
    assert "limits beyond a whole turn each way" in done.out
    assert "leans by 1.1 deg" in done.out and "2, 2, 2 mm aside" in done.out
    assert "2 x 14 mm / (tip's distance from its axis)" in done.out  # 2 mm, and twice 0.02 of the reach of 300
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
