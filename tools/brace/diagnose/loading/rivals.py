"""Causes outside the catalogue that the record cannot distinguish from what was chosen, or too small a part of them.

Every row of brace.effects.rivals that may stand in for the chosen effects, or for some of them, is fitted in their
place with everything else, and weighed by the same evidence. What only a size that no limb has can show is weighed by
the catalogue's prior on that size."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from brace.diagnose.loading.choose import WORTH_SAYING, LabelSet
from brace.diagnose.loading.evidence import evidence, implausible, score
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.troubles.likeliest import MUST_LEAD, Trouble
from brace.identify.record import Record, levers
from brace.diagnose.loading.search import Hypothesis
from brace.diagnose.loading.space import Space, Trust, space_of
from brace.effects import Freedom, Variant
from brace.effects.catalogue import NUMBER_BY_KEY
from brace.effects.rivals import RIVAL_CAUSES, RivalCause, Size
from brace.native.plant_batch import number_index

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

GAUGES = ("base_x_mm", "base_z_mm")
GAUGE_ON_RIG = (
    "put a dial gauge on the rig beside the tip's clamp: it moves with a rig that yields and stands still where a link "
    "does"
)
ENCODERS = {"femur": "enc1_rad", "tibia": "enc2_rad"}
BEAM_TURNS = 1.8  # a beam moves a point beside its end by 1.5 turns of the line to it (a force), by 2 (a moment)
ARCH_ALONG = 1.6  # 3 x the integral of (4 s (1 - s))^2 over s from 0 to 1
_ELLIPSOID = ("axial_mm_per_n", "bending_mm_per_n", "tilt_rad")

Turn = Callable[[np.ndarray, np.ndarray], None]
"""Puts a rival's sizes (points x sizes) into the numbers of limbs (points x numbers) that read the same."""


@dataclass(frozen=True)
class RivalSpace(Space):
    """A space whose last freedoms are the sizes of a rival, which are no keys of limb.toml."""

    turn: Turn = field(kw_only=True)

    def limbs(self, points: np.ndarray) -> np.ndarray:
        """The limbs without the rival."""
        models = self.numbers[np.newaxis].repeat(len(points), axis=0)
        models[:, self.places] = points[:, : self.places.size]
        return self.of_today(models)

    def models(self, points: np.ndarray) -> np.ndarray:
        """The limbs that read as the limbs with the rival do."""
        models = self.limbs(points)
        self.turn(models, points[:, self.places.size :])
        return models

    def sinks_less_than_a_base(self, record: Record) -> bool:
        """Whether the record distinguishes a rig from a base by the limb's weight."""
        heavy = bool(np.any(self.numbers[_weights()])) or any(key.startswith("gravity.") for key in self.keys)
        counts = not (record.dataset.small_displacements or record.dataset.meta.held_at_rest)
        return self.turn is _rig_yields and heavy and counts

    def gauged(self, record: Record) -> bool:
        """Whether the record distinguishes a rig from a base by gauges on the base."""
        return self.turn is _rig_yields and any(name in GAUGES for name in record.channels)

    def residuals(self, record: Record, points: np.ndarray) -> np.ndarray:
        """A base that yields gives way under the limb's weight as well, a rig that yields does not: what the weight
        does to the base is added to the displacements. A gauge on the base reads the base's share of what yields."""
        if self.turn in _PLAYS:
            return self._with_play_off_centre(record, points)
        gauged, sinks_less = self.gauged(record), self.sinks_less_than_a_base(record)
        if not gauged and not sinks_less:
            return super().residuals(record, points)
        models, limbs = self.models(points), self.limbs(points)
        if not sinks_less:
            return record.left_by(_of_base(record, models, limbs, record.player.play_numbers(models)))
        found = np.empty((len(points), record.measured.size))
        for place, (model, limb) in enumerate(zip(models, limbs)):
            moved = record.moved_by(*((model[_base()] - limb[_base()]) * _down_n(limb)))
            played = moved.player.play_numbers(model[None])
            found[place] = moved.left_by(_of_base(moved, model[None], limb[None], played) if gauged else played)[0]
        return found

    def _with_play_off_centre(self, record: Record, points: np.ndarray) -> np.ndarray:
        """A joint whose play's centre lies off its rest reads as one in the middle of its play whose tip is displaced
        back by as much, with an encoder that stands turned by it."""
        joint = _PLAYS[self.turn]
        index, data, models = number_index(), record.dataset, self.models(points)
        found = np.empty((len(points), record.measured.size))
        for place, (model, centre_rad) in enumerate(zip(models, points[:, -1])):
            femur_mm, tibia_mm = (float(model[index[f"geometry.{link}_mm"]]) for link in ("femur", "tibia"))
            lever_mm = levers(femur_mm, tibia_mm, data["theta1_rad"], data["theta2_rad"])[joint]
            moved = record.moved_by(*(-centre_rad * lever_mm))
            played = moved.player.play_numbers(model[None])
            if ENCODERS[joint] in record.channels:
                played[0, record.channels.index(ENCODERS[joint])] += centre_rad
            found[place] = moved.left_by(played)[0]
        return found


