"""The loading tests on the engine's limb against what must hold: the reference at finite displacements, the engine's
own sum of forces, and closed forms of friction, play and rig."""

from __future__ import annotations

import math

import numpy as np
import pytest

try:
    import mujoco  # noqa: F401
except ImportError as missing:
    pytest.skip(f"no physics engine ({missing}): .venv/bin/python -m pip install mujoco", allow_module_level=True)

from brace.native.loaded import under_displacement, under_force
from cases import limb_model
from engine_chain import Array
from engine_limb import engine_limb, equal_segments
from engine_plant import BEAM, k_under_load, play
from plant import INDEX, NEUTRAL
from rest import Engine

SEED = 77
STEPS = (0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0)
LIMB = {
    "geometry.femur_mm": 185.0,
    "geometry.tibia_mm": 313.5,
    "link.femur.axial_mm_per_n": 0.001,
    "link.femur.bending_mm_per_n": 0.06,
    "link.femur.moment_transfer": 1.0,
    "link.tibia.axial_mm_per_n": 0.002,
    "link.tibia.bending_mm_per_n": 0.25,
    "link.tibia.moment_transfer": 1.0,
    "joint.femur.compliance_rad_per_n_mm": 1.0e-5,
    "joint.tibia.compliance_rad_per_n_mm": 1.6e-5,
}
HEAVY = {"gravity.femur_n": 3.0, "gravity.tibia_n": 2.0, "gravity.knee_n": 1.5}
ON_A_BASE = {"base.x_mm_per_n": 2e-3, "base.z_mm_per_n": 3e-3, "base.rotation_rad_per_n_mm": 1e-6}


def limb(*parts: dict[str, float]) -> Array:
    """Parameters of the engine's limb."""
    p = NEUTRAL.copy()
    for part in (LIMB, *parts):
        for key, value in part.items():
            p[INDEX[key]] = value
    return p


