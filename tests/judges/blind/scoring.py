"""What a diagnosis is worth against the truth: one judgement a case, shares over cases, calibration, coverage."""

from __future__ import annotations

import csv
import math
import random
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Any

CONFIDENT = 0.8  # an outsider named with more than this is confidently misnamed
VISIBLE_GAP_N = 0.05  # a gap on unseen configurations below this is not scored
STRONG, WEAK = 11.5, 6.5  # s: "12" is from STRONG on, "8" between the two
OF_THE_RIG = ("rig_rotation", "rig_compliance")  # of a class that the answers, which know no rigs, cannot list
# Outsiders that the tool knows by a name of their own: a class with that name in it names them.
OWN_NAMES = {
    "rig_turned": "rig_rotation",
    "rig_yields": "rig_compliance",
    "knee_offset": "knee_offset",
    "bowed_tibia": "bowed_link",
    "off_centre_play": "off_centre_play",
}
# What a trouble of the instruments may be reported as, in a data fault: words of its sentence. A tip that is clamped
# elsewhere in each run and a zero that wanders both give forces at rest that differ from run to run.
NAMED_AS_TROUBLE = {
    "glitch_bursts": r"single readings stand out|zero moved",
    "seating": r"force at rest differs|zero moved",
    "sensor_warmth": r"force at rest differs|zero moved",
    "slip": r"slipped by",
}
ALARMS = ("effect", "ambiguous", "unknown", "data_fault")


@dataclass
class Judged:
    """One case: what it was, what was said, what of it was right."""

    id: str
    kind: str
    s: float
    truth: list[str]
    cls: set[str]
    verdict: str
    said: list[str]
    flags: dict[str, bool] = field(default_factory=dict)
    closed: float | None = None
    closable: float | None = None
    gap_before_n: float = 0.0
    claims: list[tuple[float, bool]] = field(default_factory=list)
    intervals: list[tuple[str, bool]] = field(default_factory=list)
    rows: int = 0
    left: float = math.inf  # sigmas of an outsider that no entry of the catalogue makes up
    stiffer: tuple[float, float] | None = None  # error of K under load: as believed, as exported
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    note: str = ""
    exported: bool = True  # False: a class was named whose members give different K, so limb.toml is as believed


def label(effect: dict[str, Any]) -> str:
    """name@where"""
    return f"{effect['name']}@{effect['where']}"


def judge(truth: dict[str, Any], found: dict[str, Any]) -> Judged:
    """Judges one diagnosis.json (an empty one where there is none)."""
    kind, verdict = truth["kind"], str(found.get("verdict", "nothing"))
    effects = found.get("effects", [])
    said, names = [label(e) for e in effects], [e["name"] for e in effects]
    real = [label(e) for e in truth["effects"]] if kind in ("single", "pair", "triple") else []
    group = {member for members in found.get("indistinguishable", []) for member in members}
    j = Judged(
        truth["id"], kind, float(truth["detectability"]), real or [_other(truth)], set(truth["cls"]), verdict, said,
        rows=int(truth.get("rows", 0)),
        exported=verdict not in ("effect", "ambiguous") or bool(found.get("exported", True)),
    )  # fmt: skip
    first = said[0] if said else None
    if kind == "none":
        j.flags["false_alarm"] = verdict in ALARMS or verdict == "nothing"
    elif kind == "data_fault":
        fields = {fault.get("field") for fault in found.get("data_faults", [])}
        j.flags["fault"] = verdict == "data_fault" and bool(fields & set(truth["fields"]))
        j.flags["fault_any_field"] = verdict == "data_fault"
    elif kind in ("disguised", "outside"):
        j.left = float(truth.get("left_by_catalogue", math.inf))
        is_named = _named_as_trouble(j.truth[0].split("@")[0], found)
        named = set(said) | group
        own = OWN_NAMES.get(j.truth[0].split("@")[0], "")
        seen = any(label.split("@")[0] == own for label in named)
        j.flags["unknown"] = verdict == "unknown" or (verdict == "data_fault" and is_named)
        sure = verdict == "effect" and any(e.get("confidence", 1.0) > CONFIDENT for e in effects)
        j.flags["misnamed"] = (sure and not seen) or (verdict == "data_fault" and not is_named)
        j.flags["seen_through"] = j.flags["unknown"] or seen
        if kind == "disguised":
            alike = set(truth["alike"])
            j.flags["seen_through"] |= alike <= named and set(said) <= alike | group
    elif kind == "single":
        name, whole = truth["effects"][0]["name"], j.cls | set(real)
        j.flags["exact"] = first is not None and names[0] == name
        j.flags["where"] = first == real[0]
        j.flags["class"] = (
            verdict in ("effect", "ambiguous")
            and first is not None
            and (
                names[0] == name
                or ((first in whole or names[0] in OF_THE_RIG) and (real[0] in group or real[0] in said))
            )
        )
        j.flags["place_determined"] = not any(m.startswith(f"{name}@") and m != real[0] for m in whole)
        j.flags["extra"] = verdict == "effect" and len(set(names)) > 1
    else:
        j.flags["set"] = sorted(set(names)) == sorted({e["name"] for e in truth["effects"]})
        j.flags["set_or_class"] = _matched(said, truth.get("cls_each", [[r] for r in real]))
    j.claims = [(float(e["confidence"]), one in real) for e, one in zip(effects, said, strict=True)]
    for effect, one in zip(effects, said, strict=True):
        if one in real:
            j.intervals += _held(effect, truth.get("true_parameters", {}))
    return j


