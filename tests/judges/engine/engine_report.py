"""The engine world's tables: what must be reached, and where it fails."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from statistics import median
from typing import Any

import report
from generate import LEFT_BY_CATALOGUE
from scoring import Judged, Share, closed, share, strong

HOW = """Limbs of a physics engine that nobody here wrote (tests/judges/engine), diagnosed from
loading records alone; the answers lie apart and are sealed before the run. Each link is a beam of ten segments; the tip
is held up to 2.54 mm off, and the engine's geometry is exact: force over displacement is no straight line for a sound
limb either. Limbs, poses, strokes, noise, sizes and directions are random; each true limb also differs from what is
believed within the calibration's trust. Half of the limb.toml do not say that the tibia is a beam. Detectability s =
sqrt(2 x log-likelihood gain of the truth after refitting the base), by the engine. An effect's class: those whose trace
in this design has a cosine above 0.95 with the truth's."""

READING = """Intervals are Wilson's, 95 %. Gap closed: 1 - rms after / rms before on other poses, without noise, over
single effects whose gap there is above 0.05 N. K: at 15 random postures under 4 to 20 N, the median distance from the
engine's K. Some outsiders are equal, or nearly, to entries of the catalogue in every reading of such a record (a rig
turned or yielding, a bowed tibia, a knee beside the femur's line): what is fitted of those entries leaves less than 8
sigmas, and no diagnosis of it could show them. They count among all outsiders, and the lines below those say what is said of
the others. Five of the kinds have names of their own, which the tool asks about where what they look like was chosen: a
class that holds this name names them."""

ROWS = (600, 800)  # of the records whose diagnosis is timed


def differs(j: Judged) -> bool:
    """Whether an outsider leaves more than the noise where the entries most like it are fitted."""
    return j.left >= LEFT_BY_CATALOGUE


def figures(judged: Sequence[Judged]) -> list[dict[str, Any]]:
    """What must be reached."""
    none = report.of_kind(judged, "none")
    single, pairs = [j for j in judged if j.kind == "single" and strong(j)], report.of_kind(judged, "pair")
    middle, low, count = closed(single)
    named = [j for j in judged if j.stiffer]
    nearer = sum(j.stiffer[1] < j.stiffer[0] for j in named if j.stiffer)
    k = Share(nearer, len(named))
    return [
        report.at_most("nothing hidden: named wrongly or unknown", share(none, "false_alarm"), 0.01),
        report.at_least("single, s >= 12: right effect or its class first", share(single, "class"), 0.95),
        report.line("single, s >= 12: gap closed on configurations never seen, median", "at least 93 %",
                    report.if_any(middle >= 0.93, count), report.percent(middle), "", count),
        report.at_least("both of two hidden effects and nothing else", share(pairs, "set"), 0.80),
        report.at_least("outside the catalogue, all: called unknown, or by their names",
                        share(judged, "seen_through"), 0.90),
        report.at_most("outside the catalogue, all: named with more than 0.8", share(judged, "misnamed"), 0.02),
        report.at_least("those that differ by 8 sigmas: called unknown, or by their names",
                        share(judged, "seen_through", differs), 0.90),
        report.at_most("those that differ: named with more than 0.8", share(judged, "misnamed", differs), 0.02),
        report.at_least("K under load of the exported model nearer to the truth than the believed", k, 0.97),
    ]  # fmt: skip


def besides(judged: Sequence[Judged]) -> list[tuple[str, Share]]:
    """Shares without a limit, for the lines below the table of limits."""
    single, pairs = [j for j in judged if j.kind == "single" and strong(j)], report.of_kind(judged, "pair")
    return [
        ("single, s >= 12: exactly the right effect first", share(single, "exact")),
        ("single, s >= 12: right effect and place first", share(single, "where")),
        ("single: more than one named as sure", share(single, "extra")),
        ("pairs: names or members of their classes", share(pairs, "set_or_class")),
        ("outside, all: called unknown, whatever their names", share(judged, "unknown")),
        ("outside, but within 8 sigmas of entries of the catalogue: called unknown or by their names",
         share(judged, "seen_through", lambda j: not differs(j))),
        ("cases refused or crashed", Share(sum(j.verdict == "nothing" for j in judged), len(judged))),
    ]


