"""What to measure next: the gain that is promised against a brute-force refit, the choice against the
physics of look-alikes, the file against the rig."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from brace.dataset import load_dataset
from brace.dataset.write import write_dataset
from brace.diagnose.diagnosis import NextExperiment
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import fit
from brace.diagnose.loading.next_experiment.confusability import confusability, in_words
from brace.diagnose.loading.next_experiment.experiment import next_experiment
from brace.diagnose.loading.next_experiment.menu import (
    CHANNELS,
    GROUPS,
    as_record,
    conditions,
)
from brace.diagnose.loading.next_experiment.separation import (
    Contender,
    chance_to_win,
    contenders,
    lambda_squared,
    no_rivals,
    play,
    power,
    separated,
)
from brace.diagnose.loading.search import Hypothesis
from brace.diagnose.loading.space import space_of, trust_of
from brace.diagnose.options import Options
from brace.effects import Freedom, Variant
from brace.identify.record import Record, load_record
from brace.model import LimbModel, load_limb
from brace.native.plant import LoadingPlayer
from brace.rig.rig import load_rig
from brace.rig.simulate import simulate
from scipy.optimize import least_squares

POSTURES = ((0.2, 0.7), (0.6, 1.2), (1.0, 1.6), (0.4, 2.0), (0.8, 0.9), (1.2, 1.4))
KNEE, TIBIA = "joint.tibia.compliance_rad_per_n_mm", "link.tibia.bending_mm_per_n"
HIP, TURN = "joint.femur.compliance_rad_per_n_mm", "base.rotation_rad_per_n_mm"
JOINT = Variant("joint_compliance", "joint.tibia", (Freedom(KNEE, 1e-7, 1e-3),))
LINK = Variant("link_compliance_error", "link.tibia", (Freedom(TIBIA, 1e-3, 10.0),))
FEMUR = Variant("joint_compliance", "joint.femur", (Freedom(HIP, 1e-7, 1e-3),))
BASE = Variant("base_compliance", "base", (Freedom(TURN, 0.0, 1e-2),))
GAP = Variant("backlash", "joint.tibia", (Freedom("joint.tibia.gap_rad", 0.0, 0.5, (1e-4, 1e-3)),))


@pytest.fixture(scope="module")
def believed(tmp_path_factory: pytest.TempPathFactory) -> LimbModel:
    """The paper's limb with the usual trust in its calibration."""
    path = tmp_path_factory.mktemp("limb") / "limb.toml"
    path.write_text(
        "format = 1\n[geometry]\nfemur_mm = 185.0\ntibia_mm = 313.5\n"
        "[link.femur]\naxial_mm_per_n = 0.001\nbending_mm_per_n = 0.06\n"
        "[link.tibia]\naxial_mm_per_n = 0.002\nbending_mm_per_n = 0.25\n"
        "[joint.femur]\ncompliance_rad_per_n_mm = 1e-5\n[joint.tibia]\ncompliance_rad_per_n_mm = 1.6e-5\n"
        "[uncertainty]\nlength_mm = 0.5\nangle_rad = 0.003\ncompliance_rel = 0.05\ngain_rel = 0.005\n"
    )
    return load_limb(path)


def rig_text(extra: str = "") -> str:
    """Six postures, one repeat, 0.1 N of noise."""
    poses = "".join(f"[[configuration]]\ntheta1_rad = {a}\ntheta2_rad = {b}\n" for a, b in POSTURES)
    return (
        "format = 1\nseed = 7\n[rig]\nstep_mm = 0.6\nsteps = 3\nrepeats = 1\n[sensor]\nnoise_n = 0.1\n"
        f"encoder_noise_rad = 5e-5\nbase_noise_mm = 3e-3\nresolution_n = 0.0\n{extra}\n{poses}"
    )


