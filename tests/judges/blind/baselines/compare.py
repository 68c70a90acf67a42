"""The diagnosis beside the baselines, case by case: who is right where the other is wrong."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from baselines.methods import NAMING, PROCESS, tuned
from baselines.run_case import folder_of
from scoring import VISIBLE_GAP_N, Judged, closed, judge, must_be_named, share, strong, weak

SIGNIFICANT = 0.01
US = "brace diagnose"


@dataclass(frozen=True)
class Line:
    """`right` of a judgement, None where the line does not look at the case; `must` where being better is a target."""

    words: str
    right: Callable[[Judged], bool | None]
    must: str = ""


def _single(flag: str, where: Callable[[Judged], bool]) -> Callable[[Judged], bool | None]:
    return lambda j: j.flags[flag] if j.kind == "single" and where(j) else None


def _alone(j: Judged) -> bool | None:
    return j.flags["exact"] and not j.flags["extra"] if j.kind == "single" and strong(j) else None


def _quiet(j: Judged) -> bool | None:
    return not j.flags["false_alarm"] if j.kind == "none" else None


def _pair(j: Judged) -> bool | None:
    return j.flags["set"] if j.kind == "pair" else None


def _together(j: Judged) -> bool | None:
    exact = _single("exact", must_be_named)
    return next((value for one in (exact, _quiet, _pair) if (value := one(j)) is not None), None)


LINES = (
    Line("right effect first, s >= 8", _single("exact", must_be_named), "naming"),
    Line("no alarm when nothing is hidden", _quiet, "false alarms"),
    Line("both of two hidden effects and nothing else", _pair, "pairs"),
    Line("these three together", _together, "these three together"),
    Line("right effect first and no second one, s >= 12", _alone),
    Line("right effect or its class first, s >= 12", _single("class", strong)),
    Line("right effect first, s >= 12", _single("exact", strong)),
    Line("right effect first, s = 8", _single("exact", weak)),
    Line("outside the catalogue called unknown", lambda j: j.flags["unknown"] if j.kind == "outside" else None),
)


def mcnemar_p(ours: int, theirs: int) -> float:
    """Exact and two-sided: cases that only we, only they have right."""
    n = ours + theirs
    tail = sum(math.comb(n, k) for k in range(min(ours, theirs) + 1)) / 2.0**n
    return min(1.0, 2.0 * tail)


@dataclass(frozen=True)
class Paired:
    """One line against one baseline."""

    line: Line
    method: str
    ours: int  # right by us alone
    theirs: int
    of: int

    @property
    def p(self) -> float:
        return mcnemar_p(self.ours, self.theirs)

    @property
    def better(self) -> bool:
        return self.ours > self.theirs and self.p < SIGNIFICANT


def paired(line: Line, method: str, us: Sequence[Judged], them: Sequence[Judged]) -> Paired:
    """On the same cases, in the same order."""
    ours = theirs = of = 0
    for a, b in zip(us, them, strict=True):
        if a.id != b.id:
            raise ValueError(f"{a.id} is compared with {b.id}")
        mine, other = line.right(a), line.right(b)
        if mine is None or other is None:
            continue
        of += 1
        ours += mine and not other
        theirs += other and not mine
    return Paired(line, method, ours, theirs, of)


def _said(results: Path, name: str) -> dict[str, Any]:
    said: dict[str, Any] = json.loads((folder_of(results) / f"{name}.json").read_text())
    return said


def judged_baselines(root: Path, results: Path, us: Sequence[Judged]) -> dict[str, list[Judged]]:
    """Every naming baseline's judgements, in our order; the Gaussian process has only gaps."""
    out: dict[str, list[Judged]] = {method: [] for method in (*NAMING, PROCESS)}
    for mine in us:
        truth = json.loads((root / "answers" / mine.id / "truth.json").read_text())
        said = _said(results, mine.id)
        for method, found in out.items():
            j = judge(truth, said["naming"].get(method, {}))
            j.seconds = float(said["seconds"])
            j.gap_before_n = mine.gap_before_n
            if mine.closed is not None and mine.gap_before_n > VISIBLE_GAP_N:
                after = said["after_n"].get(method)
                j.closed = 1.0 - after / mine.gap_before_n if after is not None else -1.0
            found.append(j)
    return out


