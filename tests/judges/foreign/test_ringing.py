"""The simulator of limbs that ring against closed forms: K at rest, the frequency it rings at, and the work that
friction takes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from ringing import LAWS, Bench, Hidden, Test, friction, loading_test, on_rig, play

SEED = 5


def rig(seed: int) -> tuple[dict[str, float], Test]:
    """A limb and its test."""
    return on_rig(np.random.default_rng(seed))


def stiffness(limb: dict[str, float], theta1: float, theta2: float) -> np.ndarray:
    """K [N/mm]: the inverse of all that yields, each turned into the limb's plane."""
    a1, a2 = theta1, theta1 - theta2
    tibia = limb["geometry.tibia_mm"] * np.array([math.cos(a2), math.sin(a2)])
    tip = tibia + limb["geometry.femur_mm"] * np.array([math.cos(a1), math.sin(a1)])
    yields = np.zeros((2, 2))
    for name, arm in (("femur", tip), ("tibia", tibia)):
        lever = np.array([-arm[1], arm[0]])
        yields += limb[f"joint.{name}.compliance_rad_per_n_mm"] * np.outer(lever, lever)
    for name, angle in (("femur", a1), ("tibia", a2)):
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        own = np.diag([limb[f"link.{name}.axial_mm_per_n"], limb[f"link.{name}.bending_mm_per_n"]])
        yields += turn @ own @ turn.T
    return np.asarray(np.linalg.inv(yields))


def test_it_rests_where_statics_say() -> None:
    """At steps that are small beside the limb: turning changes K by a share of them."""
    limb, test = rig(SEED)
    rows = test.rows.copy()
    rows[:, 5:7] *= 1e-3
    force = play(limb | {"wait_s": 20.0}, replace(test, rows=rows))
    due = np.array([stiffness(limb, row[1], row[2]) @ row[5:7] for row in rows])
    assert np.abs(force - due).max() < 0.01 * np.abs(due).max()


def test_it_still_rings_when_it_is_read_early() -> None:
    """And comes to rest later: readings after a short wait are off, and the less so the longer it is."""
    limb, test = rig(SEED)
    rest = play(limb | {"wait_s": 20.0}, test)
    off = [float(np.abs(play(limb | {"wait_s": wait, "move_s": 0.05}, test) - rest).max()) for wait in (0.02, 1.0)]
    assert off[0] > 0.2 > off[1]


@pytest.mark.parametrize("law", LAWS)
def test_friction_takes_work(law: str) -> None:
    """Each run ends where it began: the tip's work over it is what friction took, and no more than its level over the
    way of the joint."""
    limb, test = rig(SEED)
    hidden = friction(np.random.default_rng(1), "tibia", law)
    assert isinstance(hidden, Hidden)
    rubbed = hidden.applied(limb, 3.0) | {"wait_s": 5.0}
    force = play(rubbed, test)
    moved = np.diff(test.rows[:, 5:7], axis=0)
    same = np.diff(test.rows[:, 0]) == 0
    work = float(np.sum((0.5 * (force[1:] + force[:-1]) * moved)[same]))
    still = play(limb | {"wait_s": 5.0}, test)
    without = float(np.sum((0.5 * (still[1:] + still[:-1]) * moved)[same]))
    reach = limb["joint.tibia.compliance_rad_per_n_mm"] * limb["geometry.tibia_mm"] * float(np.abs(still).max()) * 2.0
    runs = len(np.unique(test.rows[:, 0]))
    assert abs(without) < 0.02 * work
    assert 0.0 < work < 1.5 * 90.0 * 4.0 * reach * runs


def test_a_size_is_set_on_the_limb_that_rings() -> None:
    """The detectability of a friction is that of the readings that are played, not of a limb that does not ring."""
    limb, test = rig(SEED)
    bench, hidden = Bench(limb, test), friction(np.random.default_rng(1), "femur", "lugre")
    size, s = bench.sized(hidden, 40.0)
    assert s == pytest.approx(40.0, rel=0.1)
    assert s == pytest.approx(float(np.linalg.norm(bench.bare(hidden.applied(limb, size)))))


def test_the_test_is_drawn_whole() -> None:
    """Every posture is loaded along both axes, out and back to both sides."""
    test = loading_test(np.random.default_rng(SEED))
    assert set(test.axis) == {0, 1}
    assert abs(float(test.rows[:, 5:7].sum())) < 1e-9
