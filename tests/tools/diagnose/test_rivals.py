"""Causes outside the catalogue that a record cannot tell from an effect of it: the record is of an effect, or of what
reads the same, and the diagnosis must say no more than the record shows."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from command_bench import Outcome
from handmade import loading_record

from brace.dataset import Dataset, load_dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading import rivals, run
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.rivals import TURNS, Member, _contest, _fitted, _implausible, _InPlace, _wider
from brace.diagnose.loading.search_pass import Pass
from brace.diagnose.loading.space import Trust, space_of, trust_of
from brace.diagnose.options import Options
from brace.diagnose.run import diagnose
from brace.effects import BY_NAME, all_variants
from brace.effects.rivals import RIVAL_CAUSES
from brace.identify.record import Record, load_record, setting_of
from brace.model import LimbModel, load_limb
from brace.native.plant_batch import model_numbers, number_index
from brace.stiffness.at_rest import planar_limb

GAUGE = "base_gauge = true\nbase_noise_mm = 0.002\n"
YIELDS = {"base.x_mm_per_n": 0.05, "base.z_mm_per_n": 0.05}
TURNED_RAD = 0.05
BESIDE_MM = 14.0


def told(folder: Path, limb: Path, values: Mapping[str, float], sensor: str = "", take: str | None = None) -> Diagnosis:
    """The diagnosis of a record of the limb with these values, where the limb without them is believed."""
    record = load_dataset(loading_record(folder, limb, values=values, sensor=sensor))
    return diagnose(record, load_limb(limb), Options(take=take))


def near(limb: LimbModel, other: LimbModel) -> bool:
    """The same numbers, but for what a calibration leaves open."""
    within = dict.fromkeys(YIELDS, 1e-3) | {"joint.femur.zero_offset_rad": 0.01}
    return all(abs(limb.number(key) - other.number(key)) < most for key, most in within.items())


def members(found: Diagnosis) -> list[str]:
    return [one.label for one in found.members]


@pytest.fixture(scope="module")
def limb() -> Path:
    return Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


@pytest.fixture(scope="module")
def searched_once() -> Iterator[None]:
    """The same readings beside the same limb are searched once, which takes most of a diagnosis: what is taken, said
    and exported comes after the search."""
    search, found = run._searches, dict[bytes, tuple[Pass | None, Pass]]()

    def kept(record: Record, locked: np.ndarray, trust: Trust, *rest: Any) -> tuple[Pass | None, Pass]:
        asked = b"".join(part.tobytes() for part in (record.measured, record.sigma, locked, trust.numbers))
        if asked not in found:
            found[asked] = search(record, locked, trust, *rest)
        return found[asked]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "_searches", kept)
        yield


@pytest.fixture(scope="module")
def yields(searched_once: None, tmp_path_factory: pytest.TempPathFactory, limb: Path) -> Diagnosis:
    return told(tmp_path_factory.mktemp("yields") / "record", limb, YIELDS)


@pytest.mark.minutes
def test_a_base_without_a_gauge_may_be_the_rig(yields: Diagnosis, limb: Path) -> None:
    """Base and rig are one spring after the other: nobody can say which; the limb stays as it was given."""
    assert yields.verdict == "ambiguous"
    assert members(yields)[:2] == ["base_compliance@base", "rig_compliance@rig"]
    assert [effect.label for effect in yields.effects[:2]] == members(yields)[:2]
    assert yields.members[0].probability == yields.members[1].probability < 0.5
    assert set(yields.indistinguishable[0]) == set(members(yields))
    assert yields.model.values == load_limb(limb).values
    (size,) = yields.effects[1].parameters.values()
    assert size.low < 0.05 < size.high
    assert yields.members[0].k.k_xx_n_per_mm < 0.97 * yields.members[1].k.k_xx_n_per_mm
    for words in (*members(yields), "because", "dial gauge", "--take"):
        assert words in yields.sentence
    assert yields.next_experiment is not None and "dial gauge" in yields.next_experiment.action


@pytest.mark.minutes
def test_a_gauge_on_the_base_excludes_the_rig(tmp_path: Path, limb: Path) -> None:
    found = told(tmp_path / "record", limb, YIELDS, GAUGE)
    assert found.verdict == "effect" and [one.label for one in found.effects] == ["base_compliance@base"]
    assert found.members == () and found.effects[0].confidence > 0.9
    assert found.model.number("base.x_mm_per_n") == pytest.approx(0.05, rel=0.1)


@pytest.mark.minutes
def test_a_gauge_that_moves_as_believed_speaks_for_the_rig(tmp_path: Path, limb: Path) -> None:
    """Base and rig yield one after the other, and the gauge reads the base's share of it only: a base as calibrated,
    under the force that was read. No link is blamed."""
    base = {"base.x_mm_per_n": 0.001, "base.z_mm_per_n": 0.003}
    believed = tmp_path / "believed.toml"
    believed.write_text(load_limb(limb).with_values(base).to_toml([]))
    whole = {key: base[key] + YIELDS[key] for key in base}
    record = load_dataset(loading_record(tmp_path / "record", believed, values=whole, sensor=GAUGE))
    rng = np.random.default_rng(11)
    noise_mm = 0.002 * rng.standard_normal((2, record.rows))
    gauges = {
        f"base_{axis}_mm": base[f"base.{axis}_mm_per_n"] * record[f"f{axis}_n"] + off
        for axis, off in zip("xz", noise_mm)
    }
    found = diagnose(replace(record, columns={**record.columns, **gauges}), load_limb(believed), Options())
    assert found.effects[0].label == "rig_compliance@rig" and found.effects[0].confidence > 0.9
    (size,) = found.effects[0].parameters.values()
    assert size.low < 0.05 < size.high
    assert found.next_experiment is not None and "beside the tip's clamp" in found.next_experiment.action


@pytest.mark.parametrize(
    ("cost_of_rival", "names"), [(995.0, {"rig_compliance@rig", "a"}), (900.0, {"rig_compliance@rig"})]
)
def test_what_the_readings_speak_against_is_no_member(cost_of_rival: float, names: set[str]) -> None:
    """A rival that is likelier because it needs one size less leaves both; one that leaves 10 sigmas less stands
    alone."""

    def fitted(cost: float) -> Any:
        return SimpleNamespace(cost=cost, space=SimpleNamespace(variants=()), model=np.zeros(1))

    chosen = LabelSet(frozenset("a"), cast(Any, SimpleNamespace(fit=fitted(1000.0))), 1.0)
    decision = SimpleNamespace(chosen=chosen, labels=("a",))
    final = SimpleNamespace(decision=decision, sets=[chosen], record=SimpleNamespace(readings=1000, noise_freedom=1e6))
    rig = Member(("rig_compliance@rig",), 0.0, fitted(cost_of_rival), np.zeros(1), RIVAL_CAUSES[0])
    found = _contest(cast(Any, final), RIVAL_CAUSES[0], frozenset("a"), 1e9, rig)
    assert found is not None and {one.label for one in found.members} == names
    assert found.decided == (len(names) == 1) and found.has_chosen == ("a" in names)
    assert found.share_of_chosen == pytest.approx(1e-9 if "a" in names else 0.0, rel=1e-3)


def test_a_member_is_taken_by_its_name(
    searched_once: None, brace: Callable[..., Outcome], tmp_path: Path, limb: Path
) -> None:
    record = loading_record(tmp_path / "record", limb, values=YIELDS)
    exported = {}
    for name in ("rig_compliance@rig", "base_compliance", "backlash"):
        out = tmp_path / name.partition("@")[0]
        done = brace("diagnose", record, "--model", limb, "--out", out, "--take", name)
        assert done.code == (1 if name == "backlash" else 0), "a script must not go on with a model that was not taken"
        said = json.loads((out / "diagnosis.json").read_text())
        assert said["verdict"] == "ambiguous" and len(said["members"]) >= 2
        exported[name] = (said, load_limb(out / "limb.toml"))
    believed = load_limb(limb)
    said, rig = exported["rig_compliance@rig"]
    assert said["exported"] and near(rig, believed) and rig.values != believed.values
    said, base = exported["base_compliance"]
    assert said["exported"] and base.number("base.x_mm_per_n") == pytest.approx(0.05, rel=0.1)
    said, same = exported["backlash"]
    assert not said["exported"] and same.values == believed.values
    assert any("backlash" in note and "nothing was taken" in note for note in said["notes"])


@pytest.mark.minutes
def test_a_turned_sensor_and_a_femur_turned_back_are_a_turned_rig(tmp_path: Path, limb: Path) -> None:
    both = {"sensor.rotation_rad": TURNED_RAD, "joint.femur.zero_offset_rad": -TURNED_RAD}
    found = told(tmp_path / "record", limb, both)
    assert found.verdict == "ambiguous" and members(found)[0] == "rig_rotation@rig"
    assert set(members(found)[1].split(" + ")) == {"sensor_rotation@sensor", "joint_zero_offset@joint.femur"}
    (turn,) = found.effects[0].parameters.values()
    assert turn.low < TURNED_RAD < turn.high
    assert near(found.model, load_limb(limb))
    assert "turn the sensor" in found.sentence


@pytest.mark.minutes
@pytest.mark.parametrize("femur_rad", [TURNED_RAD, -0.5 * TURNED_RAD])
def test_turns_that_do_not_match_are_two_effects(femur_rad: float, tmp_path: Path, limb: Path) -> None:
    """Turned the same way, or by half: no turned rig does that."""
    both = {"sensor.rotation_rad": TURNED_RAD, "joint.femur.zero_offset_rad": femur_rad}
    found = told(tmp_path / "record", limb, both)
    assert found.verdict == "effect" and found.members == ()
    assert "joint_zero_offset@joint.femur" in [effect.label for effect in found.effects]


@pytest.mark.minutes
def test_one_turn_alone_is_no_turned_rig(tmp_path: Path, limb: Path) -> None:
    found = told(tmp_path / "record", limb, {"sensor.rotation_rad": TURNED_RAD})
    assert found.effects[0].label == "sensor_rotation@sensor" and "rig_rotation@rig" not in members(found)


def test_a_knee_beside_the_line_gives_the_same_k(tmp_path: Path, limb: Path) -> None:
    """Both joints' zeros off by the same angle: the members agree in K, so the first is exported."""
    angle = float(np.arctan(BESIDE_MM / 185.0))
    values = {
        "joint.femur.zero_offset_rad": angle,
        "joint.tibia.zero_offset_rad": angle,
        "geometry.femur_mm": float(np.hypot(185.0, BESIDE_MM)),
        "link.femur.tilt_rad": -angle,
    }
    found = told(tmp_path / "record", limb, values)
    assert found.verdict == "ambiguous" and members(found)[0] == "knee_offset@joint.tibia"
    (size,) = found.effects[0].parameters.values()
    assert size.low < BESIDE_MM < size.high
    assert found.model.number("joint.tibia.zero_offset_rad") == pytest.approx(angle, abs=0.01)


