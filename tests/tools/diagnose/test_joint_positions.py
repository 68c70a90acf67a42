"""A joint tested at several gear positions: each has a zero of its own, and sizes that differ a little."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from by_torque import found_in, recorded, triangle, under_torque

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis, Interval
from brace.diagnose.joint_test.evidence import beside_what_is_left
from brace.diagnose.plain_words import joint_sizes
from brace.identify.gear_positions import apart, count

GAP_RAD, FRICTION_N_MM, COMPLIANCE = 0.02, 700.0, 2e-6
AMPLITUDES_N_MM = (4000.0, 9000.0)
SPRING, GAP, FRICTION = (
    f"joint.femur.{leaf}" for leaf in ("compliance_rad_per_n_mm", "gap_rad", "coulomb_n_mm")
)


def bench(folder: Path, zeros_rad: tuple[float, ...], gaps_rad: tuple[float, ...], seed: int = 0) -> Diagnosis:
    """Two amplitudes at each position."""
    rng = np.random.default_rng(seed)
    tests = []
    for zero, gap in zip(zeros_rad, gaps_rad, strict=True):
        for size in AMPLITUDES_N_MM:
            torque = size * np.concatenate([triangle(), triangle()[1:]])
            angle = zero + under_torque(torque, gap, FRICTION_N_MM, COMPLIANCE)
            noisy = torque + 20.0 * rng.standard_normal(torque.size)
            tests.append((angle + 2e-5 * rng.standard_normal(torque.size), noisy))
    return found_in(folder, tests)


@pytest.mark.minutes
def test_zeros_of_positions_are_the_record_s_own(tmp_path: Path) -> None:
    """Angles that differ by ten times the play say nothing about the joint."""
    found = bench(tmp_path, (0.1, -0.15, 0.22, 0.0), (GAP_RAD,) * 4)
    assert {effect.name for effect in found.effects} == {"backlash", "coulomb_friction"}, found.sentence
    assert found.joint is not None and found.joint.gear_positions == 4
    for key, size, wide in ((SPRING, COMPLIANCE, 0.2), (GAP, GAP_RAD, 0.2), (FRICTION, FRICTION_N_MM, 0.4)):
        held = found.joint.parameters[key]
        assert held.value == pytest.approx(size, rel=0.1), key
        assert held.low < size < held.high and held.high - held.low < wide * size, (key, held)


@pytest.mark.minutes
def test_zeros_that_differ_by_less_than_the_swing_are_several(tmp_path: Path) -> None:
    """Of a swing of 40 mrad, by a tenth of it: one zero for both would leave the joint unexplained."""
    found = bench(tmp_path, (0.1, 0.104, 0.093, 0.1105), (GAP_RAD,) * 4)
    assert found.joint is not None and found.joint.gear_positions == 4
    assert {effect.name for effect in found.effects} == {"backlash", "coulomb_friction"}, found.sentence


@pytest.mark.parametrize("zeros_rad", [(0.1,), (0.1, -0.15), (0.1, -0.15, 0.22), (0.1, -0.15, 0.1)])
def test_each_zero_is_a_position(tmp_path: Path, zeros_rad: tuple[float, ...]) -> None:
    torque = 9000.0 * triangle()
    angle = under_torque(torque, GAP_RAD, FRICTION_N_MM, COMPLIANCE)
    data = apart(load_dataset(recorded(tmp_path, [(zero + angle, torque) for zero in zeros_rad])))
    assert count(data) == len(set(zeros_rad))
    for test in range(len(zeros_rad) if len(zeros_rad) > 1 else 0):
        counted = data["angle_rad"][data["test"] == test]
        assert counted.max() == pytest.approx(-counted.min(), abs=1e-7), "from its own middle"


def test_what_a_model_leaves_widens_play_and_friction() -> None:
    """By as much torque, or as the spring turns under it; neither falls below nothing."""
    told = Interval(100.0, 97.0, 103.0)
    friction = beside_what_is_left(FRICTION, told, 4.0, COMPLIANCE)
    assert (friction.low, friction.high) == pytest.approx((95.0, 105.0))
    assert beside_what_is_left(SPRING, told, 4.0, COMPLIANCE) == told
    gap = beside_what_is_left(GAP, Interval(1e-3, 1e-3, 1e-3), 100.0, COMPLIANCE)
    assert (gap.low, gap.high) == pytest.approx((0.8e-3, 1.2e-3))
    assert beside_what_is_left(FRICTION, told, 1e3, COMPLIANCE).low == 0.0


@pytest.mark.minutes
def test_intervals_hold_the_spread_between_positions(tmp_path: Path) -> None:
    """A gap of 0.018 to 0.022 rad: of a further position the record knows no more than that spread, widened for the
    few positions that it has (Student's t)."""
    gaps = (0.018, 0.022, 0.0205, 0.019, 0.0215)
    found = bench(tmp_path, (0.1, -0.15, 0.22, 0.0, -0.3), gaps)
    assert found.joint is not None
    held = found.joint.parameters[GAP]
    expected = 2.132 * np.std(gaps, ddof=1) * np.sqrt(1.2)  # t of 95 % with 4 degrees of freedom
    assert 0.5 * (held.high - held.low) == pytest.approx(expected, rel=0.15)
    alone = bench(tmp_path / "one", (0.1,), gaps[:1]).joint
    assert alone is not None and alone.gear_positions == 1
    one = alone.parameters[GAP]
    assert one.high - one.low < 0.25 * (held.high - held.low)


@pytest.mark.parametrize("small_n_mm", [500.0, pytest.param(1500.0, marks=pytest.mark.minutes)])
def test_a_test_without_small_torques_has_no_middle(tmp_path: Path, small_n_mm: float) -> None:
    """Of two tests the second has only readings beyond what the first reaches; in the first, friction holds the joint,
    or lets it slip."""
    small = small_n_mm * np.concatenate([triangle(), triangle()[1:]])
    large = np.tile([6000.0, 9000.0, 6000.0, -6000.0, -9000.0, -6000.0], 20)
    tests = [(under_torque(torque, GAP_RAD, FRICTION_N_MM, COMPLIANCE), torque) for torque in (small, large)]
    assert found_in(tmp_path, tests).verdict == "unknown"


def test_amplitudes_from_zero_to_one_side_are_one_position(tmp_path: Path) -> None:
    """Middles of loops say nothing where a test loads the joint one way only."""
    torque = np.concatenate([np.linspace(0.0, 1.0, 200), np.linspace(1.0, 0.0, 200)])
    found = found_in(tmp_path, [(3e-6 * size * torque, size * torque) for size in (2000.0, 4000.0, 9000.0)])
    assert found.joint is None or found.joint.gear_positions == 1


@pytest.mark.minutes
def test_the_sizes_are_told_in_the_units_of_gears(tmp_path: Path) -> None:
    found = bench(tmp_path, (0.1, -0.15, 0.22), (GAP_RAD,) * 3)
    assert found.joint is not None
    words = "; ".join(joint_sizes(found.joint))
    assert "N m/rad" in words and "arcmin" in words and "up to 8.9" in words and "the 3 of the record" in words
