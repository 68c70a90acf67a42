"""All steps of a joint test's diagnosis in order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.dataset.faults import what_is_wrong
from brace.diagnose.diagnosis import (
    Diagnosis,
    Gap,
    GapPair,
    GapStep,
    Interval,
    JointSizes,
    NamedEffect,
    Residuals,
    Unexplained,
    Verdict,
)
from brace.diagnose.joint_test import positions, words
from brace.diagnose.joint_test.choose import SHAPES_SHRINK, Choice, at_an_end, choose, strained, without
from brace.diagnose.joint_test.dead_zone import is_friction_turning, refusal
from brace.diagnose.joint_test.evidence import beside_what_is_left, feigned, gain, intervals, left_n_mm
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.intake import blocking_faults, require_enough, spring_alone
from brace.diagnose.joint_test.localise import localise
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.rivals import Rival, beside, beside_friction, one_less, ranges, rivals, surest
from brace.diagnose.joint_test.shapes import fading, record_terms, shapes
from brace.diagnose.joint_test.terms import Term, effects_of
from brace.diagnose.options import Advance, Options
from brace.effects import JointTestBench
from brace.effects.catalogue import FADES_SHRINK
from brace.identify.parameters import ANGLE_ZERO, TORQUE_OFFSET
from brace.model import LimbModel
from brace.model.assumed_trust import with_assumed_trust
from brace.model.keys import KEY_BY_NAME

DRAWN_ROWS = 20000  # residuals that a report lays beside the record
STRUCTURED = 1.3  # rms over noise, above which what is left is more than noise
EXPECTED_FITS = 60.0
LIKELIER_THAN_NOT = 0.5  # an effect that is less likely there than not gets no name
MOST_UNEXPLAINED = 0.2  # of the torque's standard deviation: a model that leaves more has no name for what it leaves
ROUNDS_A_GAP = ("soft_middle", "end_stop")
STOPS = ("backlash", "coulomb_friction")  # what holds the joint somewhere inside a range of angles
GONE = 1e-3  # of the first step of a fit: a number smaller than this share counts as zero
LEAST = 1e-3  # of the swing: a smaller range is below the linearity of encoders and torque cells
LEAST_OF_STEP = 0.2  # of an encoder's step; nobody knows more exactly where within a step the joint was
SUREST = 0.99  # one joint's test never makes a name surer than this


def diagnose_joint_test(
    dataset: Dataset, believed: LimbModel | None, options: Options, advance: Advance
) -> Diagnosis:
    """Which effects one joint shows beyond `believed` (None: beyond a spring alone)."""
    require_enough(dataset)
    base = believed if believed is not None else spring_alone(dataset)
    faults = tuple(dataset.faults)
    blocking = blocking_faults(dataset)
    if blocking or (options.faults == "stop" and faults):
        return _faulty(dataset, base, blocking or list(faults), options)
    advance(0.02, "reading the loops")
    random = np.random.default_rng(options.seed)
    found = _searched(dataset, base, believed, random, advance)
    advance(0.85, "weighing what was found")
    return _diagnosed(dataset, believed, found, faults, options, random, advance)


@dataclass(frozen=True)
class _Found:
    """`refused`: why a gap that lowers the residual is no play."""

    fitter: Fitter
    choice: Choice
    refused: str
    effects: tuple[Term, ...]  # that the record can show


def _searched(
    dataset: Dataset, base: LimbModel, believed: LimbModel | None, random: np.random.Generator, advance: Advance
) -> _Found:
    record = JointRecord(dataset)
    fitter = Fitter(record, base, _trust(believed))
    bench = JointTestBench(record.size, given=believed is not None, rests=record.rests)
    effects = effects_of(base, record.joint, bench)
    tried = 0

    def trying(label: str) -> None:
        nonlocal tried
        tried += 1
        advance(0.05 + 0.75 * min(tried / EXPECTED_FITS, 1.0), f"trying {label}")

    own = record_terms(record.size, record.speeds_differ or record.rests)
    choice = choose(fitter, effects, own, partial(_competing, record), random, trying)
    refused = _refused_gap(fitter, choice.best)
    if refused:
        others = [term for term in effects if term.name != "backlash"]
        choice = choose(fitter, others, own, partial(_competing, record), random, trying)
    return _Found(fitter, choice, refused, tuple(effects))


def _competing(record: JointRecord, fitted: Fitted) -> list[Term]:
    """The shapes that may join a fit."""
    rubs = any(term.name == "coulomb_friction" for term in fitted.terms)
    found = shapes(record.size, record.strongest_period_rad(fitted.off_n_mm), rubs)
    # gaps that differ from position to position look like a spring that is smoothly softer in its middle
    return [one for one in found if record.position_count == 1 or one.name not in ROUNDS_A_GAP]


def _trust(believed: LimbModel | None) -> float:
    return float("inf") if believed is None else with_assumed_trust(believed).number("uncertainty.compliance_rel")


def _faulty(dataset: Dataset, base: LimbModel, faults: Sequence[DataFault], options: Options) -> Diagnosis:
    wrong = what_is_wrong(faults, Path(dataset.csv_path.name))
    return Diagnosis(
        "data_fault",
        f"The record is faulty, so nothing is said about the joint: {wrong}.",
        base,
        data_faults=tuple({id(f): f for f in (*dataset.faults, *faults)}.values()),
        seed=options.seed,
    )


def _refused_gap(fitter: Fitter, best: Fitted) -> str:
    if not any(term.name == "backlash" for term in best.terms):
        return ""
    plain = tuple(term for term in best.terms if term.role in ("effect", "record"))
    alone = best if len(plain) == len(best.terms) else fitter.fit(plain, best)
    return refusal(fitter.record, best) or is_friction_turning(fitter.record, alone)


def _diagnosed(
    dataset: Dataset,
    believed: LimbModel | None,
    search: _Found,
    faults: tuple[DataFault, ...],
    options: Options,
    random: np.random.Generator,
    advance: Advance,
) -> Diagnosis:
    fitter, choice, refused = search.fitter, search.choice, search.refused
    record, best = fitter.record, choice.best
    by_rows = fitter.by_rows()
    base = by_rows.fit((), choice.base)
    found = [term for term in best.terms if term.role == "effect"]
    own = [term for term in best.terms if term.role == "record"]
    left = [term for term in best.terms if term.role == "shape"]
    laws = [term for term in best.terms if term.role == "law"]
    exported = by_rows.fit((*found, *own), best)  # a shape is no physics, so no limb.toml gets it
    shapes_of = partial(_competing, record)
    tried = [*choice.sets, *choice.shaped, *one_less(fitter, best, shapes_of)]
    others = rivals(fitter, by_rows, best, frozenset(term.name for term in found), tried)
    effects = _named(fitter, by_rows, best, exported, found, others, choice.count, random)
    small = [term.name for term in found if _is_small(term, exported.values, record)]

    def is_weak(one: NamedEffect) -> bool:
        reported = {**exported.values, **{key: size.value for key, size in one.parameters.items()}}
        is_strained = any(term.name == one.name and at_an_end(term, reported) for term in found)
        return one.confidence <= LIKELIER_THAN_NOT or one.name in small or _may_be_nothing(one) or is_strained

    first = others  # what explained the record without an effect goes on doing so when another is no longer named
    while weak := [one for one in effects if is_weak(one)][-1:]:
        found = [term for term in found if term.name != weak[0].name]
        tried = [one for one in tried if all(term.name != weak[0].name for term in one.terms)]
        best = fitter.fit((*found, *own, *left, *laws), best)
        exported = by_rows.fit((*found, *own), best)
        tried += one_less(fitter, best, shapes_of)
        others = [*first, *rivals(fitter, by_rows, best, frozenset(term.name for term in found), tried)]
        effects = _named(fitter, by_rows, best, exported, found, others, choice.count, random)
    own = [term for term in own if not _is_gone(term, best)]  # a lag may have served an effect now unnamed
    others = list({one.label: one for one in reversed(others)}.values())[::-1]
    advance(0.93, "where they disagreed")
    spots = localise(record, base.off_n_mm, random)
    predicts = exported
    if believed is None and effects:
        predicts = _as_gears_are(by_rows, search, exported, True)
    predicts = _as_friction_fades(by_rows, predicts)
    gap, residuals, rows = _gaps(by_rows, base, effects, exported, predicts)
    after = gap.after.fitted
    remainder_noise = max(record.noise_n_mm, 1e-9)
    after_averaged = float(np.sqrt(np.mean(exported.off_n_mm[record.fitted] ** 2)))
    remains = localise(record, exported.off_n_mm, random)
    count = record.independent(exported.off_n_mm)
    hangs = bool(count < 0.3 * np.count_nonzero(record.fitted))
    withheld: tuple[str, ...] = ()
    beyond_noise = float(np.sqrt(max(after_averaged**2 - record.noise_n_mm**2, 0.0)))
    unexplained = beyond_noise / max(float(np.std(record.columns["torque_n_mm"][record.fitted])), 1e-30)
    if effects and unexplained > MOST_UNEXPLAINED:
        withheld, effects = tuple(effect.label for effect in effects), ()
    structured = bool(left or withheld) or (hangs and after_averaged > STRUCTURED * remainder_noise)
    verdict: Verdict = "effect" if effects else ("unknown" if structured else "none")
    shown = [words.shape(term.name, best.values) for term in left]
    if withheld:
        shown.append(words.withheld(withheld, unexplained))
    notes = _notes(record, dataset, gap, exported, refused, believed)
    notes += tuple(words.shape(term.name, best.values) for term in (*own, *laws))
    late = [term for term in own if term.name == "lag"]
    if late:
        why = f"{words.shape('lag', best.values)}; it was taken off, and limb.toml has nothing of it"
        faults = (*faults, DataFault(None, "torque_n_mm", why, blocking=False))
        if verdict == "none":
            verdict = "data_fault"
    if not effects:
        exported = by_rows.fit(tuple(own), base)
        predicts = exported
        if believed is None and verdict == "unknown":
            predicts = _as_friction_fades(by_rows, _as_gears_are(by_rows, search, exported, False))
    named = {effect.name for effect in effects}
    all_rows = by_rows.over_all()
    final = all_rows.fit(exported.terms, exported)
    reported = final if predicts is exported else all_rows.fit(predicts.terms, predicts)
    if reported is not final:
        effects = tuple(_as_reported(effect, positions.typical(record, reported)) for effect in effects)
    if more := [term for term in reported.terms if term.role == "effect" and term.name not in named]:
        keys = [parameter.key for term in more for parameter in term.parameters if parameter.key in KEY_BY_NAME]
        numbers = positions.typical(record, reported)
        notes += (words.not_named([term.name for term in more], {key: numbers[key] for key in keys}),)
    notes += tuple(words.shape(term.name, reported.values) for term in reported.terms if term.role == "law")
    model = _exportable(record, fitter.base, reported, believed, bool(effects))
    nearest = [one.label for one in choice.candidates if one.gain > 0.0 and " + " not in one.label]
    could_be = tuple(dict.fromkeys((*withheld, *nearest)))[:4] if verdict == "unknown" else ()
    if effects:
        could_be = beside(others, frozenset(effect.name for effect in effects))[:4]
    description = _description(shown, structured, remains, refused, after, record.raw_noise_n_mm)
    minutes = max(1.0, record.minutes)
    return Diagnosis(
        verdict,
        words.sentence(verdict, effects, gap.before.fitted, after, record.raw_noise_n_mm, shown)
        + (words.as_well(could_be) if effects and could_be else ""),
        model,
        gap if effects else replace(gap, after=gap.before, steps=()),
        effects,
        (),
        could_be,
        spots,
        Unexplained(after if effects else gap.before.fitted, structured, description),
        (
            words.next_experiment(effects, [term.name for term in left], could_be, minutes)
            if verdict != "none"
            else None
        ),
        faults,
        choice.candidates,
        (
            residuals
            if effects
            else Residuals(residuals.channels, residuals.before, residuals.before, residuals.held_out)
        ),
        notes,
        options.seed,
        {"rows": rows, "held_out": record.held_words, "independent_readings": float(count)},
        joint=_sizes(all_rows, reported, effects, random) if verdict in ("effect", "none") else None,
    )


def _as_gears_are(by_rows: Fitter, search: _Found, exported: Fitted, have_names: bool) -> Fitted:
    """What was found, with play and friction as they fit best where they fit better: every gear has some of both. A
    spring that hardens joins what was named only where several amplitudes show it: one amplitude says nothing of a
    cube beyond it."""
    found, record = exported, by_rows.record
    usual = (*STOPS, "joint_hardening") if record.amplitudes > 1 and have_names else STOPS
    have = {term.name for term in found.terms}
    lacking = [term for term in search.effects if term.name in usual and term.name not in have]
    # a gap is found best beside friction, a cube beside both
    for term in sorted(lacking, key=lambda one: ("coulomb_friction", "backlash", "joint_hardening").index(one.name)):
        # a fit without the gap may stand far off the middle of it, and one with a gap alone far off the friction
        afresh, before = by_rows.fit(()), by_rows.fit((term,), by_rows.fit(()), term)
        for other in found.terms:
            afresh = by_rows.fit((*afresh.terms, other), afresh, other)
            before = by_rows.fit((*before.terms, other), before, other)
        more = [before, *(by_rows.fit((*near.terms, term), near, term) for near in (found, afresh))]
        sound = [one for one in more if not strained(by_rows, one) and not _refused_gap(by_rows, one)]
        better = [one for one in sound if one.rss < (1.0 - SHAPES_SHRINK) ** 2 * found.rss
                  and one.held_rss <= found.held_rss]  # fmt: skip
        found = min(better, key=lambda one: one.rss, default=found)
    return found


def _as_friction_fades(by_rows: Fitter, found: Fitted) -> Fitted:
    """What was found, with a friction whose growth with the load fades where that fits better, as `brace identify` has
    it."""
    record = by_rows.record
    if not any(term.name == "coulomb_friction" for term in found.terms):
        return found
    law = fading(record.joint, record.size)
    faded = by_rows.fit((*found.terms, law), found, law)
    is_better = faded.rss < (1.0 - FADES_SHRINK) ** 2 * found.rss and faded.held_rss <= found.held_rss
    return faded if is_better and not strained(by_rows, faded) else found


def _as_reported(effect: NamedEffect, values: Mapping[str, float]) -> NamedEffect:
    """The effect with the numbers that limb.toml has, which may hold more than what was named."""
    held = {
        key: Interval(values[key], min(one.low, values[key]), max(one.high, values[key]))
        for key, one in effect.parameters.items()
    }
    return replace(effect, parameters=held)


def _sizes(
    by_rows: Fitter, exported: Fitted, effects: Sequence[NamedEffect], random: np.random.Generator
) -> JointSizes:
    """The spring beside what the effects say, all with the same intervals."""
    record = by_rows.record
    key = f"joint.{record.joint}.compliance_rad_per_n_mm"
    reported = dict(item for effect in effects for item in effect.parameters.items())
    if key in exported.values:
        known = intervals(by_rows, exported, random)[key]
        value, (_, low, high) = positions.typical(record, exported)[key], known
        if further := positions.further(record, exported).get(key):
            low, high = positions.together(value, further, known)
        reported = {key: Interval(value, min(value, low), max(value, high))} | reported
    torque = record.columns["torque_n_mm"][record.fitted]
    reach_n_mm = float(min(torque.max(), -torque.min()) if torque.min() < 0.0 < torque.max() else np.abs(torque).max())
    return JointSizes(reported, reach_n_mm, record.position_count)


def _is_gone(term: Term, fitted: Fitted) -> bool:
    """Whether the fit has set each of a term's numbers to nothing."""
    return all(abs(fitted.values[one.key]) < GONE * one.scale for one in term.parameters)


