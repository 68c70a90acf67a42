"""The judge's own truth against closed cases, another engine and `brace k`; a wrong truth would judge wrongly."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import truth
import world
from limbs import Array, Limbs, compliance, loaded, small
from truth import NoStance, Siconos, World, first_slip, payload, stand

BRACE = Path(sys.executable).parent / "brace"
HEIGHT_MM = 130.0  # of the plain body's origin above its feet
CLOSED_N = 1e-4  # the truth's own residual is 1e-7, in moments 1e-5 N mm at levers of 100 mm


def plain(feet_mm: list[tuple[float, float]], stiffness: float | list[float] = 10.0, **changes: object) -> World:
    """A body of 30 N on limbs equally stiff [N/mm] in all directions, its centre of mass at the feet's height."""
    n = len(feet_mm)
    limbs = Limbs(np.array([[1e-9, 100.0, HEIGHT_MM]] * n), np.array([[0, 0, np.pi / 2]] * n), np.zeros((n, 3)),
                  np.ones((n, 2, 3)) / (2 * np.broadcast_to(stiffness, n)[:, None, None]), np.zeros((n, 3)))
    mount = np.array([[x - 100, y, 0] for x, y in feet_mm], dtype=float)
    is_at = World(
        limbs=limbs, zero_rad=np.zeros((n, 3)), mount_mm=mount, turn=np.array([np.eye(3)] * n),
        commanded_mm=mount + small(limbs, np.zeros((n, 3)))[0], offset_mm=np.zeros((n, 3)),
        normal=np.array([[0, 0, 1.0]] * n), friction=np.full(n, 0.5), grip_n=np.zeros(n),
        weight_n=np.array([0, 0, -30.0]), com_mm=np.array([0, 0, -HEIGHT_MM]),
        payload_n=np.array([10.0, 0, 0]), payload_at_mm=np.array([0, 0, -HEIGHT_MM]),
        finite=False)
    return replace(is_at, **changes)  # type: ignore[arg-type]


SQUARE = [(100.0, 100.0), (-100.0, 100.0), (-100.0, -100.0), (100.0, -100.0)]
TRIANGLE = [(100 * np.cos(a), 100 * np.sin(a)) for a in np.radians([0, 120, 240])]


@pytest.mark.parametrize("finite", [False, True])
def test_a_block_on_a_slope_slides_at_its_friction(solver: Siconos, finite: bool) -> None:
    def leans(angle: float) -> World:
        return plain(SQUARE, 1e3, weight_n=30 * np.array([np.sin(angle), 0, -np.cos(angle)]), finite=finite)
    steep = np.arctan(0.5)
    state = stand(leans(steep - 0.02), solver)
    assert np.abs(state.force_n[:, 0] + 7.5 * np.sin(steep - 0.02)).max() < 1e-2 and not state.slipped.any()
    with pytest.raises(NoStance):
        stand(leans(steep + 0.02), solver)


def test_a_pull_slides_a_block_when_it_is_friction_times_weight(solver: Siconos) -> None:
    block = plain(SQUARE)
    slip = first_slip(block, solver, stand(block, solver), 20.0)
    assert slip is not None and slip.factor == pytest.approx(1.5, rel=1e-3)


def test_three_equal_limbs_share_by_levers(solver: Siconos) -> None:
    off_centre = plain(TRIANGLE, payload_n=np.array([0, 0, -10.0]), payload_at_mm=np.array([50.0, 0, 0]))
    force = payload(off_centre, solver, stand(off_centre, solver), 0, 1, 3).force_n
    assert force[:, 2] == pytest.approx([10 + 20 / 3, 10 + 5 / 3, 10 + 5 / 3], abs=CLOSED_N)
    # A pull of 5 N at y = 20 turns by -100 N mm about the vertical: the feet bear M / 3 R along their circle against
    # it.
    at = np.array([0, 20.0, -HEIGHT_MM])
    turned = plain(TRIANGLE, friction=np.full(3, 0.5), payload_at_mm=at, payload_n=np.array([10.0, 0, 0]))
    state = payload(turned, solver, stand(turned, solver), 0, 0.5, 1)
    angle = np.radians([0, 120, 240])
    along_circle = 100 / 300 * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    assert np.abs(state.force_n[:, :2] - (along_circle - [[5 / 3, 0]])).max() < CLOSED_N


def test_a_beam_on_three_springs(solver: Siconos) -> None:
    k = np.array([2.0, 10.0, 5.0])
    beam = plain([(x, y) for y in (-80.0, 80.0) for x in (-100.0, 0.0, 100.0)], [*k, *k],
                 com_mm=np.array([30.0, 0, -HEIGHT_MM]))
    x = np.array([-100.0, 0, 100])
    sag = np.linalg.solve([[k.sum(), k @ x], [k @ x, k @ x**2]], [15.0, 15.0 * 30])
    assert stand(beam, solver).force_n[:, 2] == pytest.approx(np.tile(k * (sag[0] + sag[1] * x), 2), abs=CLOSED_N)


