"""What competes with the effects in a joint test: late readings, viscosity, stops, free travel in series with a slider.
Written from the physics, nothing of the tool's plant is used."""

from __future__ import annotations

from pathlib import Path

import joint_cases
import numpy as np
import pytest
from brace.dataset import load_dataset
from brace.dataset.check_joint_test import faults
from brace.diagnose.diagnosis import Diagnosis, Interval, NamedEffect
from brace.diagnose.joint_test.choose import at_an_end
from brace.diagnose.joint_test.localise import _contrasts
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.terms import effects_of
from brace.diagnose.joint_test.workflow import _may_be_nothing
from brace.effects import JointTestBench
from brace.effects.record import JointTestSize
from brace.model import load_limb
from by_torque import found_in, triangle
from command_bench import DATA

STEP_S = 0.02  # from reading to reading, as by_torque.found_in writes them
STIFFNESS = 4e5  # N mm/rad
REACH_RAD = 0.02
AMPLITUDES = (0.4, 1.0, 0.42, 0.98, 0.41)
SPRING = "joint.femur.compliance_rad_per_n_mm"


def bench(folder: Path, torque_of: object, hold: int = 0, late_s: float = 0.0, noise_n_mm: float = 20.0) -> Diagnosis:
    """Tests at two amplitudes; `torque_of` plays the angles of one. `hold`: readings at which the joint stands at each
    reversal."""
    assert callable(torque_of)
    rng = np.random.default_rng(5)
    tests = []
    for size in AMPLITUDES:
        once = np.interp(np.arange(260), [0, 65, 195, 259], [0, 1, -1, 0])
        ends = np.concatenate([once[:66], np.ones(hold), once[66:196], -np.ones(hold), once[196:]])
        angle = size * REACH_RAD * np.concatenate([ends, ends[1:]])
        torque = torque_of(angle)
        times = STEP_S * np.arange(angle.size)
        read = np.interp(times - late_s, times, torque) + noise_n_mm * rng.standard_normal(angle.size)
        tests.append((angle, read))
    return found_in(folder, tests)


def names(found: Diagnosis) -> set[str]:
    return {effect.name for effect in found.effects}


def test_a_torque_that_is_read_late_is_a_lag_and_no_effect(tmp_path: Path) -> None:
    found = bench(tmp_path, lambda angle: STIFFNESS * angle, late_s=0.05)
    assert not found.effects and found.verdict == "data_fault", found.sentence
    why = [fault.why for fault in found.data_faults]
    assert any("lag" in one and "ms late" in one for one in why), why
    assert found.model.number(SPRING) == pytest.approx(1.0 / STIFFNESS, rel=0.01)


@pytest.mark.minutes
def test_viscosity_is_no_creep(tmp_path: Path) -> None:
    """The joint stands at its reversals, so that creep would show, and moves at two speeds."""

    def torque_of(angle: np.ndarray) -> np.ndarray:
        speed = np.diff(angle, prepend=angle[0]) / STEP_S
        return np.asarray(STIFFNESS * angle + 2e4 * speed)

    found = bench(tmp_path, torque_of, hold=100)
    assert "creep" not in names(found), found.sentence
    assert any("viscous friction" in note for note in found.notes), found.notes


@pytest.mark.minutes
def test_viscosity_below_the_encoders_rounding_is_no_friction(tmp_path: Path) -> None:
    """Sines of six speeds; the spring alone leaves no more than rounding and noise, so that the search ends with it."""
    random, step_rad, readings = np.random.default_rng(3), 2.0 * np.pi / 65536, 3000
    tests = []
    for size, times in ((1.0, 1.0), (0.5, 1.0), (1.0, 3.0), (0.5, 3.0), (0.75, 2.0), (0.9, 1.5)):
        angle = 0.0235 * size * np.sin(np.linspace(0.0, 4.0 * np.pi, readings))
        viscous = 1200.0 * times * np.gradient(angle) / STEP_S
        torque = angle / 2.87e-6 + 2.64e8 * angle**3 + viscous + 24.0 * random.standard_normal(readings)
        tests.append((np.round(angle / step_rad) * step_rad, torque))
    found = found_in(tmp_path, tests)
    assert names(found) == {"joint_hardening"}, found.sentence
    assert found.model.number("joint.femur.coulomb_n_mm") == 0.0
    assert any("viscous friction" in note for note in found.notes), found.notes


@pytest.mark.minutes
def test_a_stop_on_one_side_is_no_hardening(tmp_path: Path) -> None:
    at = 0.55 * REACH_RAD
    found = bench(tmp_path, lambda angle: STIFFNESS * (angle + 2.0 * np.maximum(angle - at, 0.0)))
    assert not found.effects and found.verdict == "unknown", found.sentence
    assert found.unexplained is not None and "side" in found.unexplained.description