def _may_be_nothing(effect: NamedEffect) -> bool:
    """Whether every interval of the effect's sizes holds zero. A number that is never zero, as a time constant is, says
    how the effect goes, not how large it is."""
    sizes = [one for key, one in effect.parameters.items() if not KEY_BY_NAME[key].open_low]
    return bool(sizes) and all(one.low <= 0.0 <= one.high for one in sizes)


def _named(
    fitter: Fitter,
    by_rows: Fitter,
    best: Fitted,
    exported: Fitted,
    found: Sequence[Term],
    others: Sequence[Rival],
    count: float,
    random: np.random.Generator,
) -> tuple[NamedEffect, ...]:
    """Effects, the surest first; of those equally sure the one that accounts for most of the angle."""
    if not found:
        return ()
    record = fitter.record
    all_rows = by_rows.over_all()  # choices are judged by what was held out, sizes are estimated from all readings
    final = all_rows.fit(exported.terms, exported)
    limits, elsewhere = intervals(all_rows, final, random), ranges(by_rows, others, random)
    further, values = positions.further(record, final), positions.typical(record, final)
    weighted = best if len(best.terms) == len(exported.terms) else fitter.fit(exported.terms, best)
    left, spring_rad_per_n_mm = left_n_mm(all_rows, final), _spring_rad_per_n_mm(record, values)
    named = []
    for term in found:
        poorer = without(fitter, best, term)
        rows_count = record.independent(exported.off_n_mm)
        both = (
            gain(record, poorer, best, count),
            gain(record, without(by_rows, exported, term), exported, rows_count),
        )
        net = max(both) - len(term.parameters) * float(np.log(max(count, 3.0)))
        real = 1.0 - feigned(record, poorer, best)
        confidence = min(real, surest(others, term.name), 1.0 / (1.0 + float(np.exp(-0.5 * net))))
        if any(other.name == "coulomb_friction" for other in found):
            confidence = beside_friction(term.name, confidence)
        confidence = min(SUREST, confidence)
        parameters = {}
        for key in (parameter.key for parameter in term.parameters if parameter.key in KEY_BY_NAME):
            value, (_, low, high) = values[key], limits[key]
            other = weighted.values[key]  # both ways of weighting are sound, so the interval holds what both say
            least, most = elsewhere.get(key, (value, value))
            if key in further:  # what differs from position to position is known no better
                low, high = positions.together(value, further[key], limits[key])
            reported = Interval(value, min(value, low, other, least), max(value, high, other, most))
            parameters[key] = beside_what_is_left(key, reported, left, spring_rad_per_n_mm)
        named.append((NamedEffect(term.name, term.where, confidence, parameters, 0.0), poorer.rss - best.rss))
    total = sum(max(rss, 0.0) for _, rss in named) or 1.0
    shared = [replace(effect, gap_share=max(rss, 0.0) / total) for effect, rss in named]
    lost = {term.name: _lost_rad(term, exported.values, record) for term in found}
    return tuple(sorted(shared, key=lambda one: (-one.confidence, -lost[one.name])))


