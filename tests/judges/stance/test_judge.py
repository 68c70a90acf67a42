"""What the judge counts: a right answer and no wrong one; the others' laws against answers known without them."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("daqp", reason="daqp is not installed: pip install -e 'tools[stance]'")

import alarms
import baselines
import judge
import limbs
import servos
import truth
import world
from truth import Siconos

BRACE = Path(sys.executable).parent / "brace"
EXACT = judge.Asked(3, world.Hidden.none(), False, True, [str(BRACE)])


def _cases(asked: judge.Asked, solver: Siconos, count: int) -> list[judge.Case]:
    found: list[judge.Case] = []
    number = 0
    while len(found) < count:
        one = judge.case(asked, number, solver)
        found += [one] if one else []
        number += 1
    return found


def test_a_row_counts_right_and_wrong() -> None:
    change = [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, 3.0]]
    truth = judge.Case(0, "floor", 1, 1.2, 0.2, 10.0, change, change, 0.0)
    right = judge.Said(1, 1.21, [[0.0, 0.0, 1.4], [0.0, 0.0, 2.0], [0.0, 0.0, 3.6]], (1.1, 1.3),
                       force_low_n=change, force_high_n=change)
    wrong = judge.Said(0, 1.5, None)
    laws = ("brace", "convex", "rigid")
    row = judge.table([replace(truth, said=dict.fromkeys(laws, right)),
                       replace(truth, spare=0.01, said=dict.fromkeys(laws, wrong))]).splitlines()
    cells = [cell.split(" (")[0].strip() for cell in row[2].split("|")[2:-1]]
    assert cells == ["100.0 %", "50.0 %", "50.0 %", "33.3 %", "-"]
    assert "forces hold in 100.0 %" in row[6] and "of the factor in 100.0 %" in row[6]


def test_changes_are_counted_by_foot_of_the_payload_and_of_the_weight() -> None:
    """The lifted foot itself does not count; a law without an answer has none right."""
    change = [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0, 0.0, -3.0]]
    said = judge.Said(0, 1.2, change)
    near = [[0.0, 0.0, 1.4], [0.0, 0.0, 3.2], [0.0, 0.0, 9.0]]  # 4 and 12 % of the payload, 1.6 and 4.8 % of the weight
    moves = [judge.Change("lift", 2, False, change, {"brace": near, "convex": None}),
             judge.Change("set-point", 0, True, change, {"brace": change, "convex": near}, "")]
    case = judge.Case(0, "floor", 1, 1.2, 0.2, 10.0, change, change, 0.0,
                      dict.fromkeys(("brace", "convex", "rigid"), said), moves, 25.0)
    cells = [[cell.split(" (")[0].strip() for cell in row.split("|")] for row in judge.changes_table([case])[2:]]
    rows = {(row[1], row[2]): row[3:8] for row in cells}
    assert rows["lift", "brace"] == ["50.0 %", "-", "50.0 %", "12.0 %", "100.0 %"]
    assert rows["lift", "convex"] == ["0.0 %", "-", "0.0 %", "inf %", "0.0 %"]
    assert rows["set-point", "brace"] == ["-", "100.0 %", "100.0 %", "0.0 %", "100.0 %"]
    assert rows["set-point", "convex"] == ["-", "33.3 %", "33.3 %", "120.0 %", "66.7 %"]
    assert rows["all three", "brace"][2] == "87.5 %"


def test_a_command_that_fails_is_named(solver: Siconos) -> None:
    fails = [sys.executable, "-c", "raise SystemExit('no such verb')"]
    one = _cases(replace(EXACT, brace=fails), solver, 1)[0]
    assert one.said["brace"].failed == "exit 1: no such verb" and "no such verb" in judge.table([one])


def test_the_convex_law_is_right_until_a_foot_slips(solver: Siconos) -> None:
    """In a world of small displacements, nothing hidden; its cones have 24 faces, within the round ones by 0.9 %."""
    for one in _cases(EXACT, solver, 3):
        said = one.said["convex"]
        assert said.factor is not None and 0.95 * one.factor < said.factor < one.factor
        assert one.spare < 0.02 or said.foot == one.foot
        off = np.abs(np.array(said.change_n) - np.array(one.change_n)).max()
        assert one.factor < 1 or off < 0.01 * one.payload_n
        assert one.said["rigid"].factor is not None and one.said["rigid"].factor > 0.98 * one.factor


def test_the_rigid_body_bears_what_any_forces_bear() -> None:
    """Three feet, a pull along the ground at its height: friction times weight, less what 24 faces take away."""
    stance = world.draw(3, 0, world.Hidden.none(), finite=False)
    feet = np.array([[100.0, 0, 0], [-50, 87, 0], [-50, -87, 0]])
    flat = replace(stance.world, commanded_mm=feet, normal=np.array([[0, 0, 1.0]] * 3), grip_n=np.zeros(3),
                   weight_n=np.array([0, 0, -30.0]), com_mm=np.zeros(3), payload_n=np.array([10.0, 0, 0]),
                   payload_at_mm=np.zeros(3))
    law = baselines.rigid(replace(stance, world=flat, friction=np.full(3, 0.5)))
    assert law.factor == pytest.approx(1.5 * np.cos(np.pi / 24), rel=1e-6)


def test_the_command_names_the_foot(solver: Siconos) -> None:
    """A few stances with nothing hidden: each foot's change and the payload at which one slips."""
    if subprocess.run([BRACE, "stance", "load", "--help"], capture_output=True).returncode:
        pytest.skip("brace has no 'stance load' yet")
    for one in _cases(replace(EXACT, finite=True, seed=4), solver, 3):
        said = one.said["brace"]
        assert not said.failed
        assert one.spare < judge.NEAR or said.foot == one.foot, (one.number, one.kind)
        assert said.factor is not None and abs(said.factor / one.factor - 1) < 0.05, (one.number, one.kind)


