"""A finished search as a Diagnosis: effects with intervals, the gap before and after, what stays,
in numbers and words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from brace.diagnose.already import already
from brace.diagnose.beside import beside
from brace.diagnose.diagnosis import (
    Alternative,
    Candidate,
    Diagnosis,
    Gap,
    GapPair,
    GapStep,
    Interval,
    Localised,
    NamedEffect,
    NextExperiment,
    Residuals,
    Unexplained,
    Verdict,
)
from brace.diagnose.loading import confidence
from brace.diagnose.loading.agreement import Agreement, agreement
from brace.diagnose.loading.next_experiment.confusability import TOLD_APART, Confusability, confusability, in_words
from brace.diagnose.loading.next_experiment.experiment import next_experiment
from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.troubles.likeliest import Trouble
from brace.diagnose.loading.few_readings import FEW, rests_on_one, slopes_in_words
from brace.diagnose.loading.hold_out import held_out, load_range
from brace.diagnose.loading.intervals import intervals, without_none
from brace.diagnose.loading.limb_of import limb_of
from brace.diagnose.loading.localise import localise
from brace.diagnose.loading.members import Resolved, resolve
from brace.identify.noise import FORCES
from brace.identify.record import NOT_MEASURED, Record, rms_force_n
from brace.diagnose.loading.rivals import Contest, Member, contests
from brace.diagnose.loading.structure import STRUCTURED_P
from brace.diagnose.loading.within_trust import allowed_sigma, pull_sigma, within_trust
from brace.diagnose.loading.verdict import NOTHING_STANDS
from brace.diagnose.loading.wandering_zero import also_seen
from brace.diagnose.plain_words import identified
from brace.diagnose.options import Options
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME
from brace.native.plant_batch import model_numbers, number_index

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

MOST_CANDIDATES = 20
FAR_OUT = 3.0  # sigmas of the calibration from which a refitted number is a finding
STAYS_AHEAD = 0.5
SURE, LIKELIER_THAN_NOT = 0.8, 0.5  # confidences from which a name is given without a word before it, with "probably"
MOST_LIKELY = 0.9  # share of the members' probability from which the first is said to be it
BESIDE_STRAINED = 0.75  # of a name's confidence: what sliding springs leave of other friction may look like an effect
MOST_SURE = confidence.RIGHT_BY_EFFECTS[1]
SIZE_FIRST = ("creep",)  # effects whose first number is their size, and whose others mean nothing without it
LOST_NATS = -2.0  # of the held-out configurations: more than refitting alone makes


def diagnosis_of(
    whole: Record,
    record: Record,
    locked: np.ndarray,
    believed: LimbModel,
    final: Pass,
    twin: Pass | None,
    options: Options,
) -> Diagnosis:
    """`whole` is all that was measured, `record` the part that was searched,
    `locked` its rows that `twin` never saw. A second process plans what to measure next."""
    contested = contests(final)
    named = final.decision.verdict in ("effect", "ambiguous")

    def following() -> NextExperiment | None:
        return next_experiment(record, final, believed, options) if named else _more_of_the_same(final)

    with beside(following, following, options.processes if named else 1) as next_one:
        found = _all_but_next(whole, record, locked, believed, final, twin, contested, options)
        options.meanwhile()
        return replace(found, next_experiment=_shown_by(next_one(), contested))


def _all_but_next(
    whole: Record,
    record: Record,
    locked: np.ndarray,
    believed: LimbModel,
    final: Pass,
    twin: Pass | None,
    contested: Sequence[Contest],
    options: Options,
) -> Diagnosis:
    decision = final.decision
    best = decision.chosen.best.fit
    judged = twin or final
    named = decision.verdict in ("effect", "ambiguous")
    after = best if named else final.base.fit
    strongest = contested[0] if contested else None
    resolved = resolve(record, final, strongest, believed, options.take)
    shown = believed if decision.verdict == "unknown" else limb_of(believed, after.model)
    agreed = agreement(record, locked, final, twin, options.seed)
    alike = confusability(final.base.fit, final.sets)
    effects = tuple(
        replace(one, confidence=one.confidence * confidence.as_found_twice(final, twin, one.label))
        for one in (_effects(record, final, resolved, contested) if named else ())
    )
    if record.rows <= FEW:  # of a few runs drawn again the share of draws with the same choice says more
        most = agreed.bootstrap_share
        effects = tuple(replace(one, confidence=min(one.confidence, most)) for one in effects)
    if any(one.cause.in_limb for one in final.troubles):
        effects = tuple(replace(one, confidence=one.confidence * BESIDE_STRAINED) for one in effects)
    effects = tuple(sorted(effects, key=lambda one: -round(one.confidence, 9)))
    held = held_out(final.record, after, locked) if decision.verdict != "unknown" else ()
    beside = tuple(
        _trouble(one, one.share / (1.0 + np.exp(-one.lead)) * (MOST_SURE if one.cause.in_limb else 1.0))
        for one in final.troubles
        if one.is_effect
    )
    return Diagnosis(
        verdict=_verdict(final, resolved),
        sentence=" ".join([
            _sentence(believed, final, effects, resolved, strongest),
            *(_also_contested(one) for one in contested[1:]),
            *_beside(final, resolved),
        ]),
        model=resolved.exported,
        gap=_gap(whole, record, locked, believed, judged),
        effects=(*effects, *beside),
        indistinguishable=_classes(final, alike, contested),
        could_be=_could_be(final, effects),
        members=_as_named(resolved.alternatives, effects),
        took=resolved.taken.label if resolved.taken is not None and options.take and not resolved.note else "",
        localised=_localised(record, final, options),
        held_out=held,
        unexplained=_unexplained(final, after),
        next_experiment=None,
        data_faults=(*record.dataset.faults, *(one.fault for one in final.troubles if not one.cause.in_limb)),
        candidates=tuple(
            Candidate(item.label, final.base.fit.cost - item.best.fit.cost, item.posterior)
            for item in final.sets[:MOST_CANDIDATES]
        ),
        residuals=_residuals(
            whole, believed, shown, judged, locked if whole is record else np.zeros(whole.rows, bool)
        ),
        notes=(
            *in_words(alike, [effect.label for effect in effects]),
            *slopes_in_words(whole, model_numbers(believed)),
            *(rests_on_one(record, after) if named else ()),
            *load_range(held),
            *_notes(whole, record, final, twin, agreed, after),
            *([resolved.note] if resolved.note else []),
        ),
        cautions=(resolved.caution,) if resolved.caution else (),
        seed=options.seed,
        details={
            **_details(record, final, agreed),
            "refitted": _refitted(whole, believed, final),
            "refit_pull_sigma": pull_sigma(judged.base.fit),
            "pull_sigma": pull_sigma(resolved.freed or after),
            "allowed_sigma": allowed_sigma(final.base.fit.space),
        },
    )


def _as_named(members: Sequence[Alternative], effects: Sequence[NamedEffect]) -> tuple[Alternative, ...]:
    """One probability for one thing: an explanation of named effects is no surer than its least sure name."""
    sure = {effect.label: effect.confidence for effect in effects}
    return tuple(
        replace(one, probability=min(sure[label] for label in one.label.split(" + ")))
        if all(label in sure for label in one.label.split(" + "))
        else one
        for one in members
    )


def _effects(
    record: Record, final: Pass, resolved: Resolved, contested: Sequence[Contest]
) -> tuple[NamedEffect, ...]:
    """The most probable first; for a class, each member with the parameters of its own fit. What only rivals leave
    alone, and far behind, is not named."""
    if resolved.verdict == "ambiguous":
        return tuple(found for one, sure in resolved.members for found in _of_member(record, final, one, sure))
    decision = final.decision
    chosen, labels = decision.chosen.best.fit, decision.chosen.labels
    sure_of = {label: confidence.of_label(final, label) for label in decision.labels}
    found: list[NamedEffect] = []
    for one in contested:
        sure = one.mass * confidence.of_a_name(final)
        if one.has_chosen:
            sure_of |= {label: min(sure * one.share_of_chosen, sure_of[label]) for label in one.disputed}
        else:
            found += _of_member(record, final, one.members[0], sure * one.members[0].share)
            sure_of = {label: sure_of[label] for label in sure_of if label not in one.disputed}
    found += [
        _effect(record, chosen, label, sure, _share(final, label), _lost(final, labels, label, chosen))
        for label, sure in sure_of.items()
    ]
    return tuple(sorted(found, key=lambda effect: -effect.confidence))


def _of_member(record: Record, final: Pass, member: Member, sure: float) -> Iterator[NamedEffect]:
    """The names of one explanation."""
    if member.trouble is not None:
        yield _trouble(member.trouble, sure)
        return
    for label in member.labels:
        lost = _lost(final, frozenset(member.labels), label, member.fit)
        yield _effect(record, member.fit, label, sure, 1.0, lost)


def _lost(final: Pass, labels: frozenset[str], label: str, fitted: Fit) -> float:
    """What chi squared rises by without this effect; 0 where the search did not try that."""
    costs = [item.best.fit.cost for item in final.sets if item.labels == labels - {label}]
    return max(0.0, min(costs) - fitted.cost) if costs else 0.0


def _effect(record: Record, fitted: Fit, label: str, sure: float, share: float, lost: float) -> NamedEffect:
    variant = next(item for item in fitted.space.variants if item.label == label)
    keys = tuple(freedom.key for freedom in variant.freedoms)
    parameters: dict[str, Interval] = dict(intervals(record, fitted, keys))
    if keys and (len(keys) == 1 or variant.effect in SIZE_FIRST):
        none = float(fitted.space.numbers[number_index()[keys[0]]]) if keys[0] in KEY_BY_NAME else 0.0
        parameters[keys[0]] = without_none(parameters[keys[0]], none, lost)
    for key, (other, ratio) in variant.stands_for.items():
        both = parameters[key]
        parameters[key] = Interval(both.value, KEY_BY_NAME[key].low, both.high)
        parameters[other] = Interval(0.0, KEY_BY_NAME[other].low, ratio * both.high)
    for key, value in variant.settings.items():
        if KEY_BY_NAME[key].kind in ("number", "ratio"):
            parameters[key] = Interval(value, value, value)
    return NamedEffect(variant.effect, variant.where, sure, parameters, share)


def _trouble(trouble: Trouble, sure: float) -> NamedEffect:
    """A trouble of the instruments as a name."""
    return NamedEffect(trouble.cause.name, trouble.cause.where, sure, trouble.sizes, 1.0)


def _classes(
    final: Pass, alike: Confusability, contested: Sequence[Contest]
) -> tuple[tuple[str, ...], ...]:
    """For each named effect what the evidence leaves in its place, and what looks the same in this record. What a rival
    contests comes first."""
    decision = final.decision
    found = [tuple(member.label for member in one.members) for one in contested if not one.decided]
    rubs = [one for one in final.troubles if one.cause.in_limb]
    found += [(one.name, *one.alike, f"coulomb_friction@{one.cause.where}") for one in rubs]
    for label in decision.labels if decision.verdict == "effect" else decision.labels[:1]:
        rivals = next((members for members in decision.classes if members[0] == label), (label,))
        look_alikes = [other for other in alike.look_alikes(label) if not _told_apart(alike, label, other)]
        group = tuple(dict.fromkeys((*rivals, *look_alikes)))
        if len(group) > 1 and not any(set(group) <= set(other) for other in found):
            found.append(group)
    return tuple(found)


def _told_apart(alike: Confusability, label: str, other: str) -> bool:
    if label == other or label not in alike.labels or other not in alike.labels:
        return False
    return bool(alike.power[alike.labels.index(label), alike.labels.index(other)] > TOLD_APART)


def _localised(record: Record, final: Pass, options: Options) -> tuple[Localised, ...]:
    """Contrasts that stand out; where none of them does alone, the families of shapes that do."""
    found = localise(record, final.base.fit, options.seed)
    if not found and final.structure.structured:
        sigma_n = record.force_sigma_n
        found = [
            Localised(family.words, family.p, sigma_n * float(np.sqrt(family.gain / final.base.fit.residual.size)))
            for family in final.structure.families[:3]
            if family.p < STRUCTURED_P
        ]
    return tuple(found)


def _share(final: Pass, label: str) -> float:
    """An effect's share of what was removed: what is lost without it, over what is lost without each."""
    chosen = final.decision.chosen
    lost = {}
    for other in chosen.labels:
        costs = [item.best.fit.cost for item in final.sets if item.labels == chosen.labels - {other}]
        lost[other] = max(0.0, (min(costs) if costs else final.base.fit.cost) - chosen.best.fit.cost)
    whole = sum(lost.values())
    return lost[label] / whole if whole > 0.0 else 1.0 / len(lost)