def hinged_forces(limb: LimbModel, record: Dataset, gap_rad: float, centre_rad: float) -> np.ndarray:
    """Of two rigid links on joints that yield, in closed form: where the tip stands tells how far each joint is bent;
    the knee's spring begins beyond its play. 2 x rows [N]"""
    femur_mm, tibia_mm = (
        limb.number("geometry.femur_mm"),
        limb.number("geometry.tibia_mm"),
    )
    yields = [limb.number(f"joint.{joint}.compliance_rad_per_n_mm") for joint in ("femur", "tibia")]
    femur_rad, knee_rad = record["theta1_rad"], record["theta2_rad"]
    tip = femur_mm * np.exp(1j * femur_rad) + tibia_mm * np.exp(1j * (femur_rad - knee_rad))
    tip = tip + record["dx_mm"] + 1j * record["dz_mm"]
    inner = np.arccos((np.abs(tip) ** 2 - femur_mm**2 - tibia_mm**2) / (2.0 * femur_mm * tibia_mm))
    hip_bent = np.angle(tip / (femur_mm + tibia_mm * np.exp(-1j * inner))) - femur_rad
    knee_bent = knee_rad - inner - centre_rad
    beyond = np.sign(knee_bent) * np.maximum(0.0, np.abs(knee_bent) - 0.5 * gap_rad)
    torques = np.array([hip_bent / yields[0], beyond / yields[1]])
    tibia = tibia_mm * np.exp(1j * (femur_rad + hip_bent - inner))
    levers = np.array([[-tip.imag, tip.real], [-tibia.imag, tibia.real]])
    return np.asarray(np.linalg.solve(levers.transpose(2, 0, 1), torques.T[:, :, None])[:, :, 0].T)


