"""How far the refit may go, what K becomes, which probability stands, and where the misfit is: each against another way
to the same number."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from handmade import POSES, loading_record
from scipy.optimize import minimize

from brace.dataset import Dataset, load_dataset
from brace.diagnose.diagnosis import Alternative, NamedEffect, StiffnessAt
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.localise import localise
from brace.diagnose.loading.outcome import _as_named
from brace.diagnose.loading.space import space_of, trust_of
from brace.diagnose.loading.structure import slopes
from brace.diagnose.loading.within_trust import allowed_sigma, pull_sigma, within_trust
from brace.diagnose.stiffness_change import apart, stiffness_change
from brace.identify.record import Record, load_record
from brace.model import LimbModel, load_limb
from brace.native.plant_batch import reference_planar_many

KNEE = "joint.tibia.compliance_rad_per_n_mm"


@pytest.fixture(scope="module")
def limb() -> Path:
    return Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


@pytest.fixture(scope="module")
def believed(limb: Path) -> LimbModel:
    return load_limb(limb)


def _refitted(data: Dataset, believed: LimbModel) -> tuple[Record, Fit]:
    record = load_record(data)
    space = space_of(trust_of(believed, turns=True), ())
    return record, fit(record, space, space.mean)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory, limb: Path) -> Dataset:
    """A record of the limb as it is believed."""
    return load_dataset(loading_record(tmp_path_factory.mktemp("sound") / "data", limb, values={}))


@pytest.fixture(scope="module")
def soft(tmp_path_factory: pytest.TempPathFactory, limb: Path, believed: LimbModel) -> Dataset:
    """A record of one whose knee is twice as soft."""
    twice = {KNEE: 2.0 * believed.number(KNEE)}
    return load_dataset(loading_record(tmp_path_factory.mktemp("soft") / "data", limb, values=twice))


def test_a_refit_within_the_trust_stays_as_it_is(sound: Dataset, believed: LimbModel) -> None:
    record, refitted = _refitted(sound, believed)
    assert pull_sigma(refitted) < allowed_sigma(refitted.space)
    assert within_trust(record, refitted) is None


def test_one_number_may_be_three_sigma_off(believed: LimbModel) -> None:
    """99.73 % of a normal law lie within three sigma; of more numbers together the bound is wider."""
    space = space_of(trust_of(believed, turns=True), ())
    draws = np.random.default_rng(1).normal(size=(200_000, int(np.isfinite(space.sigma).sum())))
    inside = np.linalg.norm(draws, axis=1) <= allowed_sigma(space)
    assert inside.mean() == pytest.approx(0.9973, abs=0.0006)  # five sigma of 200,000 draws


def test_the_best_limb_that_the_trust_allows(soft: Dataset, believed: LimbModel) -> None:
    """Against a general minimiser with the bound as its constraint, which plays the limb and linearises nothing."""
    record, refitted = _refitted(soft, believed)
    space, allowed = refitted.space, allowed_sigma(refitted.space)
    assert pull_sigma(refitted) > allowed
    model = within_trust(record, refitted)
    assert model is not None
    trusted = np.isfinite(space.sigma)
    pull = ((model[space.places] - space.mean) / space.sigma)[trusted]
    assert np.linalg.norm(pull) == pytest.approx(allowed, rel=1e-6)

    unit = np.where(trusted, space.sigma, refitted.scale)
    middle = np.where(trusted, space.mean, refitted.x)

    def left(moved: np.ndarray) -> float:
        residual = space.residuals(record, (middle + unit * moved)[None])[0]
        return float(residual @ residual)

    best = minimize(
        left,
        np.zeros(space.size),
        method="SLSQP",
        bounds=list(zip((space.low - middle) / unit, (space.high - middle) / unit, strict=True)),
        constraints={"type": "ineq", "fun": lambda moved: allowed**2 - float(np.sum(moved[trusted] ** 2))},
        options={"maxiter": 60},
    )
    found = record.residuals(model[None])[0]
    assert refitted.chi2 < found @ found < 1.01 * best.fun
    assert left(np.zeros(space.size)) > 1.05 * found @ found, "the bound leaves something to gain"


def test_k_is_compared_where_it_changes_most(sound: Dataset, believed: LimbModel) -> None:
    """A second spring in the knee, by hand: the compliance grows by s2 w w', w the lever of the tip force about it."""
    spring = believed.number(KNEE)
    softer = believed.with_values({KNEE: 2.0 * spring})
    change = stiffness_change(sound, believed, softer)
    assert change is not None

    def after(before: np.ndarray, theta1: float, theta2: float) -> np.ndarray:
        along = theta1 + believed.number("joint.femur.zero_offset_rad")
        along -= theta2 + believed.number("joint.tibia.zero_offset_rad")
        lever = believed.number("geometry.tibia_mm") * np.array([-np.sin(along), np.cos(along)])
        return np.asarray(np.linalg.inv(np.linalg.inv(before) + spring * np.outer(lever, lever)))

    def matrix(at: StiffnessAt) -> np.ndarray:
        return np.array([[at.k_xx_n_per_mm, at.k_xz_n_per_mm], [at.k_xz_n_per_mm, at.k_zz_n_per_mm]])

    def size(one: StiffnessAt, other: StiffnessAt) -> float:
        return float(np.linalg.norm(matrix(other) - matrix(one)) / np.linalg.norm(matrix(one)))

    assert matrix(change.exported) == pytest.approx(
        after(matrix(change.believed), change.believed.theta1_rad, change.believed.theta2_rad), rel=1e-9
    )
    largest = size(change.believed, change.exported)
    at_each = []
    for config in np.unique(sound["config"]):
        alone = stiffness_change(sound.select(sound["config"] == config), believed, softer)
        assert alone is not None
        at_each.append(size(alone.believed, alone.exported))
    assert len(at_each) == len(POSES) and largest == max(at_each) > min(at_each)


