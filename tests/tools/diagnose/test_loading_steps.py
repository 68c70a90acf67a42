"""The steps of a loading record's diagnosis, each against what statistics or hand calculation say it must give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from brace.dataset import load_dataset
from brace.dataset.intake import Dataset
from brace.diagnose.loading.choose import LabelSet, posterior_of
from brace.diagnose.loading.confidence import RIGHT_IN_BOTH, RIGHT_IN_ONE, as_found_twice, of_label
from brace.diagnose.loading.evidence import SPREAD, score
from brace.diagnose.loading.noise_after_base import with_growth
from brace.diagnose.loading.extensions import TAKES_BACK, Outside, _by_load, outside
from brace.diagnose.loading.fit import fit
from brace.identify.noise import growth_of, hinted_growth, noise_of, robust_sigma
from brace.dataset.enough import enough_rows
from brace.diagnose.loading.parts import locked_rows
from brace.identify import record as identify_record
from brace.identify.record import load_record, setting_of
from brace.diagnose.loading import run as loading_run, search as loading_search
from brace.diagnose.loading.run import search_pass
from brace.diagnose.loading.screen import Remover
from brace.diagnose.loading.search import Search
from brace.diagnose.loading.space import compatible, space_of, trust_of
from brace.diagnose.loading.structure import structure_of
from brace.diagnose.loading.verdict import HINT, NOTHING_STANDS, decide
from brace.effects import EFFECTS, all_variants
from brace.model import LimbModel, load_limb
from brace.native.plant import play_rig
from handmade import loading_record

NOISE_N = 0.06
META = """format = 1
kind = "loading"
[sensor]
resolution_n = 0.0
range_n = 1e3
[rig]
step_mm = 0.6
dwell_s = 4.0
"""
POSES = np.array([(0.4, 0.6), (0.9, 1.1), (1.3, 1.7), (0.6, 1.5), (1.5, 2.2), (1.0, 0.8), (0.2, 1.2), (1.7, 2.5)])


@pytest.fixture(scope="module")
def believed(tmp_path_factory: pytest.TempPathFactory) -> LimbModel:
    path = tmp_path_factory.mktemp("limb") / "limb.toml"
    path.write_text(
        "format = 1\n[geometry]\nfemur_mm = 210.0\ntibia_mm = 280.0\n"
        "[link.femur]\naxial_mm_per_n = 0.001\nbending_mm_per_n = 0.05\n"
        "[link.tibia]\naxial_mm_per_n = 0.002\nbending_mm_per_n = 0.2\n"
        "[joint.femur]\ncompliance_rad_per_n_mm = 1.1e-5\n[joint.tibia]\ncompliance_rad_per_n_mm = 1.5e-5\n"
        "[uncertainty]\nlength_mm = 0.5\nangle_rad = 0.003\ncompliance_rel = 0.05\ngain_rel = 0.005\n"
    )
    return load_limb(path)


def recorded(
    folder: Path, limb: LimbModel, seed: int, *, repeats: int = 2, noise_n: float = NOISE_N, growth: float = 0.0
) -> Dataset:
    """A record of this limb with white noise, and noise that grows with the load."""
    design = {
        "theta1_rad": POSES[:, 0].copy(),
        "theta2_rad": POSES[:, 1].copy(),
        "step_mm": 0.6,
        "repeats": repeats,
        "resolution_n": 0.0,
        "range_n": 1e3,
        "seed": seed,
    }
    columns: Mapping[str, Any] = play_rig(limb, design)
    rng = np.random.default_rng(seed)
    names = ("run", "config", "theta1_rad", "theta2_rad", "axis", "rep", "step", "t_s", "temp_degc", "dx_mm", "dz_mm")
    lines = [",".join((*names, "fx_n", "fz_n"))]
    for row in range(len(columns["run"])):
        cells = ["xz"[columns["axis"][row]] if name == "axis" else repr(columns[name][row].item()) for name in names]
        for axis in ("fx_n", "fz_n"):
            force = columns[axis][row]
            cells.append(repr(float(force + rng.normal() * np.hypot(noise_n, growth * force))))
        lines.append(",".join(cells))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "meta.toml").write_text(META)
    (folder / "data.csv").write_text("\n".join(lines) + "\n")
    return load_dataset(folder)


@pytest.mark.parametrize("repeats", [1, 3])
def test_noise_is_read_off_the_record(tmp_path: Path, believed: LimbModel, repeats: int) -> None:
    """Within 15 %: some hundred differences tell a sigma to about 5 %."""
    noise = noise_of(recorded(tmp_path, believed, 1, repeats=repeats), ["fx_n"])["fx_n"]
    assert noise.floor == pytest.approx(NOISE_N, rel=0.15)
    assert noise.growth_ratio == 0.0


def test_noise_that_grows_with_load_is_told_by_repeats(tmp_path: Path, believed: LimbModel) -> None:
    noise = noise_of(recorded(tmp_path, believed, 2, repeats=3, growth=0.01), ["fx_n"])["fx_n"]
    assert noise.growth_ratio == pytest.approx(0.01, rel=0.5)
    assert noise.floor == pytest.approx(NOISE_N, rel=0.3)


@pytest.mark.parametrize("share", [0.0, 0.05, 0.2])
def test_corners_are_no_noise(share: float) -> None:
    """A sigma from 4000 draws is told to 1.1 %; what is far off, up to a fifth of all, moves it by no more than the
    few that the noise itself has out there."""
    rng = np.random.default_rng(8)
    off = 0.3 * rng.standard_normal(4000)
    off[: int(share * off.size)] += 40.0
    assert robust_sigma(off) == pytest.approx(0.3, rel=0.04)


def test_coarse_steps_still_have_a_noise() -> None:
    """Most differences are nothing, some are a step of the resolution."""
    off = np.where(np.arange(1000) % 4 == 0, 0.0625, 0.0)
    assert 0.02 < robust_sigma(off) < 0.04


def test_noise_that_grows_is_asked_of_both_channels_of_a_sensor() -> None:
    """One whose loads are too small to tell goes with the other when they speak for it together; none grows when
    neither does; one alone does when the other's is plainly constant."""
    rng = np.random.default_rng(4)
    size = np.abs(20.0 * rng.standard_normal((2, 900)))
    both = 0.06 * np.hypot(1.0, 0.07 * size) * rng.standard_normal((2, 900))
    some = growth_of([(both[0], size[0]), (both[1][:60], size[1][:60])])
    assert growth_of([(both[1][:60], size[1][:60])]) == [None]
    assert some[1] is not None and some[1][1] == pytest.approx(0.06 * 0.07, rel=0.4)
    white = 0.06 * rng.standard_normal((2, 900))
    assert growth_of(list(zip(white, size))) == [None, None]
    one, other = growth_of([(3.0 * both[0], 3.0 * size[0]), (white[1], size[1])])
    assert one is not None and other is None