def _pair(record: Record, numbers: np.ndarray, locked: np.ndarray) -> GapPair:
    if not locked.any():
        return GapPair(rms_force_n(record, numbers), None)
    return GapPair(rms_force_n(record, numbers, ~locked), rms_force_n(record, numbers, locked))


def _gap(whole: Record, record: Record, locked: np.ndarray, believed: LimbModel, judged: Pass) -> Gap:
    """Models chosen and fitted without the locked rows, measured on them and on the rest."""
    before = _pair(record, model_numbers(believed), locked)
    refitted = judged.base.fit
    steps = []
    trusted = within_trust(judged.record, refitted)
    if trusted is not None:
        allowed = allowed_sigma(refitted.space)
        steps.append(GapStep("refitted as far as the calibration allows", _pair(record, trusted, locked), allowed))
    words = f"refitted {'within' if trusted is None else 'beyond'} the calibration's trust"
    steps.append(GapStep(words, _pair(record, refitted.model, locked), pull_sigma(refitted)))
    decision = judged.decision
    last = judged.base.fit
    if decision.verdict in ("effect", "ambiguous"):
        ordered = decision.labels if decision.verdict == "effect" else decision.labels[:1]
        for count in range(1, len(ordered) + 1):
            some = frozenset(ordered[:count])
            matching = [item for item in judged.sets if item.labels == some]
            if matching:
                last = matching[0].best.fit
                steps.append(GapStep(ordered[count - 1], _pair(record, last.model, locked), pull_sigma(last)))
    return Gap("n", record.force_sigma_n, before, _pair(record, last.model, locked), tuple(steps))


