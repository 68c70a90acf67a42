"""What a fitted model predicts of readings that it never saw, and the numbers of one model in two commands."""

from __future__ import annotations

from pathlib import Path

import pytest
from handmade import GAP_KEY, GAP_RAD, loading_record

from brace.dataset import load_dataset
from brace.diagnose.diagnosis import HeldOut
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.hold_out import held_out, load_range
from brace.diagnose.loading.intervals import intervals
from brace.diagnose.loading.parts import locked_rows
from brace.diagnose.loading.space import space_of, trust_of
from brace.effects import Freedom, Variant
from brace.identify.fit import fit as identify_fit
from brace.identify.information import information
from brace.identify.loading import LoadingProblem
from brace.identify.parameters import with_priors
from brace.identify.record import Record, load_record
from brace.model import load_limb

LIMB = Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
SPRING, HARDENING = "joint.femur.compliance_rad_per_n_mm", "joint.femur.hardening_n_mm_per_rad3"
TOO_SOFT = Variant("joint_compliance", "joint.femur", (Freedom(SPRING, 1e-7, 1e-3),))
HARDENS = Variant("joint_hardening", "joint.femur", (Freedom(HARDENING, 0.0, 1e12, (1e9,)),))
PLAYS = Variant("backlash", "joint.tibia", (Freedom(GAP_KEY, 0.0, 0.5, (1e-3,)),))


def recorded(folder: Path, **values: float) -> Record:
    keys = {key.replace("__", "."): value for key, value in values.items()}
    return load_record(load_dataset(loading_record(folder, LIMB, values=keys)))


def fitted(record: Record, *variants: Variant) -> Fit:
    space = space_of(trust_of(load_limb(LIMB), turns=True), variants)
    start = space.mean.copy()
    for variant in variants:
        for freedom in variant.freedoms:
            start[space.keys.index(freedom.key)] = (freedom.tries or (space.mean[space.keys.index(freedom.key)],))[0]
    return fit(record, space, start)


def by_part(record: Record, found: Fit) -> dict[str, HeldOut]:
    return {one.by: one for one in held_out(record, found, locked_rows(record.dataset))}


def test_a_right_model_predicts_every_part(tmp_path: Path) -> None:
    """Amplitude, direction, time and posture, to the noise and what the fit leaves open."""
    record = recorded(tmp_path / "record", joint__tibia__gap_rad=GAP_RAD)
    parts = by_part(record, fitted(record, PLAYS))
    assert set(parts) == {"amplitude", "direction", "time", "posture"}
    for one in parts.values():
        assert one.holds and one.p > 1e-3, one
        assert one.off == pytest.approx(one.expected, rel=0.15), one


def test_a_model_of_one_amplitude_is_told_to_be_one(tmp_path: Path) -> None:
    """A joint that hardens: another spring fits the whole record on the average, and small displacements do not
    predict large ones. With the hardening they do."""
    hardening = 2e10
    record = recorded(tmp_path / "record", joint__femur__hardening_n_mm_per_rad3=hardening)
    amplitude = by_part(record, fitted(record, TOO_SOFT))["amplitude"]
    assert not amplitude.holds and amplitude.off > 1.5 * amplitude.expected
    (words,) = load_range([amplitude])
    assert "its own amplitude only" in words
    holding = by_part(record, fitted(record, HARDENS))["amplitude"]
    (words,) = load_range([holding])
    assert holding.holds and f"holds for forces up to {holding.largest:.3g} N" in words


def test_identify_and_diagnose_have_the_same_numbers(tmp_path: Path) -> None:
    """One model, one record: values within a twentieth of the interval, intervals alike within a twentieth."""
    record = recorded(tmp_path / "record", joint__tibia__gap_rad=GAP_RAD)
    said = intervals(record, fitted(record, PLAYS), (GAP_KEY,))[GAP_KEY]
    problem = LoadingProblem(record.dataset)
    best = identify_fit(problem, with_priors(load_limb(LIMB), [GAP_KEY], turns=True))
    estimate = dict(zip(best.parameters.keys, information(best).estimates()))[GAP_KEY]
    width = said.high - said.low
    assert estimate.value == pytest.approx(said.value, abs=0.05 * width)
    assert estimate.low == pytest.approx(said.low, abs=0.05 * width)
    assert estimate.high == pytest.approx(said.high, abs=0.05 * width)
    assert said.low <= GAP_RAD <= said.high
