"""The benchmark's tables: every line that must be reached, where it fails, what is confused with what."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Sequence
from statistics import median
from typing import Any

from scoring import (
    VISIBLE_GAP_N,
    Judged,
    Share,
    calibration,
    calibration_scatter,
    closed,
    coverage,
    of_removable,
    share,
    strong,
    weak,
)
from seeds import REPORTED_CASES

HOW = """Effects are hidden in simulated loading tests by a simulator and a generator that share no code with the tool
(tests/judges/blind); the answers lie apart and are sealed before the run. Limbs, poses,
designs, noise, sizes and directions are random; each true limb also differs from what is believed within the
calibration's trust. Detectability s = sqrt(2 x log-likelihood gain of the truth after refitting the base). An
effect's class: those whose trace in this design has a cosine above 0.95 with the truth's."""

READING = f"""Intervals are Wilson's, 95 %. Whole gap closed: 1 - rms after / rms before on other
poses, without noise, over single effects and pairs of every s whose gap there is above {VISIBLE_GAP_N} N and whose
verdict exported a model: a class whose members give different K leaves limb.toml as it was. The record's
noise leaves a part of it even to somebody who knows what is hidden and fits just that to the same record;
removable is the rest, and its share that the tool closes is the line above. Calibration: the confidence of every
effect named against whether it is one of the hidden. Coverage: the intervals of effects named right. After the next
experiment: over all single effects of s >= 12; where the tool proposes none that a rig can play, its first word
counts. Outside the catalogue: bursts of interference reported as single readings that stand out, and clamping or a
zero that wanders reported as a force at rest that differs from run to run, count as called unknown; any other trouble
of the instruments reported in place of what is hidden counts as misnamed. The generator hides none of the
instruments' effects that the catalogue has (a lag, a rig that turns or yields, steps of gain or zero). Where one of
them explains a record as well as the hidden effect does, the tool reports both. The tool takes such a cause to be three
times rarer than an effect of the catalogue; only a rig that yields counts as common as an effect."""

TITLES = {"simulator": "# Blind benchmark", "finite": "# Blind benchmark at finite displacements"}
FINITE = """The simulator of blind.md assumes that no limb turns as it is displaced. Here its limbs, tests,
effects and outsiders are played by the physics engine of tests/judges/engine, in which limbs
turn; detectability and classes are worked out there, too. All else is as on that page."""

__all__ = ["VISIBLE_GAP_N", "as_json", "cases_as_json", "figures", "page", "table"]


def line(name: str, target: str, ok: bool | None, value: str, interval: str = "", of: int = 0) -> dict[str, Any]:
    met = "no data" if ok is None else "met" if ok else "MISSED"
    return {"figure": name, "target": target, "measured": value, "interval": interval, "of": of, "met": met}


def at_least(name: str, s: Share, target: float) -> dict[str, Any]:
    return share_line(name, f"at least {100 * target:g} %", s, s.value is not None and s.value >= target)


def at_most(name: str, s: Share, target: float) -> dict[str, Any]:
    return share_line(name, f"at most {100 * target:g} %", s, s.value is not None and s.value <= target)


def share_line(name: str, target: str, s: Share, ok: bool) -> dict[str, Any]:
    if s.value is None:
        return line(name, target, None, "-")
    low, high = s.wilson()
    return line(name, target, ok, f"{100 * s.value:.1f} %", f"{100 * low:.1f}-{100 * high:.1f} %", s.of)


def figures(
    judged: Sequence[Judged], after: dict[str, Any], steady: dict[str, Any], made: dict[str, Any]
) -> dict[str, Any]:
    """All figures of one run."""
    lines = [
        at_least("right effect or its class first, s >= 12", share(judged, "class", strong), 0.97),
        at_least("right effect or its class first, s = 8", share(judged, "class", weak), 0.90),
        at_least("exactly the right effect first, s >= 12", share(judged, "exact", strong), 0.88),
        at_least(
            "right joint or link, where the class allows it (right effect first, s >= 12)",
            share(judged, "where", lambda j: strong(j) and j.flags["place_determined"] and j.flags["exact"]),
            0.95,
        ),
        at_most("false alarm when nothing is hidden", share(judged, "false_alarm"), 0.01),
        at_least("both of two hidden effects and nothing else, 12 each", share(of_kind(judged, "pair"), "set"), 0.85),
        at_least("outside the catalogue called unknown", share(judged, "unknown"), 0.90),
        at_most("outside the catalogue confidently misnamed", share(judged, "misnamed"), 0.02),
    ]
    for what, value in (
        ("removable gap closed on configurations never seen", of_removable),
        ("whole gap closed on configurations never seen", _whole),
    ):
        middle, low, count = closed(judged, value=value)
        lines += [
            line(f"{what}, median", "at least 95 %", if_any(middle >= 0.95, count), percent(middle), "", count),
            line(f"{what}, 5th percentile", "at least 80 %", if_any(low >= 0.80, count), percent(low), "", count),
        ]
    held = coverage(judged)
    lines.append(share_line("90 % intervals that hold the true parameter", "86-94 %", held,
                             held.value is not None and 0.86 <= held.value <= 0.94))  # fmt: skip
    error, claims, bins = calibration(judged)
    middle, high = calibration_scatter(judged)
    lines.append(line("expected calibration error of the confidence", "at most 0.04", if_any(error <= 0.04, claims),
                       f"{error:.3f}", f"exact confidences: median {middle:.3f}, 95th {high:.3f}", claims))  # fmt: skip
    rows = after["cases"]
    then = Share(sum(r["exact_after"] for r in rows), len(rows)) if any(r["played"] for r in rows) else Share(0, 0)
    lines.append(at_least("after the tool's own next experiment: exactly right, s >= 12", then, 0.95))
    lines.append(at_least("same data and seed, same bytes", Share(*steady["same_bytes"]), 1.0))
    lines.append(at_least("five seeds, same verdict and effects", Share(*steady["same_verdict"]), 0.99))

    played = [r for r in rows if r["played"]]
    strict = [j for j in judged if strong(j)]
    middle12, low12, n12 = closed(judged, strong)
    by_key: dict[str, list[bool]] = defaultdict(list)
    for j in judged:
        for key, ok in j.intervals:
            by_key[key].append(ok)
    clocks = {
        "wall": sorted(j.seconds for j in judged if j.seconds),
        "cpu": sorted(j.cpu_seconds for j in judged if j.cpu_seconds),
    }
    besides = [
        ("right effect and place first, s >= 12, no allowance for the class", share(judged, "where", strong)),
        ("right effect or its class first, s = 5", share(judged, "class", lambda j: 4 <= j.s < 6.5)),
        ("right effect or its class first, s = 3", share(judged, "class", lambda j: j.s < 4)),
        ("single effect: more than one named as sure", share(judged, "extra")),
        ("pairs: names or members of their classes", share(of_kind(judged, "pair"), "set_or_class")),
        ("triples: all three and nothing else", share(of_kind(judged, "triple"), "set")),
        ("triples: names or members of their classes", share(of_kind(judged, "triple"), "set_or_class")),
        ("data fault found, in one of the right fields", share(judged, "fault")),
        ("data fault found, in any field", share(judged, "fault_any_field")),
        ("next experiment played: right first before", Share(sum(r["exact_before"] for r in played), len(played))),
        ("next experiment played: right first after", Share(sum(r["exact_after"] for r in played), len(played))),
        (
            "next experiment played: named alone and right after",
            Share(sum(r["right_after"] for r in played), len(played)),
        ),
        ("cases refused or crashed", Share(sum(j.verdict == "nothing" for j in judged), len(judged))),
    ]
    return {
        "made": made,
        "lines": lines,
        "besides": [(name, s.hits, s.of, s.value, s.wilson()) for name, s in besides if s.of],
        "closed_s12": {"median": middle12, "p5": low12, "cases": n12},
        "closed_by_knowing": _named(closed(judged, value=lambda j: j.closable)),
        "closed_of_that": _named(closed(judged, value=of_removable)),
        "seconds": {
            clock: {"median": median(v), "p95": v[int(0.95 * (len(v) - 1))], "longest": v[-1]}
            for clock, v in clocks.items()
            if v
        },
        "calibration": bins,
        "coverage_by_key": {key: (sum(v), len(v)) for key, v in sorted(by_key.items())},
        "after_next": rows,
        "promises": promises(rows),
        "strong": len(strict),
        "kinds": dict(Counter(j.kind for j in judged)),
    }  # fmt: skip


def of_kind(judged: Sequence[Judged], kind: str) -> list[Judged]:
    return [j for j in judged if j.kind == kind]


def _named(of_cases: tuple[float, float, int]) -> dict[str, float]:
    return dict(zip(("median", "p5", "cases"), of_cases, strict=True))


def _whole(j: Judged) -> float | None:
    return j.closed


def if_any(met: bool, count: int) -> bool | None:
    return met if count else None


# --- words ----------------------------------------------------------------------------------------------------


def table(found: dict[str, Any]) -> str:
    """What must be reached, and what was."""
    rows = ["| figure | must reach | measured | 95 % interval | of | |", "|---|---|---|---|---|---|"]
    rows += [
        f"| {x['figure']} | {x['target']} | {x['measured']} | {x['interval']} | {x['of'] or ''} | {x['met']} |"
        for x in found["lines"]
    ]
    return "\n".join(rows)


def _first(j: Judged) -> str:
    """What a diagnosis says first, by its effect's name; or its verdict."""
    if j.verdict in ("effect", "ambiguous") and j.said:
        return j.said[0].split("@")[0]
    return j.verdict