def _judged_fit(judged: Pass) -> Fit:
    """What the pass would export."""
    named = judged.decision.verdict in ("effect", "ambiguous")
    return judged.decision.chosen.best.fit if named else judged.base.fit


def _could_be(final: Pass, effects: Sequence[NamedEffect]) -> tuple[str, ...]:
    """Labels that the record leaves possible besides those named."""
    named = {effect.label for effect in effects}
    found = []
    for item in final.sets[:6]:
        for label in sorted(item.labels - named):
            if label not in found and (item.posterior > 0.01 or final.decision.verdict == "unknown"):
                found.append(label)
    return tuple(found)


def _unexplained(final: Pass, after: Fit) -> Unexplained:
    structure, record = final.structure, final.record
    left = (after.residual.reshape(record.measured.shape) * record.sigma)[:2]
    rms = float(np.sqrt(np.mean(left[record.forces_read] ** 2)))
    changing = _changing(final)
    if not structure.structured and not changing:
        return Unexplained(rms, False, "no more than noise")
    shown = [family.words for family in structure.families if family.p < STRUCTURED_P][:3]
    words = "; ".join([*([changing] if changing else []), *shown])
    if final.decision.verdict != "unknown":
        return Unexplained(rms, True, f"a small rest with structure: {words}")
    nearest = final.sets[0]
    taken = final.base.fit.cost - nearest.best.fit.cost
    readings = final.record.readings
    excess = max(final.base.fit.cost - readings, 1e-9)
    near = (
        f"the nearest in the catalogue, {nearest.label}, takes {min(1.0, taken / excess):.0%} of it and leaves the rest"
        if nearest.labels
        else "nothing in the catalogue takes a part of it"
    )
    return Unexplained(rms, True, f"{words}; {near}")