def recorded(folder: Path, limb: LimbModel, rig: str) -> Record:
    """The test played on a limb, written and read back."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "rig.toml").write_text(rig)
    meta, columns = simulate(limb, load_rig(folder / "rig.toml"))
    write_dataset(folder, meta, columns)
    return load_record(load_dataset(folder))


def searched(record: Record, believed: LimbModel, variants: Sequence[Variant]) -> Any:
    """What a search over these effects alone would hand over: sets by their likelihood."""
    trust = trust_of(believed, turns=True)
    base = space_of(trust, ())
    bare = Hypothesis(fit(record, base, base.mean), 0.0)
    found = []
    for variant in variants:
        space = space_of(trust, [variant])
        tries = [fit(record, space, start) for start in starts(space.mean, variant)]
        best = min(tries, key=lambda one: one.cost)
        found.append((0.5 * (bare.fit.cost - best.cost), Hypothesis(best, 0.0)))
    top = max(gain for gain, _ in found)
    sets = [LabelSet(one.labels, one, float(np.exp(gain - top))) for gain, one in found]
    ordered = sorted(sets, key=lambda item: -item.posterior)
    return SimpleNamespace(record=record, base=bare, sets=ordered, troubles=(), rival=None)


def starts(mean: np.ndarray, variant: Variant) -> list[np.ndarray]:
    """The middle, and each try of the variant's last freedom."""
    points = [mean]
    for value in variant.freedoms[-1].tries:
        points.append(np.concatenate([mean[:-1], [value]]))
    return points


def proposed(record: Record, final: Any, believed: LimbModel) -> NextExperiment:
    found = next_experiment(record, cast(Any, final), believed, Options())
    assert found is not None
    return found


@pytest.fixture(scope="module")
def soft_knee(believed: LimbModel, tmp_path_factory: pytest.TempPathFactory) -> tuple[Record, Any]:
    """A record of a limb with a soft knee, and what it could be."""
    limb = believed.with_values({KNEE: 2.6e-5})
    record = recorded(tmp_path_factory.mktemp("knee"), limb, rig_text())
    return record, searched(record, believed, [JOINT, LINK, GAP])


def brute_force(
    believed: LimbModel, record: Record, truth: Contender, rival: Contender, test: Record, read: list[str]
) -> float:
    """What the rival loses at least of twice its log-likelihood when the truth's readings of the test are
    added to the record, by a nonlinear fit over limb models."""
    space = rival.fit.space
    old, new = LoadingPlayer(record.dataset.columns), LoadingPlayer(test.dataset.columns)
    wanted = new.play(believed.with_values(dict(zip(truth.fit.space.keys, truth.fit.x))), read)
    sigma = {name: test.sigma[CHANNELS.index(name)] for name in read}
    unit = np.where(np.isinf(space.sigma), np.abs(rival.fit.x), space.sigma)

    def off(steps: np.ndarray, added: bool) -> np.ndarray:
        x = rival.fit.x + steps * unit
        limb = believed.with_values({key: float(value) for key, value in zip(space.keys, x)})
        forces = old.play(limb)
        parts = [(record.measured[i] - forces[name]) / record.sigma[i] for i, name in enumerate(("fx_n", "fz_n"))]
        parts.append(np.where(np.isinf(space.sigma), 0.0, (x - space.mean) / space.sigma))
        if added:
            readings = new.play(limb, read)
            parts += [(wanted[name] - readings[name]) / sigma[name] for name in read]
        return np.concatenate(parts)

    start = np.zeros(space.size)
    costs = [2.0 * float(least_squares(off, start, args=(added,), diff_step=1e-4).cost) for added in (True, False)]
    return costs[0] - costs[1]