def test_slip_leaves_its_history(solver: Siconos) -> None:
    """Two feet of friction 0.2 slide at 1.5 N, the others take the rest; unloaded, they press on one another."""
    pulled = plain(SQUARE, friction=np.array([0.2, 0.5, 0.5, 0.2]))
    state = stand(pulled, solver)
    slip = first_slip(pulled, solver, state, 5.0)
    assert slip is not None and slip.factor == pytest.approx(0.6, rel=1e-3) and slip.foot in (0, 3)
    there = payload(pulled, solver, state, 0, 0.9, 9)
    assert -there.force_n[:, 0] == pytest.approx([1.5, 3.0, 3.0, 1.5], abs=CLOSED_N)
    assert list(there.slipped) == [True, False, False, True]
    back = payload(pulled, solver, there, 0.9, 0, 9)
    assert -back.force_n[:, 0] == pytest.approx([-0.75, 0.75, 0.75, -0.75], abs=CLOSED_N)


def test_a_foot_over_a_hollow_bears_nothing_and_comes_back(solver: Siconos) -> None:
    """A table on springs of k: a foot that the ground misses by d bears less by k d / 4, down to nothing."""
    low = np.array([[0, 0, -1.0], *[[0, 0, 0]] * 3])
    assert stand(plain(SQUARE, offset_mm=low), solver).force_n[:, 2] == pytest.approx([5, 10, 5, 10], abs=CLOSED_N)
    hollow = plain(SQUARE, offset_mm=4 * low, payload_n=np.array([0, 0, -10.0]), payload_at_mm=np.array([60.0, 60, 0]))
    state = stand(hollow, solver)
    assert state.force_n[:, 2] == pytest.approx([0, 15, 0, 15], abs=CLOSED_N)
    # Off the diagonal the body tips until the foot touches, and then it bears all of the moment's half.
    assert payload(hollow, solver, state, 0, 3, 6).force_n[0, 2] > 5


def test_a_grip_holds_up_to_its_limit_and_is_gone_for_good(solver: Siconos) -> None:
    hung = plain(TRIANGLE, weight_n=np.array([0, 0, 30.0]), com_mm=np.zeros(3), grip_n=np.array([15.0, 40, 40]),
                 payload_n=np.array([0, 0, 10.0]), payload_at_mm=np.array([0, 0, 0.0]))
    slip = first_slip(hung, solver, stand(hung, solver), 5.0)
    assert slip is not None and slip.foot == 0 and slip.factor == pytest.approx(1.5, rel=1e-3)
    lost = replace(plain(SQUARE), weight_n=hung.weight_n, com_mm=np.zeros(3), grip_n=np.array([7.0, 40, 40, 40]),
                   friction=np.full(4, 5.0))
    gone = stand(lost, solver)
    assert list(gone.gone) == [True, False, False, False] and not gone.force_n[0].any()


def test_the_laws_residual_sees_a_wrong_force(solver: Siconos) -> None:
    drawn = world.draw(5, 4)
    state = stand(drawn.world, solver)
    assert state.residual_n < truth.BALANCE_N
    friction, one = np.array([0.5]), np.ones(1)
    slides = np.array([[2.0, 1, 0]]), np.array([[0, -0.3, 0]])
    assert truth.law_residual_n(*slides, friction, one) < 1e-12
    for force, apart in (([2.0, 1.1, 0], [0, -0.3, 0]), ([2.0, 1, 0], [0, 0.3, 0]), ([2.0, 0.9, 0], [0, -0.3, 0]),
                         ([-0.1, 0, 0], [0, 0, 0]), ([2.0, 0, 0], [0.1, 0, 0]), ([0, 0, 0], [-0.1, 0, 0])):
        assert truth.law_residual_n(np.array([force]), np.array([apart]), friction, one) > 0.04, (force, apart)


