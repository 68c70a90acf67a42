"""Friction that is strained before it slides: its columns against a closed form, and a record that has it."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import numpy as np
import pytest
from brace.dataset import Dataset, load_dataset
from brace.diagnose.diagnosis import Diagnosis, Verdict
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.extensions import Outside
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.plain_loop import with_plain_loop
from brace.diagnose.loading.run import diagnose_loading
from brace.diagnose.loading.troubles import likeliest
from brace.diagnose.loading.search import Hypothesis
from brace.diagnose.loading.search_pass import Pass
from brace.diagnose.loading.space import space_of, trust_of
from brace.diagnose.loading.troubles.presliding import (
    STRAINS,
    by_place,
    friction_n_mm,
    presliding_columns,
    sliding_rad,
    turned_columns,
    turned_rad,
)
from brace.diagnose.loading.structure import structure_of
from brace.diagnose.loading.verdict import Decision
from brace.diagnose.options import Options, silent
from brace.identify.record import Record, levers, load_record
from brace.model import LimbModel, load_limb
from brace.native.plant_batch import number_index, reference_planar_many
from handmade import loading_record

LEVEL_N_MM, STRAIN_RAD = 60.0, 1.5e-3
KEPT_N_MM, SHAKEN_OFF = 80.0, 0.3


def bent_before_it_slides(way_rad: np.ndarray, run: np.ndarray) -> np.ndarray:
    """Dahl's torque along a way, in closed form between two readings: it goes to the level as an exponential."""
    torque, out = 0.0, np.empty(way_rad.size)
    for row, at in enumerate(way_rad):
        begins = row == 0 or run[row] != run[row - 1]
        step = at if begins else at - way_rad[row - 1]
        end = np.sign(step) * LEVEL_N_MM
        torque = end + ((0.0 if begins else torque) - end) * np.exp(-abs(step) / STRAIN_RAD)
        out[row] = torque
    return out


def way_and_push(data: Dataset, limb: LimbModel, joint: str) -> tuple[np.ndarray, np.ndarray]:
    """The joint's way without friction, by the record's own forces, and the forces for a torque of 1 that holds it
    back (K J c; the tip is held), 2 x rows."""
    lengths = (limb.number("geometry.femur_mm"), limb.number("geometry.tibia_mm"))
    arms = levers(*lengths, data["theta1_rad"], data["theta2_rad"])[joint]
    yields = limb.number(f"joint.{joint}.compliance_rad_per_n_mm")
    index, numbers = number_index(), np.zeros(len(number_index()))
    for key, place in index.items():
        numbers[place] = limb.number(key) if key != "change.link" else 1.0
    angles = np.stack([data["theta1_rad"], data["theta2_rad"]], axis=1)
    xx, xz, zz = reference_planar_many(numbers[None], angles[None])[0, :, :3].T
    way = yields * np.sum(arms * np.stack([data["fx_n"], data["fz_n"]]), axis=0)
    return way, yields * np.stack([xx * arms[0] + xz * arms[1], xz * arms[0] + zz * arms[1]])


def kept_by_a_joint_that_rings(way_rad: np.ndarray, run: np.ndarray) -> np.ndarray:
    """Dry friction's torque where the joint rings after each step: it stands against the last step, and the further the
    steps of a run take the joint, the more it rings and the less it keeps."""
    begins = np.diff(run, prepend=-1) != 0
    step = np.where(begins, way_rad, np.diff(way_rad, prepend=0.0))
    longest = np.array([np.abs(step[run == one]).max() for one in run])
    return np.asarray(KEPT_N_MM * np.sign(step) * (1.0 - SHAKEN_OFF * longest / longest.max()))


def ringing(folder: Path, limb: Path, joint: str) -> Dataset:
    """A record of the limb with such friction in one joint."""
    data = load_dataset(loading_record(folder, limb, values={}, rig="step_mm = 1.6\n"))
    way, push = way_and_push(data, load_limb(limb), joint)
    held = push * kept_by_a_joint_that_rings(way, data["run"])
    return data.with_columns({"fx_n": data["fx_n"] + held[0], "fz_n": data["fz_n"] + held[1]})


