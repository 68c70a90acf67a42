"""Joint tests by real instruments: a coarse encoder, and ramps too small for the gap that large ramps suggest. The
records are written here from the physics; the tool's plant takes no part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.dataset.grid import step_of, unrounded
from brace.diagnose.diagnosis import Diagnosis
from brace.identify.swing import swing_over_both_flanks_rad
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose

COUNT_RAD = 2.0 * np.pi / 4096  # 12 bits a turn
META = 'format = 1\nkind = "joint_test"\ntitle = "joint"\njoint = "femur"\n'


def ramps(size: float, readings: int, times: int) -> np.ndarray:
    """There and back over both sides, starting from nothing."""
    legs = [np.linspace(0, 1, readings), np.linspace(1, -1, 2 * readings), np.linspace(-1, 0, readings)]
    return np.tile(size * np.concatenate(legs), times)


def told(folder: Path, angle_rad: np.ndarray, torque_n_mm: np.ndarray, test: np.ndarray) -> Diagnosis:
    folder.mkdir()
    (folder / "meta.toml").write_text(META)
    rows = zip(0.01 * np.arange(angle_rad.size), angle_rad, torque_n_mm, test)
    lines = [f"{t:.3f},{a:.9g},{q:.6g},{n}" for t, a, q, n in rows]
    (folder / "data.csv").write_text("\n".join(["t_s,angle_rad,torque_n_mm,test", *lines]) + "\n")
    return diagnose(load_dataset(folder), None, Options())


@pytest.mark.parametrize("counts", [12, 80])
def test_a_perfect_spring_behind_a_coarse_encoder(tmp_path: Path, counts: int) -> None:
    """Its torque over the rounded angle is a staircase, which is neither cogging nor play."""
    rng = np.random.default_rng(5 + counts)
    torque = np.concatenate([ramps(3e4 * share, 250, 2) for share in (0.5, 1.0, 0.5, 1.0)])
    test = np.repeat(np.arange(4), torque.size // 4)
    angle = torque * counts * COUNT_RAD / 3e4 + 0.3
    read = torque + rng.normal(0.0, 6.0, torque.size)
    found = told(tmp_path / "record", COUNT_RAD * np.rint(angle / COUNT_RAD), read, test)
    assert found.verdict == "none", found.sentence


@pytest.mark.minutes
@pytest.mark.parametrize("counts", [6, 11])
def test_dry_friction_behind_a_coarse_encoder_is_dry_friction_alone(tmp_path: Path, counts: int) -> None:
    """Dahl's law at three amplitudes and two rates. What the encoder rounds off is neither creep nor a lag."""
    rng = np.random.default_rng(12)
    spring_n_mm_per_rad, friction_n_mm, bristle_n_mm_per_rad = 1.54e6 / counts, 230.0, 6e5
    angles, torques = [], []
    for share, readings in ((0.2, 280), (0.2, 200), (0.45, 280), (0.45, 200), (1.0, 280), (1.0, 200)):
        angle = ramps(counts * COUNT_RAD * share, readings, 4)
        rubs = np.zeros(angle.size)
        for row in range(1, angle.size):
            way = angle[row] - angle[row - 1]
            bent = rubs[row - 1] - np.sign(way) * friction_n_mm
            rubs[row] = np.sign(way) * friction_n_mm + bent * np.exp(-bristle_n_mm_per_rad * abs(way) / friction_n_mm)
        angles.append(angle + 0.11)
        torques.append(spring_n_mm_per_rad * angle + rubs + rng.normal(0.0, 18.0, angle.size))
    test = np.repeat(np.arange(6), [angle.size for angle in angles])
    read = COUNT_RAD * np.rint(np.concatenate(angles) / COUNT_RAD)
    found = told(tmp_path / "record", read, np.concatenate(torques), test)
    assert [effect.name for effect in found.effects] == ["coulomb_friction"], found.sentence
    assert not found.data_faults
    told_n_mm = found.effects[0].parameters["joint.femur.coulomb_n_mm"].value
    assert told_n_mm == pytest.approx(friction_n_mm, rel=0.2)  # the law that is fitted is another


def test_what_an_encoder_read_before_it_rounded() -> None:
    """A ramp of `rows` readings a count is known to half a reading's motion between its first and last change; where it
    turns back, no worse than to a count."""
    rows = 20
    angle = COUNT_RAD * (0.3 + ramps(10.0, 10 * rows, 2))
    read = COUNT_RAD * np.rint(angle / COUNT_RAD)
    before = unrounded(read, np.zeros(angle.size), COUNT_RAD)
    off = np.abs(before - angle)
    passing = np.abs(angle - 0.3 * COUNT_RAD) < 8.0 * COUNT_RAD
    passing[: 2 * rows] = passing[-2 * rows :] = False
    assert off[passing].max() < 1.01 * 0.5 * COUNT_RAD / rows
    assert off.max() < COUNT_RAD


def test_readings_that_no_step_explains_stay() -> None:
    fast = COUNT_RAD * np.array([0.0, 3.0, 7.0, 4.0, 4.0, 9.0, 9.0, 9.0, 2.0])
    assert np.array_equal(unrounded(fast, np.zeros(fast.size), COUNT_RAD), fast)
    still = np.full(30, 0.2)
    assert np.array_equal(unrounded(still, np.zeros(still.size), COUNT_RAD), still)


def test_nothing_is_known_from_one_test_to_the_next() -> None:
    read = COUNT_RAD * np.repeat([0.0, 1.0], 10)
    apart = unrounded(read, np.repeat([0, 1], 10), COUNT_RAD)
    assert np.array_equal(apart, read)


def test_the_step_of_an_encoder_is_found() -> None:
    angle = np.linspace(-0.02, 0.03, 900)
    assert step_of(COUNT_RAD * np.rint(angle / COUNT_RAD)) == pytest.approx(COUNT_RAD)
    assert step_of(angle) == 0.0
    assert step_of(angle + np.random.default_rng(1).normal(0.0, 1e-4, 900)) == 0.0


def test_a_gap_is_no_larger_than_a_swing_over_both_flanks() -> None:
    """A ramp that ends in a rising torque on both sides went through all of the gap."""
    torque = ramps(4e3, 100, 2)
    gap_rad = 0.02
    angle = torque / 4e5 + 0.5 * gap_rad * np.sign(torque)
    one = np.zeros(torque.size)
    assert swing_over_both_flanks_rad(angle, torque, one) == pytest.approx(np.ptp(angle))
    within = 0.4 * gap_rad * np.sin(np.linspace(0, 12, 400))
    rubs = 300.0 * np.sign(np.gradient(within))
    assert swing_over_both_flanks_rad(within, rubs, np.zeros(400)) == np.inf
    both = np.concatenate([angle, within]), np.concatenate([torque, rubs]), np.repeat([0, 1], [torque.size, 400])
    assert swing_over_both_flanks_rad(*both) == pytest.approx(np.ptp(angle))


def test_a_planned_ramp_is_no_encoders_grid() -> None:
    """A ramp that a motor follows in even steps stands on a grid that nobody rounded."""
    once = np.concatenate([np.arange(0, 60), np.arange(60, -60, -1), np.arange(-60, 0)])
    assert step_of(1e-4 * np.tile(once, 4)) == 0.0