def test_play_that_lies_to_one_side_is_no_weight(tmp_path: Path, limb: Path) -> None:
    """What the catalogue has for it is play, with a bias or a weight that nobody hung on the limb."""
    stiff = {f"link.{link}.{way}_mm_per_n": 1e-6 for link in ("femur", "tibia") for way in ("axial", "bending")}
    soft = {
        "joint.femur.compliance_rad_per_n_mm": 6e-5,
        "joint.tibia.compliance_rad_per_n_mm": 8e-5,
    }
    believed = load_limb(limb).with_values(stiff | soft)
    (tmp_path / "limb.toml").write_text(believed.to_toml([]))
    data = load_dataset(loading_record(tmp_path / "record", tmp_path / "limb.toml", values={}))
    forces = hinged_forces(believed, data, 4e-3, 1.6e-3) + 0.1 * np.random.default_rng(4).standard_normal(
        (2, data.rows)
    )
    record = load_record(replace(data, columns={**data.columns, "fx_n": forces[0], "fz_n": forces[1]}))
    trust = trust_of(believed, turns=True)
    (cause,) = (one for one in RIVAL_CAUSES if one.label == "off_centre_play@joint.tibia")
    named = [one for one in all_variants(setting_of(record, believed)) if one.label in cause.looks_like[0]]
    space = space_of(trust, list({one.label: one for one in named}.values()))
    chosen = fit(record, space, space.mean + 1e-3 * (space.mean == 0.0), final=False)
    off_centre = _fitted(record, trust, chosen, cause, cause.ways[0], cause.looks_like[0])
    assert off_centre is not None and off_centre.cost < 1.1 * record.readings < chosen.cost
    assert off_centre.x[-2:] == pytest.approx([4e-3, 1.6e-3], rel=0.15)
    assert off_centre.model[number_index()["joint.tibia.gap_rad"]] == off_centre.x[-2]