def kept_in(data: Dataset, limb: Path) -> np.ndarray:
    """The torque that the knee's friction has in that record, nearly: its forces are the limb's with the friction."""
    return kept_by_a_joint_that_rings(way_and_push(data, load_limb(limb), "tibia")[0], data["run"])


def rubbing(folder: Path, limb: Path, joint: str) -> Dataset:
    """A record of the limb with such friction in one joint."""
    data = load_dataset(loading_record(folder, limb, values={}))
    way, push = way_and_push(data, load_limb(limb), joint)
    held = push * bent_before_it_slides(way, data["run"])
    return data.with_columns({"fx_n": data["fx_n"] + held[0], "fz_n": data["fz_n"] + held[1]})


@pytest.fixture(scope="module", params=["tibia"])
def found(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Diagnosis]:
    """The joint, and the diagnosis."""
    limb = Path(__file__).parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"
    data = rubbing(tmp_path_factory.mktemp("rubbing") / "record", limb, request.param)
    return request.param, diagnose_loading(data, load_limb(limb), Options(processes=1), silent)


def test_it_is_named_at_its_joint(found: tuple[str, Diagnosis]) -> None:
    """As friction of either kind: the catalogue's, whose law is sharper, may come as near."""
    joint, diagnosis = found
    assert diagnosis.verdict == "effect"
    (effect,) = diagnosis.effects
    assert effect.name in ("presliding_friction", "coulomb_friction") and effect.where == f"joint.{joint}"
    assert not diagnosis.data_faults


def test_the_model_gets_no_law_that_it_lacks(found: tuple[str, Diagnosis]) -> None:
    """Neither friction nor compliances that would make up for it: K is the believed limb's within its trust."""
    joint, diagnosis = found
    (effect,) = diagnosis.effects
    if effect.name == "presliding_friction":
        assert diagnosis.model.number(f"joint.{joint}.coulomb_n_mm") == 0.0
        assert "limb.toml leaves the friction out" in diagnosis.sentence
        assert any(f"coulomb_friction@joint.{joint}" in members for members in diagnosis.indistinguishable)


def test_a_joint_that_rings_has_friction_and_nothing_beside_it(tmp_path: Path, paper_limb: Path) -> None:
    """Of what dry friction would be, the record lacks the part that was shaken off, another one in each run: a link
    that changed, or play in the contact, makes up for it."""
    data = ringing(tmp_path / "record", paper_limb, "tibia")
    found = diagnose_loading(data, load_limb(paper_limb), Options(processes=1), silent)
    assert [(one.name, one.where) for one in found.effects] == [("presliding_friction", "joint.tibia")]
    assert found.effects[0].confidence > 0.9
    assert found.effects[0].parameters["joint.tibia.coulomb_n_mm"].value == pytest.approx(
        np.mean(np.abs(kept_in(data, paper_limb))), rel=0.25
    )


