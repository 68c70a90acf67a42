"""Joint tests that tell less than they seem to: written from the physics, nothing of the tool's plant is used."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from by_torque import LEG, found_in, recorded, triangle, under_torque

from brace.dataset import load_dataset
from brace.dataset.grid import step_of
from brace.diagnose.joint_test.dead_zone import is_friction_turning, refusal
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.intake import spring_alone
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.rivals import Rival, _share, beside, beside_friction, one_less, surest
from brace.diagnose.joint_test.shapes import SOFT, shapes
from brace.diagnose.joint_test.terms import Term, effects_of
from brace.diagnose.joint_test.workflow import _refused_gap
from brace.effects import JointTestBench
from brace.effects.catalogue import FRICTION_TURN
from brace.identify.parameters import Parameter, ParameterSet
from brace.identify.swing import swing_over_both_flanks_rad
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


@pytest.mark.minutes
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


def test_hardening_and_creep_beside_friction_must_be_ten_times_likelier() -> None:
    for name in ("joint_hardening", "creep"):
        assert beside_friction(name, 10.0 / 11.0) == pytest.approx(0.5)
        assert beside_friction(name, 0.0) == 0.0 and beside_friction(name, 1.0) == 1.0
    for name in ("coulomb_friction", "backlash"):
        assert beside_friction(name, 0.7) == 0.7


def soft_middle(random: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """A spring whose middle is neither a dead zone nor a cubic, with as much noise as tells them apart badly."""
    tests = []
    for size in (0.97, 1.0, 0.98, 0.99, 0.96):
        angle = 0.02 * size * triangle()
        soft = angle - 0.004 * np.tanh(angle / 0.006)
        torque = 4e5 * soft + 600.0 * np.sign(np.gradient(angle)) + 950.0 * random.standard_normal(LEG)
        tests.append((angle, torque))
    return tests


@pytest.mark.minutes
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


def fitter_of(folder: Path, tests: list[tuple[np.ndarray, np.ndarray]]) -> tuple[Fitter, dict[str, Term]]:
    """A fitter of these tests and all its terms by name."""
    dataset = load_dataset(recorded(folder, tests))
    record = JointRecord(dataset)
    fitter = Fitter(record, spring_alone(dataset), np.inf)
    terms = effects_of(fitter.base, record.joint, JointTestBench(record.size, given=False, rests=False))
    return fitter, {term.name: term for term in (*terms, *shapes(record.size, 0.005, True))}


def test_beside_a_stop_hardening_has_the_stop_alone_as_its_rival(tmp_path: Path) -> None:
    """Alone, and with a further shape of the spring: a stop is seldom of the form that is fitted."""
    random = np.random.default_rng(3)
    tests = []
    for size in (0.4, 0.41, 1.0, 0.99):
        angle = 0.02 * size * triangle()
        torque = 4e5 * angle + 6e5 * np.maximum(angle - 0.013, 0.0) + 20.0 * random.standard_normal(LEG)
        tests.append((angle, torque))
    fitter, terms = fitter_of(tmp_path, tests)

    def alone(*names: str) -> Fitted:
        fitted = fitter.fit(())
        for name in names:
            fitted = fitter.fit((*fitted.terms, terms[name]), fitted, terms[name])
        return fitted

    def poorer(fitted: Fitted) -> set[frozenset[str]]:
        found = one_less(fitter, fitted, lambda _: list(terms.values()))
        return {frozenset(term.name for term in one.terms) for one in found}

    further = {"asymmetric_spring", "cogging", "soft_middle"}
    rivals = poorer(alone("end_stop", "joint_hardening"))
    assert rivals == {frozenset({"end_stop"})} | {frozenset({"end_stop", one}) for one in further}
    assert poorer(alone("joint_hardening")) == {frozenset()}


def test_a_soft_middle_beside_another_shape_of_the_spring_is_no_hardening() -> None:
    def says(*names: str) -> frozenset[str]:
        terms = tuple(Term(name, "joint", (), ()) for name in names)
        soft = ParameterSet(load_limb(LIMB), (Parameter(SOFT, 0.0, 1.0, -1e4, 1e4),))
        return Rival(Fitted(terms, soft, np.array([100.0]), np.zeros(0), 0.0, 0.0), 0.1).names

    assert "joint_hardening" in says("soft_middle", "coulomb_friction")
    assert "joint_hardening" not in says("soft_middle", "end_stop")


def test_a_shape_is_rare_only_where_the_spring_has_none_yet() -> None:
    """A second turn of friction is none of the spring's. The rival leaves half of the held-out misfit, over 50
    independent readings: no luck."""
    kept = np.arange(200) < 100
    record = SimpleNamespace(
        kept=kept, fitted=~kept, independent=lambda _: 50.0, size=SimpleNamespace(torque_n_mm=1e3)
    )
    fitter = cast(Fitter, SimpleNamespace(record=record))

    def left(held: float, *shape_names: str) -> Fitted:
        terms = tuple(Term(name, "joint", (), (), None, "shape") for name in shape_names)
        return Fitted(terms, ParameterSet(load_limb(LIMB), ()), np.zeros(0), np.zeros(200), 0.0, held)

    first = _share(fitter, left(1e6), left(5e5, "end_stop"))
    further = _share(fitter, left(1e6, "end_stop"), left(5e5, "end_stop", "soft_middle"))
    beside_a_law = _share(fitter, left(1e6, "later_friction"), left(5e5, "later_friction", "soft_middle"))
    assert first == beside_a_law == pytest.approx(3.0 / 13.0)
    assert further == pytest.approx(0.5)
    lucky = _share(fitter, left(1e6, "end_stop"), left(1e6, "end_stop", "soft_middle"))
    assert lucky == pytest.approx(0.25)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_gap_of_which_one_side_was_not_reached_is_no_play(side: float) -> None:
    """Of a gap of 0.01 rad the joint goes 0.015 rad beyond one side, and ends within it on the other."""
    deflection = side * np.concatenate([[-0.004], np.linspace(0.006, 0.02, 199)])
    size = SimpleNamespace(swing_rad=1.0)
    record = SimpleNamespace(
        joint="femur", size=size, fitted=np.full(200, True), deflection_rad=lambda *_: deflection[None]
    )
    values = {"joint.femur.gap_rad": 0.01, "joint.femur.compliance_rad_per_n_mm": 1e-5}
    model = SimpleNamespace(number=values.__getitem__)
    fitted = SimpleNamespace(model=model, nuisances={}, off_n_mm=np.zeros(200))
    assert "does not reach both" in refusal(cast(JointRecord, record), cast(Fitted, fitted))


def test_a_gap_that_is_crossed_while_friction_turns_is_no_play(tmp_path: Path) -> None:
    """The gap takes 2000 N mm from the spring: friction of 3000 N mm may stand for it, friction of 1500 N mm not."""
    torque = 8000.0 * triangle()
    tests = [(under_torque(size * torque, 0.008, 600.0, 2e-6), size * torque) for size in (0.5, 1.0, 0.52, 0.98)]
    fitter, terms = fitter_of(tmp_path, tests)
    fitted = fitter.fit(())
    for name in ("coulomb_friction", "backlash"):
        fitted = fitter.fit((*fitted.terms, terms[name]), fitted, terms[name])
    keys, x = fitted.parameters.keys, fitted.x.copy()
    assert fitted.values["joint.femur.gap_rad"] == pytest.approx(0.008, rel=0.1)
    assert not _refused_gap(fitter, fitted)
    for turn_rad, rubs_n_mm, refused in ((0.007, 3000.0, False), (0.009, 1500.0, False), (0.009, 3000.0, True)):
        x[keys.index(FRICTION_TURN)] = turn_rad
        x[keys.index("joint.femur.coulomb_n_mm")] = rubs_n_mm
        x[keys.index("joint.femur.coulomb_per_load_ratio")] = 0.0
        assert bool(is_friction_turning(fitter.record, replace(fitted, x=x))) == refused
    assert "still turns" in _refused_gap(fitter, replace(fitted, x=x))