def confusion(judged: Sequence[Judged]) -> str:
    """Truth by row, what was said first by column; a dot is none."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for j in judged:
        counts[j.truth[0].split("@")[0]][_first(j)] += 1
    heads = sorted({said for row in counts.values() for said in row})
    rows = ["| truth \\ said first | " + " | ".join(heads) + " |", "|---" * (len(heads) + 1) + "|"]
    for name in sorted(counts):
        rows.append(f"| {name} | " + " | ".join(str(counts[name][h] or ".") for h in heads) + " |")
    return "\n".join(rows)


def by_effect(judged: Sequence[Judged]) -> str:
    """Per effect: exact and class at each detectability."""
    groups: dict[str, dict[str, list[Judged]]] = defaultdict(lambda: defaultdict(list))
    for j in of_kind(judged, "single"):
        level = "12 and more" if j.s >= 11.5 else "8" if j.s >= 6.5 else "5" if j.s >= 4 else "3"
        groups[j.truth[0]][level].append(j)
    heads = ("3", "5", "8", "12 and more")
    rows = ["| effect | " + " | ".join(f"s = {h}: exact, class, of" for h in heads) + " |", "|---" * 5 + "|"]
    for name in sorted(groups):
        cells = []
        for head in heads:
            inside = groups[name][head]
            exact, kin = (sum(j.flags[f] for j in inside) for f in ("exact", "class"))
            cells.append(f"{exact}, {kin}, {len(inside)}" if inside else "")
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(rows)


def promises(rows: Sequence[dict[str, Any]]) -> list[tuple[float, float, int]]:
    """Compares what next experiments promised with what they brought when they were played. Each entry: (mean promised
    probability that the hidden effect is separated from its rivals, share of cases in which it was named alone and right,
    number of cases). The entries are of promises below 0.8, from 0.8 to 0.95, and above."""
    kept = [(r["promised"], r["right_after"]) for r in rows if r["played"] and r["promised"] is not None]
    bins = [[pair for pair in kept if low <= pair[0] < high] for low, high in ((0.0, 0.8), (0.8, 0.95), (0.95, 1.1))]
    return [(*(sum(column) / len(pairs) for column in zip(*pairs)), len(pairs)) for pairs in bins if pairs]


def said_by_truth(judged: Sequence[Judged]) -> str:
    """For outsiders and faults: how often what was said."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    for j in judged:
        counts[j.truth[0]][", ".join(j.said) if j.verdict in ("effect", "ambiguous") else j.verdict] += 1
    rows = ["| hidden | said |", "|---|---|"]
    for name in sorted(counts):
        rows.append(f"| {name} | " + "; ".join(f"{n} x {said}" for said, n in counts[name].most_common()) + " |")
    return "\n".join(rows)


