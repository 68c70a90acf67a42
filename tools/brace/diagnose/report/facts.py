"""What the report says of one finished diagnosis, as data: every number with its words, in the page's order. Made once;
the page only sets it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from brace.dataset import Dataset
from brace.diagnose import plain_words as words
from brace.diagnose.already import only_sizes
from brace.diagnose.diagnosis import Diagnosis, Gap, GapPair, Interval, NamedEffect, StiffnessAt
from brace.diagnose.digits import number, percent, unit
from brace.diagnose.export import changed
from brace.diagnose.limb_change import inspections, limb_change
from brace.diagnose.provenance import Provenance
from brace.diagnose.report.views import View, view
from brace.diagnose.report.what_k_becomes import JOINTS, what_k_becomes
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME

MOST_FAULTS, MOST_CANDIDATES = 60, 14
MOST_SURE = 0.999  # of what a number of played tests says
MOST_TIMES = 1000.0  # beyond that only the order of magnitude is said
PUSH = "To the controller: brace params push limb.toml --bus URL."
COULD_BE_TIMES = 100.0  # less likely by more than this is not called possible


@dataclass(frozen=True)
class Answer:
    """One of the four questions of the first screen."""

    question: str
    short: str
    more: str


@dataclass(frozen=True)
class Spot:
    """A contrast that stands out."""

    where: str
    size: str
    share: str


@dataclass(frozen=True)
class Parameter:
    """A line of the effects' table; `effect`, `label` and `sure` are empty but in an effect's first."""

    effect: str
    label: str
    sure: str
    key: str
    believed: str
    found: str
    interval: str


@dataclass(frozen=True)
class KLine:
    """K of one model."""

    model: str
    sure: str
    k: tuple[str, str, str]


@dataclass(frozen=True)
class Step:
    """The misfit with one model; shares are of the largest. `is_beyond`: the calibration does not allow the model."""

    model: str
    fitted: str
    fitted_share: float
    held_out: str
    held_out_share: float
    pull: str
    is_beyond: bool


@dataclass(frozen=True)
class Tried:
    """A candidate beside the likeliest."""

    words: str
    label: str
    gain: str
    gain_share: float
    less_likely: str


@dataclass(frozen=True)
class Facts:
    """What one report page shows, in the order of the page. An empty text or list: the page has no such part."""

    record: str
    limb: str
    verdict: str
    headline: str
    sentence: str
    cautions: tuple[str, ...]
    answers: tuple[Answer, ...]
    misfit: str
    unit: str  # of the misfit
    faults: tuple[tuple[str, str, str, str], ...]  # row, field, why, suggestion
    more_faults: int
    view: View | None
    believed_words: str
    refit_words: str
    spots_words: str
    spots: tuple[Spot, ...]
    missing_title: str
    meanings: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    k_words: str
    k_lines: tuple[KLine, ...]
    steps: tuple[Step, ...]
    refitted: tuple[tuple[str, str, str, str], ...]  # key, before, after, unit
    refitted_words: str
    held_out: tuple[str, ...]
    not_held_out: str
    unexplained: tuple[str, ...]
    classes_words: str
    classes: tuple[tuple[tuple[str, str], ...], ...]  # words and label of each member
    could_be: str
    next_words: tuple[str, ...]
    rig_toml: str
    candidates: tuple[Tried, ...]
    more_candidates: int
    notes: tuple[str, ...]
    origin: tuple[tuple[str, str, str], ...]  # what, value, words behind it


def facts(dataset: Dataset, believed: LimbModel | None, found: Diagnosis, origin: Provenance) -> Facts:
    """From the diagnosis to its words, once."""
    given = "the model as believed" if believed is not None else "a spring alone, fitted"
    k_words, k_lines = _k(found)
    refitted = _refitted(believed, found)
    classes_words, classes = _alike(found)
    tried = sorted(found.candidates, key=lambda one: (-one.posterior, -one.gain))
    faults = tuple(
        (
            "all" if fault.row is None else str(fault.row),
            fault.field,
            fault.why,
            "" if fault.suggestion is None else str(fault.suggestion),
        )
        for fault in found.data_faults
    )
    return Facts(
        record=origin.name,
        limb=_limb_of(believed, origin) if believed is not None else "no model given: a spring alone",
        verdict=found.verdict,
        headline=_headline(believed, found),
        sentence=found.sentence,
        cautions=found.cautions,
        answers=(
            _missing(believed, found),
            _sure(found),
            Answer(*what_k_becomes(believed, found)),
            _to_do(believed, found),
        ),
        misfit=_misfit(found, given),
        unit=_unit(found),
        faults=faults[:MOST_FAULTS],
        more_faults=max(0, len(faults) - MOST_FAULTS),
        view=view(dataset, found, given),
        believed_words=f"{_capital(given)}{'' if believed is not None else ','} misses the record by {_both(found.gap.before, found.gap)}."
        if found.gap is not None
        else "",
        refit_words=_refit(found),
        spots_words=_spots(found),
        spots=tuple(
            Spot(
                spot.where,
                f"{number(spot.size)} {_unit(found)}",
                "" if spot.share is None else percent(spot.share),
            )
            for spot in sorted(found.localised, key=lambda one: -(one.share or 0.0))
        ),
        missing_title=_missing_title(believed, found),
        meanings=_meanings(found),
        parameters=tuple(line for effect in found.effects for line in _parameters(believed, found.model, effect)),
        k_words=k_words,
        k_lines=k_lines,
        steps=_steps(found, given),
        refitted=refitted,
        refitted_words=_refitted_words(found, len(refitted)) if refitted else "",
        held_out=tuple(words.held_out(part, found.gap.unit) for part in found.held_out) if found.gap else (),
        not_held_out=f"{_capital(_not_held_out(found))}, so the misfit of the model as found is one of fitting only."
        if found.gap is not None and found.gap.after.held_out is None
        else "",
        unexplained=_unexplained(found),
        classes_words=classes_words,
        classes=classes,
        could_be=_could_be(found),
        next_words=_next(believed, found),
        rig_toml=found.next_experiment.rig_toml if found.next_experiment is not None else "",
        candidates=_candidates([(one.label, one.gain, one.posterior) for one in tried]),
        more_candidates=max(0, len(tried) - MOST_CANDIDATES),
        notes=found.notes,
        origin=_origin(found, origin),
    )


def _limb_of(believed: LimbModel, origin: Provenance) -> str:
    """Empty where the record has the limb's name."""
    return "" if believed.name == origin.name else f"limb “{believed.name}”"


