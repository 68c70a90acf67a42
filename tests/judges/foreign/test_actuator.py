"""The actuator simulator against closed forms, and what the generator writes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import instruments
import joints
import numpy as np
import pytest
import sets
from actuator import Bench, Joint, Test, at_rest, play, read

STIFF, FULL = 2e5, 6000.0
SLOW = Bench(False, 0.01, 0.0, 0.0, 0.0)
BY_TORQUE = replace(SLOW, torque_driven=True, interval_s=0.004)
UP_AND_DOWN = Test(0.03, 0.05, 2)


def spring(angle: np.ndarray, gap: float = 0.0) -> np.ndarray:
    """Torque of a spring behind play."""
    return np.asarray(STIFF * np.sign(angle) * np.maximum(0.0, np.abs(angle) - 0.5 * gap))


def test_spring_behind_play() -> None:
    """Position-driven, without friction: the torque is the spring's."""
    joint = Joint(STIFF, gap=0.01, zero=0.1, inertia=0.0)
    _, angle, torque = play(joint, UP_AND_DOWN, SLOW)
    assert torque == pytest.approx(spring(angle - 0.1, 0.01), abs=1e-6)


def test_torque_driven_joint_stands_where_the_spring_has_the_torque() -> None:
    """A motor of 0.5 kg m2 swings by less than a hundredth of the reach at such rates."""
    joint = Joint(STIFF, hardening=2e8, inertia=5.0, viscous=50.0)
    _, angle, torque = play(joint, Test(FULL, 0.05, 2), BY_TORQUE)
    assert STIFF * angle + 2e8 * angle**3 == pytest.approx(torque, abs=0.01 * FULL)


@pytest.mark.parametrize("maxwell", [0.0, 1.0])
def test_friction_slips_at_its_level(maxwell: float) -> None:
    """Both laws: from one flank to the other the torque jumps by twice the level, which grows with the load."""
    joint = Joint(STIFF, coulomb=400.0, per_load=0.1, bristle=1e6, maxwell=maxwell, inertia=0.0)
    _, angle, torque = play(joint, UP_AND_DOWN, SLOW)
    rubs, level = torque - spring(angle), 400.0 + 0.1 * np.abs(spring(angle))
    going = np.gradient(angle)
    for sign in (1.0, -1.0):
        at = int(np.flatnonzero((np.abs(angle - sign * 0.02) < 3e-4) & (sign * going > 0))[-1])
        assert rubs[at] == pytest.approx(sign * level[at], rel=0.03)
    assert np.all(np.abs(rubs) < 1.05 * level)


def test_friction_holds_before_it_slips() -> None:
    """A hundredth of the sliding distance: the joint is stiffer by the bristles, but for a hundredth at each turn."""
    joint = Joint(STIFF, coulomb=400.0, bristle=1e6, inertia=0.0)
    _, angle, torque = play(joint, Test(4e-6, 0.05, 1), SLOW)
    assert torque == pytest.approx((STIFF + 1e6) * angle, rel=0.01, abs=0.05)


def test_slider_behind_free_travel() -> None:
    """Free travel after each reversal, then constant friction."""
    joint = Joint(1.0, slip=0.02, slip_torque=500.0, slip_stiffness=1e7, inertia=0.0)
    _, angle, torque = play(joint, UP_AND_DOWN, SLOW)
    assert np.max(np.abs(torque)) == pytest.approx(500.0, rel=0.01)
    top, bottom = int(np.argmax(angle)), int(np.argmin(angle))
    down, pushes = angle[top:bottom], torque[top:bottom]
    lets_go, takes_hold = down[pushes < 250.0][0], down[pushes < -250.0][0]
    assert lets_go - takes_hold == pytest.approx(0.02 + 5e-5, abs=1.2e-4)  # a reading is 6e-5 rad from the next
    assert np.all(np.abs(pushes[(down < lets_go - 2e-4) & (down > takes_hold + 2e-4)]) < 1.0)


def test_standing_still_nothing_creeps() -> None:
    """While the drive stands at a reversal, neither angle nor torque moves: what a tool calls creep there is none."""
    joint = Joint(STIFF, coulomb=400.0, bristle=1e6, bristle_damping=300.0, inertia=5.0)
    test = Test(FULL, 0.1, 1, "ramp", hold_s=4.0)
    command, angle, _ = play(joint, test, BY_TORQUE)
    held = np.flatnonzero(command == FULL)[250:]
    assert len(held) > 500
    assert np.ptp(angle[held]) < 1e-3 * np.ptp(angle)


def test_late_and_coarse_readings() -> None:
    """The torque column is that of an earlier moment, the angle in whole counts."""
    how = replace(SLOW, late_s=0.05, count_rad=0.001)
    record = read(np.random.default_rng(1), [Joint(STIFF, inertia=0.0)], [UP_AND_DOWN], how)
    angle, torque = record.columns["angle_rad"], record.columns["torque_n_mm"]
    assert angle == pytest.approx(np.round(angle / 0.001) * 0.001, abs=1e-12)
    assert torque[100:400] == pytest.approx(play(Joint(STIFF, inertia=0.0), UP_AND_DOWN, SLOW)[2][95:395], abs=1e-6)


def test_every_joint_kind_is_made_alike_from_its_seed() -> None:
    """All kinds can be made, are finite, and come out the same twice."""
    for makers in (joints.NAMED, joints.TROUBLED, joints.OUTSIDE, joints.EVIDENCE, joints.POSITIONS):
        for maker in makers.values():
            one, two = (maker(np.random.default_rng([5, 7])) for _ in range(2))
            for name, values in one.record.columns.items():
                assert np.all(np.isfinite(values)), name
                assert np.array_equal(values, two.record.columns[name]), name
            assert np.all(np.diff(one.record.columns["t_s"]) > 0.0)
            assert one.size == two.size


def test_a_joint_starts_from_rest() -> None:
    """Unloaded, in the middle of its play, wherever its zero is."""
    joint = Joint(STIFF, gap=0.01, zero=0.3, inertia=5.0, viscous=50.0)
    _, angle, _ = play(joint, Test(0.0, 0.1, 1), BY_TORQUE, at_rest(joint))
    assert angle == pytest.approx(0.3, abs=1e-12)


def test_every_trouble_is_in_the_record(tmp_path: Path) -> None:
    """What a limb's readings show of it is measured in sigmas; the others are seen in the file."""
    pytest.importorskip("mujoco")
    none = instruments.drawn([31, 1], "", None)
    for kind in instruments.TROUBLES:
        made = instruments.drawn([31, 1], kind, None)
        about, forces = made.truth["about"], np.array([made.table["fx_n"], made.table["fz_n"]])
        if kind == "clock_origin":
            assert made.table["t_s"][0] == pytest.approx(about["start_s"] + none.table["t_s"][0])
        elif kind == "coarse_resolution":
            assert forces / about["step_n"] == pytest.approx(np.round(forces / about["step_n"]), abs=1e-9)
        elif kind == "outliers":
            usual = np.array([none.table["fx_n"], none.table["fz_n"]])
            most = np.max(np.abs(usual), axis=1, keepdims=True)
            assert np.sum(np.abs(forces - usual) > 0.08 * most) == about["count"]
        else:
            assert made.truth["trouble_s"] > 3.0, kind
    case = sets.Case(31, "sound", "sound", 0)
    case.write(tmp_path)
    before = (tmp_path / "cases" / case.name / "data.csv").read_bytes()
    case.write(tmp_path)
    assert (tmp_path / "cases" / case.name / "data.csv").read_bytes() == before
