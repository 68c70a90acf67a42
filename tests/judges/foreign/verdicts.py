"""What a diagnosis of a foreign case is worth: which names were right, whether a trouble was named, what
intervals hold."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from scoring import CONFIDENT, label
from words import OUTSIDERS, TROUBLES, May

SURE = 0.9  # a name said with this much is to be right in 95 of 100
NAMED_S = 8.0  # sigmas that a trouble must leave to be asked for: below that silence is right
COVERED = ("gap_rad", "compliance_rad_per_n_mm", "coulomb_n_mm")


@dataclass(frozen=True)
class Claim:
    """One effect that was named."""

    label: str
    confidence: float
    right: bool  # itself
    in_class: bool  # itself, or a member of the class it was named with


@dataclass
class Word:
    """One judged case."""

    truth: dict[str, Any]
    verdict: str
    claims: list[Claim] = field(default_factory=list)
    told: bool | None = None  # the trouble, where there is one to name
    found: bool | None = None  # every hidden effect was named
    misnamed: bool | None = None  # an outsider, confidently
    impossible: list[str] = field(default_factory=list)  # sizes that the record itself excludes
    sizes: list[float] = field(default_factory=list)  # of names that are right: value / truth
    covered: dict[str, bool | None] = field(default_factory=dict)  # of the gear position left out; None: no interval
    note: str = ""

    @property
    def wrongly_named(self) -> bool:
        """Whether anything named is neither there nor of a class with what is there."""
        return any(not claim.in_class for claim in self.claims)

    def wrong(self, from_confidence: float) -> list[str]:
        """Wrong names said with so much, and sizes that cannot be."""
        wrong = [c for c in self.claims if c.confidence >= from_confidence and not c.in_class]
        return [f"{c.label} {c.confidence:.2f}" for c in wrong] + self.impossible


def _may(truth: dict[str, Any]) -> list[May]:
    out = [TROUBLES[truth["trouble"]]] if truth["trouble"] else []
    return out + ([OUTSIDERS[truth["outside"]]] if truth["outside"] else [])


def _bare(one: str) -> str:
    return one.split("@")[0]


def _parts(members: Iterable[str]) -> Iterator[str]:
    """The names of a class, those that stand together apart."""
    return (part for member in members for part in re.split(r"\s*\+\s*", str(member)))


def texts(found: dict[str, Any]) -> Iterator[str]:
    """What a diagnosis says beside names."""
    for fault in found.get("data_faults", []):
        yield f"{fault.get('field')}: {fault.get('why')}"
    yield from found.get("notes", [])
    yield str((found.get("unexplained") or {}).get("description", ""))


def intervals(found: Any) -> Iterator[tuple[str, float, float]]:
    """Every interval anywhere in a diagnosis, by the last part of its parameter's name."""
    if isinstance(found, dict):
        for key, inner in found.items():
            if isinstance(inner, dict) and "low" in inner and "high" in inner and "value" in inner:
                low = -math.inf if inner["low"] is None else float(inner["low"])
                high = math.inf if inner["high"] is None else float(inner["high"])
                yield key.rsplit(".", 1)[-1], low, high
            else:
                yield from intervals(inner)
    elif isinstance(found, list):
        for inner in found:
            yield from intervals(inner)


def judge(truth: dict[str, Any], found: dict[str, Any], run: dict[str, Any]) -> Word:
    """Judges one diagnosis.json, {} where there is none. A record that is refused is called faulty."""
    refused = not found and "refused" in run
    verdict = "data_fault" if refused else str(found.get("verdict", "nothing"))
    word = Word(truth, verdict, note=str(run.get("crashed", run.get("refused", ""))))
    real, may = {label(e) for e in truth["effects"]}, _may(truth)
    kin = real | set(truth["cls"])  # cls: labels that leave the same trace in this design
    accepted = {name for one in may for name in (*one.names, *one.also)}
    classes = [set(_parts(members)) for members in found.get("indistinguishable", [])]
    nothing_can_be = truth["trouble"] == "other_units"
    for effect in found.get("effects", []):
        said = label(effect)
        right = (said in real or effect["name"] in accepted) and not nothing_can_be
        # A member may be two names together, written with " + ": naming either of them names the class.
        listed = set().union(*(c for c in classes if said in c)) | {said}
        near = bool(listed & real) or said in kin or any(_bare(one) in accepted for one in listed)
        word.claims.append(Claim(said, float(effect["confidence"]), right, (right or near) and not nothing_can_be))
        if said in real and not nothing_can_be:
            parameters = effect.get("parameters") or {}
            word.sizes += [float(parameters[key]["value"]) / true for key, true in truth.get("size", {}).items()
                           if key in parameters and true]  # fmt: skip
        gap = (effect.get("parameters") or {}).get(f"{effect['where']}.gap_rad")
        if truth["part"] == "joint" and gap and float(gap["value"]) > truth["swing_rad"] and not nothing_can_be:
            word.impossible.append(f"gap {gap['value']:.3g} of a swing of {truth['swing_rad']:.3g} rad")
    if truth["effects"]:
        word.found = real <= {claim.label for claim in word.claims}
    if truth["outside"]:
        named = [c for c in word.claims if c.confidence > CONFIDENT and not c.in_class]
        word.misnamed = verdict == "effect" and bool(named)
    trace = truth.get("trouble_s")
    if may and (trace is None or trace >= NAMED_S):
        word.told = any(_names(one, word, found, refused) for one in may)
    if truth.get("left_out"):
        found_intervals = list(intervals(found))
        for key, value in truth["left_out"].items():
            leaf = key.rsplit(".", 1)[-1]
            here = [low <= value <= high for name, low, high in found_intervals if name == leaf]
            word.covered[leaf] = any(here) if here else None
    return word


def _names(may: May, word: Word, found: dict[str, Any], refused: bool) -> bool:
    named = {_bare(claim.label) for claim in word.claims}
    for members in [*found.get("indistinguishable", []), found.get("could_be", [])]:
        named |= {_bare(part) for part in _parts(members)}
    if named & set(may.names) or word.verdict in may.verdicts or (refused and "data_fault" in may.verdicts):
        return True
    if may.silence and not word.wrongly_named and word.verdict in ("none", "effect", "ambiguous"):
        return True
    return any(re.search(may.finding, text, re.IGNORECASE) for text in texts(found))