def _headline(believed: LimbModel | None, found: Diagnosis) -> str:
    if found.verdict == "effect" and only_sizes(believed, found):
        return "What the model has is of another size in the record, and it has a name"
    return words.verdict(found)


def _missing(believed: LimbModel | None, found: Diagnosis) -> Answer:
    question = "What is missing"
    if found.verdict == "none":
        return Answer(question, "Nothing", "that this record can show")
    if found.verdict == "data_fault":
        count = len(found.data_faults)
        first = found.data_faults[0] if count else None
        place = "" if first is None else f"first: {'' if first.row is None else f'row {first.row}, '}{first.field}"
        return Answer("What is wrong", f"{count} fault{'s' if count != 1 else ''} of the record", place)
    if not found.effects:
        return Answer(question, "Something without a name here", "no effect of the catalogue explains it")
    if found.verdict == "effect" and only_sizes(believed, found):
        question = "What is of another size"
    between = " or " if found.verdict == "ambiguous" else " and "
    shown = []
    for effect in found.effects:
        if (change := limb_change(found.model, effect)) is not None:
            shown.append(change.words)
            continue
        shown += [
            f"{key} = {words.value_with_unit(key, held.value)}{_ninety(key, held)}"
            for key, held in effect.parameters.items()
        ]
    return Answer(question, between.join(words.named(effect) for effect in found.effects), "; ".join(shown))