@pytest.mark.minutes
def test_free_travel_in_series_with_a_slider_is_described(tmp_path: Path) -> None:
    """The slider follows when the free travel is used up and its spring has bent as far as friction holds."""
    travel, most = 0.4 * REACH_RAD, 1500.0
    spring = most / (0.02 * REACH_RAD)

    def torque_of(angle: np.ndarray) -> np.ndarray:
        slider, reach, out = 0.0, 0.5 * travel + most / spring, []
        for one in angle:
            slider = float(np.clip(slider, one - reach, one + reach))
            bent = one - slider
            out.append(spring * np.sign(bent) * max(abs(bent) - 0.5 * travel, 0.0))
        return np.asarray(STIFFNESS * angle + np.array(out))

    found = bench(tmp_path, torque_of)
    assert names(found) <= {"coulomb_friction"}, found.sentence
    assert found.unexplained is not None and "in series with a slider" in found.unexplained.description


def test_a_torque_in_newton_metres_is_told() -> None:
    """A stiffness that a limb may have, in revolutions and N m, and a torque that no joint of a limb has."""
    angle = 0.004 * triangle()
    columns = {"t_s": STEP_S * np.arange(angle.size), "angle_rad": angle, "torque_n_mm": 4.0 * triangle()}
    sound = columns | {"torque_n_mm": 4e3 * triangle()}
    assert not any(fault.field == "torque_n_mm" for fault in faults(sound))
    told = [fault for fault in faults(columns) if fault.field == "torque_n_mm"]
    assert told and told[0].blocking and "N m" in told[0].why


def _creep(ratio: Interval, time_constant_s: Interval) -> NamedEffect:
    return NamedEffect("creep", "creep", 0.99, {"creep.ratio": ratio, "creep.time_constant_s": time_constant_s}, 1.0)


def test_an_effect_whose_size_may_be_zero_is_nothing() -> None:
    """A time constant is never zero, whatever the record says: it says how creep goes, not whether there is any."""
    constant = Interval(21.6, 0.4, 21.6)
    assert _may_be_nothing(_creep(Interval(0.77, 0.0, 1.0), constant))
    assert not _may_be_nothing(_creep(Interval(0.77, 0.6, 1.0), constant))
    friction = {"joint.femur.coulomb_n_mm": Interval(700.0, 600.0, 800.0)}
    ratio = {"joint.femur.coulomb_per_load_ratio": Interval(0.0, 0.0, 0.1)}
    assert not _may_be_nothing(NamedEffect("coulomb_friction", "joint.femur", 0.99, friction | ratio, 1.0))


def test_a_time_constant_at_an_end_of_its_range_is_no_creep() -> None:
    a_minute = JointTestSize(0.04, 8000.0, 60.0, 0.0, 0.01, float("inf"))
    terms = effects_of(load_limb(DATA / "paper-limb.toml"), "femur", JointTestBench(a_minute, given=False, rests=True))
    (creep,) = [term for term in terms if term.name == "creep"]
    low, high = next((one.low, one.high) for one in creep.parameters if one.key == "creep.time_constant_s")
    for constant_s, at_end in ((low, True), (1.05 * low, True), (2.0 * low, False), (0.9 * high, False), (high, True)):
        assert at_an_end(creep, {"creep.ratio": 0.1, "creep.time_constant_s": constant_s}) == at_end


def test_where_the_residuals_of_a_joint_test_are_looked_for(tmp_path: Path) -> None:
    """The middle of the range is its middle third, far from it are the outer thirds."""
    angle = np.linspace(-REACH_RAD, REACH_RAD, 400)
    folder = joint_cases.Case("", {}, {
        "t_s": STEP_S * np.arange(400), "angle_rad": angle, "torque_n_mm": STIFFNESS * angle, "test": np.zeros(400)
    }).write(tmp_path)  # fmt: skip
    record = JointRecord(load_dataset(folder))
    told, weights = _contrasts(record)
    place = record.columns["angle_rad"] / REACH_RAD
    middle, far = (weights[told.index(next(name for name in told if name.startswith(words)))]
                   for words in ("in the middle", "far from the middle"))  # fmt: skip
    assert np.ptp(place) > 1.9
    assert middle == pytest.approx(np.where(np.abs(place) < 1.0 / 3.0, place, 0.0), abs=0.02)
    assert far + middle == pytest.approx(np.where(np.abs(place) > 2.0 / 3.0, np.sign(place), 0.0))