def seconds(judged: Sequence[Judged]) -> dict[str, float]:
    """Of a diagnosis with its report."""
    taken = sorted(j.cpu_seconds for j in judged if j.cpu_seconds and ROWS[0] <= j.rows <= ROWS[1])
    return {"median": median(taken), "longest": taken[-1], "cases": len(taken)} if taken else {}


def made(judged: Sequence[Judged], by: dict[str, Any], command: str) -> tuple[str, str, dict[str, Any]]:
    """Table, page and figures."""
    lines, more, time = figures(judged), besides(judged), seconds(judged)
    single = report.of_kind(judged, "single")
    _, low, count = closed([j for j in single if strong(j)])
    kinds = ", ".join(f"{n} {kind}" for kind, n in sorted(Counter(j.kind for j in judged).items()))
    rows = ["| figure | measured | 95 % interval | of |", "|---|---|---|---|"]
    for name, s in more:
        if s.of:
            least, most = s.wilson()
            rows.append(f"| {name} | {report.percent(s.value)} | {100 * least:.1f}-{100 * most:.1f} % | {s.of} |")
    rows.append(f"| single, s >= 12: gap closed, 5th percentile | {report.percent(low)} | | {count} |")
    alarms = [j for j in judged if j.flags.get("false_alarm")]
    wrong = [j for j in single if strong(j) and not j.flags["class"]]
    worse = [j for j in judged if j.stiffer and j.stiffer[1] >= j.stiffer[0]]
    table = report.table({"lines": lines})
    timing = (f"A diagnosis of {ROWS[0]} to {ROWS[1]} rows with its report took {time['median']:.1f} s (median), "
              f"{time['longest']:.1f} s (longest of {time['cases']:.0f}) of one core's time; "
              "other work beside it makes that longer." if time else "")  # fmt: skip
    page = "\n\n".join(part for part in (
        "# Blind benchmark on limbs of a physics engine",
        f"    {command}",
        HOW,
        f"This run: {by['cases']} of {by['planned']} planned cases ({kinds}), the first of a random order fixed by "
        f"the seed; {by['unmade']} cannot be made, as no draw is as detectable as wanted. "
        f"{by['set'].capitalize()} seed {by['seed']}, "
        f"answers' seal `{by['seal_sha256'][:16]}`, generator `{by['generator_sha256'][:12]}`, tool `{by['tool']}`.",
        table, READING, timing,
        "## Besides", "\n".join(rows),
        "## Nothing hidden, but something said", _listed(alarms),
        "## Single effects with s of 12 and more, not named right", _listed(wrong),
        "## Single effects, by effect", report.by_effect(single),
        "## Pairs that were missed", report.missed_sets(report.of_kind(judged, "pair")),
        "## Outside the catalogue", report.said_by_truth(report.of_kind(judged, "outside")),
        "## Outside the catalogue, but like entries of it", report.said_by_truth(report.of_kind(judged, "disguised")),
        "## K under load no nearer", _stiffness(worse),
        *(["## Refused or crashed", "\n".join(f"- {j.id}: {j.note.splitlines()[-1][:200]}" for j in judged if j.note)]
          if any(j.note for j in judged) else []),
    ) if part) + "\n"  # fmt: skip
    content = {
        "made": by, "lines": lines, "seconds": time,
        "besides": [(name, s.hits, s.of) for name, s in more if s.of],
    }  # fmt: skip
    return table, page, content


def _listed(judged: Sequence[Judged]) -> str:
    if not judged:
        return "None."
    rows = ["| case | hidden | s | said | verdict |", "|---|---|---|---|---|"]
    for j in judged:
        rows.append(f"| {j.id} | {', '.join(j.truth)} | {j.s:.0f} | {', '.join(j.said) or '-'} | {j.verdict} |")
    return "\n".join(rows)


def _stiffness(judged: Sequence[Judged]) -> str:
    if not judged:
        return "None."
    rows = ["| case | hidden | said | K off as believed | as exported |", "|---|---|---|---|---|"]
    for j in judged:
        before, after = j.stiffer or (0.0, 0.0)
        off = f"{100 * before:.2f} % | {100 * after:.2f} %"
        rows.append(f"| {j.id} | {', '.join(j.truth)} | {', '.join(j.said)} | {off} |")
    return "\n".join(rows)