def _ninety(key: str, held: Interval) -> str:
    """The 90 % interval behind a value; a switch has none."""
    return "" if words.is_switch(key, held.value) else f", 90 %: {words.interval(held)}"


def _sure(found: Diagnosis) -> Answer:
    question = "How sure"
    could_be = _could_be(found).removesuffix(".")
    if found.effects and found.verdict in ("effect", "ambiguous"):
        if len(found.effects) == 1:
            more = "probability that this name is the right one"
            return Answer(question, percent(found.effects[0].confidence), f"{more}. {could_be}" if could_be else more)
        each = "; ".join(f"{percent(one.confidence)} {words.effect(one.name)}" for one in found.effects)
        kind = "what is left is the others’" if found.verdict == "ambiguous" else "each by itself"
        return Answer(question, each, f"probability that a name is right; {kind}{f'. {could_be}' if could_be else ''}")
    if found.verdict == "data_fault":
        return Answer(question, "No probability", "each fault stands below, with the reason why it is one")
    if found.gap is None:
        return Answer(question, "No probability", "and no misfit was computed")
    ends = [(found.gap.before, "as believed")]
    ends += [(found.gap.after, "with its numbers refitted")] if _is_refit(found) else []
    sizes = [f"{number(_end(pair) / max(found.gap.noise_floor, 1e-12))} times the noise {of}" for pair, of in ends]
    left = f"the model misses the record by {', and by '.join(sizes)}"
    if found.verdict == "none":
        left += ". An effect that is too small for this record would not show"
        return Answer(question, "No sign of an effect", left)
    return Answer(question, "No probability", f"only a named effect has one; {left}")


def _is_refit(found: Diagnosis) -> bool:
    """Whether what is left is of the believed model with its numbers refitted, and nothing added."""
    return found.verdict in ("none", "unknown") and found.details.get("refit_pull_sigma") is not None


def _to_do(believed: LimbModel | None, found: Diagnosis) -> Answer:
    question = "What to do next"
    after = found.next_experiment
    measure = "" if after is None else f"{_capital(after.action)}."
    if found.verdict == "none":
        if believed is not None and not changed(believed, found.model):
            return Answer(question, "Go on with your model", "limb.toml is the same model")
        return Answer(question, "Go on with limb.toml", f"it has your model’s numbers, refitted to this record. {PUSH}")
    if found.verdict == "data_fault":
        return Answer(question, "Mend the record", "correct the faults listed below, or measure again, then diagnose anew")
    if found.verdict == "unknown":
        return Answer(question, "Measure again", measure or "with smaller steps, where it shows most")
    if found.verdict == "ambiguous" and believed is not None and not changed(believed, found.model):
        return Answer(question, "Measure what tells them apart", measure)
    added = "one of them added; which one stands above" if found.verdict == "ambiguous" else "what was missing"
    done = f"it is your model with {added}. {PUSH}"
    if any(effect.where == "sensor" for effect in found.effects):
        done += (
            " Its [sensor] describes the sensor that read this record: leave it out if that is the rig’s, not the "
            "limb’s."
        )
    surer = f"{done} To be surer: {measure[:1].lower()}{measure[1:]}" if measure else done
    inspect = inspections(believed, found)
    if inspect:
        return Answer(question, "Inspect the limb", f"{'. '.join(inspect)}. Then use limb.toml: {surer}")
    return Answer(question, "Use limb.toml", surer)