@pytest.mark.parametrize("read", [["fx_n", "fz_n"], ["fx_n", "fz_n", "enc1_rad", "enc2_rad"]])
def test_expected_gain_is_what_a_refit_over_both_records_loses(
    believed: LimbModel, soft_knee: tuple[Record, Any], read: list[str]
) -> None:
    record, final = soft_knee
    hypotheses = contenders(final.sets)
    labels = [item.label for item in hypotheses]
    a, b = labels.index(JOINT.label), labels.index(LINK.label)
    condition = next(iter(conditions(record, [item.fit for item in hypotheses])))
    test = as_record(record, condition, np.array([[0.3, 2.3], [1.1, 0.6]]), hypotheses[0].fit.model)
    amount = np.array([1.0, float(len(read) > 2), 0.0])[None, :, None] * np.ones((1, 1, 2))
    promised = lambda_squared(play(test, hypotheses, GROUPS), hypotheses, amount)[0, a, b]
    kept = brute_force(believed, record, hypotheses[a], hypotheses[b], test, read)
    # linear in the nuisances: the rival moves a few sigmas, over which the limb bends by some hundredths
    assert promised == pytest.approx(kept, rel=0.1, abs=0.1)


def test_chance_to_win_is_that_of_drawn_records() -> None:
    """Two known predictions, white noise: the log-likelihood ratio is drawn, not computed from its
    moments."""
    rng = np.random.default_rng(3)
    for lead in (0.0, -2.0):
        away = np.array([1.5, -2.0, 1.0])
        draws = rng.standard_normal((40000, 3))
        ratio = 0.5 * np.sum((draws + away) ** 2 - draws**2, axis=1) + lead
        assert float(chance_to_win(np.array(away @ away), lead)) == pytest.approx(np.mean(ratio > 3.0), abs=0.01)


def test_knee_and_tibia_are_told_apart_by_encoders(
    believed: LimbModel, soft_knee: tuple[Record, Any], tmp_path: Path
) -> None:
    """Their forces are alike wherever the tip is pushed; only the joint's own turning differs."""
    record, final = soft_knee
    found = proposed(record, final, believed)
    assert {JOINT.label, LINK.label} <= set(found.separates)
    assert found.power > 0.95
    assert "encoders" in found.action and "gauge" not in found.action
    (tmp_path / "next.toml").write_text(found.rig_toml)
    rig = load_rig(tmp_path / "next.toml")
    _, columns = simulate(believed, rig)
    assert "enc2_rad" in columns and "base_x_mm" not in columns
    runs_min = float(columns["t_s"][-1] - columns["t_s"][0]) / 60.0
    assert runs_min < found.minutes < runs_min + 40.0


def test_more_of_the_same_is_enough_for_what_forces_tell(believed: LimbModel, tmp_path: Path) -> None:
    """Play and a soft femur joint differ in the forces: no instrument is mounted for that."""
    limb = believed.with_values({"joint.tibia.gap_rad": 8e-4})
    record = recorded(tmp_path, limb, rig_text())
    found = proposed(record, searched(record, believed, [GAP, FEMUR]), believed)
    assert found.power > 0.95
    assert "encoders" not in found.action and "gauge" not in found.action


def test_instruments_that_are_there_stay_on(believed: LimbModel, tmp_path: Path) -> None:
    limb = believed.with_values({KNEE: 2.6e-5})
    record = recorded(tmp_path, limb, rig_text("encoders = true\nbase_gauge = true"))
    found = proposed(record, searched(record, believed, [JOINT, LINK, GAP]), believed)
    assert "besides" not in found.action
    assert "encoders = true" in found.rig_toml and "base_gauge = true" in found.rig_toml
    assert found.minutes < 20.0


def test_the_same_under_two_names_is_said_to_be_inseparable(believed: LimbModel, soft_knee: tuple[Record, Any]) -> None:
    record, _ = soft_knee
    twin = Variant("another_name", "joint.tibia", JOINT.freedoms)
    found = proposed(record, searched(record, believed, [JOINT, twin]), believed)
    assert found.power < 0.05 and not found.rig_toml
    assert "nothing on this rig's menu separates" in found.action


def test_no_rival_no_experiment(believed: LimbModel, soft_knee: tuple[Record, Any]) -> None:
    record, final = soft_knee
    alone = SimpleNamespace(record=record, base=final.base, sets=final.sets[:1], troubles=(), rival=None)
    assert next_experiment(record, cast(Any, alone), believed, Options()) is None