def compliance_with_a_knee_beside(knee_beside_mm: float, moment_transfer: float, theta1_rad: float) -> np.ndarray:
    """Of the limb below, term by term: two joints, two stretched links, a bent tibia, and a femur whose end moves and
    turns as a uniform beam's does under force and moment, as far as it is a beam."""

    def quarter(v: np.ndarray) -> np.ndarray:
        return np.array([-v[1], v[0]])

    along = np.array([np.cos(theta1_rad), np.sin(theta1_rad)])
    tibia = np.array([np.cos(theta1_rad - 1.1), np.sin(theta1_rad - 1.1)])
    end = 200.0 * along
    knee = end + knee_beside_mm * quarter(along)
    tip = knee + 260.0 * tibia
    hip_lever, knee_lever, end_lever = quarter(tip), quarter(tip - knee), quarter(tip - end)
    across = quarter(along)
    beam = 1.5 / 200.0 * (np.outer(across, end_lever) + np.outer(end_lever, across))
    beam += 3.0 / 200.0**2 * np.outer(end_lever, end_lever)
    return np.asarray(
        1e-5 * np.outer(hip_lever, hip_lever) + 1.3e-5 * np.outer(knee_lever, knee_lever)
        + 0.002 * (np.outer(along, along) + np.outer(tibia, tibia)) + 0.1 * np.outer(quarter(tibia), quarter(tibia))
        + 0.08 * (np.outer(across, across) + moment_transfer * beam)
    )  # fmt: skip


