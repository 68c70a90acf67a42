"""What is said and exported where several explanations stand: each with its probability and the K that it gives.

Members that give the same K are exported by the first of them. Where they do not, limb.toml stays as it was given until
somebody takes one by its name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from brace.diagnose.diagnosis import Alternative, StiffnessAt, Verdict
from brace.diagnose.loading import confidence
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.fit import Fit
from brace.diagnose.loading.gain_instead import gain_instead, in_words, with_its_scale
from brace.diagnose.loading.limb_of import limb_of
from brace.diagnose.loading.rivals import Contest, Member
from brace.diagnose.stiffness_change import apart, k_at, postures
from brace.identify.record import Record
from brace.model import LimbModel

if TYPE_CHECKING:
    from brace.diagnose.loading.search_pass import Pass

SAME_K = 0.01  # relative, Frobenius: a third of the uncertainty that a controller reports with a K


@dataclass(frozen=True)
class Resolved:
    """`verdict` with the contest counted; `members` with the probability that each is the one, empty where one name
    stands alone; `exported` the limb of limb.toml, `taken` the member that it holds (None: none, it is as given);
    `caution` what else would explain a record in which nothing is missing, `freed` the fit that is exported for it."""

    verdict: Verdict
    members: tuple[tuple[Member, float], ...]
    alternatives: tuple[Alternative, ...]
    exported: LimbModel
    taken: Member | None
    note: str = ""
    caution: str = ""
    freed: Fit | None = None


def resolve(record: Record, final: Pass, found: Contest | None, believed: LimbModel, take: str | None) -> Resolved:
    """From the search's decision and what contests it to what is said and exported."""
    decision = final.decision
    verdict = decision.verdict
    chosen = limb_of(believed, decision.chosen.best.fit.model)
    if found is not None:
        if decision.chosen.labels == found.disputed:
            verdict = "effect" if found.decided else "ambiguous"
        sure = found.mass * confidence.of_a_name(final)
        members = [(member, sure * member.share) for member in found.members]
    elif verdict == "ambiguous":
        sets = [_alone(final.sets, label) for label in decision.labels]
        members = [
            (Member(tuple(item.labels), item.posterior, item.best.fit, item.best.fit.model),
             confidence.of_label(final, next(iter(item.labels))))
            for item in sets
        ]  # fmt: skip
    else:
        unexplained = verdict == "none" and final.structure.structured  # beside a plain loop: no refit to rely on
        base = believed if unexplained else limb_of(believed, final.base.fit.model)
        freed = None if unexplained else gain_instead(final)
        if freed is not None:
            kept = with_its_scale(believed, freed)
            caution = in_words(record, believed, base, kept, freed)
            return Resolved(verdict, (), (), kept, None, _nothing_to_take(take), caution, freed)
        exported = believed if verdict == "unknown" else chosen if verdict == "effect" else base
        return Resolved(verdict, (), (), exported, None, _nothing_to_take(take))
    limbs = [limb_of(believed, member.model) for member, _ in members]
    at_rad = postures(record.dataset)
    k = np.array([k_at(limb, at_rad) for limb in limbs])  # members x postures x (xx, xz, zz)
    taken = _asked_for([member for member, _ in members], take)
    note = "" if taken is not None or take is None else _nothing_to_take(take)
    off = _apart(k)
    if taken is None and float(np.median(off)) <= SAME_K:
        taken = members[0][0]
    exported = believed if taken is None else limb_of(believed, taken.model)
    place = int(np.argmax(off))
    alternatives = tuple(
        Alternative(member.label, sure, StiffnessAt(*(float(angle) for angle in at_rad[place]), *map(float, values)))
        for (member, sure), values in zip(members, k[:, place])
    )
    return Resolved(verdict, tuple(members), alternatives, exported, taken, note)


def _nothing_to_take(take: str | None) -> str:
    return "" if take is None else f"--take {take}: no member of what this record leaves open; nothing was taken"


def _alone(sets: Sequence[LabelSet], label: str) -> LabelSet:
    return next(item for item in sets if item.labels == {label})


def _asked_for(members: Sequence[Member], take: str | None) -> Member | None:
    """By its label, or by a name that only one member has."""
    if take is None:
        return None
    for member in members:
        if take == member.label:
            return member
    named = [one for one in members if take in {part for label in one.labels for part in (label, label.split("@")[0])}]
    return named[0] if len(named) == 1 else None


def _apart(k: np.ndarray) -> np.ndarray:
    """By posture, how far the members' K are from the first one's at most; what cannot be said is far."""
    return np.asarray(np.nan_to_num(apart(k, k[0]), nan=np.inf).max(axis=0))
