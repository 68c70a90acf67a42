"""The steps of a loading record's diagnosis, in order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from brace.dataset import Dataset
from brace.dataset.enough import enough_rows
from brace.diagnose.beside import beside
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading import outcome
from brace.diagnose.loading.choose import LabelSet, posterior_of
from brace.diagnose.loading.data_faults.gate import gate
from brace.diagnose.loading.evidence import log_likelihood, score
from brace.diagnose.loading.extensions import outside
from brace.diagnose.loading.fit import fit
from brace.diagnose.loading.noise_after_base import with_growth, with_known_noise, with_less_noise
from brace.diagnose.loading.parts import locked_rows
from brace.diagnose.loading.plain_loop import with_plain_loop
from brace.diagnose.loading.rivals import with_causes
from brace.diagnose.loading.rounding import asked_for
from brace.diagnose.loading.search import Hypothesis, Search
from brace.diagnose.loading.search_pass import Pass
from brace.diagnose.loading.space import Trust, trust_of
from brace.diagnose.loading.structure import structure_of
from brace.diagnose.loading.troubles.likeliest import friction_instead, likeliest, with_trouble
from brace.diagnose.loading.verdict import decide, undecided
from brace.diagnose.loading.wandering_zero import with_wandering_zero
from brace.diagnose.options import Advance, Options, silent
from brace.effects import Variant, all_variants
from brace.ground.errors import UsageError
from brace.identify.record import Record, load_record, setting_of
from brace.identify.turning import settled
from brace.model import LimbModel
from brace.model.assumed_trust import with_assumed_trust


MOST_TROUBLES = 3
GROWTH_MUST_GAIN = 6.0  # nats that a noise growing with the load must be ahead of a constant one


def diagnose_loading(
    dataset: Dataset, believed: LimbModel | None, options: Options, advance: Advance
) -> Diagnosis:
    """Names what `believed` lacks. A twin search that never sees the locked configurations is judged on them; the
    search over all configurations names and is exported."""
    if believed is None:
        raise UsageError(
            "a loading record needs a model to disagree with",
            why="nothing can be missing from no model",
            next_step="--model limb.toml",
        )
    dataset = settled(dataset, with_assumed_trust(believed))
    stopped = gate(dataset, believed, options)
    if stopped is not None:
        return stopped
    advance(0.02, "reading the noise off the repeats")
    trust = trust_of(believed, turns=not dataset.small_displacements)
    whole = with_wandering_zero(with_known_noise(load_record(dataset), trust))
    enough = enough_rows(dataset)
    record = whole if enough.all() else whole.select(enough)
    variants = all_variants(setting_of(record, believed))
    locked = locked_rows(record.dataset)
    twin, final = _searches(record, locked, trust, variants, options.processes, advance)
    advance(0.92, "what to measure next")
    return outcome.diagnosis_of(whole, record, locked, believed, final, twin, options)


def _searches(
    record: Record, locked: np.ndarray, trust: Trust, variants: Sequence[Variant], processes: int, advance: Advance
) -> tuple[Pass | None, Pass]:
    """The twin's pass over the rows that are not locked, None where all would be left, and the pass over all of them.
    Neither knows of the other, so that a second process may do the twin's."""

    def over_all() -> Pass:
        return search_pass(record, trust, variants, lambda share, doing: advance(0.05 + 0.45 * share, doing))

    if not locked.any():
        return None, over_all()
    seen = record.select(~locked)
    with beside(
        lambda: search_pass(seen, trust, variants, silent),
        lambda: search_pass(seen, trust, variants, lambda share, doing: advance(0.5 + 0.4 * share, doing)),
        processes,
    ) as twin:
        final = over_all()
        advance(0.5, "searching again without the postures that are held out")
        return twin(), final


def search_pass(record: Record, trust: Trust, variants: Sequence[Variant], advance: Advance) -> Pass:
    """Search, then the best set fitted to the end, and what it leaves tested for structure."""
    return with_plain_loop(_search_pass(record, trust, variants, advance))