def _changing(final: Pass) -> str:
    """Words for what is not in the catalogue and does better than what is, or nothing."""
    outside = final.decision.outside
    return f"the error looks as if {outside.words}" if outside.likely else ""


def _shown_by(following: NextExperiment | None, contested: Sequence[Contest]) -> NextExperiment | None:
    """The measurement that shows a rival, before the loading test that separates what is in the catalogue."""
    if following is None or not contested:
        return following
    shown = "; ".join(one.would_tell for one in contested)
    return replace(following, action=f"{shown}; as for loading tests, {following.action}")


def _also_contested(contested: Contest) -> str:
    """A further part of what was named, for which something else may stand."""
    names = [member.label for member in contested.members]
    if contested.decided:
        replaced = " and ".join(sorted(contested.disputed))
        return f"{names[0]} is named in the place of {replaced}, because it explains the record far better."
    return (
        f"{names[0]} may also be {' or '.join(names[1:])}, because {contested.cause.same_because}. "
        f"To tell, {contested.would_tell}."
    )


def _contested(resolved: Resolved, contested: Contest, effects: Sequence[NamedEffect]) -> str:
    """Both are named, with why the record does not tell them apart, what would, and what limb.toml holds."""
    cause = contested.cause
    names = [member.label for member in contested.members]
    sure = [effect.label for effect in effects if effect.label not in {*contested.disputed, *names}]
    likely = contested.members[0].share >= MOST_LIKELY
    either = (
        names[0]
        if contested.decided
        else f"most likely {names[0]}, perhaps {' or '.join(names[1:])}"
        if likely
        else f"{', '.join(names[:-1])} or {names[-1]}"
    )
    lead = (
        f"Something is missing: {either}."
        if resolved.verdict == "ambiguous"
        else f"Missing: {' and '.join([*sure, either])}."
        if contested.decided
        else f"Missing: {', '.join(sure)}, and {either}."
        if likely
        else f"Missing: {', '.join(sure)}, and one of {either}."
    )
    taken = resolved.taken
    exported = (
        f"Nothing was added to the model, which has no law for {taken.label}."
        if taken is not None and taken.trouble is not None and taken.trouble.cause.in_limb
        else f"Nothing was added to the model, because {taken.label} is no part of the limb."
        if taken is not None and taken.cause is not None and not taken.cause.in_limb
        else f"The model has {taken.label} added."
        if taken is not None
        else f"They give different K, so the model was left as it was given; --take '{names[0]}' exports the first."
    )
    if contested.decided:
        return f"{lead} {exported} To see it, {contested.would_tell}."
    return (
        f"{lead} This record {'hardly tells' if likely else 'cannot tell'} them apart, because {cause.same_because}. "
        f"To tell, {contested.would_tell}. "
        f"{exported}"
    )