def test_one_channel_that_grows_by_itself_must_be_far_likelier() -> None:
    """The noise of both channels of a sensor grows. By chance the thirty readings of one channel under the most load
    scatter little."""
    rng = np.random.default_rng(12)
    size = np.abs(5.0 * rng.standard_normal((2, 300)))
    off = 0.02 * np.hypot(1.0, 0.15 * size) * rng.standard_normal((2, 300))
    off[0][np.argsort(size[0])[-30:]] *= 0.3
    alone = growth_of([(off[0], size[0])])
    found = growth_of(list(zip(off, size)))
    assert alone == [None] and None not in found


def test_repeats_that_only_hint_at_a_noise_that_grows_ask_what_the_search_leaves(
    tmp_path: Path, believed: LimbModel
) -> None:
    """Too few readings under load for repeats to say it alone; a record whose noise does not grow asks nothing."""
    grows = recorded(tmp_path / "grows", believed, 4, growth=0.005)
    steady = recorded(tmp_path / "steady", believed, 4)
    assert noise_of(grows, ["fx_n", "fz_n"])["fx_n"].growth_ratio == 0.0, "not by repeats alone"
    hinted = hinted_growth(grows, ["fx_n", "fz_n"])
    assert set(hinted) == {"fx_n", "fz_n"} and hinted_growth(steady, ["fx_n", "fz_n"]) == {}