def _mujoco_forces(drawn: world.Stance, factor: float) -> Array:
    """The ground's forces on feet that are tied to their footholds, from the joints' deflections at rest."""
    mujoco = pytest.importorskip("mujoco")
    is_at, limbs, m = drawn.world, drawn.world.limbs, 1e-3

    def said(values: Array) -> str:
        return " ".join(repr(float(value)) for value in values)

    parts, ties = [], []
    for i, (coxa, femur, tibia) in enumerate((limbs.length_mm * m).tolist()):
        yaw, pitch, knee = limbs.theta_rad[i]
        k = m / limbs.joint_rad_per_n_mm[i]
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, is_at.turn[i].ravel())
        light = '<inertial pos="0 0 0" mass="0.002" diaginertia="1e-6 1e-6 1e-6"/>'
        joint = [f'<joint type="hinge" axis="{axis}" stiffness="{float(stiff)!r}" damping="1" armature="0.002"/>'
                 for axis, stiff in zip(("0 0 1", "0 -1 0", "0 1 0"), k)]
        parts.append(f'''<body pos="{said(is_at.mount_mm[i] * m)}" quat="{said(quat)}">
          <body euler="0 0 {float(yaw)!r}">{light}{joint[0]}
            <body pos="{coxa!r} 0 0" euler="0 {-float(pitch)!r} 0">{light}{joint[1]}
              <body pos="{femur!r} 0 0" euler="0 {float(knee)!r} 0">{light}{joint[2]}
                <site name="tip{i}" pos="{tibia!r} 0 0"/>
          </body></body></body></body>''')
        ties.append(f'<connect site1="tip{i}" site2="hold{i}" solref="0.004 1" solimp="0.9999 0.9999 0.001 0.5 2"/>')
    holds = "".join(f'<site name="hold{i}" pos="{said(at * m)}"/>' for i, at in enumerate(is_at.commanded_mm))
    model = mujoco.MjModel.from_xml_string(f'''<mujoco><compiler angle="radian"/>
      <option timestep="0.001" gravity="0 0 0" integrator="implicitfast" iterations="200" tolerance="1e-14"/>
      <worldbody>{holds}<body name="body"><freejoint/><inertial pos="0 0 0" mass="3" diaginertia="0.02 0.02 0.02"/>
      {"".join(parts)}</body></worldbody><equality>{"".join(ties)}</equality></mujoco>''')
    data = mujoco.MjData(model)
    body = model.body("body").id
    for _ in range(8000):
        for force, at in ((is_at.weight_n, is_at.com_mm), (factor * is_at.payload_n, is_at.payload_at_mm)):
            place = data.xpos[body] + data.xmat[body].reshape(3, 3) @ at * m
            mujoco.mj_applyFT(model, data, force, np.zeros(3), place, body, data.qfrc_applied)
        data.qfrc_applied[:6] -= np.repeat([20.0, 1.0], 3) * data.qvel[:6]
        mujoco.mj_step(model, data)
        data.qfrc_applied[:] = 0
    assert np.abs(data.qvel).max() < 1e-5
    forces = np.zeros_like(is_at.commanded_mm)
    for i, at in enumerate(is_at.commanded_mm):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, None, model.site(f"tip{i}").id)
        assert np.abs(data.site(f"tip{i}").xpos - at * m).max() < 2e-6
        joints = slice(6 + 3 * i, 9 + 3 * i)
        deflection = data.qpos[7 + 3 * i:10 + 3 * i]
        forces[i] = np.linalg.solve(jacobian[:, joints].T, m / limbs.joint_rad_per_n_mm[i] * deflection)
    return forces


@pytest.mark.parametrize("number", [4, 9])
def test_feet_that_stick_bear_what_an_engine_says(solver: Siconos, number: int) -> None:
    """Any displacement, joints elastic and links rigid; the tie of the engine gives way by up to 2 micrometres."""
    drawn = world.draw(5, number, world.Hidden.none())
    limbs = replace(drawn.world.limbs, link_mm_per_n=0 * drawn.world.limbs.link_mm_per_n)
    sticks = replace(drawn, world=replace(drawn.world, limbs=limbs, friction=np.full(len(drawn.friction), 50.0),
                                          grip_n=np.full(len(drawn.friction), 100.0)))
    ours = payload(sticks.world, solver, stand(sticks.world, solver), 0, 1, 2).force_n
    assert np.abs(ours - _mujoco_forces(sticks, 1.0)).max() < 0.02


@pytest.mark.parametrize("number", range(4))
def test_brace_k_is_the_limbs_k(number: int, tmp_path: Path) -> None:
    """At no load and under one, in the limb's frame: files that are written say what the world has."""
    drawn = world.draw(7, number, world.Hidden.none())
    world.write(drawn, tmp_path)
    force = np.random.default_rng(number).normal(0, 3, 3)
    for i in (0, 1):
        limbs = drawn.nominal.take([i])
        theta = limbs.theta_rad[0]
        yaw = theta[0]
        # --fx is in the limb's plane
        back = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
        ask = [str(BRACE), "k", "--model", str(tmp_path / f"limb{i}.toml"), "--json", "--theta0", repr(float(theta[0])),
               "--theta1", repr(float(theta[1])), "--theta2", repr(float(theta[2]))]
        loads = [f"--f{axis}={float(value)!r}" for axis, value in zip("xyz", force)]
        under_load = loaded(limbs, (back @ force)[None], np.zeros((1, 9)))[1][0]
        for more, c, least in (([], compliance(limbs)[0], 1e-5), (loads, under_load, 1e-4)):
            said = json.loads(subprocess.run([*ask, *more], capture_output=True, text=True, check=True).stdout)
            k = np.array([[said[f"k_{''.join(sorted(a + b))}_n_per_mm"] for b in "xyz"] for a in "xyz"])
            ours: Array = np.linalg.inv(c)
            assert np.abs(k - ours).max() < least * np.abs(ours).max(), (more, k, ours)