def _verdict(final: Pass, resolved: Resolved) -> Verdict:
    """A sound limb in a record with troubled instruments: the record is at fault, or, where the trouble has a name
    among the effects, that is what is missing."""
    if resolved.verdict != "none" or not final.troubles:
        return resolved.verdict
    return "effect" if any(one.is_effect for one in final.troubles) else "data_fault"


def _beside(final: Pass, resolved: Resolved) -> Iterator[str]:
    """What the record has besides, behind what is said of the limb."""
    if resolved.verdict == "none":
        return
    if rubs := "; ".join(one.shown for one in final.troubles if one.cause.in_limb):
        yield f"Beside it, {rubs}."
    if troubles := "; ".join(one.shown for one in final.troubles if not one.cause.in_limb):
        yield f"The instruments were in trouble, too, and the limb is judged without what they did: {troubles}."


def _beside_nothing(final: Pass) -> str:
    """Of a limb with nothing from the catalogue: its friction that has no law here, and what the instruments did."""
    rubs = [one.shown for one in final.troubles if one.cause.in_limb]
    troubles = [one.shown for one in final.troubles if not one.cause.in_limb]
    if not rubs:
        return (
            f"The limb agrees with its model, but the instruments were in trouble: {'; '.join(troubles)}. "
            "Nothing was added to the model."
        )
    too = f" The instruments were in trouble, too: {'; '.join(troubles)}." if troubles else ""
    return f"Missing: {'; '.join(rubs)}.{too}"