def _lost_rad(term: Term, values: Mapping[str, float], record: JointRecord) -> float:
    """How far an effect moves the joint [rad], so how much of the angle nobody knows because of it."""
    if term.shows is None:
        return 0.0
    return term.shows.lost_rad(term.by_leaf(values), record.size, _spring_rad_per_n_mm(record, values))


def _spring_rad_per_n_mm(record: JointRecord, values: Mapping[str, float]) -> float:
    """The joint's compliance; by the record's swing where it is not fitted."""
    compliance = f"joint.{record.joint}.compliance_rad_per_n_mm"
    return values.get(compliance, record.size.angle_rad / record.size.torque_n_mm)


def _is_small(term: Term, values: Mapping[str, float], record: JointRecord) -> bool:
    """Whether the effect moves the joint by less than instruments can show."""
    lost_rad = _lost_rad(term, values, record)
    if term.name in STOPS and lost_rad < LEAST * record.size.angle_rad:
        return True
    return 0.0 < lost_rad < LEAST_OF_STEP * record.angle_step_rad


def _gaps(
    by_rows: Fitter, base: Fitted, effects: Sequence[NamedEffect], exported: Fitted, predicts: Fitted
) -> tuple[Gap, Residuals, np.ndarray]:
    """The gap before, after each effect in the order they are named, and after all that limb.toml has."""
    record = by_rows.record
    fitted, kept = record.raw_marks()

    def pair(off: np.ndarray) -> GapPair:
        held = float(np.sqrt(np.mean(off[kept] ** 2))) if kept.any() else None
        return GapPair(float(np.sqrt(np.mean(off[fitted] ** 2))), held)

    before, named, after = (record.raw_off(one.model, one.nuisances) for one in (base, exported, predicts))
    by_label = {term.label: term for term in exported.terms}
    steps, current = [], base
    for number, effect in enumerate(effects):
        term = by_label[effect.label]
        last = number == len(effects) - 1
        current = exported if last else by_rows.fit((*current.terms, term), current, term)
        off = named if last else record.raw_off(current.model, current.nuisances)
        steps.append(GapStep(effect.label, pair(off)))
    rows = np.flatnonzero(fitted | kept)
    rows = rows[:: max(1, -(-rows.size // DRAWN_ROWS))]
    residuals = Residuals(
        ("torque_n_mm",), before[rows][:, None], after[rows][:, None], np.asarray(kept[rows])
    )
    return Gap("n_mm", record.raw_noise_n_mm, pair(before), pair(after), tuple(steps)), residuals, rows


def _exportable(
    record: JointRecord, base: LimbModel, fitted: Fitted, believed: LimbModel | None, named: bool
) -> LimbModel:
    """The base with what was fitted of limb.toml's keys; the spring only where it was free to be fitted."""
    values = {key: value for key, value in positions.typical(record, fitted).items() if key in KEY_BY_NAME}
    if believed is not None and not named:
        return believed
    return base.with_values(values)


def _notes(
    record: JointRecord,
    dataset: Dataset,
    gap: Gap,
    exported: Fitted,
    refused: str,
    believed: LimbModel | None,
) -> tuple[str, ...]:
    notes = []
    _, kept = record.raw_marks()
    if gap.after.held_out is not None:
        torque = dataset["torque_n_mm"]
        whole = np.repeat(record.held_rows, record.block_counts)
        off = record.raw_off(exported.model, exported.nuisances)
        alike, all_rows = (max(float(np.std(torque[rows])), 1e-9) for rows in (kept, whole))
        with_limit = float(np.sqrt(np.mean(off[whole] ** 2)))
        notes.append(
            f"held out: {record.held_words}; the misfit there is {gap.after.held_out / alike:.1%} of the"
            f" torque's standard deviation ({alike:.4g} N mm) without rows in which the drive is at its limit or does"
            f" not follow its command, {with_limit / all_rows:.1%} with them ({with_limit:.4g} of {all_rows:.4g} N mm)"
        )
    else:
        notes.append("nothing could be held out: fewer than three tests and too few ramps")
    own = exported.nuisances
    notes.append(
        f"the record's own, not the limb's: zero of the angle {own[ANGLE_ZERO]:+.4g} rad, offset of the"
        f" torque {own[TORQUE_OFFSET]:+.4g} N mm, friction's state where each test starts"
    )
    if believed is None:
        notes.append(
            "no model was given: the joint alone is fitted, in the example limb, which stands in for the rest"
        )
    if refused:
        notes.append(f"no backlash is claimed although a gap lowers the residual: {refused}")
    return tuple(notes)


def _description(
    shown: Sequence[str],
    structured: bool,
    remains: Sequence[object],
    refused: str,
    after: float,
    noise_n_mm: float,
) -> str:
    if not structured:
        return f"what is left ({after:.3g} N mm) has no structure beyond the noise of {noise_n_mm:.3g} N mm"
    parts = list(shown)
    where = [str(getattr(one, "where")) for one in remains][:2]
    parts += where
    if refused:
        parts.append(f"a soft region that is no play: {refused}")
    if not parts:
        parts.append("slow deviations that differ from ramp to ramp")
    return f"{after:.3g} N mm remain over a noise of {noise_n_mm:.3g} N mm: " + "; ".join(parts)