def _misfit(found: Diagnosis, given: str) -> str:
    """Before and after in one line."""
    gap = found.gap
    if gap is None:
        return ""
    if gap.after.held_out is None:
        on = f"on what was fitted; {_not_held_out(found)}"
    else:
        kind = "configurations" if gap.unit == "n" else "tests" if gap.unit == "n_mm" else "postures"
        on = f"on {kind} that took no part in the fit"
    size = unit(gap.unit)
    ends = f"{number(_end(gap.before))} {size} of {given}"
    if _is_refit(found):
        not_written = ", which limb.toml does not have" if found.verdict == "unknown" else ""
        ends += f" → {number(_end(gap.after))} {size} with its numbers refitted{not_written}"
    elif found.verdict in ("effect", "ambiguous", "unknown"):
        ends += f" → {number(_end(gap.after))} {size} of the model as found"
    return f"Misfit (rms of measured less model) {on}: {ends}. Noise floor: {number(gap.noise_floor)} {size}."


def _refit(found: Diagnosis) -> str:
    """How far the record pulls the calibrated numbers where nothing is added."""
    pull, allowed = found.details.get("refit_pull_sigma"), found.details.get("allowed_sigma")
    if not isinstance(pull, float) or not isinstance(allowed, float):
        return ""
    if pull <= allowed:
        return (
            f"The numbers that the calibration leaves open are then refitted: {pull:.1f} sigma from their calibration "
            f"all together, where {allowed:.1f} sigma are allowed. What follows is of that refitted model."
        )
    return (
        f"Refitting the calibrated numbers alone would pull them {pull:.0f} sigma away from their calibration, where "
        f"{allowed:.1f} sigma are allowed: such a model is not believed, it only takes out of the misfit what could "
        "look like a calibration error. What follows is of that refitted model."
    )


def _spots(found: Diagnosis) -> str:
    of = "Of the refitted model: " if found.details.get("refit_pull_sigma") is not None else ""
    if found.localised:
        where = "where" if of else "Where"
        return (
            f"{of}{where} the misfit stands out of the noise, each place after those above it are taken out. Chance "
            "would show any of these in fewer than 5 of 100 records."
        )
    hidden = found.verdict not in ("none", "data_fault") and of
    return f"{of}{'no' if of else 'No'} contrast over load, direction, configuration, order, time or temperature stands out" + (
        "; what is missing has gone into the numbers that were pulled." if hidden else "."
    )


def _missing_title(believed: LimbModel | None, found: Diagnosis) -> str:
    if not found.effects:
        return "What was refitted"
    if found.verdict == "effect":
        return "What is of another size" if only_sizes(believed, found) else "What was missing"
    return "What it could be"


def _meanings(found: Diagnosis) -> tuple[str, ...]:
    names = dict.fromkeys(effect.name for effect in found.effects)
    return tuple(f"{_capital(words.effect(name))}: {words.meaning(name)}." for name in names if words.meaning(name))


def _parameters(believed: LimbModel | None, model: LimbModel, effect: NamedEffect) -> list[Parameter]:
    heads = (words.named(effect), effect.label, f"{percent(effect.confidence)} sure")
    lines: list[Parameter] = []
    for key, held in effect.parameters.items():
        number_of = believed is not None and isinstance(believed.values.get(key), (int, float))
        was = words.value_alone(key, believed.number(key)) if believed is not None and number_of else "–"
        value = words.value_with_unit(key, held.value)
        lines.append(Parameter(*(heads if not lines else ("", "", "")), key, was, value, words.interval(held)))
    if believed is not None and (change := limb_change(model, effect)) is not None:
        before, now = (words.value_with_unit(change.key, one.number(change.key)) for one in (believed, model))
        lines.append(Parameter("", "", "", change.key, before, now, "as the factor"))
    return lines or [Parameter(*heads, "", "", "", "")]


def _k(found: Diagnosis) -> tuple[str, tuple[KLine, ...]]:
    """K of each explanation, or of the model before and after."""
    if found.members:
        members = sorted(found.members, key=lambda one: -one.probability)
        at = members[0].k
        lines = [KLine(one.label, percent(one.probability), _entries(one.k)) for one in members]
        why = "where the explanations differ most"
    elif found.stiffness is not None and found.stiffness.believed != found.stiffness.exported:
        at = found.stiffness.believed
        lines = [
            KLine("as believed", "", _entries(at)),
            KLine("as limb.toml has it now", "", _entries(found.stiffness.exported)),
        ]
        why = "where the two models differ most"
    else:
        return "", ()
    play = ", any play taken up" if any(found.model.number(f"{joint}.gap_rad") > 0.0 for joint in JOINTS) else ""
    place = f"theta1 {at.theta1_rad:.3f}, theta2 {at.theta2_rad:.3f} rad"
    return f"K without load{play}, at {place}, {why}:", tuple(lines)