def _sentence(
    believed: LimbModel, final: Pass, effects: Sequence[NamedEffect], resolved: Resolved, contested: Contest | None
) -> str:
    verdict, structure = final.decision.verdict, final.structure
    if contested is not None:
        return _contested(resolved, contested, effects)
    if verdict == "none" and final.troubles:
        return _beside_nothing(final)
    if verdict == "none":
        return "Model and record agree within the noise and what calibration leaves open; nothing is missing."
    if verdict == "unknown":
        return (
            "The record disagrees with the model in a way that no effect of the catalogue makes: "
            f"{_changing(final) or f'it shows {structure.strongest.words}'}. Nothing was added to the model."
        )
    if verdict == "ambiguous":
        names = [effect.label for effect in effects]
        held = (
            f"the model has {resolved.taken.label} added."
            if resolved.taken is not None
            else f"they give different K, so the model was left as it was given; --take '{names[0]}' exports the first."
        )
        either = f"{', '.join(names[:-1])} and {names[-1]}"
        return f"Something is missing that this record cannot tell between {either}; {held}"
    names = [f"{_surely(effect)}{identified(effect)}" for effect in effects]
    explains = "they explain" if len(names) > 1 else "it explains"
    if max(effect.confidence for effect in effects) < LIKELIER_THAN_NOT:
        but = (
            "so few readings do not show it"
            if final.record.rows <= FEW
            else f"a cause outside it explains the record better: it looks as if {final.decision.outside.words}"
        )
        return (
            f"The nearest in the catalogue is {' and '.join(one.label for one in effects)}, but {but}. The model has "
            "the nearest added; do not rely on it before another record says so."
        )
    if all(already(believed, effect) for effect in effects):
        return f"Of another size than in the model: {' and '.join(names)}. With that size, {explains} the misfit."
    return f"Missing: {' and '.join(names)}. Added to the model, {explains} the misfit."


def _surely(effect: NamedEffect) -> str:
    """Nothing before a name that is sure, else how sure it is."""
    if effect.confidence >= SURE:
        return ""
    return "probably " if effect.confidence >= LIKELIER_THAN_NOT else "perhaps "


def _more_of_the_same(final: Pass) -> NextExperiment | None:
    if final.decision.verdict != "unknown":
        return None
    where = final.structure.strongest.words
    return NextExperiment(
        f"repeat the runs that show it most ({where}) with smaller steps and a longer dwell, to see its shape",
        (),
        0.0,
        10.0,
    )


