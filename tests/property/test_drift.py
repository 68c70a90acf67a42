"""The drift check keeps its bounds on fewer limbs and readings than drift_figures.py reports, and on other seeds."""
from __future__ import annotations

import numpy as np
import pytest

import drift_figures as figures
import limbs
from drift_record import DRIFTED, PRACTICE, WATCHING, commissioning, measured, mixed, split_at_reversals, with_loss

SEED = 3_000_001


@pytest.mark.parametrize("name", sorted(figures.NAMED))
def test_an_unchanged_limb_raises_no_alarm(name: str) -> None:
    alarm, readings = figures.quiet(SEED, figures.NAMED[name], PRACTICE, 200_000)
    assert not alarm and readings >= 200_000


def test_random_limbs_raise_no_alarm() -> None:
    assert not any(figures.random_case(SEED + 100 + i).false_alarm for i in range(30))


def test_friction_raises_no_alarm_when_runs_end_at_reversals() -> None:
    assert not figures.quiet(SEED, limbs.PAPER, PRACTICE, 100_000, friction=True)[0]


@pytest.mark.parametrize("name", sorted(figures.NAMED))
@pytest.mark.parametrize("link", [0, 1])
@pytest.mark.parametrize("axial_too", [False, True])
def test_a_tenth_lost_is_flagged_within_thirty_readings_of_check_runs(name: str, link: int, axial_too: bool) -> None:
    found = [f for i in range(12) for f in figures.named_losses(name, SEED + i, link, 0.10, True, 5, axial_too)]
    assert figures.within(found) >= 0.85
    assert np.mean([f.possible for f in found]) >= 0.95
    assert abs(np.median([f.loss for f in found]) - 0.1) < 0.03


@pytest.mark.parametrize("name, friction", [("paper", False), ("second", False), ("paper", True)])
@pytest.mark.parametrize("link", [0, 1])
def test_a_tenth_lost_is_flagged_within_thirty_readings_at_a_posture_of_its_choice(name: str, friction: bool,
                                                                                  link: int) -> None:
    """drift_figures asks for 98 % of 400; of these 60 at least 56 then fall within with a probability above 0.99."""
    found = [f for i in range(12) for f in figures.named_losses(name, SEED + i, link, 0.10, True, 5, friction=friction,
                                                                rehearsed=True)]
    assert sum(f.alarm and f.delay <= figures.WITHIN for f in found) >= 56


@pytest.mark.parametrize("name, friction", [("paper", False), ("second", False), ("paper", True)])
def test_an_unchanged_limb_raises_no_alarm_at_postures_of_its_choice(name: str, friction: bool) -> None:
    alarm, readings = figures.quiet_at_choice(SEED, figures.NAMED[name], PRACTICE, 100_000, True, friction)
    assert not alarm and readings >= 100_000


def test_random_limbs_raise_no_alarm_at_postures_of_their_choice_and_report_most_losses() -> None:
    """Nine in ten losses on 1,000 limbs; of these 80 at least 66 (three sigma below 74) if as many are."""
    cases = [figures.random_choice(SEED + 100 + i, True) for i in range(40)]
    assert not any(alarm for _, alarm, _ in cases)
    found = [f for _, _, losses in cases for f in losses]
    assert len(found) >= 76 and sum(f.alarm and f.delay <= figures.WITHIN for f in found) >= 66


@pytest.mark.parametrize("seed", [5_401_282, 7_000_346, 7_000_358])
def test_limbs_far_within_the_tails_of_their_trust_raise_no_alarm_either(seed: int) -> None:
    """A tibia 14 % off along itself, with check postures both stretched and folded; thermal rates 46 and 52 % off. Each
    raised a false alarm while the axial compliance was no estimate and the thermal rate a logarithm."""
    limb = figures.of_its_choice(figures.learned(seed), True)
    for _ in range(4):
        for record in (mixed(limb.postures, 147, limb.rng), figures.check_runs(limb, 74)):
            limb.check.watch(record, measured(limb.true, record, limb.rng))
    assert limb.check.state.state == WATCHING


def test_mixed_runs_name_the_link() -> None:
    for link in (0, 1):
        found = [f for i in range(4) for f in figures.named_losses("paper", SEED + i, link, 0.10, False, 5)]
        assert np.mean([f.alarm for f in found]) >= 0.95
        assert np.mean([f.named for f in found]) >= 0.75 and np.mean([f.possible for f in found]) >= 0.9


def test_the_outlook_is_kept() -> None:
    """Where ten readings should do on average, thirty do nearly always; where none should, thirty do not."""
    cases = [figures.random_case(SEED + i) for i in range(60)]
    for link in (0, 1):
        found = [case.check_run[link] for case in cases if case.watching]
        soon = [f for f in found if f.steps_needed <= 10]
        late = [f for f in found if f.steps_needed > 200]
        assert len(found) >= 50 and len(soon) >= 10
        assert figures.within(soon) >= 0.9
        assert not late or figures.within(late) <= 0.1


def test_a_slow_loss_is_flagged_before_it_doubles() -> None:
    """A tenth of the femur's stiffness over 5,000 readings."""
    limb = figures.learned(SEED, limbs.PAPER, PRACTICE)
    for share in np.linspace(0.0, 2.0, 101):
        record = mixed(PRACTICE, 6, limb.rng, swing_degc=figures.LOSS_SWING_DEGC)
        limb.check.watch(record, measured(with_loss(limb.true, "femur", 0.1 * float(share)), record, limb.rng))
        if limb.check.state.state == DRIFTED:
            break
    assert limb.check.state.state == DRIFTED and share <= 1.0


def test_learning_takes_up_a_calibration_that_is_off() -> None:
    limb = figures.learned(SEED + 7, limbs.PAPER, PRACTICE)
    assert limb.check.state.state == WATCHING
    for index, key in ((0, "link.femur.bending_mm_per_n"), (2, "joint.femur.compliance_rad_per_n_mm")):
        off = limb.true[key] / limbs.PAPER[key] - 1
        assert abs(limb.check.state.offset[index] - off) < 0.05
    knee = limb.true["joint.tibia.zero_offset_rad"]
    assert abs(limb.check.state.offset[4] - knee) < 0.002


def test_splitting_at_reversals_keeps_every_reading() -> None:
    record = commissioning(PRACTICE[:2], np.random.default_rng(SEED), repeats=1)
    split = split_at_reversals(record)
    assert len(split) == len(record) and len(set(split.run)) > 3 * len(set(record.run))
