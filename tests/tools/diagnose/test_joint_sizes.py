"""What a joint test says of sizes, and what it exports where no model was given. Written from the physics."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from by_torque import found_in, recorded, triangle, under_torque

import joint_cases
from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.joint_test.fit import Fitter
from brace.diagnose.joint_test.intake import spring_alone
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.terms import effects_of
from brace.effects import JointTestBench
from brace.effects.catalogue import FRICTION_TURN
from brace.identify.joint_test import JointProblem, usable
from brace.identify.parameters import ANGLE_ZERO, TORQUE_OFFSET
from brace.identify.run import Options, identify
from brace.model import load_limb
from brace.rig.predict import predict

LIMB = Path(__file__).parents[3] / "tools/brace/data/paper-limb.toml"
COMPLIANCE, GAP, FRICTION = 2e-6, 0.04, 1200.0
FULL_N_MM = 4000.0
GAP_KEY, RATIO_KEY = "joint.femur.gap_rad", "joint.femur.coulomb_per_load_ratio"


def ramps(reach_rad: float, gap_rad: float, compliance: float, hardening: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Angles that are imposed, and the torque. Friction turns over a hundredth of the swing."""
    angle = reach_rad * np.concatenate([triangle(), triangle()])
    rubs, friction = 0.0, []
    for moved in np.diff(angle, prepend=0.0):
        rubs = float(np.clip(rubs + FRICTION * moved / (0.02 * reach_rad), -FRICTION, FRICTION))
        friction.append(rubs)
    bent = np.sign(angle) * np.maximum(np.abs(angle) - 0.5 * gap_rad, 0.0)
    return angle, bent / compliance + hardening * bent**3 + np.array(friction)


def small_ramps(folder: Path, gap_rad: float = GAP) -> Diagnosis:
    """Ramps that hardly leave the play: eight tenths of the swing are free travel."""
    random = np.random.default_rng(3)
    angle, torque = ramps(0.5 * gap_rad + COMPLIANCE * (FULL_N_MM - FRICTION), gap_rad, COMPLIANCE)
    tests = [(angle, torque + 40.0 * random.standard_normal(angle.size)) for _ in range(5)]
    return found_in(folder, tests)


@pytest.mark.minutes
def test_play_may_take_nearly_all_of_a_small_swing(tmp_path: Path) -> None:
    found = small_ramps(tmp_path)
    play = [e for e in found.effects if e.name == "backlash"]
    assert play, found.sentence
    assert play[0].parameters[GAP_KEY].value == pytest.approx(GAP, rel=0.05)
    assert found.model.number("joint.femur.compliance_rad_per_n_mm") == pytest.approx(COMPLIANCE, rel=0.25)


@pytest.mark.minutes
def test_without_a_model_limb_toml_has_play_and_friction_as_gears_do(tmp_path: Path) -> None:
    """Play was not named; limb.toml has the little that fits, and a note says why."""
    found = small_ramps(tmp_path, gap_rad=0.0)
    assert {e.name for e in found.effects} == {"coulomb_friction"}, found.sentence
    assert found.model.number("joint.femur.coulomb_n_mm") == pytest.approx(FRICTION, rel=0.1)
    assert found.model.number("joint.femur.hardening_n_mm_per_rad3") == 0.0
    told = any("limb.toml also has backlash (gap_rad" in note for note in found.notes)
    assert told is (found.model.number(GAP_KEY) > 0.0), found.notes