def test_friction_that_is_not_far_ahead_puts_in_doubt_what_stands_beside_it(
    tmp_path: Path, paper_limb: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the evidence does not suffice to take the joint's friction for another law, whatever was chosen with the
    plain law is no surer than the odds between the two."""
    monkeypatch.setattr(likeliest, "MUST_LEAD", 1e3)
    data = ringing(tmp_path / "record", paper_limb, "tibia")
    found = diagnose_loading(data, load_limb(paper_limb), Options(processes=1), silent)
    sure = {one.name: one.confidence for one in found.effects}
    assert "presliding_friction" in sure
    assert all(of < 0.8 for name, of in sure.items() if not name.endswith("_friction"))


def test_play_beside_dry_friction_keeps_its_name(tmp_path: Path, paper_limb: Path) -> None:
    """Where both are there and nothing rings."""
    values = {"joint.tibia.coulomb_n_mm": 60.0, "contact.play_mm": 0.2}
    data = load_dataset(loading_record(tmp_path / "record", paper_limb, values=values))
    found = diagnose_loading(data, load_limb(paper_limb), Options(processes=1), silent)
    assert {one.name for one in found.effects if one.confidence > 0.9} == {"contact_play", "coulomb_friction"}
    assert len(found.effects) == 2


@pytest.fixture
def plain(tmp_path: Path, paper_limb: Path) -> tuple[Record, Fit]:
    """A sound limb's record and the refitted limb."""
    record = load_record(load_dataset(loading_record(tmp_path / "record", paper_limb, values={})))
    space = space_of(trust_of(load_limb(paper_limb), turns=True), ())
    return record, fit(record, space, space.mean)


def test_the_joint_that_rubs_is_found_alone(tmp_path: Path, paper_limb: Path, plain: tuple[Record, Fit]) -> None:
    """With its friction's size, ahead of all that has no friction. Sets with friction do not count, sets without do."""
    record = load_record(rubbing(tmp_path / "rubbing", paper_limb, "tibia"))
    space = space_of(trust_of(load_limb(paper_limb), turns=True), ())
    fitted = fit(record, space, space.mean)
    nothing = LabelSet(frozenset(), Hypothesis(fitted, 0.0), 0.1)
    found, lead = likeliest.rubs(record, [nothing])
    assert found is not None and found.name == "presliding_friction@joint.tibia" and not found.alike
    assert lead == found.lead > 100.0
    assert found.value == pytest.approx(LEVEL_N_MM, rel=0.25)
    friction, other = (
        LabelSet(frozenset({label}), Hypothesis(fitted, lead + 1000.0), 0.9)
        for label in ("coulomb_friction@joint.tibia", "backlash@joint.tibia")
    )
    assert likeliest.rubs(record, [friction, nothing])[1] == lead
    assert likeliest.rubs(record, [other, nothing])[1] < -likeliest.MUST_LEAD
    sound, fitted = plain
    assert likeliest.rubs(sound, [LabelSet(frozenset(), Hypothesis(fitted, 0.0), 1.0)])[1] < likeliest.MAY_BE


def test_where_nothing_was_said_a_plain_loop_is_friction(tmp_path: Path, paper_limb: Path) -> None:
    """What was said stays as it is."""
    record = load_record(rubbing(tmp_path / "rubbing", paper_limb, "tibia"))
    trust = trust_of(load_limb(paper_limb), turns=True)
    fitted = fit(record, space_of(trust, ()), space_of(trust, ()).mean)
    alone = LabelSet(frozenset(), Hypothesis(fitted, 0.0), 1.0)
    structure = structure_of(record, fitted)
    for verdict, named in (("none", []), ("unknown", ["presliding_friction@joint.tibia"])):
        decision = Decision(cast(Verdict, verdict), (), (), alone, structure, Outside(-np.inf, ""))
        found = with_plain_loop(Pass(record, trust, alone.best, [alone], structure, decision))
        assert [one.name for one in found.troubles] == named and found.decision.verdict == "none"


def test_elements_slide_at_their_strain(plain: tuple[Record, Fit]) -> None:
    """A triangle of a way: the stiffest element never slides and follows it; a weak one is a loop of constant height,
    whose work over the way is its strain, less what it is bent by at each turn."""
    record, _ = plain
    starts = np.flatnonzero(np.diff(record.dataset["run"], prepend=-1))
    place = np.arange(record.rows) - np.repeat(starts, np.diff(np.append(starts, record.rows)))
    long = int(place.max()) + 1
    way = np.interp(place / long, [0.0, 0.25, 0.75, 1.0], [0.0, 1.0, -1.0, 0.0])
    held = sliding_rad(record, way)
    most = float(np.abs(way).max())
    assert np.abs(held).max(axis=0) == pytest.approx(most * np.array(STRAINS), rel=1e-9)
    weakest = held[:, -1]
    back = (place > 0.35 * long) & (place < 0.7 * long)
    assert weakest[back] == pytest.approx(np.full(int(back.sum()), -most * STRAINS[-1]))


def test_columns_push_against_the_way(plain: tuple[Record, Fit]) -> None:
    """Friction takes work: the tip's force is larger on the way out, so that the loop runs the right way round."""
    record, fitted = plain
    angles = np.stack([record.dataset["theta1_rad"], record.dataset["theta2_rad"]], axis=1)
    xx, xz, zz = reference_planar_many(fitted.model[None], angles[None])[0, :, :3].T
    stiffness = np.stack([np.stack([xx, xz]), np.stack([xz, zz])], axis=2)
    moved = np.stack([record.dataset["dx_mm"], record.dataset["dz_mm"]])
    begins = np.diff(record.dataset["run"], prepend=-1) != 0
    steps = np.where(begins, moved, np.diff(moved, axis=1, prepend=0.0))
    for joint in ("femur", "tibia"):
        columns = presliding_columns(record, fitted, joint, stiffness)
        turned = turned_columns(record, fitted, joint, stiffness)
        work = np.einsum("frs,fr->s", np.concatenate([columns, turned], axis=2)[:2], steps)
        assert np.all(work[-5:] > 0.0)
        assert np.all(friction_n_mm(record, fitted, joint)[-5:] > 0.0)


def test_the_base_moves_along_with_the_force_on_each_axis(tmp_path: Path, paper_limb: Path) -> None:
    soft = {"base.x_mm_per_n": 0.004, "base.z_mm_per_n": 0.003}
    data = load_dataset(loading_record(tmp_path / "record", paper_limb, values=soft, sensor="base_gauge = true\n"))
    record, space = load_record(data), space_of(trust_of(load_limb(paper_limb).with_values(soft), turns=True), ())
    fitted = fit(record, space, space.mean)
    columns = dict(zip(record.channels, turned_columns(record, fitted, "tibia", np.ones((2, record.rows, 2)))))
    for axis in "xz":
        yields = fitted.model[number_index()[f"base.{axis}_mm_per_n"]]
        assert np.ptp(columns[f"base_{axis}_mm"]) > 0.0
        assert columns[f"base_{axis}_mm"] == pytest.approx(yields * columns[f"f{axis}_n"])


def test_what_a_ringing_joint_keeps_turns_with_the_first_step_back(plain: tuple[Record, Fit]) -> None:
    """However short that step is. Rows that stand still keep it; none is there before the first step of a run."""
    record, _ = plain
    run = record.dataset["run"]
    way = np.zeros(record.rows)
    way[run == 1] = 1.0 - 0.01 * np.arange(int(np.sum(run == 1)))
    way[np.flatnonzero(run == 1)[0]] = 0.0
    way[np.flatnonzero(run == 1)[1]] = 0.0
    held = turned_rad(record, way)[run == 1]
    assert held[0] == held[1] == 0.0
    assert held[2] > 0.0 and held[3:] == pytest.approx(np.full(held.size - 3, -held[2]))
    assert not turned_rad(record, way)[run != 1].any()


def test_places_share_the_rows(plain: tuple[Record, Fit]) -> None:
    """Each row counts at its posture and axis alone: the repeats of a run together."""
    record, _ = plain
    columns = np.ones((len(record.channels), record.rows))
    places = by_place(record, columns)
    assert np.array_equal(places.sum(axis=2), columns)
    config, axis = record.dataset["config"], record.dataset["axis"]
    assert places.shape[2] == len({*zip(config.tolist(), axis.tolist())})
    for place in np.moveaxis(places[0] > 0.0, 1, 0):
        assert np.ptp(config[place]) == np.ptp(axis[place]) == 0