def percent(value: float | None) -> str:
    return "-" if value is None or math.isnan(value) else f"{100 * value:.1f} %"


def _not_exported(judged: Sequence[Judged]) -> int:
    return sum(1 for j in judged if j.kind in ("single", "pair") and not j.exported)


def closable(found: dict[str, Any]) -> str:
    """What was closed beside what could be."""
    known, of_that = found["closed_by_knowing"], found["closed_of_that"]
    return (
        "To know what is hidden and to fit just that to the same noisy record would close "
        f"{percent(known['median'])} (median), {percent(known['p5'])} (5th percentile) of the same gaps; of what "
        f"that would close, the tool closes {percent(of_that['median'])} (median), {percent(of_that['p5'])} (5th "
        f"percentile) of {of_that['cases']} cases."
    )


def page(found: dict[str, Any], judged: Sequence[Judged], command: str) -> str:
    """Everything that a run found, in tables."""
    made = found["made"]
    kinds = ", ".join(f"{n} {kind}" for kind, n in sorted(found["kinds"].items()))
    besides = ["| figure | measured | 95 % interval | of |", "|---|---|---|---|"]
    besides += [
        f"| {name} | {percent(value)} | {100 * low:.1f}-{100 * high:.1f} % | {of} |"
        for name, _, of, value, (low, high) in found["besides"]
    ]
    strong12 = found["closed_s12"]
    bins = ["| mean confidence | share right | claims |", "|---|---|---|"]
    bins += [f"| {c:.2f} | {r:.2f} | {n} |" for c, r, n in found["calibration"]]
    kept = ["| mean probability promised | share named alone and right | cases |", "|---|---|---|"]
    kept += [f"| {promised:.2f} | {right:.2f} | {n} |" for promised, right, n in found["promises"]]
    keys = ["| parameter | in its interval | of |", "|---|---|---|"]
    keys += [f"| {key} | {ok} | {n} |" for key, (ok, n) in found["coverage_by_key"].items()]
    troubles = [f"- {j.id} ({j.kind}, {j.truth[0]}): {j.note.strip().splitlines()[-1][:200]}" for j in judged if j.note]
    return "\n\n".join(
        [
            TITLES[made["world"]],
            f"    {command}",
            HOW,
            *([FINITE] if made["world"] == "finite" else []),
            f"This run: {made['cases']} cases ({kinds}), {made['set']} seed {made['seed']}, answers' seal "
            f"`{made['seal_sha256'][:16]}`, generator `{made['generator_sha256'][:12]}`, tool `{made['tool']}`.",
            table(found),
            f"{READING} With s >= 12 alone the gap closed is {percent(strong12['median'])} (median), "
            f"{percent(strong12['p5'])} (5th percentile) of {strong12['cases']}. "
            f"{_not_exported(judged)} single effects and pairs were named as a class that exports nothing.",
            closable(found),
            f"A diagnosis of 150 to 1000 rows with its report, one core each, took ({REPORTED_CASES} cases; median, "
            "95th percentile, longest): "
            + "; ".join(
                f"{v['median']:.1f}, {v['p95']:.1f}, {v['longest']:.1f} s by the {clock} clock"
                for clock, v in found["seconds"].items()
            ) + ".",
            *(["## Beside other ways to choose", found["baselines_text"]] if "baselines_text" in found else []),
            "## Besides",
            "\n".join(besides),
            "## Single effects, by effect and detectability",
            by_effect(judged),
            "## What is said first, single effects with s of 12 and more, and none",
            confusion([j for j in judged if (j.kind == "single" and strong(j)) or j.kind == "none"]),
            "## What is said first, single effects with s = 8",
            confusion([j for j in judged if j.kind == "single" and weak(j)]),
            "## Pairs and triples that were missed",
            missed_sets([j for j in judged if j.kind in ("pair", "triple")]),
            "## Outside the catalogue",
            said_by_truth(of_kind(judged, "outside")),
            "## Data faults",
            said_by_truth(of_kind(judged, "data_fault")),
            "## Confidence against share right",
            "\n".join(bins),
            *(["## What next experiments promised and brought", "\n".join(kept)] if found["promises"] else []),
            "## Intervals",
            "\n".join(keys),
            *(["## Refused or crashed", "\n".join(troubles)] if troubles else []),
        ]
    ) + "\n"  # fmt: skip


def missed_sets(judged: Sequence[Judged]) -> str:
    """Those that were not named as they are."""
    missed = [j for j in judged if not j.flags["set"]]
    rows = ["| hidden | said | verdict |", "|---|---|---|"]
    for j in sorted(missed, key=lambda j: j.truth):
        rows.append(f"| {', '.join(j.truth)} | {', '.join(j.said) or '-'} | {j.verdict} |")
    return f"{len(missed)} of {len(judged)}, here, were not named as they are.\n\n" + "\n".join(rows)


def as_json(found: dict[str, Any]) -> dict[str, Any]:
    """The figures that the page is made of."""
    return {key: value for key, value in found.items() if key not in ("after_next", "baselines_text")}


def cases_as_json(judged: Sequence[Judged]) -> list[dict[str, Any]]:
    """One entry a case: what was hidden and what was said."""
    return [
        {"id": j.id, "kind": j.kind, "s": j.s, "truth": j.truth, "verdict": j.verdict, "said": j.said, **j.flags,
         "closed": j.closed}
        for j in judged
    ]  # fmt: skip