def test_a_model_is_laid_against_the_right_side_of_its_gap(tmp_path: Path) -> None:
    """A model that is not quite the joint's: the misfit has a valley on either side of the gap. A grid of zeros and of
    angles over which friction turns finds the deeper one."""
    random = np.random.default_rng(0)
    bent = 0.01675 * triangle(400) - 0.005157
    rubs = np.zeros(bent.size)
    for i in range(1, bent.size):
        rubs[i] = np.clip(rubs[i - 1] + 3580.0 * (bent[i] - bent[i - 1]) / 0.002755, -3580.0, 3580.0)
    spring = np.sign(bent) * np.maximum(np.abs(bent) - 0.01097, 0.0) / 1.749e-6
    torque = spring + rubs + 5.0 * random.standard_normal(bent.size)
    numbers = {"compliance_rad_per_n_mm": 3e-6, "gap_rad": 0.03695, "coulomb_n_mm": 4258.0}
    model = load_limb(LIMB).with_values({f"joint.femur.{leaf}": value for leaf, value in numbers.items()})
    problem = JointProblem(load_dataset(recorded(tmp_path, [(bent + 0.3, torque)])))

    def left(own: dict[str, float]) -> float:
        return float(np.std(problem.torque_n_mm(model, own) - torque))

    grid = min(
        left({ANGLE_ZERO: zero, TORQUE_OFFSET: 0.0, FRICTION_TURN: turn})
        for zero in np.linspace(-0.32, -0.28, 21)
        for turn in (0.001, 0.002, 0.004, 0.008)
    )
    assert left(problem.aligned(model)) <= grid


def _fitter(folder: Path) -> Fitter:
    """Of a small test whose friction grows with the load."""
    torque = FULL_N_MM * triangle()
    angle = under_torque(torque, 0.0, 0.5 * FULL_N_MM, COMPLIANCE)
    times = 0.02 * np.arange(angle.size)
    columns = {"t_s": times, "angle_rad": angle, "torque_n_mm": torque, "test": np.zeros(angle.size)}
    data = load_dataset(joint_cases.Case("", {}, columns).write(folder))
    return Fitter(JointRecord(data), spring_alone(data), np.inf)


def test_a_friction_that_no_gear_has_needs_evidence_to_match(tmp_path: Path) -> None:
    """Where a record does not show how friction depends on the load, the fit takes what gears usually have. A small
    test has few readings where the friction turns, and constant friction may stand in for one that grows with the
    load."""
    fitter = _fitter(tmp_path)
    bench = JointTestBench(fitter.record.size, given=False, rests=False)
    rubs = next(term for term in effects_of(fitter.base, "femur", bench) if term.name == "coulomb_friction")
    chosen = fitter.parameter_set((rubs,))
    at = chosen.keys.index(RATIO_KEY)
    x = chosen.array("start").copy()
    off = np.full(fitter.record.fitted.size, 10.0)
    x[at] = 0.15
    assert fitter._pull(chosen, x, off) is None
    x[at] = 0.5
    pull = fitter._pull(chosen, x, off)
    assert pull is not None and pull[at] > 0.0 and np.count_nonzero(pull) == 1


def test_of_fits_of_the_same_terms_the_best_is_kept(tmp_path: Path) -> None:
    fitter = _fitter(tmp_path)
    found = fitter.fit(())
    for rss, kept in ((0.0, 0.0), (np.inf, found.rss)):
        fitter.known[frozenset()] = replace(found, rss=rss)
        fitter.fit(())
        assert fitter.known[frozenset()].rss == pytest.approx(kept)


@pytest.mark.minutes
def test_identify_and_diagnose_give_the_same_numbers(tmp_path: Path) -> None:
    """A joint that has all that `brace identify` fits: both fit the same model to the same readings."""
    random = np.random.default_rng(4)
    tests = []
    for share in (0.5, 1.0, 0.52, 0.98):
        angle, torque = ramps(share * 0.02, 0.008, COMPLIANCE, 3e9)
        tests.append((angle, torque + 40.0 * random.standard_normal(angle.size)))
    found = found_in(tmp_path / "diagnose", tests)
    assert {e.name for e in found.effects} == {"backlash", "coulomb_friction", "joint_hardening"}, found.sentence
    record = load_dataset(recorded(tmp_path / "identify", tests))
    fitted = identify(record, spring_alone(record), Options())
    assert found.joint is not None
    told = dict(zip(fitted.fit.parameters.keys, fitted.information.estimates()))
    for key, held in found.joint.parameters.items():
        if not key.endswith("per_load_ratio"):
            assert told[key].value == pytest.approx(held.value, rel=0.01), key
            assert told[key].low <= held.high and held.low <= told[key].high, key