@dataclass(frozen=True)
class Member:
    """One explanation: `labels` joined make it, `share` is its probability among the members, `model` the limb."""

    labels: tuple[str, ...]
    share: float
    fit: Fit
    model: np.ndarray
    cause: RivalCause | None = None
    trouble: Trouble | None = None

    @property
    def label(self) -> str:
        """`sensor_rotation@sensor + joint_zero_offset@joint.femur`."""
        return " + ".join(self.labels)


@dataclass(frozen=True)
class Contest:
    """`members`, most probable first, could each stand for the `disputed` ones of the chosen labels. Those are no
    member themselves where the readings speak against them; `mass` is what the search gave to all of them together;
    `cause` is the strongest rival."""

    members: tuple[Member, ...]
    disputed: frozenset[str]
    mass: float
    cause: RivalCause
    gauged: bool = False

    @property
    def share_of_chosen(self) -> float:
        """Probability among the members that it is what was chosen."""
        return next((member.share for member in self.members if set(member.labels) == self.disputed), 0.0)

    @property
    def has_chosen(self) -> bool:
        """Whether what was chosen is among the members."""
        return any(set(member.labels) == self.disputed for member in self.members)

    @property
    def decided(self) -> bool:
        """Whether one explanation alone is left."""
        return len(self.members) == 1

    @property
    def would_tell(self) -> str:
        """The measurement that shows the rival, as an order."""
        return GAUGE_ON_RIG if self.gauged else self.cause.would_tell


def contests(final: Pass) -> tuple[Contest, ...]:
    """Each disputes other names, the one with the strongest rival first. Empty where nothing was named, or where no
    rival explains the record about as well."""
    if final.decision.verdict not in ("effect", "ambiguous"):
        return ()
    found = [one for cause in RIVAL_CAUSES if (one := _against(final, cause)) is not None]
    if final.rival is not None and (one := _by_instruments(final, final.rival)) is not None:
        found.append(one)
    apart: list[Contest] = []
    for one in sorted(found, key=lambda one: one.share_of_chosen):
        if not any(one.disputed & other.disputed for other in apart):
            apart.append(one)
    return tuple(apart)


def with_causes(final: Pass) -> list[LabelSet]:
    """The sets of the search, and before them the set that a cause outside the catalogue makes with what is left of
    the chosen ones, where it is likelier than they are."""
    if final.decision.verdict not in ("effect", "ambiguous"):
        return final.sets
    tried = [one for cause in RIVAL_CAUSES if (one := _strongest(final, cause)) is not None]
    likeliest = max(tried, key=lambda one: one.lead, default=None)
    if likeliest is None or likeliest.lead < 0.0:
        return final.sets
    fitted, labels = likeliest.fit, final.decision.chosen.labels - likeliest.disputed
    hypothesis = Hypothesis(fitted, _score(final, fitted))
    return [LabelSet(labels | {likeliest.cause.label}, hypothesis, 1.0), *final.sets]


@dataclass(frozen=True)
class _InPlace:
    """A cause fitted in the place of the `disputed` effects; `lead` over the chosen set, nats."""

    cause: RivalCause
    lead: float
    disputed: frozenset[str]
    fit: Fit


def _strongest(final: Pass, cause: RivalCause) -> _InPlace | None:
    """The place in which a cause explains the record best; None where it looks like nothing that was chosen."""
    chosen = final.decision.chosen
    tried = [one for disputed in cause.looks_like if disputed <= chosen.labels
             for one in _in_place_of(final, cause, disputed)]  # fmt: skip
    return _wider(final, cause, max(tried, key=lambda one: one.lead)) if tried else None


def _against(final: Pass, cause: RivalCause) -> Contest | None:
    """The strongest contest that one cause makes for a part of the chosen set."""
    best = _strongest(final, cause)
    if best is None:
        return None
    rival = final.decision.chosen.posterior * float(np.exp(min(best.lead, 700.0)))
    space = best.fit.space
    assert isinstance(space, RivalSpace)
    limb = best.fit.model if cause.in_limb else space.limbs(best.fit.x[None])[0]
    return _contest(final, cause, best.disputed, rival, Member((cause.label,), 0.0, best.fit, limb, cause))


