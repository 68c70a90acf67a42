"""Other sets of effects that predict the held-out readings about as well.

A chosen set is one explanation of several. Its sizes are known no better than these explanations agree on, and an
effect that one of them does without is no surer than that explanation is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.diagnose.joint_test.choose import Shapes, strained, without
from brace.diagnose.joint_test.evidence import intervals
from brace.diagnose.joint_test.fit import Fitted, Fitter
from brace.diagnose.joint_test.shapes import BENDS_THE_SPRING, SOFT

AS_WELL = 0.05  # a rival has at least this share of the odds between it and the chosen set: 90 % intervals hold it
MOST_RIVALS = 8
BY_CHOICE = 3.0  # odds that one of several shapes gains on the held-out readings because it is the luckiest of them
# Times less likely, before any reading, than an effect of the catalogue: as in loading records. A spring that has one
# shape is not of the catalogue, so that a further one is no rarer than an effect.
SHAPE = 10.0
# Real friction turns in another curve than the one that is fitted. What that curve leaves over bends with the load or
# lasts for a while, and hardening or creep takes it. So beside friction both start as rare as a shape.
FEIGNED_BY_FRICTION = frozenset({"joint_hardening", "creep"})

Ranges = dict[str, tuple[float, float]]


@dataclass(frozen=True)
class Rival:
    """`share` [0, 1]: its part of the odds between it and the chosen set, by what neither has seen."""

    fitted: Fitted
    share: float

    @property
    def names(self) -> frozenset[str]:
        """What the set says of the joint. A spring that is softer in its middle stiffens under load, as a hardening
        spring does. Beside another shape of the spring, the softer middle only rounds that shape off."""
        names = frozenset(term.name for term in self.fitted.terms)
        stiffens = self.fitted.values.get(SOFT, 0.0) > 0.0 and len(names & BENDS_THE_SPRING) == 1
        return names | {"joint_hardening"} if stiffens else names

    @property
    def label(self) -> str:
        return " + ".join(term.label for term in self.fitted.terms) or "nothing"


def one_less(fitter: Fitter, chosen: Fitted, shapes: Shapes) -> list[Fitted]:
    """The chosen set without one of its effects, once for each effect. Beside a shape that bends the spring, hardening
    may be nothing but that shape's own form. So there a further shape takes hardening's place in one more rival."""
    effects = [term for term in chosen.terms if term.role == "effect"]
    poorer = {term.name: without(fitter, chosen, term) for term in effects}
    found = list(poorer.values())
    if "joint_hardening" in poorer and any(term.name in BENDS_THE_SPRING for term in chosen.terms):
        shape_alone = poorer["joint_hardening"]
        lacking = BENDS_THE_SPRING - {term.name for term in shape_alone.terms}
        others = [shape for shape in shapes(shape_alone) if shape.name in lacking]
        found += [fitter.fit((*shape_alone.terms, shape), shape_alone, shape) for shape in others]
    return found


def rivals(
    fitter: Fitter, by_rows: Fitter, chosen: Fitted, effects: frozenset[str], sets: Sequence[Fitted]
) -> list[Rival]:
    """All sound sets that predict the held-out readings about as well as `chosen`, the likeliest first; those without
    one of its `effects` are asked first. Both ways of weighting the readings are sound, so the one counts that is kinder
    to the rival."""
    record = fitter.record
    if not record.kept.any():
        return []
    names = frozenset(term.name for term in chosen.terms)
    weighted, alike = fitter.fit(chosen.terms, chosen), by_rows.fit(chosen.terms, chosen)
    best: dict[frozenset[str], Fitted] = {}
    for one in sorted(sets, key=lambda one: one.held_rss):
        best.setdefault(frozenset(term.name for term in one.terms), one)
    best.pop(names, None)
    doing_without = [one for having, one in best.items() if not effects <= having]
    others = [one for having, one in best.items() if effects <= having]
    found = []
    for one in (*doing_without[:MOST_RIVALS], *others[: MOST_RIVALS // 2]):
        if strained(fitter, one):
            continue
        share = _share(fitter, weighted, one)
        rows = by_rows.fit(one.terms, one)
        share = max(share, _share(by_rows, alike, rows))
        if share >= AS_WELL:
            found.append(Rival(rows, share))
    return sorted(found, key=lambda rival: -rival.share)


def _share(fitter: Fitter, chosen: Fitted, rival: Fitted) -> float:
    """The rival's part of the odds by the independent ones of the held-out readings."""
    record = fitter.record
    kept = np.count_nonzero(record.kept)
    count = record.independent(chosen.off_n_mm) * kept / np.count_nonzero(record.fitted)
    floor = 1e-12 * kept * record.size.torque_n_mm**2
    odds = 0.5 * count * np.log((rival.held_rss + floor) / (chosen.held_rss + floor))
    if _shapes(rival) > _shapes(chosen):
        bent = any(term.name in BENDS_THE_SPRING for term in chosen.terms)
        odds = odds + np.log(BY_CHOICE) if bent else np.log(SHAPE) + max(odds, -np.log(BY_CHOICE))
    return float(1.0 / (1.0 + np.exp(np.clip(odds, 0.0, 50.0))))  # what predicts better by luck is as good at most


def _shapes(fitted: Fitted) -> int:
    return sum(term.role in ("shape", "law") for term in fitted.terms)


def ranges(by_rows: Fitter, found: Sequence[Rival], random: np.random.Generator) -> Ranges:
    """low, high (90 %) over all rivals without shapes, of every parameter that they have. A shape that is added to an
    effect takes from it what it likes, and so does a second turn of friction from the first one."""
    held: Ranges = {}
    for rival in (one for one in found if all(term.role != "shape" for term in one.fitted.terms)):
        law = any(term.role == "law" for term in rival.fitted.terms)
        for key, (_, low, high) in intervals(by_rows, rival.fitted, random).items():
            if law and key.rpartition(".")[2].startswith("coulomb_"):
                continue
            least, most = held.get(key, (low, high))
            held[key] = min(least, low), max(most, high)
    return held


def surest(found: Sequence[Rival], name: str) -> float:
    """How sure an effect can be at most while these rivals stand."""
    return 1.0 - max((rival.share for rival in found if name not in rival.names), default=0.0)


def beside_friction(name: str, confidence: float) -> float:
    """How sure an effect is that stands beside friction, of how sure the readings alone make it."""
    if name not in FEIGNED_BY_FRICTION:
        return confidence
    return confidence / (confidence + SHAPE * (1.0 - confidence))


def beside(found: Sequence[Rival], named: frozenset[str]) -> tuple[str, ...]:
    """The rivals that do without something that was named."""
    return tuple(rival.label for rival in found if not named <= rival.names)
