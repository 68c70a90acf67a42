"""This step decides which terms a joint test asks for.

It grows sets of effects, each from the best sets that are one smaller, so it finds two effects that make sense only
together. Then shapes that no effect has may join. At last every term must stand up to three judges: independent
readings, stretches drawn anew, and the readings that were held out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.diagnosis import Candidate
from brace.diagnose.joint_test.evidence import agreement, feigned, gain
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.record import JointRecord
from brace.diagnose.joint_test.terms import Term

BEAM = 4  # sets of one size that are grown on
LEAST_GAIN = 4.0  # twice the log of the odds, ln(n) for every parameter paid
LEAST_AGREEMENT = 0.9
LEAST_SHRINK = 0.002  # of the rms; nobody can use less
MOST_SHAPES = 2
SECOND_SHRINK = 0.03  # of the rms; a term that joins on a second look must do more than mend another's shape
SHAPES_SHRINK = 0.02  # a shape is only described, so it must explain more
MOST_STIFFENING = 5.0  # of a spring within one record; gears and belts stiffen by two or three

Trying = Callable[[str], None]
Shapes = Callable[[Fitted], list[Term]]


@dataclass(frozen=True)
class Choice:
    """`base` has no terms; `sets` are all sets of effects that were fitted, `shaped` are those with a shape; `best` may
    have shapes in it."""

    base: Fitted
    sets: tuple[Fitted, ...]
    shaped: tuple[Fitted, ...]
    best: Fitted
    count: float  # independent readings
    candidates: tuple[Candidate, ...]


def choose(
    fitter: Fitter,
    effects: Sequence[Term],
    own: Sequence[Term],
    shapes: Shapes,
    random: np.random.Generator,
    trying: Trying,
) -> Choice:
    """`own` are terms of the record itself, which grow along with the effects. `shapes` gives the shapes to compete,
    for a fit."""
    base = fitter.fit(())
    sets = _grown(fitter, base, (*effects, *own), len(effects), trying)
    shaped: list[Fitted] = []
    record = fitter.record
    count = record.independent(min(sets, key=lambda one: one.rss).off_n_mm)

    def worth(one: Fitted) -> float:
        return gain(record, base, one, count) - _paid(one, count)

    best = max((one for one in sets if not strained(fitter, one)), key=worth)
    for _ in range(MOST_SHAPES):
        if _is_noise(record, best):
            break
        have = {term.name for term in best.terms}
        joined = []
        for shape in shapes(best):
            if shape.name not in have:
                trying(shape.label)
                joined.append(fitter.fit((*best.terms, shape), best, shape))
                for term in best.terms:  # the shape may also take an effect's place
                    if term.role == "shape" or (shape.role == "law" and term.name == "coulomb_friction"):
                        continue
                    rest = tuple(other for other in best.terms if other is not term)
                    joined.append(fitter.fit((*rest, shape), best if rest else base, shape))
        joined = [one for one in joined if not strained(fitter, one)]
        shaped += joined
        sound = [one for one in joined if _needed(fitter, best, one, random)]
        sound = [one for one in sound if one.rss < (1.0 - SHAPES_SHRINK) ** 2 * best.rss]
        if not sound:
            break
        best = max(sound, key=worth)
    best = _kept(fitter, best, random)
    best = _joined_by_rows(fitter, best, sets, (*effects, *own), random, trying)
    listed = [one for one in sets if not strained(fitter, one)]
    return Choice(base, tuple(sets), tuple(shaped), best, count, _candidates(listed, worth))


def _is_noise(record: JointRecord, fitted: Fitted) -> bool:
    """Whether a fit leaves no more than the noise, the encoder's rounding included: a shape in it says nothing."""
    return bool(fitted.rss <= record.noise_n_mm**2 * np.count_nonzero(record.fitted))


def _joined_by_rows(
    fitter: Fitter,
    best: Fitted,
    sets: Sequence[Fitted],
    terms: Sequence[Term],
    random: np.random.Generator,
    trying: Trying,
) -> Fitted:
    """Weighted readings show best what the joint does where it slips. Readings that count alike show best what it does
    under high load, where it stays longest. A term that all judges ask for among readings that count alike joins too.
    Where an effect does, the record's own terms compete with it, and go first where they do about as well: else friction
    or creep would be named for what viscosity does."""
    by_rows = fitter.by_rows()
    while best.terms:
        current = by_rows.fit(best.terms, best)
        have = {term.name for term in best.terms}
        joined = []
        for term in terms:
            if term.name not in have:
                trying(term.label)
                joined.append(by_rows.fit((*best.terms, term), current, term))
        joined = [one for one in joined if one.rss < (1.0 - SECOND_SHRINK) ** 2 * current.rss]
        sound = [
            one for one in joined if not strained(fitter, one) and _needed(by_rows, current, one, random)
        ]
        if all(one.terms[-1].role == "record" for one in sound):
            break
        chosen = min(sound, key=lambda one: one.rss)
        own = min((one for one in sound if one.terms[-1].role == "record"), key=lambda one: one.rss, default=chosen)
        chosen = chosen if _is_ahead(fitter.record, own, chosen) else own
        have = {term.name for term in chosen.terms}
        known = [one for one in sets if {term.name for term in one.terms} == have]
        best = min([fitter.fit(chosen.terms, chosen), *known], key=lambda one: one.rss)
    return best