def _in_place_of(final: Pass, cause: RivalCause, disputed: frozenset[str]) -> Iterator[_InPlace]:
    """Each way of the cause."""
    chosen = final.decision.chosen.best.fit
    for way in cause.ways:
        fitted = _fitted(final.record, final.trust, chosen, cause, way, disputed)
        if fitted is not None:
            yield _InPlace(cause, _score(final, fitted) - _score(final, chosen), disputed, fitted)


def _wider(final: Pass, cause: RivalCause, best: _InPlace) -> _InPlace:
    """The same, with the cause in the place of further chosen effects while that is likelier. Several effects together
    may have stood for one cause."""
    while others := final.decision.chosen.labels - best.disputed:
        tried = [one for label in sorted(others) for one in _in_place_of(final, cause, best.disputed | {label})]
        likeliest = max(tried, key=lambda one: one.lead, default=best)
        if likeliest.lead <= best.lead:
            break
        best = likeliest
    return best


def _by_instruments(final: Pass, trouble: Trouble) -> Contest | None:
    """What a trouble of the instruments, or friction of another law, leaves uncertain."""
    chosen = final.decision.chosen
    disputed = chosen.labels - trouble.rest.labels
    if not disputed or not trouble.rest.labels < chosen.labels:
        return None
    fitted, cause = trouble.rest.best.fit, trouble.cause
    if cause.in_limb:
        cause = replace(cause, same_because="friction of another law reads as dry friction with something beside it")
    member = Member((cause.label,), 0.0, fitted, fitted.model, cause, trouble)
    return _contest(final, cause, disputed, float(np.exp(min(trouble.lead, 700.0))), member)


def _contest(
    final: Pass, cause: RivalCause, disputed: frozenset[str], rival: float, member: Member
) -> Contest | None:
    """All that may stand for the disputed labels; `rival` is what the record says for the cause, on the scale of the
    posterior's shares."""
    chosen = final.decision.chosen
    weights = dict(_stand_ins(final.sets, chosen, disputed))
    rival /= cause.rarer
    top = max(weight for weight, _ in weights.values())
    if rival < WORTH_SAYING * top:
        return None
    space, record = member.fit.space, final.record
    told_apart = isinstance(space, RivalSpace) and (space.sinks_less_than_a_base(record) or space.gauged(record))
    if cause.twin in weights and not told_apart:
        weight, twin_fit = weights[cause.twin]
        weights[cause.twin] = (max(weight, rival), twin_fit)
    top = max(top, rival)
    mass = min(1.0, sum(item.posterior for item in final.sets if chosen.labels - disputed <= item.labels))
    own = " + ".join(sorted(disputed))
    stays = not _told_apart(final, member.fit)
    kept = {
        name: found for name, found in weights.items() if found[0] >= WORTH_SAYING * top or (name == own and stays)
    }
    whole = rival + sum(weight for weight, _ in kept.values())
    members = [
        Member(_ordered(final, name), weight / whole, found, found.model) for name, (weight, found) in kept.items()
    ]
    members.append(replace(member, share=rival / whole))
    members.sort(key=lambda one: (-round(one.share, 9), one.cause is not None, one.label))
    gauged = isinstance(space, RivalSpace) and space.gauged(record)
    return Contest(tuple(members), disputed, mass, cause, gauged)


def _told_apart(final: Pass, better: Fit) -> bool:
    """Whether the readings themselves, with no prior, speak for this fit against what was chosen."""
    record, chosen = final.record, final.decision.chosen.best.fit
    return evidence(better.cost, chosen.cost, 0, 0, record.readings, record.noise_freedom) > MUST_LEAD


def _ordered(final: Pass, name: str) -> tuple[str, ...]:
    """Labels of one explanation in the order in which the search named them."""
    labels = name.split(" + ")
    order = list(final.decision.labels)
    return tuple(sorted(labels, key=lambda label: order.index(label) if label in order else len(order)))


def _stand_ins(
    sets: Sequence[LabelSet], chosen: LabelSet, disputed: frozenset[str]
) -> Iterator[tuple[str, tuple[float, Fit]]]:
    """What the search found for the disputed labels: they themselves, and what else could stand in their place."""
    rest = chosen.labels - disputed
    for item in sets:
        stand_in = item.labels - rest
        if rest <= item.labels and 0 < len(stand_in) <= len(disputed):
            weight = item.posterior * float(np.exp(-_implausible(item.best.fit, stand_in)))
            yield " + ".join(sorted(stand_in)), (weight, item.best.fit)


