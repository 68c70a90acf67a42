"""The trouble of the instruments that explains a loading record best, weighed by the same evidence as effects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from brace.dataset import DataFault
from brace.diagnose.diagnosis import Interval
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.evidence import evidence, freedoms, score
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.intervals import Z_90
from brace.identify.record import Record
from brace.diagnose.loading.rounding import rounds_to_record
from brace.diagnose.loading.screen import Remover
from brace.diagnose.loading.troubles.kinds import (
    GAIN_STEP,
    LAG,
    NOT_NAMED,
    OUTLIERS,
    RUBS,
    SLIP,
    ZERO_STEP,
    ZEROS,
    Shaken,
    kinds,
    lag_columns,
    rubbing,
)
from brace.diagnose.loading.troubles.lag import rarity_nats
from brace.diagnose.loading.troubles.words import first_row, shown
from brace.effects.rivals import TROUBLE_BY_KIND, RivalCause

MUST_LEAD = 4.6  # nats: 100 to 1 against the best of the catalogue, as every name must be ahead of nothing missing
REFITTED = 5  # kinds of trouble beside sets of effects, the most likely ones
BY_SLOPES = 0.01  # nats for each sigma squared that a trouble explains by slopes: what a fit may explain beside
BACK = 0.2  # of the largest slip: what slips that go back may leave
MAY_BE = -3.0  # nats: 1 to 20, from which a trouble is a rival of what was named, or of a likelier trouble
SURELY = 3.0  # sigmas that friction must be above nothing
FLAT = 1e3  # whitened: a size of which nothing is known before


@dataclass(frozen=True)
class Trouble:
    """`columns` are channels x rows x sizes, in the channels' units, wide enough to take the trouble out of a record;
    `lead` over the best of the catalogue in nats, beside `rest`, whose fit has the trouble taken out; `value` is the
    first size, `sigma` its own; `shown` the sentence for people."""

    name: str
    field: str
    row: int | None
    columns: np.ndarray
    rest: LabelSet
    lead: float
    value: float
    sigma: float
    shown: str
    alike: tuple[str, ...] = ()  # kinds that explain the record nearly as well
    share: float = 1.0  # of the probability of all kinds alike

    @property
    def is_effect(self) -> bool:
        """Whether it is a name among the effects."""
        return self.name == LAG or self.name in RUBS

    @property
    def far_ahead(self) -> bool:
        """Whether nothing of the catalogue comes near."""
        return self.lead > MUST_LEAD

    @property
    def is_named(self) -> bool:
        """Whether the report may name it: it is a trouble of the instruments. Anything else has no name, and makes
        the verdict unknown where it is far ahead."""
        return self.name not in NOT_NAMED

    @property
    def meaning(self) -> str:
        """What it does, in half a sentence."""
        return self.cause.meaning if self.is_named else NOT_NAMED[self.name]

    @property
    def cause(self) -> RivalCause:
        """Name and words of a trouble of the instruments. KeyError where `is_named` is false."""
        return TROUBLE_BY_KIND[self.name]

    @property
    def sizes(self) -> dict[str, Interval]:
        """Its first size with its 90 % interval; none where the trouble has a size for each run or reading."""
        if self.name not in (LAG, GAIN_STEP, ZERO_STEP, SLIP, *RUBS):
            return {}
        half = Z_90 * self.sigma
        if self.name in RUBS:
            return {self.cause.ways[0][0].key: Interval(self.value, max(0.0, self.value - half), self.value + half)}
        return {self.cause.ways[0][0].key: Interval(self.value, self.value - half, self.value + half)}

    @property
    def fault(self) -> DataFault:
        """As an entry of data_faults that does not stop the diagnosis."""
        return DataFault(self.row, self.field, self.shown, blocking=False)


def likeliest(record: Record, sets: Sequence[LabelSet]) -> Trouble | None:
    """The trouble that is ahead of every set of effects, or not far behind, or None. `sets` are sorted; one of them has
    no labels."""
    known = {item.labels: item for item in sets}
    best, base = sets[0], known[frozenset()].best.fit
    if rounds_to_record(record, best.best.fit):
        return None
    against = _of_best(record, best, base)
    sizes = range(len(best.labels) + 1)
    rests = [frozenset(rest) for size in sizes for rest in combinations(sorted(best.labels), size)]
    options = [option for rest in rests if rest in known for option in _options(record, known[rest])]
    first: dict[tuple[str, frozenset[str]], _Option] = {}
    for option in sorted(options, key=lambda one: -one.promise(record, base)):
        first.setdefault((option.kind, option.rest.labels), option)
    chosen = [one for place, one in enumerate(first.values()) if place < REFITTED or one.kind == LAG]
    troubles = [_fitted(record, base, option, against) for option in chosen]
    return _of_joints(most_likely(troubles), troubles)


def friction_instead(record: Record, sets: Sequence[LabelSet]) -> Trouble | None:
    """Friction of another law in the place of the best set's dry friction and of something else that was chosen beside
    it: what a law leaves that is not the joint's own looks like a further effect. None where it is far behind."""
    known = {item.labels: item for item in sets}
    best, base = sets[0], known[frozenset()].best.fit
    against = _of_best(record, best, base)
    found = []
    for name, joint in RUBS.items():
        rest = best.labels - {f"coulomb_friction@joint.{joint}"}
        options = [
            option
            for size in range(len(rest)) for some in combinations(sorted(rest), size) if frozenset(some) in known
            for option in _options(record, known[frozenset(some)], (name,))
        ]  # fmt: skip
        if rest != best.labels and options:
            found.append(_fitted(record, base, max(options, key=lambda one: one.promise(record, base)), against))
    first = max(found, key=lambda one: one.lead, default=None)
    return first if first is not None and first.lead > MAY_BE else None


