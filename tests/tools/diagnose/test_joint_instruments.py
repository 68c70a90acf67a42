"""Joint tests by real instruments: a coarse encoder, and ramps too small for the gap that large ramps suggest. The
records are written here from the physics; the tool's plant takes no part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from brace.dataset import load_dataset
from brace.dataset.grid import step_of
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