def _is_ahead(record: JointRecord, other: Fitted, fitted: Fitted) -> bool:
    """Whether the fit is likelier than the other by as much as a further term must gain."""
    count = record.independent(fitted.off_n_mm)
    return gain(record, other, fitted, count) - (_paid(fitted, count) - _paid(other, count)) >= LEAST_GAIN


def _grown(fitter: Fitter, base: Fitted, effects: Sequence[Term], most: int, trying: Trying) -> list[Fitted]:
    sets, level = [base], [base]
    for _ in range(most):
        if _is_noise(fitter.record, level[0]):
            break
        found: dict[frozenset[str], Fitted] = {}
        for smaller in level:
            have = {term.name for term in smaller.terms}
            for term in effects:
                if term.name in have:
                    continue
                trying(" + ".join((*(one.label for one in smaller.terms), term.label)))
                grown = fitter.fit((*smaller.terms, term), smaller, term)
                key = frozenset(have | {term.name})
                if key not in found or grown.rss < found[key].rss:
                    found[key] = grown
        if not found:
            break
        level = sorted(found.values(), key=lambda one: one.rss)[:BEAM]
        sets += found.values()
    return sets


def strained(fitter: Fitter, fitted: Fitted) -> bool:
    """Whether an effect helps only with a value that no joint has, and so stands for something else: creep as slow as
    the whole record, friction that grows as fast as the load, a spring so soft in the middle that it is a dead zone in
    disguise."""
    if any(at_an_end(term, fitted.values) for term in fitted.terms):
        return True
    return _stiffening(fitter, fitted) > MOST_STIFFENING


def at_an_end(term: Term, values: Mapping[str, float]) -> bool:
    """Whether a value of the effect stands at an end of its range where it is no joint's any more."""
    for parameter in term.parameters:
        value, inside = values[parameter.key], parameter.low + 0.98 * (parameter.high - parameter.low)
        # a time constant as short as the readings' own spacing is no creep
        too_small = parameter.low > 0.0 and value <= 1.1 * parameter.low
        if term.ends_strained(parameter) and (value >= inside or too_small):
            return True
    return False


def _stiffening(fitter: Fitter, fitted: Fitted) -> float:
    """How many times stiffer the spring is at the ends of the record than in its middle."""
    at = f"joint.{fitter.record.joint}."
    number = fitted.model.number
    reach_rad = 0.5 * (fitter.record.size.angle_rad - number(at + "gap_rad"))
    spring, cubic = number(at + "compliance_rad_per_n_mm"), number(at + "hardening_n_mm_per_rad3")
    return 1.0 + 3.0 * cubic * spring * reach_rad**2 if cubic > 0.0 else 1.0


def _paid(fitted: Fitted, count: float) -> float:
    return sum(len(term.parameters) for term in fitted.terms) * float(np.log(max(count, 3.0)))


def without(fitter: Fitter, fitted: Fitted, term: Term) -> Fitted:
    """The best fit of the other terms that has sound values."""
    rest = tuple(other for other in fitted.terms if other is not term)
    names, larger = frozenset(term.name for term in rest), frozenset(term.name for term in fitted.terms)
    if names not in fitter.known:  # grow it term by term: without the missing one the others may settle elsewhere
        grown = fitter.fit(())
        for other in rest:
            grown = fitter.fit((*grown.terms, other), grown, other)
    if (names, larger) not in fitter.left:  # and shrink it from the larger set
        fitter.left.add((names, larger))
        fitter.fit(rest, fitted)
    poorer = fitter.known[names]
    if not strained(fitter, poorer):
        return poorer
    # a fit that needs a value that no joint has is no rival; sound fits of fewer terms are
    rivals = [without(fitter, poorer, other) for other in poorer.terms]
    return min(rivals, key=lambda one: one.rss)


def _needed(fitter: Fitter, poorer: Fitted, richer: Fitted, random: np.random.Generator) -> bool:
    """Do all three judges ask for what the richer fit has more?"""
    record = fitter.record
    count = record.independent(richer.off_n_mm)
    net = gain(record, poorer, richer, count) - (_paid(richer, count) - _paid(poorer, count))
    if net < LEAST_GAIN or richer.rss > (1.0 - LEAST_SHRINK) ** 2 * poorer.rss:
        return False
    if feigned(record, poorer, richer) > 0.5:
        return False
    if record.kept.any() and richer.held_rss >= poorer.held_rss:
        return False
    return agreement(record, poorer, richer, random) >= LEAST_AGREEMENT


def _kept(fitter: Fitter, best: Fitted, random: np.random.Generator) -> Fitted:
    """Takes out the terms that the others make needless, the least needed first."""
    while best.terms:
        poorer = sorted((without(fitter, best, term) for term in best.terms), key=lambda one: one.rss)
        for one in poorer:
            if not _needed(fitter, one, best, random):
                best = one
                break
        else:
            return best
    return best


def _candidates(sets: Sequence[Fitted], worth: Callable[[Fitted], float]) -> tuple[Candidate, ...]:
    values = np.array([worth(one) for one in sets])
    shares = np.exp(0.5 * (values - values.max()))
    shares /= shares.sum()
    listed = [
        Candidate(" + ".join(term.label for term in one.terms) or "nothing", float(value), float(share))
        for one, value, share in zip(sets, values, shares)
    ]
    return tuple(sorted(listed, key=lambda one: -one.gain)[:12])