def test_same_record_same_proposal(believed: LimbModel, soft_knee: tuple[Record, Any]) -> None:
    record, final = soft_knee
    assert proposed(record, final, believed) == proposed(record, final, believed)


def test_a_larger_set_is_no_rival_of_its_part(believed: LimbModel, soft_knee: tuple[Record, Any]) -> None:
    record, _ = soft_knee
    trust = trust_of(believed, turns=True)
    spaces = [space_of(trust, [JOINT]), space_of(trust, [JOINT, GAP])]
    sets = []
    for space in spaces:
        one = Hypothesis(fit(record, space, space.mean), 0.0)
        sets.append(LabelSet(one.labels, one, 0.5))
    hypotheses = contenders(sets)
    assert no_rivals(hypotheses).tolist() == [[True, True], [False, True]]
    assert separated(np.zeros((1, 2, 2)), hypotheses)[0].round(3).tolist() == [[1.0, 1.0], [0.0, 1.0]]
    # the part has no rival, so only the larger set is judged
    assert power(np.zeros((1, 2, 2)), hypotheses) == pytest.approx(0.0, abs=1e-3)


def test_what_the_record_leaves_possible_contends(soft_knee: tuple[Record, Any]) -> None:
    """Sets of their own count down to odds of e^-8, three rivals even where they are less likely, six sets in all; one
    that adds an effect to another counts from 2 % of the posterior. An infinite misfit does not count."""
    fitted = soft_knee[1].base.fit

    def count(*shares: float, added: float = 0.0) -> int:
        labels = [frozenset({f"effect {place}"}) for place in range(len(shares))]
        sets = [LabelSet(label, Hypothesis(fitted, 0.0), share) for label, share in zip(labels, shares, strict=True)]
        larger = labels[0] | {"added"}
        chosen = contenders([*sets, LabelSet(larger, Hypothesis(fitted, 0.0), added)])
        assert [one.log_odds for one in chosen] == sorted((one.log_odds for one in chosen), reverse=True)
        assert all(one.log_odds <= 0.0 for one in chosen)
        return len(chosen)

    assert count(0.97, added=0.03) == 2 and count(0.99, added=0.01) == 1
    assert count(1.0, 1e-9, 1e-9, 1e-9, 1e-9) == 4
    assert count(1.0, 4e-4, 4e-4, 4e-4, 4e-4) == 5 and count(1.0, 3e-4, 3e-4, 3e-4, 3e-4) == 4
    assert count(0.2, 0.2, 0.2, 0.1, 0.1, 0.1, 0.1) == 6
    broken = Hypothesis(replace(fitted, cost=np.inf), 0.0)
    sets = [LabelSet(frozenset({"a"}), Hypothesis(fitted, 0.0), 0.5), LabelSet(frozenset({"b"}), broken, 0.5)]
    assert len(contenders(sets)) == 1


def test_look_alikes_of_the_knee(soft_knee: tuple[Record, Any]) -> None:
    """Bending of the tibia makes the knee's signature; play does not. Lengths are the gains' roots."""
    _, final = soft_knee
    found = confusability(final.base.fit, final.sets)
    assert found.look_alikes(JOINT.label)[0] == JOINT.label
    assert LINK.label in found.look_alikes(JOINT.label) and GAP.label not in found.look_alikes(JOINT.label)
    assert any({JOINT.label, LINK.label} <= set(group) and GAP.label not in group for group in found.classes)
    a, b = found.labels.index(JOINT.label), found.labels.index(LINK.label)
    assert found.power[a, b] < 0.5 < found.power[a, found.labels.index(GAP.label)]
    gain = final.base.fit.cost - next(item.best.fit.cost for item in final.sets if item.label == JOINT.label)
    assert found.detectability[a] == pytest.approx(np.sqrt(gain), rel=0.1)
    assert LINK.label in in_words(found, [JOINT.label])[0]