def _named_as_trouble(name: str, found: dict[str, Any]) -> bool:
    """Whether every data fault names the trouble of the instruments that was hidden; one that names another is a wrong
    name."""
    words = NAMED_AS_TROUBLE.get(name)
    reasons = [str(fault.get("why", "")) for fault in found.get("data_faults", [])]
    return words is not None and bool(reasons) and all(re.search(words, reason) for reason in reasons)


def _other(truth: dict[str, Any]) -> str:
    if truth["kind"] in ("outside", "disguised"):
        return str(truth["effects"][0]["name"])
    return str(truth.get("fault", "none"))


def _matched(said: Sequence[str], classes: Sequence[Iterable[str]]) -> bool:
    """Whether what was said can be paired off with the truths, each with a member of its class."""
    if len(said) != len(classes):
        return False
    if not said:
        return True
    return any(
        said[0] in set(members) and _matched(said[1:], [c for k, c in enumerate(classes) if k != i])
        for i, members in enumerate(classes)
    )


def _held(effect: dict[str, Any], real: dict[str, Any]) -> list[tuple[str, bool]]:
    """For each parameter with an interval: whether the true value lies in it. null is an open end."""
    out = []
    for key, interval in effect.get("parameters", {}).items():
        value = real.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            continue
        low = -math.inf if interval.get("low") is None else float(interval["low"])
        high = math.inf if interval.get("high") is None else float(interval["high"])
        slack = 1e-8 * abs(value)  # printed to nine digits
        out.append((key, low - slack <= value <= high + slack))
    return out


def gap_n(measured: Path, predicted: Path) -> float:
    """rms of measured less predicted force over both axes [N]."""
    a, b = _forces(measured), _forces(predicted)
    if len(a) != len(b):
        return math.inf
    return math.sqrt(sum((p - q) ** 2 for p, q in zip(a, b, strict=True)) / len(a))


def _forces(path: Path) -> list[float]:
    with path.open(newline="") as file:
        return [float(row[name]) for row in csv.DictReader(file) for name in ("fx_n", "fz_n")]


def of_removable(j: Judged) -> float | None:
    """Gap closed as a share of what knowing the truth's effects would have closed."""
    if j.closed is None or j.closable is None or j.closable <= 0.0:
        return None
    return j.closed / j.closable


# --- shares ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Share:
    """How many of how many."""

    hits: int
    of: int

    @property
    def value(self) -> float | None:
        """The share, None of nothing."""
        return self.hits / self.of if self.of else None

    def wilson(self, z: float = 1.959964) -> tuple[float, float]:
        """95 % interval of the share."""
        if not self.of:
            return 0.0, 1.0
        n, p = self.of, self.hits / self.of
        middle, spread = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        return max(0.0, (middle - spread) / (1 + z * z / n)), min(1.0, (middle + spread) / (1 + z * z / n))


def share(cases: Iterable[Judged], flag: str, where: Callable[[Judged], bool] = lambda _: True) -> Share:
    """Share of a flag among the cases that have it."""
    values = [j.flags[flag] for j in cases if flag in j.flags and where(j)]
    return Share(sum(values), len(values))


def strong(j: Judged) -> bool:
    """s = 12 and more."""
    return j.s >= STRONG


def weak(j: Judged) -> bool:
    """s = 8."""
    return WEAK <= j.s < STRONG


def must_be_named(j: Judged) -> bool:
    """s = 8 and more: what must be named."""
    return j.s >= WEAK


def calibration(cases: Iterable[Judged], bins: int = 10) -> tuple[float, int, list[tuple[float, float, int]]]:
    """Expected calibration error of the confidences of all that was named; how many; per bin mean confidence, share
    right, count."""
    claims = sorted(claim for j in cases for claim in j.claims)
    table = []
    for k in range(bins):
        inside = [c for c in claims if k / bins <= c[0] < (k + 1) / bins or (k == bins - 1 and c[0] >= 1.0)]
        if inside:
            right = sum(ok for _, ok in inside) / len(inside)
            table.append((sum(c for c, _ in inside) / len(inside), right, len(inside)))
    total = len(claims)
    return (sum(n * abs(c - r) for c, r, n in table) / total if total else math.nan), total, table


def calibration_scatter(cases: Iterable[Judged], draws: int = 1000) -> tuple[float, float]:
    """The calibration error of a tool whose confidences are exact, from so few claims: median and 95th percentile of
    draws in which each claim is right as often as it says."""
    cases = list(cases)
    rng = random.Random(0)
    said = [confidence for j in cases for confidence, _ in j.claims]
    if not said:
        return math.nan, math.nan
    errors = []
    for _ in range(draws):
        drawn = [(confidence, rng.random() < confidence) for confidence in said]
        errors.append(calibration([replace(cases[0], claims=drawn)])[0])
    errors.sort()
    return errors[draws // 2], errors[int(0.95 * draws)]


def coverage(cases: Iterable[Judged]) -> Share:
    """Intervals that hold the true parameter, of effects that were named right."""
    held = [ok for j in cases for _, ok in j.intervals]
    return Share(sum(held), len(held))


def closed(
    cases: Iterable[Judged],
    where: Callable[[Judged], bool] = lambda _: True,
    value: Callable[[Judged], float | None] = lambda j: j.closed,
) -> tuple[float, float, int]:
    """Share of the gap on unseen configurations that the corrected model closes: median, 5th percentile, cases."""
    found = [value(j) for j in cases if j.kind in ("single", "pair") and where(j)]
    values = sorted(x for x in found if x is not None)
    if not values:
        return math.nan, math.nan, 0
    return median(values), values[int(0.05 * len(values))], len(values)