def _of_best(record: Record, best: LabelSet, base: Fit) -> float:
    """Log evidence of the best set over nothing missing, with what else the search found counted."""
    return score(best.best.fit, base, record.readings, record.noise_freedom) - float(np.log(best.posterior))


def _of_joints(found: Trouble | None, troubles: Sequence[Trouble]) -> Trouble | None:
    """Friction of a joint with the other joint's beside it, where the record hardly tells the two."""
    if found is None or found.name not in RUBS:
        return found
    others: dict[str, float] = {}
    for one in troubles:
        if one.name in RUBS and one.name != found.name and one.rest.labels == found.rest.labels:
            others[one.name] = max(others.get(one.name, -np.inf), one.lead - found.lead)
    alike = tuple(name for name, behind in others.items() if behind > MAY_BE)
    return replace(found, alike=alike, share=float(1.0 / (1.0 + np.sum(np.exp(list(others.values()))))))


def rubs(record: Record, sets: Sequence[LabelSet]) -> tuple[Trouble | None, float]:
    """The friction of one joint, strained before it slides, that alone explains the record best; and its lead over
    everything without friction that is known here: `sets`, and the troubles of the instruments beside the best of
    those. None where no joint's friction explains anything."""
    without = [item for item in sets if not any(label.startswith("coulomb_friction@") for label in item.labels)]
    base = next(item for item in sets if not item.labels)
    fitted = base.best.fit
    known = max(item.best.score for item in without)
    options = list(_options(record, base))
    beside = [one for one in options if one.kind not in RUBS]
    if without[0].labels:
        beside += [one for one in _options(record, without[0]) if one.kind not in RUBS]
    known = max([known, *(one.promise(record, fitted) for one in beside)])
    best = [max((one for one in options if one.kind == name), key=lambda one: one.promise(record, fitted), default=None)
            for name in RUBS]  # fmt: skip
    troubles = [_fitted(record, fitted, one, known) for one in best if one is not None]
    found = max(troubles, key=lambda one: one.lead, default=None)
    if found is None or not np.isfinite(found.lead):
        return None, -np.inf
    return _of_joints(found, troubles), found.lead


def most_likely(troubles: Sequence[Trouble]) -> Trouble | None:
    """Chooses the trouble with the most lead; None where even that trouble is improbable. Where it is far ahead of the
    catalogue and a trouble without a name is nearly as likely (1 to 20), the one without a name is returned, with the
    lead of the first: one of the two is far ahead, and nobody can say which."""
    first = max(troubles, key=lambda one: one.lead, default=None)
    if first is None or first.lead <= MAY_BE:
        return None
    nameless = max((one for one in troubles if not one.is_named), key=lambda one: one.lead, default=None)
    if not first.far_ahead or nameless is None or nameless.lead <= first.lead + MAY_BE:
        return first
    return replace(nameless, lead=first.lead)


def with_trouble(record: Record, troubles: Sequence[Trouble], found: Trouble) -> tuple[Trouble, ...]:
    """Adds a trouble to those found before. Two sets of single readings that stand out become one."""
    before = [one.columns for one in troubles if one.name == found.name == OUTLIERS]
    if not before:
        return (*troubles, found)
    columns = np.concatenate([*before, found.columns], axis=2)
    whole = replace(
        found,
        field=_channels(record, columns),
        row=first_row(columns) + 1,
        columns=columns,
        shown=shown(record, OUTLIERS, columns, np.array([found.value]), found.sigma),
    )
    return (*(one for one in troubles if one.name != OUTLIERS), whole)


def _channels(record: Record, columns: np.ndarray) -> str:
    return ", ".join(name for place, name in enumerate(record.channels) if np.any(columns[place] != 0.0))


@dataclass(frozen=True)
class _Option:
    """One way of one kind of trouble beside the effects of `rest`. `spread`: one sigma of each size, 0 where nothing is
    known of it; `cost` by the slopes of the fit of `rest`; `price` in nats, for the sizes' spread and the choice."""

    kind: str
    columns: np.ndarray
    spread: float
    rest: LabelSet
    cost: float
    price: float
    sigma: float
    total: np.ndarray
    shaken: Shaken | None

    def score(self, record: Record, base: Fit, cost: float) -> float:
        """Log evidence over nothing missing, with this cost."""
        fitted = self.rest.best.fit
        own = freedoms(fitted) + (0 if self.spread else self.columns.shape[2])
        effects = len(fitted.space.variants) + 1
        return evidence(cost, base.cost, own, effects, record.readings, record.noise_freedom) - self.price

    def promise(self, record: Record, base: Fit) -> float:
        """The score that a fit may come to. Slopes say the less, the further the limb has to move."""
        return self.score(record, base, self.cost) + BY_SLOPES * (self.rest.best.fit.cost - self.cost)