def _search_pass(record: Record, trust: Trust, variants: Sequence[Variant], advance: Advance) -> Pass:
    """Readings that scatter more under load may look like troubles, and the other way round: the likelier of the two
    goes first."""
    found = _with_less_noise(_searched(record, trust, variants, advance), variants, advance)
    noisier = _with_growing_noise(found, variants, advance)
    if noisier is not found:
        trouble = likeliest(found.record, found.sets)
        if trouble is None or trouble.lead < _likelihood(noisier) - _likelihood(found):
            return _without_troubles(noisier, variants, advance)
    cleaner = _without_troubles(found, variants, advance)
    if cleaner is found:
        return noisier
    return _with_growing_noise(cleaner, variants, advance)


def _with_less_noise(found: Pass, variants: Sequence[Variant], advance: Advance) -> Pass:
    """The search again, with the noise that its best set leaves. The first search where that noise is not far less."""
    if found.decision.verdict == "none":
        return found
    quieter = with_less_noise(found.record, found.decision.chosen.best.fit)
    return found if quieter is None else _searched(quieter, found.trust, variants, advance)


def _with_growing_noise(found: Pass, variants: Sequence[Variant], advance: Advance) -> Pass:
    """The search again with a noise that grows with the load; as it was where that is not far likelier."""
    growing = with_growth(found.record, found.sets[0].best.fit)
    if growing is None:
        return found
    other = replace(_searched(growing, found.trust, variants, advance), troubles=found.troubles)
    return other if _likelihood(other) > _likelihood(found) + GROWTH_MUST_GAIN else found


def _without_troubles(found: Pass, variants: Sequence[Variant], advance: Advance) -> Pass:
    """The search again without what the instruments did to the record. As it was where nothing is missing, and where
    even that leaves the record unexplained, because then the trouble is no explanation either."""
    if found.decision.verdict == "none":
        return found
    cleaner, first = found, None
    for _ in range(MOST_TROUBLES):
        trouble = likeliest(cleaner.record, cleaner.sets)
        if trouble is not None and trouble.far_ahead:  # of the catalogue: a rig may explain the record better than both
            sets = with_causes(cleaner)
            trouble = trouble if sets is cleaner.sets else likeliest(cleaner.record, sets)
        if trouble is None or not trouble.far_ahead or trouble.lead < cleaner.decision.outside.lead:
            of_instruments = trouble is not None and trouble.is_named and not trouble.cause.in_limb
            rival = trouble if of_instruments else friction_instead(cleaner.record, cleaner.sets)
            cleaner = replace(cleaner, rival=rival)
            break
        first = first or trouble
        if not trouble.is_named:
            cleaner = replace(cleaner, decision=undecided(cleaner.decision, trouble.lead, trouble.meaning))
            break
        record = cleaner.record.beside(trouble.columns)
        again = _searched(record, found.trust, variants, advance)
        cleaner = replace(again, troubles=with_trouble(record, cleaner.troubles, trouble))
    unexplained = cleaner.decision.verdict == "unknown" or (cleaner.troubles and cleaner.decision.outside.lead > 0.0)
    if not unexplained:
        return cleaner
    return found if first is None else replace(found, decision=undecided(found.decision, first.lead, first.meaning))


def _searched(record: Record, trust: Trust, variants: Sequence[Variant], advance: Advance) -> Pass:
    search = Search(record, trust, variants, advance)
    hypotheses = asked_for(record, search.run())
    sets = posterior_of(hypotheses, variants)
    sets[0] = _polished(record, sets[0])
    structure = structure_of(record, sets[0].best.fit)
    decision = decide(sets, structure, search.base.fit, outside(record, sets, variants))
    return Pass(record, trust, search.base, sets, structure, decision)


def _likelihood(found: Pass) -> float:
    """Log posterior of what a pass chose, its noise included."""
    best, base = found.sets[0].best, found.base.fit
    count, freedom = found.record.readings, found.record.noise_freedom
    return log_likelihood(base, found.record.sigma, count, freedom) + score(best.fit, base, count, freedom)


def _polished(record: Record, best: LabelSet) -> LabelSet:
    """The best way of the best set, fitted to the end with every derivative fresh."""
    rough = best.best
    fitted = fit(record, rough.fit.space, rough.fit.x)
    if not np.isfinite(fitted.cost) or fitted.cost > rough.fit.cost:
        fitted = rough.fit
    return LabelSet(best.labels, Hypothesis(fitted, rough.score), best.posterior)