def _steps(found: Diagnosis, given: str) -> tuple[Step, ...]:
    gap = found.gap
    if gap is None:
        return ()
    stages: list[tuple[str, GapPair, float | None]] = [(given, gap.before, None), *((step.added, step.gap, step.pull_sigma) for step in gap.steps)]
    if stages[-1][1] != gap.after:
        stages.append(("the model as written", gap.after, None))
    largest = max([max(pair.fitted, pair.held_out or 0.0) for _, pair, _ in stages] + [1e-12])
    allowed = found.details.get("allowed_sigma")
    return tuple(
        Step(
            f"with {words.label(added)}" if "@" in added else added,
            number(pair.fitted),
            pair.fitted / largest,
            "" if pair.held_out is None else number(pair.held_out),
            (pair.held_out or 0.0) / largest,
            "" if pull is None else f"{pull:.1f} sigma",
            isinstance(allowed, float) and pull is not None and pull > allowed * (1.0 + 1e-6),
        )
        for added, pair, pull in stages
    )


def _refitted(believed: LimbModel | None, found: Diagnosis) -> tuple[tuple[str, str, str, str], ...]:
    """What was refitted besides."""
    if believed is None:
        return ()
    named = {key for effect in found.effects for key in effect.parameters}
    named |= {change.key for effect in found.effects if (change := limb_change(found.model, effect)) is not None}
    return tuple(
        (key, _shown(believed, key), _shown(found.model, key), words.key_unit(key))
        for key in changed(believed, found.model)
        if key not in named and KEY_BY_NAME[key].kind != "text"  # a text is set, not fitted
    )


def _refitted_words(found: Diagnosis, count: int) -> str:
    said = f"{count} value{'s' if count > 1 else ''} refitted besides"
    pull, allowed = found.details.get("pull_sigma"), found.details.get("allowed_sigma")
    if not isinstance(pull, float) or not isinstance(allowed, float):
        return said
    within = "within" if pull <= allowed else "beyond"
    return f"{said}, {within} the calibration’s trust: {pull:.1f} sigma all together, {allowed:.1f} are allowed"


def _unexplained(found: Diagnosis) -> tuple[str, ...]:
    left = found.unexplained
    if left is None:
        return ()
    size = f"{number(left.rms)} {_unit(found)}"
    lead = (
        f"{size} (rms) is left of the model as found, and it has structure: it is not noise alone. It is not exported "
        "as physics."
        if left.structured
        else f"{size} (rms) is left of the model as found, without structure: as far as this record can show, it is noise."
    )
    return (lead, f"{_capital(left.description)}.") if left.structured else (lead,)


def _could_be(found: Diagnosis) -> str:
    known = {one for members in found.indistinguishable for one in members} | {one.label for one in found.effects}
    times = {label: _times_less(found, label) for label in found.could_be if label not in known}
    rest = [
        words.label(label) + ("" if less is None else f" ({_times(1.0, 1.0 / less)} less likely)")
        for label, less in times.items()
        if less is None or less <= COULD_BE_TIMES
    ]
    return f"It could also be, alone or besides: {'; '.join(rest)}." if rest else ""


def _times_less(found: Diagnosis, label: str, instead_of: str = "") -> float | None:
    """How much less likely the likeliest candidate with a label is than the likeliest of all; `instead_of`: without
    that one. None: no such candidate was tried. Infinite: far beyond what a number holds."""
    shares = [
        one.posterior
        for one in found.candidates
        if label in one.label.split(" + ") and instead_of not in one.label.split(" + ")
    ]
    first = max((one.posterior for one in found.candidates), default=0.0)
    if not shares or first <= 0.0:
        return None
    return first / max(shares) if max(shares) > 0.0 else math.inf