def test_how_far_two_k_are_apart_counts_xz_twice() -> None:
    one, other = np.array([[3.0, 1.0, 2.0]]), np.array([[3.0, 1.5, 2.0]])
    assert apart(other, one) == pytest.approx(np.sqrt(2 * 0.25) / np.sqrt(9 + 2 + 4))


def test_an_explanation_is_as_sure_as_its_names() -> None:
    k = StiffnessAt(0.0, 1.0, 1.0, 0.0, 1.0)
    effects = [NamedEffect(name, "here", sure, {}, sure) for name, sure in (("a", 0.6), ("b", 0.3))]
    given = [Alternative(label, 0.5, k) for label in ("a@here", "a@here + b@here", "c@here")]
    assert [one.probability for one in _as_named(given, effects)] == [0.6, 0.3, 0.5]


def _places(data: Dataset, believed: LimbModel) -> dict[str, float]:
    """Words and share of what stands out."""
    found = localise(*_refitted(data, believed), seed=0)
    return {spot.where: spot.share or 0.0 for spot in found}


def _pushed(data: Dataset, shape: np.ndarray) -> Dataset:
    return data.with_columns({"fx_n": data["fx_n"] + shape})


def test_each_place_is_said_once(sound: Dataset, believed: LimbModel) -> None:
    """A sound record shows none. Two pushes, each at one configuration, the first twice as large: they are named in
    this order, and what contrasts that resemble them would add is under a twentieth of the misfit."""
    assert not _places(sound, believed)
    one, two = (np.where(sound["config"] == config, 1.0, 0.0) for config in np.unique(sound["config"])[[1, 4]])
    found = _places(_pushed(sound, 2.0 * one + 1.0 * two), believed)
    assert list(found.values()) == sorted(found.values(), reverse=True)
    first, second = list(found)[:2]
    assert first.startswith(f"at configuration {np.unique(sound['config'])[1]} ") and ", in fx whatever" in first
    assert second.startswith(f"at configuration {np.unique(sound['config'])[4]} ") and ", in fx whatever" in second
    assert len(found) <= 4 and sum(found.values()) <= 1.0 and min(found.values()) >= 0.05


def test_a_force_that_is_off_at_every_reading_is_placed_there(sound: Dataset, believed: LimbModel) -> None:
    for name in ("fx", "fz"):
        off = sound.with_columns({f"{name}_n": sound[f"{name}_n"] + 1.0})
        assert next(iter(_places(off, believed))) == f"in {name}, the same at every reading"


def test_what_a_force_rises_by_along_a_run_is_an_entry_of_k(sound: Dataset, believed: LimbModel) -> None:
    record, fitted = _refitted(sound, believed)
    is_x = sound["axis"] == 0
    angles = np.stack([sound["theta1_rad"], sound["theta2_rad"]], axis=1)
    xx, xz, zz = reference_planar_many(fitted.model[None], angles[None])[0, :, :3].T
    found = slopes(record, fitted, np.where(is_x, sound["dx_mm"], sound["dz_mm"]))
    wanted = np.stack([np.where(is_x, xx, xz), np.where(is_x, xz, zz)])
    assert np.abs(found - wanted).max() < 0.02 * np.abs(wanted).max()


def test_traces_of_one_shape_are_not_places_of_their_own(tmp_path: Path, limb: Path, believed: LimbModel) -> None:
    """Play leaves a trace in most contrasts. What each has beyond those before it adds up to the misfit at most."""
    found = _places(load_dataset(loading_record(tmp_path / "play", limb)), believed)
    assert found and sum(found.values()) <= 1.0 and min(found.values()) >= 0.05


def test_time_is_named_only_where_postures_were_visited_again(sound: Dataset, believed: LimbModel) -> None:
    """A push that grows from the first to the last reading. Once each posture is done with before the next, once all
    are pressed along x and then all of them along z."""
    said = []
    for order in (np.arange(len(sound["t_s"])), np.argsort(sound["axis"], kind="stable")):
        data = sound.select(order).with_columns({"t_s": 30.0 * np.arange(len(order))})
        push = np.linspace(-1.5, 1.5, len(order))
        said.append(" ".join(_places(_pushed(data, push), believed)))
    assert "growing with the order of the postures" in said[0] and "growing with time" not in said[0]
    assert "growing with time" in said[1] and "order of the postures" not in said[1]