def test_the_command_says_what_a_set_point_and_a_lift_change(solver: Siconos) -> None:
    """With nothing hidden; forces of feet that slide as another lets go hang on how it does."""
    asked = replace(EXACT, finite=True, seed=6, changes=True)
    those = [change for one in _cases(asked, solver, 2) for change in one.changes]
    assert {change.kind for change in those} == {"set-point", "lift"}
    for change in those:
        off = np.linalg.norm(np.array(change.said["brace"]) - change.change_n, axis=1)[change.feet()]
        assert off.max() < (0.5 if change.slipped else 0.03), (change, off)


def test_a_lifted_foot_leaves_what_the_feet_bear_without_it(solver: Siconos) -> None:
    """Stuck feet of linear limbs: the same as where the others were put down without it."""
    for number in range(40):
        drawn = world.draw(8, number, world.Hidden.none(), finite=False)
        bare = replace(drawn.world, payload_n=np.zeros(3))
        if len(bare.friction) < 4:
            continue
        try:
            before = truth.stand(bare, solver, 2)
            after = truth.lift(bare, solver, before, 0)
        except truth.NoStance:
            continue
        assert not after.force_n[0].any() and after.gone[0]
        assert np.abs(after.force_n.sum(axis=0) + bare.weight_n).max() < 1e-6
        if before.slipped.any() or after.slipped.any():
            continue
        gone = replace(truth.begin(bare), gone=after.gone)
        anew = truth.step(bare, solver, gone, 1.0, 0.0)
        if not anew.slipped.any():
            assert after.force_n == pytest.approx(anew.force_n, abs=1e-4)
            return
    raise AssertionError("no foot can be lifted")