def comparison(root: Path, results: Path, us: Sequence[Judged]) -> dict[str, Any]:
    """`lines` for the main table (figure, target, measured, interval, of, met), `baselines` for the
    JSON, `baselines_text` for the page."""
    lost = [j.id for j in us if "crashed" in _said(results, j.id)]
    us = [j for j in us if j.id not in lost]
    them = judged_baselines(root, results, us)
    found = [paired(line, method, us, them[method]) for line in LINES for method in NAMING]
    lines = []
    for line in LINES:
        if not line.must:
            continue
        of_line = [x for x in found if x.line is line]
        worst = max(of_line, key=lambda x: (not x.better, x.p))
        met = "no data" if not worst.of else "met" if all(x.better for x in of_line) else "MISSED"
        lines.append(
            {"figure": f"{line.must}: better than every baseline", "target": "paired, p < 0.01",
             "measured": f"p {_p(worst.p)}, {worst.ours} to {worst.theirs} ({worst.method})", "interval": "",
             "of": worst.of, "met": met}
        )  # fmt: skip
    rows = [
        {"line": x.line.words, "baseline": x.method, "only_diagnose_right": x.ours, "only_baseline_right": x.theirs,
         "of": x.of, "p": x.p} for x in found
    ]  # fmt: skip
    return {"lines": lines, "baselines": rows, "baselines_text": section(us, them, found, lost)}


def section(
    us: Sequence[Judged], them: dict[str, list[Judged]], found: Sequence[Paired], lost: Sequence[str] = ()
) -> str:
    """Markdown."""
    made = tuned()
    seconds = [j.seconds for j in them[PROCESS]] or [0.0]
    knobs = [
        f"- {name}: {', '.join(f'{k} {v}' for k, v in entry['knobs'].items())}"
        for name, entry in made["methods"].items()
    ]
    return "\n\n".join(
        [
            f"""Other people's ways to choose, on the same cases in the same run, judged by the same judge. Each is
given the tool's own noise, refitted base and catalogue: one whitened column per way of an effect, played on the plant,
the base taken out (tests/judges/blind/baselines). Each was tuned with {made['trials']} random trials
on the development set (`{made['command']}`), for naming, pairs and no false alarm in equal parts. Labels whose
columns have a cosine above 0.9 with a chosen one are printed with it, as its class. What instruments do (a lag,
a rig that turns or yields) has no column here, so a baseline never takes it for what is hidden. An `unknown` comes
from a chi squared test of what is left, its threshold tuned as well. On unseen configurations the chosen effects are
fitted on the plant and played. The Gaussian process names nothing: it learns what the refitted limb leaves of the
forces over posture, displacement and branch. All of them together took {median(seconds):.2f} s a case (median).""",
            _shares(us, them),
            "Paired: cases that only `brace diagnose` has right, to cases that only the baseline has; exact McNemar "
            "test, two-sided.",
            _pairs(found),
            *([f"Left out, since a baseline crashed there: {', '.join(lost)}."] if lost else []),
            "What they were tuned to:",
            "\n".join(knobs),
        ]
    )


def _shares(us: Sequence[Judged], them: dict[str, list[Judged]]) -> str:
    heads = [line.words for line in LINES]
    rows = [
        f"| | {' | '.join(heads)} | outsiders named | gap closed: median | 5th percentile |",
        "|---" * (len(heads) + 4) + "|",
    ]
    for name, judged in ((US, list(us)), *them.items()):
        cells = []
        for line in LINES:
            values = [value for j in judged if (value := line.right(j)) is not None]
            names = name != PROCESS and values
            cells.append(f"{100 * sum(values) / len(values):.1f} %" if names else "-")
        named = share((j for j in judged if j.kind == "outside"), "misnamed")
        cells.append(f"{100 * named.value:.1f} %" if name != PROCESS and named.value is not None else "-")
        middle, low, count = closed(judged)
        cells += [f"{100 * middle:.1f} %", f"{100 * low:.1f} %"] if count else ["-", "-"]
        rows.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(rows)


def _pairs(found: Sequence[Paired]) -> str:
    rows = [f"| | of | {' | '.join(NAMING)} |", "|---" * (len(NAMING) + 2) + "|"]
    for line in LINES:
        inside = [x for x in found if x.line is line]
        cells = [f"{x.ours} to {x.theirs}, p {_p(x.p)}" for x in inside]
        rows.append(f"| {line.words} | {inside[0].of} | {' | '.join(cells)} |")
    return "\n".join(rows)


def _p(value: float) -> str:
    return f"{value:.2f}" if value >= 0.095 else f"{value:.1g}"