def test_a_record_without_noise_is_identified_and_predicted(tmp_path: Path) -> None:
    """As somebody's own simulator writes it, and with a model that is far from it."""
    record = load_dataset(recorded(tmp_path, [ramps(share * 0.02, 0.004, COMPLIANCE) for share in (0.5, 1.0, 0.52)]))
    found = identify(record, spring_alone(record), Options()).fit.model
    assert found.number(GAP_KEY) == pytest.approx(0.004, rel=0.02)
    assert found.number("joint.femur.compliance_rad_per_n_mm") == pytest.approx(COMPLIANCE, rel=0.02)
    torque = np.asarray(predict(record, load_limb(LIMB)).columns["torque_n_mm"])
    assert np.all(np.isfinite(torque)) and np.std(torque - record["torque_n_mm"]) > 100.0


def test_readings_where_the_drive_does_not_follow_tell_nothing() -> None:
    """A drive that follows its command but for a moment, one whose torque is measured elsewhere, and none recorded."""
    command = 1000.0 * triangle(400)
    columns = {"torque_n_mm": command.copy(), "command_n_mm": command, "test": np.zeros(400)}
    columns["torque_n_mm"][50:60] += 300.0
    assert np.flatnonzero(~usable(columns)).tolist() == list(range(50, 60))
    elsewhere = columns | {"torque_n_mm": 0.85 * command}
    assert np.all(usable(elsewhere))
    assert np.all(usable({name: columns[name] for name in ("torque_n_mm", "test")}))


def rubbing(fade_per_n_mm: float, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Angles that are imposed on a joint with play, and the torque: friction grows with the load, and ever less."""
    angle = 0.03 * np.concatenate([triangle(), triangle()])
    spring = np.sign(angle) * np.maximum(np.abs(angle) - 0.004, 0.0) / COMPLIANCE
    level = held_by_friction(np.abs(spring), fade_per_n_mm)
    share = 0.0
    shares = []
    for moved in np.diff(angle, prepend=0.0):
        share = float(np.clip(share + moved / 6e-4, -1.0, 1.0))
        shares.append(share)
    return angle, spring + level * np.array(shares) + 40.0 * random.standard_normal(angle.size)


def held_by_friction(load_n_mm: np.ndarray, fade_per_n_mm: float) -> np.ndarray:
    return np.asarray(700.0 + 0.4 * load_n_mm * (1.0 + fade_per_n_mm * load_n_mm) ** (-1.0 / 3.0))


@pytest.mark.minutes
@pytest.mark.parametrize("fade_per_n_mm", [pytest.param(0.0, marks=pytest.mark.minutes), 1.0 / 800.0])
def test_limb_toml_has_a_friction_whose_growth_fades_where_it_does(tmp_path: Path, fade_per_n_mm: float) -> None:
    """Both commands find it, and say so; a share that stays is told as one."""
    random = np.random.default_rng(6)
    tests = [rubbing(fade_per_n_mm, random) for _ in range(4)]
    found = found_in(tmp_path / "diagnose", tests)
    record = load_dataset(recorded(tmp_path / "identify", tests))
    fitted = identify(record, spring_alone(record), Options())
    for model in (found.model, fitted.fit.model):
        leaves = ("n_mm", "per_load_ratio", "load_fade_per_n_mm")
        told = [model.number(f"joint.femur.coulomb_{leaf}") for leaf in leaves]
        assert (told[2] > 0.0) is (fade_per_n_mm > 0.0), told
        for load_n_mm in (3000.0, 6000.0, 12000.0):
            most = told[0] + told[1] * load_n_mm * (1.0 + told[2] * load_n_mm) ** (-1.0 / 3.0)
            assert most == pytest.approx(float(held_by_friction(np.array(load_n_mm), fade_per_n_mm)), rel=0.05), told
    assert any("ever less with the load" in note for note in found.notes) is (fade_per_n_mm > 0.0)