def test_only_a_force_s_noise_may_grow_with_the_reading(tmp_path: Path) -> None:
    """Noise in proportion to the reading, on a force and on an encoder: an encoder's is as large as what it reads."""
    limb = Path(__file__).parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
    data = load_dataset(loading_record(tmp_path / "record", limb, values={}, repeats=1, sensor="encoders = true\n"))
    record = load_record(data)
    space = space_of(trust_of(load_limb(limb), turns=True), ())
    size = np.abs(record.measured) / np.abs(record.measured).max(axis=1)[:, None]
    grown = np.hypot(1.0, 9.0 * size) * np.random.default_rng(5).standard_normal(size.shape)
    found = with_growth(record, replace(fit(record, space, space.mean), residual=grown.ravel()))
    assert found is not None
    assert {name for name in found.channels if found.noise[name].growth_ratio > 0.0} == {"fx_n", "fz_n"}


def test_rounding_is_no_sign_of_a_load() -> None:
    """What a model plays at rest is rounding, whose sign would follow the reading."""
    ways = _by_load(np.array([1e-15, -1e-15, 2.0, -3.0]))
    assert ways["acted under positive load only"].tolist() == [0.0, 0.0, 1.0, 0.0]
    assert ways["acted under negative load only"].tolist() == [0.0, 0.0, 0.0, 1.0]


def test_a_reading_under_load_is_no_glitch(tmp_path: Path, believed: LimbModel) -> None:
    """Where the noise grows to five times with the load, which was not told, no reading under load is a fault of its
    own; the same deviation of one under little load is."""
    record = load_record(recorded(tmp_path, believed, 6))
    space = space_of(trust_of(believed, turns=True), ())
    found = fit(record, space, space.mean)
    rng = np.random.default_rng(2)
    left = rng.standard_normal(record.measured.shape)
    order = np.argsort(np.abs(record.measured[0]))
    left[0] *= np.hypot(1.0, 5.0 * record.measured[0] / np.abs(record.measured[0]).max())
    left[0][order[-1]] = 9.0
    small = left.copy()
    small[0][order[5]] = 9.0

    def p_of(residual: np.ndarray) -> float:
        tests = structure_of(record, replace(found, residual=residual.ravel())).families
        return next(test.p for test in tests if test.words == "in single readings")

    assert p_of(left) > 1e-3
    assert p_of(small) < 1e-6


def test_a_hint_is_told_and_not_named(tmp_path: Path, believed: LimbModel) -> None:
    """Between the odds that are asked of a name and those that are worth a second record."""
    record = load_record(recorded(tmp_path, believed, 9))
    found = search_pass(
        record, trust_of(believed, turns=True), all_variants(setting_of(record, believed)), lambda _a, _b: None
    )
    nothing = next(item for item in found.sets if not item.labels)
    for share, told in ((0.9, None), (0.5 * (HINT + NOTHING_STANDS), 0.1)):
        chosen = replace(nothing, posterior=share)
        odds = replace(found.decision, verdict="none", chosen=chosen).hint_odds
        assert (odds is None) == (told is None)
        assert odds is None or odds == pytest.approx((1.0 - share) / share)


def test_base_fit_finds_the_least_of_a_linear_problem(tmp_path: Path, believed: LimbModel) -> None:
    """At the least, the slope of the cost is nothing beside its curvature: no key could gain a hundredth."""
    record = load_record(recorded(tmp_path, believed, 3))
    space = space_of(trust_of(believed, turns=True), ())
    found = fit(record, space, space.mean)
    slope = found.jacobian.T @ found.residual - found.scale / space.sigma * space.pull(found.x)
    curvature = np.sum(found.jacobian**2, axis=0) + (found.scale / space.sigma) ** 2
    assert np.max(slope**2 / curvature) < 0.01
    assert found.chi2 == pytest.approx(found.residual.size, rel=0.15)