def _alike(found: Diagnosis) -> tuple[str, tuple[tuple[tuple[str, str], ...], ...]]:
    """What leaves nearly the same trace: a heading, and words and label of each member of each class. Beside a sure
    name each other member says how much less likely it is."""
    sure = found.verdict == "effect"
    classes = []
    for members in found.indistinguishable:
        named = [one.label for one in found.effects if one.label in members]
        shown = []
        for label in members:
            less = _times_less(found, label, named[0]) if sure and named and label not in named else None
            odds = "" if less is None else f" ({_times(1.0, 1.0 / less)} less likely)"
            shown.append((words.label(label) + odds, label))
        classes.append(tuple(shown))
    lead = "In this record these leave nearly the same trace."
    return lead, tuple(classes)


def _next(believed: LimbModel | None, found: Diagnosis) -> tuple[str, ...]:
    said = [f"{one}." for one in inspections(believed, found)]
    after = found.next_experiment
    if after is None:
        return tuple(said)
    said.append(f"{_capital(after.action).removesuffix('.')}.")
    if after.separates:
        said.append(
            f"It would tell apart: {'; '.join(words.label(label) for label in after.separates)}. It would succeed with "
            f"a probability of {percent(min(after.power, MOST_SURE))}."
        )
    return tuple(said)


def _candidates(tried: Sequence[tuple[str, float, float]]) -> tuple[Tried, ...]:
    if not tried:
        return ()
    most = max(max(gain for _, gain, _ in tried), 1e-12)
    first = tried[0][2]
    return tuple(
        Tried(
            words.label(label),
            label if "@" in label else "",
            number(gain),
            gain / most,
            "likeliest" if place == 0 else _times(first, posterior),
        )
        for place, (label, gain, posterior) in enumerate(tried[:MOST_CANDIDATES])
    )


def _times(first: float, posterior: float) -> str:
    times = first / posterior if posterior > 0.0 else math.inf
    if math.isinf(times):  # a share below the least number that there is, or nearly so
        return "over 10^300 times"
    return f"10^{math.floor(math.log10(times))} times" if times >= MOST_TIMES else f"{number(times)} times"


def _origin(found: Diagnosis, origin: Provenance) -> tuple[tuple[str, str, str], ...]:
    versions: Mapping[str, str] = origin.versions
    return (
        ("record", f"{origin.name}: {origin.kind.replace('_', ' ')}, {origin.rows} rows", ""),
        ("data sha256", origin.data_sha256, "(meta.toml, then data.csv)"),
        *((("model sha256", origin.model_sha256, "(as believed)"),) if origin.model_sha256 else ()),
        ("seed", str(found.seed), ""),
        ("versions", ", ".join(f"{name} {value}" for name, value in versions.items()), ""),
    )


def _both(pair: GapPair, gap: Gap) -> str:
    return words.gap_pair(pair, gap.unit)


def _not_held_out(found: Diagnosis) -> str:
    """Parts of the record may be predicted from its rest all the same."""
    return "no configuration or test could be held out" if found.held_out else "nothing could be held out"


def _end(pair: GapPair) -> float:
    """On what took no part, where there is some."""
    return pair.fitted if pair.held_out is None else pair.held_out


def _entries(k: StiffnessAt) -> tuple[str, str, str]:
    """xx, xz, zz."""
    return number(k.k_xx_n_per_mm), number(k.k_xz_n_per_mm), number(k.k_zz_n_per_mm)


def _shown(model: LimbModel, key: str) -> str:
    value = model.values[key]
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def _unit(found: Diagnosis) -> str:
    return unit(found.gap.unit) if found.gap else ""


def _capital(words_: str) -> str:
    return words_[:1].upper() + words_[1:]