@pytest.mark.parametrize("moment_transfer, most", [(0.0, 1e-5), (0.5, 0.008), (1.0, 0.008)])
def test_a_knee_beside_the_line_is_played_as_it_yields(moment_transfer: float, most: float, limb: Path) -> None:
    """20 mm beside the end of a femur of 200 mm. Turned back as one that is no beam, it would be off by 2 to 5 %."""
    numbers = {
        "geometry.femur_mm": 200.0, "geometry.tibia_mm": 260.0,
        "link.femur.axial_mm_per_n": 0.002, "link.femur.bending_mm_per_n": 0.08, "link.femur.tilt_rad": 0.0,
        "link.femur.moment_transfer": moment_transfer,
        "link.tibia.axial_mm_per_n": 0.002, "link.tibia.bending_mm_per_n": 0.1, "link.tibia.tilt_rad": 0.0,
        "joint.femur.compliance_rad_per_n_mm": 1e-5, "joint.tibia.compliance_rad_per_n_mm": 1.3e-5,
        "base.x_mm_per_n": 0.0, "base.z_mm_per_n": 0.0, "base.rotation_rad_per_n_mm": 0.0,
    }  # fmt: skip
    index, models = number_index(), model_numbers(load_limb(limb).with_values(numbers))[None].copy()
    TURNS["knee_offset@joint.tibia"](models, np.array([[20.0]]))
    turned = ("geometry.femur_mm", "link.femur.tilt_rad")
    beside = planar_limb(load_limb(limb).with_values(numbers | {key: float(models[0, index[key]]) for key in turned}))
    shift_rad = float(models[0, index["joint.femur.zero_offset_rad"]])
    for theta1_rad in (-0.3, 0.2, 0.7, 1.2):
        found = beside.stiffness(np.array([theta1_rad + shift_rad]), np.array([1.1 + shift_rad]))[0]
        c_xz = found["c_xz_mm_per_n"]
        c = np.array([[found["c_xx_mm_per_n"], c_xz], [c_xz, found["c_zz_mm_per_n"]]])
        exact = compliance_with_a_knee_beside(20.0, moment_transfer, theta1_rad)
        assert np.linalg.norm(c - exact) <= most * np.linalg.norm(exact)


def compliance_of_an_arch(height_mm: float, tilt_rad: float) -> np.ndarray:
    """Of a tibia of 260 mm along x, summed over 4000 short pieces: what each turns by, times its lever to the tip."""
    share = (np.arange(4000) + 0.5) / 4000
    place = np.stack([260.0 * share, 4.0 * height_mm * share * (1.0 - share)])
    lever = np.array([[260.0], [0.0]]) - place
    turning = np.stack([-lever[1], lever[0]])
    along = np.array([1.0, 0.0])
    own = 0.002 * np.outer(along, along) + 3.0 * 0.1 / 260.0**2 * turning @ turning.T / 4000
    c, s = np.cos(tilt_rad), np.sin(tilt_rad)
    return np.asarray(np.array([[c, -s], [s, c]]) @ own @ np.array([[c, s], [-s, c]]))


@pytest.mark.parametrize("tilt_rad", [0.0, -0.3])
@pytest.mark.parametrize("height_mm", [-90.0, 10.0, 60.0])
def test_a_bowed_tibia_is_played_as_it_yields(height_mm: float, tilt_rad: float, limb: Path) -> None:
    numbers = {
        "geometry.tibia_mm": 260.0, "link.tibia.axial_mm_per_n": 0.002, "link.tibia.bending_mm_per_n": 0.1,
        "link.tibia.tilt_rad": tilt_rad,
    }  # fmt: skip
    index, models = number_index(), model_numbers(load_limb(limb).with_values(numbers))[None].copy()
    TURNS["bowed_link@link.tibia"](models, np.array([[-height_mm]]))
    axial, bending, tilt = (
        float(models[0, index[f"link.tibia.{key}"]]) for key in ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad")
    )
    axes = np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    played = axes @ np.diag([axial, bending]) @ axes.T
    assert played == pytest.approx(compliance_of_an_arch(height_mm, tilt_rad), rel=1e-5, abs=1e-7)