def test_structure_of_pure_noise_is_none_and_of_a_shape_is_found(tmp_path: Path, believed: LimbModel) -> None:
    """p is about uniform for noise (20 records: none under 0.001); a wave of 1 sigma amplitude is 25 sigma in all."""
    space = space_of(trust_of(believed, turns=True), ())
    for seed in range(20):
        record = load_record(recorded(tmp_path / str(seed), believed, 100 + seed))
        assert structure_of(record, fit(record, space, space.mean)).p > 1e-3, seed
    data = recorded(tmp_path / "wave", believed, 7)
    wave = NOISE_N * np.sin(2 * np.pi * data["dx_mm"] / 1.3)
    record = load_record(data.with_columns({"fx_n": data["fx_n"] + wave}))
    assert structure_of(record, fit(record, space, space.mean)).structured


def test_what_the_base_can_make_up_is_taken_out_and_nothing_else(tmp_path: Path, believed: LimbModel) -> None:
    """A signature that is one of the base's own leaves only what its prior holds back: 1 / (1 + power of the data over
    the prior's) of its square. One that the base cannot make stays whole."""
    record = load_record(recorded(tmp_path, believed, 4))
    space = space_of(trust_of(believed, turns=True), ())
    found = fit(record, space, space.mean)
    remover = Remover(found)
    place = space.keys.index("sensor.gain")
    own = found.jacobian[:, place]
    alone = np.linalg.norm(own) ** 2 / (1.0 + np.linalg.norm(own) ** 2 / (found.scale[place] / space.sigma[place]) ** 2)
    assert np.linalg.norm(remover.columns(own[:, None])) ** 2 <= alone * (1.0 + 1e-9)
    moved = remover.augmented(np.stack([found.residual + own, found.residual]))
    assert np.linalg.norm(moved[0] - moved[1]) ** 2 <= alone * (1.0 + 1e-9)
    foreign = np.random.default_rng(1).normal(size=own.size)
    basis, _ = np.linalg.qr(found.jacobian)
    foreign -= basis @ (basis.T @ foreign)
    left = remover.columns(foreign[:, None])[: own.size, 0]
    assert np.linalg.norm(left - foreign) < 1e-6 * np.linalg.norm(foreign)