def _options(record: Record, rest: LabelSet, only: tuple[str, ...] = ()) -> Iterator[_Option]:
    """Every way of every kind, or of these alone, beside a set of effects."""
    fitted = rest.best.fit
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    for kind in kinds(record, fitted, remover, left):
        if only and kind.name not in only:
            continue
        for way in kind.ways:
            bare = remover.columns(record.whitened(way.columns))
            power, along = bare.T @ bare, bare.T @ left
            if not np.all(np.diag(power) > 1e-6):
                continue
            for spread in kind.spread or (0.0,):
                inner = power + (np.eye(along.size) / spread**2 if spread else 0.0)
                inverse = np.linalg.pinv(inner, hermitian=True)
                price = way.price + float(np.log(max(1, len(kind.spread))))
                if spread:
                    price += 0.5 * float(np.linalg.slogdet(np.eye(along.size) + spread**2 * power)[1])
                total = way.total if way.total.size else np.eye(along.size)[0]
                sigma = float(np.sqrt(max(total @ inverse @ total, 0.0)))
                cost = fitted.cost - float(along @ inverse @ along)
                yield _Option(kind.name, way.columns, spread, rest, cost, price, sigma, total, way.shaken)


def _fitted(record: Record, base: Fit, option: _Option, against: float) -> Trouble:
    """The trouble with the limb fitted anew beside it, which may gain more than the slopes of the old fit show."""
    rest = option.rest.best.fit
    wide = option.columns * (option.spread or _flat(record, option.columns))
    fitted = fit(record.beside(wide), rest.space, rest.x)
    if option.kind == LAG:  # fitted without its lag, a limb's stiffness is some percent off, and so are the columns
        option = replace(option, columns=lag_columns(record, fitted), cost=np.inf)
        wide = option.columns * _flat(record, option.columns)
        fitted = fit(record.beside(wide), rest.space, fitted.x)
    lead = option.score(record, base, min(fitted.cost, option.cost)) - against
    if option.kind in RUBS:  # as for a lag: the way of a joint goes by its compliance
        again = rubbing(record, fitted, RUBS[option.kind], option.shaken)
        option = replace(option, columns=again.columns, total=again.total, cost=np.inf)
        wide = option.columns * option.spread
        fitted = fit(record.beside(wide), rest.space, fitted.x)
    whitened = record.whitened(option.columns)
    inner = whitened.T @ whitened + (np.eye(whitened.shape[1]) / option.spread**2 if option.spread else 0.0)
    left = fitted.space.residuals(record, fitted.x[None])[0]
    sizes = np.linalg.pinv(inner, hermitian=True) @ (whitened.T @ left)
    if option.kind == LAG:
        lead -= rarity_nats(record, float(sizes[0]))
    found = _in_words(record, option, fitted, wide, sizes, lead)
    backwards = option.kind in RUBS and found.value < SURELY * found.sigma  # friction takes work out of a joint
    return replace(found, lead=-np.inf) if backwards or (option.kind == SLIP and _goes_back(sizes)) else found


def _goes_back(sizes: np.ndarray) -> bool:
    """Whether slips, each along x and z, end where they began. No clamp does that; within one run a burst of
    interference, which is up and down again, reads like it."""
    slips = sizes.reshape(-1, 2)
    net_mm, largest_mm = np.linalg.norm(slips.sum(axis=0)), np.linalg.norm(slips, axis=1).max()
    return len(slips) > 1 and bool(net_mm < BACK * largest_mm)


def _in_words(
    record: Record, option: _Option, fitted: Fit, wide: np.ndarray, sizes: np.ndarray, lead: float
) -> Trouble:
    """The trouble in words."""
    columns = option.columns
    if option.kind == ZEROS:  # runs may share a zero: what is alike in all of them is no bias
        wide = columns * _flat(record, columns)
    row = first_row(columns) + 1 if option.kind in (GAIN_STEP, ZERO_STEP, SLIP, OUTLIERS) else None
    sentence = shown(record, option.kind, columns, sizes, option.sigma)
    rest = replace(option.rest, best=replace(option.rest.best, fit=fitted))
    field, value = _channels(record, columns), float(option.total @ sizes)
    return Trouble(option.kind, field, row, wide, rest, lead, value, option.sigma, sentence)


def _flat(record: Record, columns: np.ndarray) -> np.ndarray:
    """Factors that make each column as long as a size of which nothing is known."""
    length = np.linalg.norm(record.whitened(columns), axis=0)
    return np.asarray(FLAT / np.where(length > 0.0, length, 1.0))