def _residuals(
    whole: Record, believed: LimbModel, exported: LimbModel, judged: Pass, locked: np.ndarray
) -> Residuals:
    """After: the exported limb, but on the locked rows the one that never saw them."""
    models = np.stack([model_numbers(believed), model_numbers(exported), _judged_fit(judged).model])
    played = whole.player.play_numbers(models)
    if exported is not believed:
        played[1][:, locked] = played[2][:, locked]
    off = np.where(whole.sigma < NOT_MEASURED, whole.measured[None] - played, np.nan)
    return Residuals(whole.channels, off[0].T.copy(), off[1].T.copy(), locked)


def _refitted(whole: Record, believed: LimbModel, final: Pass) -> np.ndarray:
    """Measured less the model with only what calibration leaves open refitted, rows x channels: what is localised."""
    refitted = model_numbers(limb_of(believed, final.base.fit.model))
    return np.asarray((whole.measured - whole.player.play_numbers(refitted[None])[0]).T)


def _notes(
    whole: Record, record: Record, final: Pass, twin: Pass | None, agreed: Agreement, after: Fit
) -> tuple[str, ...]:
    notes = []
    if whole is not record:
        notes.append(
            f"chosen and fitted on {record.rows} of {whole.rows} rows, whole runs spread over all configurations"
        )
    if record.dataset.small_displacements:
        notes.append(
            "the record is played at small displacements: its forces are proportional to the displacement, as in a "
            "simulation whose limb does not turn (meta.toml may say so: displacements = \"small\")"
        )
    for name, read in zip(FORCES, whole.forces_read):
        if not read.all():
            notes.append(
                f"{name} was read in {np.count_nonzero(read)} of {read.size} rows; what only the other readings would "
                "show, this record does not show"
            )
    if twin is None:
        notes.append("too few configurations to lock one away: no held-out misfit")
    elif twin.decision.chosen.labels != final.decision.chosen.labels:
        notes.append(
            f"without the held-out configurations the choice is {twin.decision.chosen.label}; the misfits are "
            "that choice's"
        )
    if final.decision.chosen.labels and agreed.held_out_nats is not None and agreed.held_out_nats < LOST_NATS:
        notes.append("the configurations that were held out do not gain from what was chosen without them")
    if final.decision.verdict == "effect" and agreed.bootstrap_share < STAYS_AHEAD:
        notes.append(
            "the choice rests on few runs: when the runs are drawn at random again, it wins in "
            f"{agreed.bootstrap_share:.0%} of the draws"
        )
    if (odds := final.decision.hint_odds) is not None:
        notes.append(
            f"a hint of {final.sets[0].label}: {odds:.0f} to 1 against nothing missing, where {1 / NOTHING_STANDS:.0f} "
            "to 1 is asked of a name; another record like this one would settle it"
        )
    if final.decision.verdict != "unknown" and (small := also_seen(record, after)):
        notes.append(small)
    space = after.space
    for key, pull in zip(space.keys, space.pull(after.x)):
        if abs(pull) > FAR_OUT:
            notes.append(f"{key} is pulled {pull:+.1f} sigma from what calibration says")
    for name, noise in record.noise.items():
        if noise.growth_ratio > 0.0:
            notes.append(f"the noise of {name} grows with the load: {noise.growth_ratio:.2%} of the reading")
    return tuple(notes)


def _details(record: Record, final: Pass, agreed: Agreement) -> dict[str, object]:
    return {
        "noise": {
            name: {"sigma": noise.floor, "growth_ratio": noise.growth_ratio, "source": noise.source}
            for name, noise in record.noise.items()
            if np.isfinite(noise.floor)
        },
        "structure": [
            {"where": family.words, "p": family.p, "gain": family.gain, "dimensions": family.dimensions}
            for family in final.structure.families[:5]
        ],
        "structure_p": final.structure.p,
        "posterior": final.sets[0].posterior,
        "held_out_nats": agreed.held_out_nats,
        "bootstrap_share": agreed.bootstrap_share,
        "gain": final.base.fit.cost - final.decision.chosen.best.fit.cost,
    }