def rows(poses: Array, step_mm: float = 0.635) -> Array:
    """A loading test at some poses, along both axes."""
    out: list[list[float]] = []
    for pose in poses:
        for axis in (0, 1):
            for step in STEPS:
                d = [0.0, 0.0]
                d[axis] = step * step_mm
                out.append([float(len(out) // len(STEPS)), *pose, 4.0 * len(out), 22.0, *d])
    return np.array(out)


@pytest.fixture
def poses() -> Array:
    """Postures from nearly straight to nearly folded."""
    return np.random.default_rng(SEED).uniform((-0.3, 0.45), (1.7, 2.75), (6, 2))


HALF_A_BEAM = {"link.femur.moment_transfer": 0.4, "link.tibia.tilt_rad": 0.2}


@pytest.mark.parametrize("part", [{}, HEAVY, ON_A_BASE | HEAVY, HALF_A_BEAM],
                         ids=["light", "heavy", "on a base", "half a beam"])  # fmt: skip
def test_force_at_a_held_tip(part: dict[str, float], poses: Array) -> None:
    """As the reference with the same segments: only rounding is between them."""
    table = rows(poses)
    expected = under_displacement(limb_model(LIMB | part), table[:, 1], table[:, 2], table[:, 5:7], parts=-10)
    np.testing.assert_allclose(play(limb(part), table, equal_segments(10))[:, :2], expected.force_n, rtol=0, atol=1e-7)


def test_the_beam_is_an_elastica(poses: Array) -> None:
    """What records are made with: n segments turn by 1/(4 n^2) too much under a moment, so no force is off by more than
    that share of the largest; twice as many come four times as near."""
    table = rows(poses)
    expected = under_displacement(limb_model(LIMB | HEAVY), table[:, 1], table[:, 2], table[:, 5:7]).force_n
    count = len(BEAM.at)
    beams = BEAM, equal_segments(2 * count)
    off, finer = (np.abs(play(limb(HEAVY), table, beam)[:, :2] - expected).max() for beam in beams)
    assert off < 0.25 / count**2 * np.abs(expected).max()
    assert finer == pytest.approx(off / 4.0, rel=0.15)


def test_the_engine_agrees_that_this_is_rest(poses: Array) -> None:
    """The engine's own sum of spring forces, weights and tip force brings the tip to where the record has it held."""
    table = rows(poses[:2])
    forces = play(limb(HEAVY), table)[:, :2]
    for row in range(0, len(table), 5):
        engine = Engine(engine_limb(LIMB | HEAVY, table[row, 1], table[row, 2], BEAM), np.array([0.0, 0.0, -1.0]))
        rest = engine.push(np.array([forces[row, 0], 0.0, forces[row, 1]]))
        np.testing.assert_allclose(rest.tip_mm[[0, 2]], table[row, 5:7], rtol=0, atol=1e-7)


def test_k_under_load(poses: Array) -> None:
    """K of the same segments is the reference's."""
    force = np.random.default_rng(SEED).normal(size=(len(poses), 2)) * 10.0
    expected = under_force(limb_model(LIMB | HEAVY), poses[:, 0], poses[:, 1], force, parts=-10).k_n_per_mm
    np.testing.assert_allclose(k_under_load(limb(HEAVY), poses, force, equal_segments(10)), expected, rtol=1e-6)


def test_friction_sticks_or_slides(poses: Array) -> None:
    """Rigid links: the knee's deflection is its encoder's. Torque less spring is within the friction; where the joint
    moved it is all of the friction, towards the motion."""
    stiff = {f"link.{link}.{key}_mm_per_n": 1e-6 for link in ("femur", "tibia") for key in ("axial", "bending")}
    coulomb, compliance = 200.0, LIMB["joint.tibia.compliance_rad_per_n_mm"]
    table = rows(poses)
    out = play(limb(stiff, {"joint.tibia.coulomb_n_mm": coulomb}), table)
    turned = out[:, 2] + out[:, 3]  # by which the tibia is turned
    angle = table[:, 1] - table[:, 2] + turned
    lever = LIMB["geometry.tibia_mm"] * np.column_stack([np.cos(angle), np.sin(angle)])
    rubbing = lever[:, 0] * out[:, 1] - lever[:, 1] * out[:, 0] - out[:, 3] / compliance
    slack = 0.02 * coulomb  # the links' own bending
    assert np.all(np.abs(rubbing) <= coulomb + slack)
    moved = np.diff(out[:, 3], prepend=0.0) * (table[:, 0] == np.roll(table[:, 0], 1))
    slid = np.abs(moved) > 1e-6
    assert slid.sum() > len(table) // 2
    np.testing.assert_allclose(rubbing[slid], np.sign(moved[slid]) * coulomb, rtol=0, atol=slack)


def test_friction_sticks_until_it_slides(poses: Array) -> None:
    """Elastic links let the knee stand while the tip moves: there it may carry up to its friction more than its spring,
    and no more. The knee's own way of a few mm, times the force, is all that the undeflected lever leaves out."""
    coulomb, compliance = 2000.0, LIMB["joint.tibia.compliance_rad_per_n_mm"]
    table = rows(poses)
    out = play(limb({"joint.tibia.coulomb_n_mm": coulomb}), table)
    angle = table[:, 1] - table[:, 2]
    lever = LIMB["geometry.tibia_mm"] * np.column_stack([np.cos(angle), np.sin(angle)]) + table[:, 5:7]
    rubbing = lever[:, 0] * out[:, 1] - lever[:, 1] * out[:, 0] - out[:, 3] / compliance
    slack = 3.0 * np.linalg.norm(out[:, :2], axis=1)
    assert np.all(np.abs(rubbing) <= coulomb + slack)
    stands = (np.abs(np.diff(out[:, 3], prepend=0.0)) < 1e-12) & (table[:, 0] == np.roll(table[:, 0], 1))
    assert stands.sum() > len(table) // 4
    assert np.abs(rubbing[stands]).max() > 0.7 * coulomb


def test_friction_carried_from_run_to_run(poses: Array) -> None:
    """Without it every run begins without force; with it a later run does not, by no more than the friction holds."""
    part = {"joint.femur.coulomb_n_mm": 300.0}
    table = rows(poses)
    fresh, carried = (play(limb(part, {"outside.friction_carried": kept}), table) for kept in (0.0, 1.0))
    begins = np.flatnonzero(table[:, 0] != np.roll(table[:, 0], 1))
    assert np.abs(fresh[begins, :2]).max() < 1e-9
    assert np.abs(carried[begins[0], :2]).max() < 1e-9
    assert np.abs(carried[begins[1:], :2]).max() > 0.1
    np.testing.assert_array_less(np.abs(carried[begins, 2]), 300.0 * 1e-5 + 1e-9)


def test_play_carries_nothing() -> None:
    """The tip moves freely by half the gap times the knee's lever, across the tibia; then the spring carries."""
    gap = 0.01
    pose = np.array([[0.4, 1.1]])
    free_mm = 0.5 * gap * LIMB["geometry.tibia_mm"]
    across = np.array([-math.sin(0.4 - 1.1), math.cos(0.4 - 1.1)])
    distances = np.array([0.0, 0.5, 0.9, 1.5]) * free_mm
    table = np.array([[0.0, *pose[0], 0.0, 22.0, *(across * d)] for d in distances])
    forces = np.linalg.norm(play(limb({"joint.tibia.gap_rad": gap}), table)[:, :2], axis=1)
    # the arc leaves the straight way by d^2 / 2 L, which the stiff links resist
    assert np.all(forces[:3] < 1e3 * distances[:3] ** 2 / LIMB["geometry.tibia_mm"] * 0.05 + 1e-9)
    assert forces[3] > 0.1


def test_a_rig_that_yields_is_a_base_that_does(poses: Array) -> None:
    """Both are springs that turn nothing."""
    table, mm_per_n = rows(poses), 0.03
    base = {"base.x_mm_per_n": mm_per_n, "base.z_mm_per_n": mm_per_n}
    np.testing.assert_allclose(
        play(limb({"outside.rig_mm_per_n": mm_per_n}), table)[:, :2], play(limb(base), table)[:, :2], rtol=0, atol=1e-8
    )


def test_a_turned_rig_is_a_turned_limb(poses: Array) -> None:
    """A rig that moves along axes turned one way sees a limb turned the other way, and a sensor that is turned."""
    table, turn = rows(poses), 0.04
    other = {"joint.femur.zero_offset_rad": -turn, "sensor.rotation_rad": turn}
    np.testing.assert_allclose(
        play(limb({"outside.rig_turn_rad": turn}), table)[:, :2], play(limb(other), table)[:, :2], rtol=0, atol=1e-8
    )


def test_creep_relaxes() -> None:
    """Long after a step the drives are softer by their creep's ratio, just after it as stiff as without."""
    pose, ratio = [0.4, 1.1], 0.3
    table = np.array([[0.0, *pose, 0.0, 22.0, 0.0, 0.0]] + [[0.0, *pose, t, 22.0, 0.0, 1.0] for t in (1e-3, 1e4, 2e4)])
    forces = play(limb({"creep.ratio": ratio, "creep.time_constant_s": 20.0}), table)[:, :2]
    softer = {f"joint.{joint}.compliance_rad_per_n_mm": (1.0 + ratio) * LIMB[f"joint.{joint}.compliance_rad_per_n_mm"]
              for joint in ("femur", "tibia")}  # fmt: skip
    np.testing.assert_allclose(forces[1], play(limb(), table[1:2])[0, :2], rtol=0, atol=1e-3)
    # the delayed part follows the elastic one of the row before: two rows reach its end but for ratio^2
    np.testing.assert_allclose(forces[3], play(limb(softer), table[1:2])[0, :2], rtol=0.03)


def test_a_hanging_limb_is_taken_hold_of_without_force(poses: Array) -> None:
    """Held at rest, runs begin without force; held at the weightless place they begin with the weight's."""
    table = rows(poses)
    at_rest = play(limb(HEAVY, {"outside.held_at_rest": 1.0}), table)
    begins = np.flatnonzero(np.all(table[:, 5:7] == 0.0, axis=1))
    assert np.abs(at_rest[begins, :2]).max() < 1e-7
    assert np.abs(play(limb(HEAVY), table)[begins, :2]).min(axis=0).max() > 0.1