def test_a_current_says_no_more_than_the_published_friction_lets_it() -> None:
    """Torques that may hold a load of 2 N m, by hand from model M5; and where none of it rubs, currents are loads."""
    rng = np.random.default_rng(1)
    drawn = servos.Servos.draw(rng, 1)
    m5 = {name: np.array([servos.fits()[0].get(name, 0.0)]) for name in drawn.fit}
    one = replace(drawn, constant=m5["kt"], factor=np.ones(1), fit=m5)
    load, a, b, c = 2.0, 0.2076 + 0.1952, 0.0227 + 0.0849, 0.1224
    assert one.end(np.array([load]), -1.0) == pytest.approx((load * (1 - b) - c) / (1 + a), rel=1e-3)
    assert one.end(np.array([load]), 1.0) == pytest.approx((load * (1 + b) + c) / (1 - a), rel=1e-3)
    grown = one.torques(rng, [np.array([load])])
    assert grown == pytest.approx(one.end(np.array([load]), -1.0))  # a load that has only grown
    fallen = [one.torques(rng, [np.array([most]), np.array([load])]) for most in (5.0, 10.0)]
    assert fallen[0] == pytest.approx(one.end(np.array([5.0]), -1.0))  # friction holds it all the way back
    assert fallen[1] == pytest.approx(one.end(np.array([load]), 1.0))
    free = replace(one, factor=np.zeros(1))
    read = free.read_n_mm(rng, free.torques(rng, [np.array([load])]))
    assert read == pytest.approx(1000 * load, abs=4 * 1e3 * 2.2 * servos.CURRENT_NOISE_A)


def test_loads_of_joints_are_a_forces_work(solver: Siconos) -> None:
    """A joint that turns a little under a force: work over angle, in the finite world, under load."""
    drawn = world.draw(3, 3, world.Hidden.none())
    state = truth.begin(drawn.world)
    force = np.array([[1.0, -2.0, 5.0]] * len(drawn.friction))
    by = truth.by_joints(drawn.world, state)
    for joint in range(3):
        turned = drawn.nominal.theta_rad + 1e-6 * np.eye(3)[joint]
        tips = [limbs.small(replace(drawn.nominal, theta_rad=theta), 0 * force)[0]
                for theta in (drawn.nominal.theta_rad, turned)]
        way = np.einsum("nab,nb->na", drawn.world.turn, tips[1] - tips[0])
        assert (force * way).sum(axis=1) / 1e-6 == pytest.approx((by[:, joint] * force).sum(axis=1), rel=1e-4, abs=1e-2)


def test_currents_are_asked_and_forces_counted(solver: Siconos) -> None:
    hidden = world.Hidden(tells_play=True, currents=True)
    one = _cases(replace(EXACT, hidden=hidden, seed=7), solver, 1)[0]
    said = one.said["brace"]
    assert not said.failed and said.before_n is not None
    width = np.array(said.before_high_n) - np.array(said.before_low_n)
    assert np.median(width) > 1.0  # a sensor of 0.3 N has less
    text = judge.table([one])
    assert "Forces before the payload, in % of the weight" in text and "Forces under it, of the load" in text


def test_an_alarm_comes_before_a_slip_and_not_where_all_hold() -> None:
    held = list(alarms.run(3, 0, False, 4, 1))
    slipped = list(alarms.run(3, 10_000_000, True, 4, 1))
    assert [one.alarm_share for one in held] == [None] * 4
    assert all(one.alarm_share is not None and one.alarm_share > 0.2 for one in slipped)


def test_true_forces_lie_within_the_range_of_every_history(solver: Siconos, tmp_path: Path) -> None:
    """Feet come down, slide and let go by Coulomb's law, without a payload; hidden offsets set them under strain."""
    judged = 0
    for number in range(200):
        drawn = world.draw(6, number, world.Hidden(zero_rad=0, play_rad=0, compliance_rel=0), finite=False)
        drawn = replace(drawn, world=replace(drawn.world, payload_n=1e-9 * drawn.world.payload_n))
        try:
            state = truth.stand(drawn.world, solver)
        except truth.NoStance:
            continue
        asked = [str(BRACE), "stance", "range", str(world.write(drawn, tmp_path / str(number))), "--json"]
        said = json.loads(subprocess.run(asked, capture_output=True, text=True, check=True).stdout)["limbs"]
        for limb, force in zip(said, state.force_n, strict=True):
            for low, high, true in zip(limb["force_low_n"], limb["force_high_n"], force, strict=True):
                # offsets move feet by some mm, which is 2 % of their distance, and so of the 30 N
                assert (low is None or low < true + 1.0) and (high is None or true < high + 1.0), (number, limb["name"])
        judged += 1
        if judged == 5:
            return
    raise AssertionError("too few stances stand")