def test_a_limb_seen_before_has_the_residuals_that_it_had(
    tmp_path: Path, believed: LimbModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever was asked for in between, and whatever was done to what was given."""
    monkeypatch.setattr(identify_record, "MOST_KNOWN", 3)
    record = load_record(recorded(tmp_path, believed, 12))
    space = space_of(trust_of(believed, turns=True), ())
    models = space.models(space.mean + np.outer(np.arange(5), 0.1 * space.sigma))
    alone = np.array([replace(record).residuals(model[None])[0] for model in models])
    for some in ([0, 1], [1, 0, 1], [], [0, 2, 3, 4, 0], [4, 1]):
        found = record.residuals(models[some])
        assert np.array_equal(found, alone[some]), some
        found += 1.0


def test_a_freedom_that_gains_nothing_costs_its_share(tmp_path: Path, believed: LimbModel) -> None:
    """Two fits of the same cost, one with a freedom more: log SPREAD apart; a second effect costs its prior besides."""
    record = load_record(recorded(tmp_path, believed, 5))
    trust = trust_of(believed, turns=True)
    variants = [v for v in all_variants(setting_of(record, believed)) if v.label == "sensor_bias@sensor"]
    base = fit(record, space_of(trust, ()), space_of(trust, ()).mean)
    one, _, both = (fit(record, space_of(trust, (way,)), space_of(trust, (way,)).mean) for way in variants)
    same = replace(both, cost=one.cost)
    assert score(one, base, record.readings, 1e9) - score(same, base, record.readings, 1e9) == pytest.approx(
        np.log(SPREAD), abs=1e-6
    )


def test_nothing_hidden_nothing_found(tmp_path: Path, believed: LimbModel) -> None:
    record = load_record(recorded(tmp_path, believed, 11))
    search = Search(record, trust_of(believed, turns=True), all_variants(setting_of(record, believed)))
    assert search.run()[0].label == "none"


@pytest.mark.parametrize(
    ("key", "value", "label"),
    [
        ("joint.tibia.gap_rad", 1.5e-3, "backlash@joint.tibia"),
        pytest.param("joint.femur.coulomb_n_mm", 40.0, "coulomb_friction@joint.femur", marks=pytest.mark.minutes),
        ("sensor.bias_z_n", 0.1, "sensor_bias@sensor"),
        ("contact.play_mm", 0.06, "contact_play@contact"),
    ],
)
def test_a_hidden_effect_is_found_with_its_size(
    tmp_path: Path, believed: LimbModel, key: str, value: float, label: str
) -> None:
    record = load_record(recorded(tmp_path, believed.with_values({key: value}), 12))
    search = Search(record, trust_of(believed, turns=True), all_variants(setting_of(record, believed)))
    best = search.run()[0]
    assert best.label == label
    assert best.fit.value(key) == pytest.approx(value, rel=0.25)


def test_every_part_of_the_best_set_is_tried(tmp_path: Path, believed: LimbModel) -> None:
    """Also the parts that no search came by, so that a trouble of the instruments may stand for the rest."""
    both = {"joint.tibia.gap_rad": 1.5e-3, "joint.femur.coulomb_n_mm": 80.0}
    record = load_record(recorded(tmp_path, believed.with_values(both), 12))
    search = Search(record, trust_of(believed, turns=True), all_variants(setting_of(record, believed)))
    best = search.run()[0]
    assert len(best.labels) == 2
    search.tried = {name: item for name, item in search.tried.items() if not (item.labels < best.labels and name)}
    search._parts_of(best)
    assert {frozenset({label}) for label in best.labels} <= {item.labels for item in search.tried.values()}


@pytest.mark.parametrize(("lead", "verdict"), [(-0.1, "ambiguous"), (0.1, "unknown")])
def test_names_that_are_wrong_more_often_than_right_are_not_said(lead: float, verdict: str) -> None:
    """Two effects that look alike, and something outside the catalogue that is likelier than both or less likely."""
    fitted = cast(Any, SimpleNamespace(fit=SimpleNamespace(cost=100.0), label="x"))
    sets = [LabelSet(frozenset({name}), fitted, 0.5) for name in ("a", "b")]
    structure, base = cast(Any, SimpleNamespace(structured=False)), cast(Any, SimpleNamespace(cost=200.0))
    assert decide(sets, structure, base, Outside(lead, "", TAKES_BACK)).verdict == verdict


@pytest.mark.parametrize(("rest", "verdict"), [(2.9, "ambiguous"), (3.1, "unknown"), (50.0, "unknown")])
def test_what_is_left_unnames_an_effect_from_three_hundredths_of_what_it_explains(rest: float, verdict: str) -> None:
    fitted = cast(Any, SimpleNamespace(fit=SimpleNamespace(cost=100.0), label="x"))
    sets = [LabelSet(frozenset({name}), fitted, 0.5) for name in ("a", "b")]
    structure = cast(Any, SimpleNamespace(structured=True, strongest=SimpleNamespace(gain=rest)))
    base = cast(Any, SimpleNamespace(cost=200.0))
    assert decide(sets, structure, base, Outside(-50.0, "")).verdict == verdict


def against_the_catalogue(data: Dataset, believed: LimbModel) -> tuple[Outside, str]:
    """What speaks for something outside the catalogue, and what the best in it is called."""
    record = load_record(data)
    variants = all_variants(setting_of(record, believed))
    sets = posterior_of(Search(record, trust_of(believed, turns=True), variants).run(), variants)
    return outside(record, sets, variants), sets[0].label


def clock(data: Dataset) -> np.ndarray:
    """0 at the record's start, 1 at its end."""
    return np.asarray(data["t_s"] / np.ptp(data["t_s"]))


@pytest.mark.minutes
def test_what_changes_during_the_record_is_not_in_the_catalogue(tmp_path: Path, believed: LimbModel) -> None:
    """A gain that grows by 6 % over the record, of 6 N rms in 544 rows: some 20 sigma after refitting, and a link that
    changes half way makes most of it; the words say what changes, and with what."""
    data = recorded(tmp_path / "gain", believed, 21)
    gain = 1.0 + 0.06 * clock(data)
    grown = data.with_columns({name: data[name] * gain for name in ("fx_n", "fz_n")})
    found, _ = against_the_catalogue(grown, believed)
    assert found.likely and found.probability > 0.99
    assert found.words == "sensor.gain grew with time"
    soft = recorded(tmp_path / "soft", believed.with_values({"joint.tibia.compliance_rad_per_n_mm": 1.8e-5}), 22)
    stiff = recorded(tmp_path / "stiff", believed, 22)
    side = np.where(soft["axis"] == 1, soft["dz_mm"], soft["dx_mm"]) > 0.0
    both = {name: np.where(side, soft[name], stiff[name]) for name in ("fx_n", "fz_n")}
    found, _ = against_the_catalogue(soft.with_columns(both), believed)
    assert found.likely
    assert "load only" in found.words


@pytest.mark.parametrize(
    ("values", "label"),
    [
        ({}, "none"),
        ({"joint.femur.hardening_n_mm_per_rad3": 4e9}, "joint_hardening@joint.femur"),
        pytest.param({"joint.tibia.gap_rad": 2e-3}, "backlash@joint.tibia", marks=pytest.mark.minutes),
        pytest.param({"sensor.drift_x_n_per_s": 2e-4}, "sensor_drift@sensor", marks=pytest.mark.minutes),
        pytest.param(
            {"joint.femur.coulomb_n_mm": 40.0, "sensor.bias_z_n": 0.1},
            "coulomb_friction@joint.femur + sensor_bias@sensor",
            marks=pytest.mark.minutes,
        ),
        ({"change.link": "tibia", "change.at_s": 1100.0, "change.bending_factor": 1.4}, "link_change@link.tibia"),
    ],
)
def test_an_effect_of_the_catalogue_is_not_outside_it(
    tmp_path: Path, believed: LimbModel, values: dict[str, Any], label: str
) -> None:
    """Hardening is a compliance that changes with the load, drift a bias that changes with time, a cracked link a
    bending that does: by another name they are still what they are."""
    found, best = against_the_catalogue(recorded(tmp_path, believed.with_values(values), 23), believed)
    assert best == label
    assert not found.likely and found.probability < 0.3


def test_the_odds_of_an_outsider_lower_the_confidence(tmp_path: Path, believed: LimbModel) -> None:
    """By just their share; a lead of nothing is even odds."""
    assert Outside(0.0, "").probability == 0.5
    assert not Outside(0.0, "").likely and not Outside(-0.1, "", TAKES_BACK).likely
    assert Outside(0.1, "", TAKES_BACK).likely, "a name that is wrong more often than right is taken back"
    assert not Outside(5.5, "").likely, "a sound limb is called faulty at 400 to 1 only"
    record = load_record(recorded(tmp_path, believed.with_values({"joint.tibia.gap_rad": 2e-3}), 24))
    variants = all_variants(setting_of(record, believed))
    found = search_pass(record, trust_of(believed, turns=True), variants, lambda share, doing: None)
    sure, torn = (
        of_label(replace(found, decision=replace(found.decision, outside=Outside(lead, ""))), "backlash@joint.tibia")
        for lead in (-50.0, 0.0)
    )
    assert sure > 0.95
    assert torn == pytest.approx(0.5 * sure)


def test_a_quarter_of_the_configurations_is_locked_and_none_at_the_ends(tmp_path: Path, believed: LimbModel) -> None:
    data = recorded(tmp_path, believed, 1, repeats=1)
    locked = locked_rows(data)
    knees = np.unique(data["theta2_rad"][locked])
    assert len(knees) == 2
    assert POSES[:, 1].min() < knees.min() and knees.max() < POSES[:, 1].max()
    few = data.select(data["config"] <= 3)
    assert not locked_rows(few).any()


@pytest.mark.parametrize(("hoped", "kept", "again"), [(96.0, 1.0, True), (94.0, 1.0, False), (96.0, 60.0, False)])
def test_a_promise_is_tried_again_where_it_would_come_near_the_best(
    monkeypatch: pytest.MonkeyPatch, hoped: float, kept: float, again: bool
) -> None:
    """By 5 nats, and where the first fit kept no more than half of what the slopes promised."""
    monkeypatch.setattr(loading_search, "evidence", lambda *_: hoped)
    record = SimpleNamespace(readings=100, noise_freedom=10.0)
    at = SimpleNamespace(fit=SimpleNamespace(cost=200.0))
    searched = SimpleNamespace(tried={"best": SimpleNamespace(score=100.0)}, base=at, record=record)
    promise = SimpleNamespace(cost=100.0, space=SimpleNamespace(own=1, variants=()))
    fitted = SimpleNamespace(cost=200.0 - kept)
    assert Search._fell_short(cast(Any, searched), cast(Any, promise), cast(Any, fitted), cast(Any, at)) is again


def test_a_long_record_is_thinned_by_whole_runs(tmp_path: Path, believed: LimbModel) -> None:
    data = recorded(tmp_path, believed, 1, repeats=12)
    keep = enough_rows(data, 600)
    assert 500 <= keep.sum() <= 700
    assert 1000 <= enough_rows(data, 1200).sum() <= 1400
    assert set(np.unique(data["config"][keep])) == set(np.unique(data["config"]))
    for run in np.unique(data["run"]):
        assert len(set(keep[data["run"] == run].tolist())) == 1


def test_the_catalogue_is_whole_and_its_keys_exist(tmp_path: Path, believed: LimbModel) -> None:
    """Twenty names as the format lists them; each variant makes a space of its own."""
    record = load_record(recorded(tmp_path, believed, 1, repeats=1))
    variants = all_variants(setting_of(record, believed))
    assert len(EFFECTS) == len({effect.name for effect in EFFECTS}) == 20
    trust = trust_of(believed, turns=True)
    for variant in variants:
        space = space_of(trust, (variant,))
        assert len(space.keys) == len(set(space.keys)) == len(space.mean)
        assert not compatible((variant, variant)) or not variant.keys


@pytest.mark.parametrize(
    ("twin", "left"),
    [
        (None, {"a": 1.0, "b": 1.0, "rig": 1.0}),
        ("", {"a": 1.0, "b": 1.0, "rig": 1.0}),
        ("ab", {"a": 1.0, "b": 1.0, "rig": 1.0}),
        ("ac", {"a": RIGHT_IN_BOTH[2], "b": RIGHT_IN_ONE, "rig": RIGHT_IN_BOTH[2]}),
        ("c", {"a": RIGHT_IN_ONE, "b": RIGHT_IN_ONE, "rig": RIGHT_IN_BOTH[2]}),
    ],
)
def test_a_name_that_is_not_found_twice_is_less_sure(twin: str | None, left: dict[str, float]) -> None:
    """A cause outside the catalogue, as a rig, is not looked for a second time."""

    def found(labels: str) -> Any:
        return SimpleNamespace(decision=SimpleNamespace(chosen=SimpleNamespace(labels=frozenset(labels))))

    other = None if twin is None else found(twin)
    assert {label: as_found_twice(found("ab"), other, label) for label in left} == left


@pytest.mark.parametrize(
    ("lead", "is_named", "verdict"), [(20.0, False, "unknown"), (2.0, False, "effect"), (2.0, True, "effect")]
)
def test_what_has_no_name_and_does_better_leaves_the_verdict_open(
    believed: LimbModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lead: float, is_named: bool, verdict: str
) -> None:
    """Forces that follow the posture are no trouble of the instruments, and no effect's, either."""
    data = recorded(tmp_path, believed.with_values({"joint.tibia.gap_rad": 2e-3}), 7)
    record, trust = load_record(data), trust_of(believed, turns=True)
    better: Any = SimpleNamespace(
        lead=lead, far_ahead=lead > 4.6, is_named=is_named, meaning="the force at rest differed",
        cause=SimpleNamespace(in_limb=False),
    )  # fmt: skip
    monkeypatch.setattr(loading_run, "likeliest", lambda record, sets: better)
    found = search_pass(record, trust, all_variants(setting_of(record, believed)), lambda share, doing: None)
    assert found.decision.verdict == verdict
    assert (found.rival is better) == is_named
    if verdict == "unknown":
        assert found.decision.outside.words == "the force at rest differed" and found.decision.outside.lead == lead