def _score(final: Pass, fitted: Fit) -> float:
    """Log evidence, the size prior not counted: what the search would have given."""
    record = final.record
    return score(fitted, final.base.fit, record.readings, record.noise_freedom)


def _implausible(fitted: Fit, labels: frozenset[str]) -> float:
    """Nats that the sizes of these effects of a fit cost by the catalogue's prior: normal in the logarithm of the ratio
    to what was believed."""
    cost = 0.0
    index = number_index()
    for key in (freedom.key for one in fitted.space.variants if one.label in labels for freedom in one.freedoms):
        number = NUMBER_BY_KEY.get(key)
        if number is None or not np.isfinite(number.plausible_times):
            continue
        believed, value = float(fitted.space.numbers[index[key]]), fitted.value(key)
        if believed > 0.0 and value > believed:
            cost += implausible(value / believed, number.plausible_times)
    return cost


def _fitted(
    record: Record, trust: Trust, chosen: Fit, cause: RivalCause, way: Sequence[Size], disputed: frozenset[str]
) -> Fit | None:
    """The cause fitted in the place of the disputed effects."""
    own = chosen.space.keys[chosen.space.size - chosen.space.own :]
    if cause.name == "bowed_link" and "link.tibia.tilt_rad" not in own:
        return None  # a bow shows as a tilt
    rest = [variant for variant in chosen.space.variants if variant.label not in disputed]
    if TURNED_KEYS[cause.label] & {key for variant in rest for key in variant.keys}:
        return None  # what is fitted besides would make up for any of its sizes
    plain = space_of(trust, rest)
    space = RivalSpace(
        plain.numbers,
        (*plain.keys, *(size.key for size in way)),
        plain.places,
        np.concatenate([plain.mean, np.zeros(len(way))]),
        np.concatenate([plain.sigma, np.full(len(way), np.inf)]),
        np.concatenate([plain.low, [size.low for size in way]]),
        np.concatenate([plain.high, [size.high for size in way]]),
        plain.own + len(way),
        plain.stepwise,
        (*plain.variants, Variant(cause.name, cause.where, tuple(Freedom(s.key, s.low, s.high) for s in way))),
        plain.changing,
        turn=TURNS[cause.label],
    )
    of_disputed = {key for variant in chosen.space.variants if variant.label in disputed for key in variant.keys}
    known = {key: value for key, value in zip(chosen.space.keys, chosen.x) if key not in of_disputed}
    start = np.array([known.get(key, middle) for key, middle in zip(space.keys, space.mean)])
    start[plain.size :] = _start(cause, way, chosen)
    return fit(record, space, start)


def _start(cause: RivalCause, way: Sequence[Size], chosen: Fit) -> list[float]:
    """Sizes near those that make the chosen fit's readings."""
    index, model = number_index(), chosen.model
    if cause.name == "rig_rotation":
        return [float(model[index["sensor.rotation_rad"]])]
    if cause.name == "rig_compliance":
        base = [max(float(model[index[f"base.{axis}_mm_per_n"]]), 1e-3) for axis in "xz"]
        return [sum(base) / 2.0] if len(way) == 1 else base
    if cause.name == "off_centre_play":
        return [float(model[index[f"{cause.where}.gap_rad"]]), 0.0]
    if cause.name == "knee_offset":
        return [float(model[index["geometry.femur_mm"]] * np.tan(model[index["joint.femur.zero_offset_rad"]]))]
    tilt = index["link.tibia.tilt_rad"]
    return [float(model[index["geometry.tibia_mm"]] * np.tan(model[tilt] - chosen.space.numbers[tilt]))]


@cache
def _weights() -> list[int]:
    return [number_index()[f"gravity.{part}_n"] for part in ("femur", "tibia", "knee")]


@cache
def _base() -> list[int]:
    return [number_index()[f"base.{axis}_mm_per_n"] for axis in "xz"]


def _down_n(limb: np.ndarray) -> np.ndarray:
    """The limb's weight as a force along x and z."""
    down_rad = float(limb[number_index()["gravity.direction_rad"]])
    return float(limb[_weights()].sum()) * np.array([np.cos(down_rad), np.sin(down_rad)])


