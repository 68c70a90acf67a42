"""Joint tests that tell less than they seem to: written from the physics, nothing of the tool's plant is used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from by_torque import LEG, found_in, triangle, under_torque

from brace.dataset.grid import step_of
from brace.diagnose.joint_test.fit import Fitted
from brace.identify.swing import swing_over_both_flanks_rad
from brace.diagnose.joint_test.rivals import Rival, beside, surest
from brace.diagnose.joint_test.terms import Term
from brace.identify.parameters import ParameterSet
from brace.model import load_limb

LIMB = Path(__file__).parents[3] / "tools/brace/data/paper-limb.toml"


def test_the_swing_bounds_play_only_where_both_flanks_were_reached() -> None:
    torque = 4000.0 * triangle()
    reached = under_torque(torque, 0.025, 1500.0, 1e-6)
    swing = swing_over_both_flanks_rad(reached, torque, np.zeros(LEG, dtype=int))
    assert 0.025 <= swing == pytest.approx(np.ptp(reached))
    held = under_torque(torque, 0.025, 5000.0, 1e-6)
    assert swing_over_both_flanks_rad(held + 1e-7 * torque, torque, np.zeros(LEG, dtype=int)) == np.inf
    late = under_torque(torque, 0.025, 3800.0, 1e-6)  # slips only just before the torque turns
    assert swing_over_both_flanks_rad(late, torque, np.zeros(LEG, dtype=int)) == np.inf


def test_an_encoder_of_12_bits_is_no_cogging(tmp_path: Path) -> None:
    step, random = 2.0 * np.pi / 4096, np.random.default_rng(1)
    tests = []
    for size in (0.6, 1.0, 0.62, 0.98, 0.61):
        angle = 0.05 * size * triangle(800)
        tests.append((np.round(angle / step) * step, 4e5 * angle + 5.0 * random.standard_normal(800)))
    assert step_of(tests[0][0]) == pytest.approx(step)
    found = found_in(tmp_path, tests)
    assert found.verdict == "none", found.sentence


def test_travel_that_is_no_joint_withholds_names(tmp_path: Path) -> None:
    """Moves without load between the ramps: most of the torque is left by any model."""
    random = np.random.default_rng(2)
    tests = []
    for _ in range(5):
        angle = np.concatenate([0.02 * triangle(), 0.15 * triangle(130), 0.02 * triangle()])
        torque = np.concatenate([8000.0 * triangle(), np.zeros(130), 8000.0 * triangle()])
        tests.append((angle, torque + 30.0 * random.standard_normal(angle.size)))
    found = found_in(tmp_path, tests)
    assert found.verdict == "unknown" and not found.effects, found.sentence
    assert found.unexplained is not None and found.unexplained.structured


def soft_middle(random: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """A spring whose middle is neither a dead zone nor a cubic, with as much noise as tells them apart badly."""
    tests = []
    for size in (0.97, 1.0, 0.98, 0.99, 0.96):
        angle = 0.02 * size * triangle()
        soft = angle - 0.004 * np.tanh(angle / 0.006)
        torque = 4e5 * soft + 600.0 * np.sign(np.gradient(angle)) + 950.0 * random.standard_normal(LEG)
        tests.append((angle, torque))
    return tests


def test_a_smooth_soft_middle_is_no_play_for_sure(tmp_path: Path) -> None:
    found = found_in(tmp_path, soft_middle(np.random.default_rng(0)))
    assert all(effect.confidence < 0.8 for effect in found.effects if effect.name == "backlash")


def test_an_effect_is_no_surer_than_the_rival_without_it_is_wrong() -> None:
    def rival(share: float, *names: str) -> Rival:
        terms = tuple(Term(name, "joint.femur", (), ()) for name in names)
        nothing = np.zeros(0)
        return Rival(Fitted(terms, ParameterSet(load_limb(LIMB), ()), nothing, nothing, 0.0, 0.0), share)

    found = [rival(0.4, "backlash"), rival(0.2, "backlash", "joint_hardening"), rival(0.1, "joint_hardening")]
    assert surest(found, "coulomb_friction") == pytest.approx(0.6)
    assert surest(found, "joint_hardening") == pytest.approx(0.6)
    assert surest(found, "backlash") == pytest.approx(0.9)
    assert beside(found, frozenset({"joint_hardening"})) == ("backlash@joint.femur",)