def test_a_size_that_no_limb_has_needs_evidence(tmp_path: Path, limb: Path) -> None:
    """As the catalogue defines it: ten times the believed is three sigma, no more than believed costs nothing."""
    believed = load_limb(limb)
    record = load_record(load_dataset(loading_record(tmp_path / "record", limb, values=YIELDS)))
    axial = [
        variant
        for variant in all_variants(setting_of(record, believed))
        if variant.label == "link_compliance_error@link.tibia"
        and [freedom.key for freedom in variant.freedoms] == ["link.tibia.axial_mm_per_n"]
    ]
    space = space_of(trust_of(believed, turns=True), axial)
    nothing = np.zeros(1)
    assert BY_NAME["link_compliance_error"].number("axial_mm_per_n").plausible_times == 10.0
    for times, nats in ((0.5, 0.0), (1.0, 0.0), (10.0, 4.5), (100.0, 18.0)):
        x = space.mean.copy()
        x[-1] = times * 0.002
        fitted = Fit(space, x, nothing, nothing, nothing, 0.0)
        assert _implausible(fitted, frozenset({axial[0].label})) == pytest.approx(nats)


def test_a_cause_stands_for_as_many_effects_as_is_likeliest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leads of a cause in the place of a, of a and b, and so on: each effect that the cause makes needless saves its
    price."""
    leads = {"a": -2.0, "ab": 1.5, "ac": -1.0, "ad": 0.5, "abc": 3.0, "abd": 0.0, "abcd": 2.5}
    chosen = SimpleNamespace(decision=SimpleNamespace(chosen=SimpleNamespace(labels=frozenset("abcd"))))
    asked: list[str] = []

    def in_place_of(_final: object, _cause: object, disputed: frozenset[str]) -> Iterator[_InPlace]:
        asked.append("".join(sorted(disputed)))
        yield _InPlace(RIVAL_CAUSES[0], leads[asked[-1]], disputed, cast(Any, None))

    monkeypatch.setattr(rivals, "_in_place_of", in_place_of)
    first = _InPlace(RIVAL_CAUSES[0], leads["a"], frozenset("a"), cast(Any, None))
    widest = _wider(cast(Any, chosen), RIVAL_CAUSES[0], first)
    assert (widest.lead, widest.disputed) == (3.0, frozenset("abc"))
    assert asked == ["ab", "ac", "ad", "abc", "abd", "abcd"]


def test_every_rival_turns_the_numbers_of_the_limb(limb: Path) -> None:
    """Rows and turns belong together, and a size of nothing changes nothing."""
    numbers = model_numbers(load_limb(limb))
    assert set(TURNS) == {cause.label for cause in RIVAL_CAUSES}
    for cause in RIVAL_CAUSES:
        for way in cause.ways:
            models = numbers[None].copy()
            TURNS[cause.label](models, np.zeros((1, len(way))))
            np.testing.assert_allclose(models[0], numbers, rtol=0, atol=1e-12)
            TURNS[cause.label](models, np.full((1, len(way)), 0.5 * way[0].high))
            assert np.nanmax(np.abs(np.where(np.isfinite(numbers), models[0] - numbers, 0.0))) > 1e-3


def test_the_summary_has_the_members(yields: Diagnosis) -> None:
    from brace.diagnose.summary import lines

    text = "\n".join(lines(yields))
    assert text.count("  K          ") == len(yields.members)
    assert "mm/N" in text and "gives way under load" in text