def _of_base(record: Record, models: np.ndarray, limbs: np.ndarray, played: np.ndarray) -> np.ndarray:
    """Played readings (models x channels x rows, changed in place) of base and rig together, with the gauges reading
    the base's share."""
    for place, name in enumerate(record.channels):
        if name in GAUGES:
            key = _base()[GAUGES.index(name)]
            whole = models[:, key]
            share = np.divide(limbs[:, key], whole, out=np.zeros(len(whole)), where=whole > 0.0)
            played[:, place] *= share[:, None]
    return played


def _rig_yields(models: np.ndarray, sizes: np.ndarray) -> None:
    index = number_index()
    models[:, index["base.x_mm_per_n"]] += sizes[:, 0]
    models[:, index["base.z_mm_per_n"]] += sizes[:, -1]


def _rig_turned(models: np.ndarray, sizes: np.ndarray) -> None:
    """The limb, and what pulls it down, stand turned back in the rig's frame; the sensor stays in the limb's."""
    index = number_index()
    for key, way in (("joint.femur.zero_offset_rad", -1.0), ("gravity.direction_rad", -1.0),
                     ("sensor.rotation_rad", 1.0)):  # fmt: skip
        models[:, index[key]] += way * sizes[:, 0]


def _knee_beside(models: np.ndarray, sizes: np.ndarray) -> None:
    """The line to the knee turns and grows, and the tibia keeps its direction. A femur that yields at its end keeps the
    directions in which it yields. The end of a femur that is a beam turns, too, and moves the knee beside it."""
    index = number_index()
    femur_mm = models[:, index["geometry.femur_mm"]].copy()
    turned = np.arctan2(sizes[:, 0], femur_mm)
    models[:, index["geometry.femur_mm"]] = np.hypot(femur_mm, sizes[:, 0])
    models[:, index["joint.femur.zero_offset_rad"]] += turned
    models[:, index["joint.tibia.zero_offset_rad"]] += turned
    turns = BEAM_TURNS * models[:, index["link.femur.moment_transfer"]] - 1.0
    models[:, index["link.femur.tilt_rad"]] += turns * turned


def _tibia_bowed(models: np.ndarray, sizes: np.ndarray) -> None:
    """A shallow arch of height c over the chord L bends with the lever (4 c s (1 - s), L (1 - s)) at the share s of its
    way. That adds bending x [[8/5 (c/L)^2, c/L], [c/L, 0]] to its compliance along and across."""
    index = number_index()
    axial, bending, tilt = (index[f"link.tibia.{leaf}"] for leaf in _ELLIPSOID)
    arched = sizes[:, 0] / models[:, index["geometry.tibia_mm"]]
    across = models[:, bending].copy()
    along, mixed = models[:, axial] + ARCH_ALONG * arched**2 * across, arched * across
    middle, half = 0.5 * (along + across), np.hypot(0.5 * (across - along), mixed)
    models[:, axial], models[:, bending] = middle - half, middle + half
    models[:, tilt] += 0.5 * np.arctan2(2.0 * mixed, across - along)


def _femur_plays(models: np.ndarray, sizes: np.ndarray) -> None:
    models[:, number_index()["joint.femur.gap_rad"]] = sizes[:, 0]


def _tibia_plays(models: np.ndarray, sizes: np.ndarray) -> None:
    models[:, number_index()["joint.tibia.gap_rad"]] = sizes[:, 0]


_PLAYS: dict[Turn, str] = {_femur_plays: "femur", _tibia_plays: "tibia"}
TURNED_KEYS: dict[str, frozenset[str]] = {
    "rig_compliance@rig": frozenset({"base.x_mm_per_n", "base.z_mm_per_n"}),
    "rig_rotation@rig": frozenset({"joint.femur.zero_offset_rad", "sensor.rotation_rad"}),
    "knee_offset@joint.tibia": frozenset(
        {"geometry.femur_mm", "joint.femur.zero_offset_rad", "joint.tibia.zero_offset_rad", "link.femur.tilt_rad"}
    ),
    "bowed_link@link.tibia": frozenset(f"link.tibia.{leaf}" for leaf in _ELLIPSOID),
    "off_centre_play@joint.femur": frozenset({"joint.femur.gap_rad"}),
    "off_centre_play@joint.tibia": frozenset({"joint.tibia.gap_rad"}),
}
TURNS: dict[str, Turn] = {
    "rig_compliance@rig": _rig_yields,
    "rig_rotation@rig": _rig_turned,
    "knee_offset@joint.tibia": _knee_beside,
    "bowed_link@link.tibia": _tibia_bowed,
    "off_centre_play@joint.femur": _femur_plays,
    "off_centre_play@joint.tibia": _tibia_plays,
}
