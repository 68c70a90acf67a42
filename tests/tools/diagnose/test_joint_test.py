"""Diagnosis of joint tests: what is hidden is named, what is not there is not, bad records are told from bad
joints."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import joint_cases
from brace.dataset import load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.joint_test.dead_zone import refusal
from brace.diagnose.joint_test.fit import Fitter
from brace.diagnose.joint_test.hold_out import held_out
from brace.diagnose.joint_test.intake import spring_alone
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.terms import effects_of
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.effects import JointTestBench
from brace.ground.errors import BadFileError
from brace.identify.swing import ramps
from brace.model import load_limb

REAL = Path(os.environ.get("BRACE_REAL_DATA", ""))
needs_real = pytest.mark.skipif(
    not os.environ.get("BRACE_REAL_DATA") or not (REAL / "cycloidal_base").is_dir(),
    reason="BRACE_REAL_DATA names no folder with cycloidal_base, cycloidal_preloaded, cycloidal_polymer",
)


def found_in(folder: Path, model: Path | None = None, seed: int = 0) -> Diagnosis:
    """The diagnosis of a folder."""
    return diagnose(load_dataset(folder), load_limb(model) if model else None, Options(seed=seed))


def names(found: Diagnosis) -> list[str]:
    return [effect.name for effect in found.effects]


def value(found: Diagnosis, leaf: str) -> float:
    """A fitted value by the last part of its key."""
    return next(
        interval.value
        for effect in found.effects
        for key, interval in effect.parameters.items()
        if key.endswith(leaf)
    )


@pytest.mark.parametrize("kind", joint_cases.KINDS)
def test_what_is_hidden_is_named_and_nothing_else(kind: str, tmp_path: Path) -> None:
    case = joint_cases.case(kind, np.random.default_rng([7, joint_cases.KINDS.index(kind)]))
    found = found_in(case.write(tmp_path))
    assert set(names(found)) == case.hidden, found.sentence
    outside = kind in joint_cases.OUTSIDE
    assert found.verdict == ("none" if kind == "none" else "unknown" if outside else "effect")
    assert found.gap is not None
    if outside:
        assert found.model.number("joint.femur.hardening_n_mm_per_rad3") == 0.0
        assert found.unexplained is not None and found.unexplained.structured
    for effect in found.effects:
        for key, interval in effect.parameters.items():
            assert interval.low <= interval.value <= interval.high
            assert found.model.number(key) == interval.value
    if case.hidden:
        before, after = found.gap.before.held_out, found.gap.after.held_out
        assert before is not None and after is not None and after < 0.5 * before
        assert len(found.gap.steps) == len(found.effects)


def test_sizes_come_out(tmp_path: Path) -> None:
    """All three at once: within some percent of what was put in."""
    kind = "backlash+coulomb_friction+joint_hardening"
    case = joint_cases.case(kind, np.random.default_rng(11))
    found = found_in(case.write(tmp_path))
    for leaf, tolerance in (("gap_rad", 0.05), ("hardening_n_mm_per_rad3", 0.1)):
        assert value(found, leaf) == pytest.approx(case.truth[leaf], rel=tolerance)
    assert value(found, "coulomb_n_mm") == pytest.approx(case.truth["coulomb_n_mm"], rel=0.1)


def limb(folder: Path, compliance: float, extra: str = "") -> Path:
    """A believed limb whose femur joint has this spring."""
    path = folder / "believed.toml"
    path.write_text(
        "format = 1\n[geometry]\nfemur_mm = 185.0\ntibia_mm = 313.5\n[link.tibia]\nbending_mm_per_n ="
        " 0.25\n[joint.femur]\ncompliance_rad_per_n_mm ="
        f" {compliance!r}\n{extra}[uncertainty]\ncompliance_rel = 0.05\n"
    )
    return path


def test_a_believed_spring_is_kept_or_found_wrong(tmp_path: Path) -> None:
    case = joint_cases.case("backlash", np.random.default_rng(3))
    spring = case.truth["compliance_rad_per_n_mm"]
    folder = case.write(tmp_path / "d")
    assert names(found_in(folder, limb(tmp_path, spring * 1.03))) == ["backlash"]
    wrong = found_in(folder, limb(tmp_path, spring * 0.6))
    assert set(names(wrong)) == {"backlash", "joint_compliance"}
    assert value(wrong, "compliance_rad_per_n_mm") == pytest.approx(spring, rel=0.03)


def test_what_the_model_has_already_is_not_missing(tmp_path: Path) -> None:
    case = joint_cases.case("backlash", np.random.default_rng(4))
    spring, gap = case.truth["compliance_rad_per_n_mm"], case.truth["gap_rad"]
    model = limb(tmp_path, spring, f"gap_rad = {gap!r}\n")
    found = found_in(case.write(tmp_path / "d"), model)
    assert found.verdict == "none" and found.effects == ()
    assert found.model.values == load_limb(model).values


@pytest.mark.minutes
def test_the_same_again(tmp_path: Path) -> None:
    folder = joint_cases.case("coulomb_friction", np.random.default_rng(5)).write(tmp_path)
    first, second = found_in(folder), found_in(folder)
    assert first.effects == second.effects and first.localised == second.localised and first.gap == second.gap
    assert names(found_in(folder, seed=9)) == names(first)


def write(folder: Path, rows: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    (folder / "data.csv").write_text("t_s,angle_rad,torque_n_mm\n" + rows)
    return folder


@pytest.mark.parametrize(
    "rows",
    [
        "",
        "0,0,0\n" * 5,
        "".join(f"{i},nan,1\n" for i in range(100)),
        "".join(f"{i},{i * 1e-4},x\n" for i in range(100)),
    ],
)
def test_what_cannot_be_read_is_refused(rows: str, tmp_path: Path) -> None:
    with pytest.raises(BadFileError):
        found_in(write(tmp_path / "d", rows))


@pytest.mark.parametrize("row", ["0,0,0\n", "0,0.01,100\n"])
def test_rows_that_never_change_are_the_records_fault(row: str, tmp_path: Path) -> None:
    found = found_in(write(tmp_path / "d", row * 5000))
    assert found.verdict == "data_fault" and not found.effects and found.data_faults
    assert "never changes" in found.sentence


def test_noise_alone_names_nothing(tmp_path: Path) -> None:
    """A joint that was never loaded: an angle that jitters and a torque that has nothing to do with it."""
    random = np.random.default_rng(0)
    rows = "".join(
        f"{0.01 * i:.2f},{1e-4 * random.standard_normal():.7f},{100 * random.standard_normal():.2f}\n"
        for i in range(2000)
    )
    try:
        found = found_in(write(tmp_path / "d", rows))
    except BadFileError:
        return
    assert not found.effects


def test_ramps_and_what_is_held_out() -> None:
    angle = np.interp(np.linspace(0, 4, 401), [0, 1, 3, 4], [0, 1, -1, 0])
    one = np.zeros(401, dtype=int)
    assert np.unique(ramps(angle, one)).size == 3
    assert not held_out(angle, angle, one)[0].any()
    tests = np.repeat([1, 2, 3, 4], 401)
    torque = np.tile(angle, 4) * np.repeat([1.0, 1.1, 10.0, 10.5], 401)
    held, words = held_out(np.tile(angle, 4), torque, tests)
    assert set(tests[held]) == {2, 4} and words == "tests 2, 4"
    assert not any(0 < held[tests == test].sum() < 401 for test in (1, 2, 3, 4))


def test_a_gap_that_carries_torque_is_no_play(tmp_path: Path) -> None:
    """A spring half as stiff in its middle: a gap lowers the residual, and the readings inside it are on a
    slope."""
    random = np.random.default_rng(1)
    rows = []
    for test in range(5):
        angle = 0.02 * np.interp(np.linspace(0, 4, 260), [0, 1, 3, 4], [0, 1, -1, 0])
        torque = 1e5 * np.sign(angle) * np.maximum(np.abs(angle) - 0.008, 0) + 1e5 * angle
        torque = torque + 10.0 * random.standard_normal(260)
        rows.append(np.column_stack([0.02 * np.arange(260), angle, torque, np.full(260, test)]))
    case = joint_cases.Case(
        "soft", {}, dict(zip(("t_s", "angle_rad", "torque_n_mm", "test"), np.vstack(rows).T))
    )
    folder = case.write(tmp_path)
    record = JointRecord(load_dataset(folder))
    fitter = Fitter(record, spring_alone(load_dataset(folder)), np.inf)
    bench = JointTestBench(record.size, given=False, rests=False)
    gap = next(term for term in effects_of(fitter.base, "femur", bench) if term.name == "backlash")
    fitted = fitter.fit((gap,), fitter.fit(()), gap)
    assert fitted.rss < 0.8 * fitter.fit(()).rss
    assert "carries torque" in refusal(record, fitted)
    assert "backlash" not in names(found_in(folder))


@needs_real
def test_a_real_gearbox_shows_its_play_and_friction() -> None:
    found = found_in(REAL / "cycloidal_base")
    assert found.verdict == "effect" and set(names(found)) == {"backlash", "coulomb_friction"}
    assert any("saturated" in fault.why for fault in found.data_faults)
    assert found.gap is not None and found.gap.after.held_out is not None
    torque = load_dataset(REAL / "cycloidal_base")["torque_n_mm"]
    # readings where the drive does not follow its command are no part of it: they lie in the play, where little is off
    assert found.gap.after.held_out <= 0.095 * np.std(torque)


@needs_real
def test_preload_takes_play_and_gives_friction() -> None:
    base, preloaded = found_in(REAL / "cycloidal_base"), found_in(REAL / "cycloidal_preloaded")
    play = [
        [i for e in one.effects for k, i in e.parameters.items() if k.endswith("gap_rad")]
        for one in (base, preloaded)
    ]
    assert play[0] and all(one.high < play[0][0].low for one in play[1])
    # the constant and the growing part of friction stand in for one another: under a load they are one torque
    dry = [value(one, ".coulomb_n_mm") + 4000.0 * value(one, "per_load_ratio") for one in (base, preloaded)]
    assert dry[1] > 1.5 * dry[0]


@needs_real
def test_no_gap_is_wider_than_a_swing_over_both_flanks() -> None:
    """The small ramps of this record swing 31 mrad and end on a flank on both sides."""
    found = found_in(REAL / "cycloidal_split_reassembled")
    gaps = [i for e in found.effects for k, i in e.parameters.items() if k.endswith("gap_rad")]
    assert all(one.high <= 0.031 for one in gaps)


@needs_real
def test_one_gearbox_at_another_position_keeps_its_play() -> None:
    """Its makers report a play of 44.6 mrad and no hardening over three positions. At this one play and friction
    predict the held-out readings about as well as less play with hardening."""
    found = found_in(REAL / "cycloidal_base_pos5")
    play = next(i for e in found.effects for k, i in e.parameters.items() if k.endswith("gap_rad"))
    assert play.low <= 0.0446 <= play.high
    assert all(e.confidence < 0.8 for e in found.effects if e.name == "joint_hardening")


@needs_real
def test_a_soft_gearbox_gets_no_negative_spring_and_no_huge_play() -> None:
    found = found_in(REAL / "cycloidal_polymer")
    assert found.model.number("joint.femur.compliance_rad_per_n_mm") > 0.0
    assert found.model.number("joint.femur.gap_rad") < np.radians(3.0)


@pytest.mark.parametrize("seed", [0, pytest.param(3, marks=pytest.mark.minutes)])
def test_a_spring_that_is_softer_to_one_side_is_nothing_else(seed: int, tmp_path: Path) -> None:
    """Beside that shape an effect of the catalogue may take a per cent of the rest: rather not there, it is not named."""
    random = np.random.default_rng(seed)
    t_s = np.arange(3000) * 0.01
    torque = 4000.0 * np.sin(2 * np.pi * t_s / 5.0) * (0.6 + 0.4 * np.sin(2 * np.pi * t_s / 39.0))
    angle = torque / 6e4 * np.where(torque < 0.0, 1.4, 1.0) + 2e-5 * random.standard_normal(t_s.size)
    read = torque + 40.0 * random.standard_normal(t_s.size)
    columns = {"t_s": t_s, "angle_rad": angle, "torque_n_mm": read, "test": 1 + t_s // 10}
    found = found_in(joint_cases.Case("asymmetric", {}, columns).write(tmp_path))
    assert found.verdict == "unknown" and not found.effects, found.sentence
    assert found.unexplained is not None and "on one side" in found.unexplained.description
