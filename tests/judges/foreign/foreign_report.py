"""The foreign benchmark's page: what must be reached, where it fails, which case to look at."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import Any

import kept
import report
from scoring import CONFIDENT, Judged, Share, calibration
from verdicts import COVERED, SURE, Word
from words import FRICTION, OUTSIDERS, TROUBLES

HOW = """Records that neither the tool's plant nor its authors' simulator made
(tests/judges/foreign): joint tests of an actuator simulator with LuGre, Dahl and generalised
Maxwell-slip friction; loading records of a physics engine's limbs by instruments that misbehave; public measured
joint tests. Answers lie apart and are sealed before the run. Sizes are those of real joints, rigs and recorders,
without regard to how well they can be found."""

READING = f"""Intervals are Wilson's, 95 %. A name is right if it is hidden, if it names the trouble or the outsider
by a word of words.py, or if the class that it was named with has such a member. A gap
larger than the joint swung is wrong whatever its name. Calibration error: over all names, in ten bins; there a name
stands for itself alone. A trouble must be named where it leaves 8 sigmas after the base is refitted; noise and files'
troubles always. Outsiders: named with more than {CONFIDENT} in a verdict `effect`. Coverage: the interval of a
parameter, found from all gear positions but one, holds the true value of the one left out. A baseline's names count
as said with 0.95."""


RINGING = """## Limbs that ring

Loading records of limbs whose joints ring after each step, with LuGre's, Dahl's, Maxwell's slip or dry friction
(ringing.c). Every single effect leaves 8 sigmas or more on the limb that is played, after the base is refitted. A
sensor's zero wanders by 0.01 N, a third of its resolution, on sound limbs. These cases are in no other figure here."""


def nothing_hidden(w: Word) -> bool:
    """Healthy but for the instruments."""
    return not w.truth["effects"] and not w.truth["outside"] and bool(w.truth["trouble"])


def kind(w: Word) -> str:
    """As the tables have it."""
    return f"{w.truth['part']}: {w.truth['group']}/{w.truth['kind']}"


def figures(words: Sequence[Word], public: dict[str, Any]) -> list[dict[str, Any]]:
    """What must be reached."""
    sure = [claim for w in words for claim in w.claims if claim.confidence >= SURE]
    error, count = calibration_of(words)[:2]
    healthy = [w for w in words if nothing_hidden(w)]
    asked = [w for w in healthy if w.told is not None]
    outside = [w for w in words if w.misnamed is not None]
    evidence = [w for w in words if w.truth["evidence"]]
    held = [h for w in words for h in w.covered.values() if h is not None]
    coverage = Share(sum(held), len(held))
    ratios = [one["ratio"] for one in public.get("left_out", [])]
    met = [r is not None and r <= 1.05 for r in ratios]
    worst = "no model" if None in ratios else f"{max(ratios):.2f}" if ratios else "-"
    low = coverage.value is not None and 0.80 <= coverage.value <= 0.95
    return [
        report.at_least(
            f"everything named with {SURE} or more: right", Share(sum(c.in_class for c in sure), len(sure)), 0.95
        ),
        report.line("calibration error over all names", "at most 0.05", report.if_any(error <= 0.05, count),
                    f"{error:.3f}", "", count),
        report.at_most("nothing hidden, a trouble of the instruments: anything named wrongly",
                       Share(sum(w.wrongly_named for w in healthy), len(healthy)), 0.01),
        report.at_least(
            "nothing hidden: the trouble named instead", Share(sum(bool(w.told) for w in asked), len(asked)), 0.90
        ),
        report.at_most(
            f"outsiders named with more than {CONFIDENT}",
            Share(sum(bool(w.misnamed) for w in outside), len(outside)),
            0.02,
        ),
        report.share_line("90 % intervals hold what a gear position left out has", "80 to 95 %", coverage, low),
        report.line("measured sets, each amplitude predicted from the others: rms against five numbers, worst",
                    "at most 1.05 in each",
                    report.if_any(all(met), len(met)), worst,
                    f"{sum(met)} of {len(met)} within", len(met)),
        report.at_most(f"known failures, rebuilt: wrong with {CONFIDENT} or more",
                       Share(sum(bool(w.wrong(CONFIDENT)) for w in evidence), len(evidence)), 0.0),
    ]  # fmt: skip


def of_ringing(words: Sequence[Word]) -> list[dict[str, Any]]:
    """What must be reached of limbs that ring."""
    singles = [w for w in words if w.truth["effects"]]
    sound = [w for w in words if not w.truth["effects"]]
    rubbing = [w for w in singles if w.truth["effects"][0]["name"] in FRICTION]
    named = [any(c.in_class for c in w.claims) for w in singles]
    as_friction = [any(c.label.split("@")[0] in FRICTION for c in w.claims) for w in rubbing]
    nothing = [not w.claims and w.verdict != "data_fault" for w in sound]
    return [
        report.at_least("one effect in a limb that rings, s >= 8: named, or its class",
                        Share(sum(named), len(named)), 0.90),
        report.at_most(f"one effect in a limb that rings: anything wrong with {CONFIDENT} or more",
                       Share(sum(bool(w.wrong(CONFIDENT)) for w in singles), len(singles)), 0.0),
        report.at_least("friction named as friction", Share(sum(as_friction), len(as_friction)), 0.90),
        report.at_least("sound limb, a zero that wanders by a third of the resolution: no name and no fault",
                        Share(sum(nothing), len(nothing)), 0.95),
    ]  # fmt: skip


def calibration_of(words: Sequence[Word]) -> tuple[float, int, list[tuple[float, float, int]]]:
    """As tests/judges/blind/scoring.py has it, of these claims."""
    claims = [(c.confidence, c.right) for w in words for c in w.claims]
    return calibration([Judged("", "", 0.0, [], set(), "", [], claims=claims)])


def besides(words: Sequence[Word]) -> list[tuple[str, Share]]:
    """Without a limit."""
    sound = [w for w in words if not (w.truth["effects"] or w.truth["outside"] or w.truth["trouble"])]
    hidden = [w for w in words if w.found is not None]
    clean = [w for w in hidden if not w.truth["trouble"] and not w.truth["outside"]]
    beside = [w for w in hidden if w.truth["trouble"]]
    asked_of = [w for w in beside if w.told is not None]
    outside = [w for w in words if w.misnamed is not None]
    wrong = [c for w in words if w.truth["part"] == "joint" for c in w.claims if c.confidence >= SURE]
    other = [c for w in words if w.truth["part"] == "loading" for c in w.claims if c.confidence >= SURE]
    sizes = [s for w in words for s in w.sizes]
    asked = [h for w in words if w.truth.get("left_out") for h in w.covered.values()]
    return [
        ("joint tests: named with 0.9 or more and right", Share(sum(c.in_class for c in wrong), len(wrong))),
        ("loading records: named with 0.9 or more and right", Share(sum(c.in_class for c in other), len(other))),
        ("nothing at all is wrong: named wrongly", Share(sum(w.wrongly_named for w in sound), len(sound))),
        ("all hidden effects named, good instruments", Share(sum(bool(w.found) for w in clean), len(clean))),
        ("all hidden effects named, beside a trouble", Share(sum(bool(w.found) for w in beside), len(beside))),
        ("the trouble named, beside an effect", Share(sum(bool(w.told) for w in asked_of), len(asked_of))),
        ("outsiders called unknown or by their name", Share(sum(bool(w.told) for w in outside), len(outside))),
        ("gear positions: parameters reported with an interval", Share(sum(h is not None for h in asked), len(asked))),
        (
            "joint tests: right names whose size is within a factor of two",
            Share(sum(0.5 <= s <= 2.0 for s in sizes), len(sizes)),
        ),
        ("records that end without a diagnosis", Share(sum(w.verdict == "nothing" for w in words), len(words))),
    ]


def by_kind(words: Sequence[Word]) -> str:
    """Each kind: how many, wrong with 0.9, named, found; what was said first; one case to look at."""
    rows = ["| kind | cases | wrong with 0.9 or more | all hidden named | trouble or outsider named | "
            "said, of a case that fails |",
            "|---|---|---|---|---|---|"]  # fmt: skip
    groups: dict[str, list[Word]] = defaultdict(list)
    for w in words:
        groups[kind(w)].append(w)

    def counted(which: list[Word], value: Callable[[Word], bool | None]) -> str:
        asked = [v for v in map(value, which) if v is not None]
        return f"{sum(asked)} of {len(asked)}" if asked else "-"

    for name in sorted(groups):
        those = groups[name]
        failing = [w for w in those if w.wrong(SURE) or w.misnamed or w.told is False or w.note.startswith("Trace")]
        failing.sort(key=lambda w: -len(w.wrong(SURE)))
        example = f"`{failing[0].truth['id']}` {_said(failing[0])}" if failing else ""
        rows.append(f"| {name} | {len(those)} | {sum(bool(w.wrong(SURE)) for w in those)} | "
                    f"{counted(those, lambda w: w.found)} | {counted(those, lambda w: w.told)} | "
                    f"{example} |")  # fmt: skip
    return "\n".join(rows)


def _said(w: Word) -> str:
    names = ", ".join(f"{c.label} {c.confidence:.2f}" for c in w.claims)
    more = "; ".join([*w.impossible, *(w.note.strip().splitlines()[-1:] if w.verdict == "nothing" else [])])
    return f"{w.verdict}: {names or '-'}" + (f" ({more})" if more else "")


def coverage_rows(words: Sequence[Word]) -> str:
    """By parameter."""
    rows = ["| parameter | interval holds the position left out | no interval given |", "|---|---|---|"]
    for leaf in COVERED:
        held = [w.covered[leaf] for w in words if leaf in w.covered]
        given = [h for h in held if h is not None]
        rows.append(f"| {leaf} | {sum(given)} of {len(given)} | {len(held) - len(given)} of {len(held)} |")
    return "\n".join(rows)


def evidence_rows(words: Sequence[Word]) -> str:
    """The known failures, case by case kind."""
    rows = ["| known failure | wrong with 0.8 or more | said |", "|---|---|---|"]
    groups: dict[str, list[Word]] = defaultdict(list)
    for w in words:
        if w.truth["evidence"]:
            groups[w.truth["evidence"]].append(w)
    for name, those in sorted(groups.items()):
        wrong = [w for w in those if w.wrong(CONFIDENT)]
        first = (wrong or those)[0]
        rows.append(f"| {name} | {len(wrong)} of {len(those)} | `{first.truth['id']}` {_said(first)} |")
    return "\n".join(rows)


def measured_text(public: dict[str, Any]) -> str:
    """Of the public sets."""
    if not public:
        return "Not run: BRACE_REAL_DATA names no folder."
    rows = ["| set | left out: the tests that swing | rms of the tool's model [N mm] | five-parameter fit | ratio | "
            "deviation of the torque there |",
            "|---|---|---|---|---|---|"]  # fmt: skip
    for one in public["left_out"]:
        tool, ratio = ("none", "-") if one["tool"] is None else (f"{one['tool']:.0f}", f"{one['ratio']:.2f}")
        rows.append(f"| {one['set']} | {one['left_out_mrad']:.0f} mrad | {tool} | {one['five']:.0f} | {ratio} | "
                    f"{one['deviation']:.0f} |")  # fmt: skip
    rows += ["", "| set | what its authors or the record say | diagnosis agrees |", "|---|---|---|"]
    rows += [f"| {name} | {what} | {'yes' if ok else 'NO'} |" for name, what, ok in public["checks"]]
    rows += ["", "| gear position left out: five numbers there | held by the interval of the two others |", "|---|---|"]
    rows += [f"| {what} | {'-' if ok is None else 'yes' if ok else 'NO'} |" for what, ok in public["positions"]]
    rows += ["", "| set | verdict | said |", "|---|---|---|"]
    for name, d in public["said"].items():
        rows.append(f"| {name} | {d['verdict']} | {', '.join(f'{n} {c:.2f}' for n, c in d['effects']) or '-'} |")
    return "\n".join(rows)


def table(lines: Sequence[dict[str, Any]], beside: Sequence[dict[str, Any]]) -> str:
    """What must be reached, with the baselines' figures in a column."""
    other = {one["figure"]: one["measured"] for one in beside}
    rows = ["| figure | must | measured | 95 % | of | | baselines |", "|---|---|---|---|---|---|---|"]
    for one in lines:
        same = (
            other.get(one["figure"], "")
            if "measured sets" not in one["figure"] and "intervals" not in one["figure"]
            else ""
        )
        rows.append(f"| {one['figure']} | {one['target']} | {one['measured']} | {one['interval']} | {one['of']} | "
                    f"{one['met']} | {same} |")  # fmt: skip
    return "\n".join(rows)


def words_text() -> str:
    """The table of accepted words."""
    rows = [
        "| trouble or outsider | named by | verdicts that name it | silence is right | because |",
        "|---|---|---|---|---|",
    ]
    for name, may in {**TROUBLES, **OUTSIDERS}.items():
        rows.append(f"| {name} | {', '.join(may.names) or '-'} | {', '.join(may.verdicts) or '-'} | "
                    f"{'yes' if may.silence else 'no'} | {may.reason} |")  # fmt: skip
    return "\n".join(rows)


def _runs(parts: dict[str, Any]) -> str:
    """Which run each part is from."""
    lines = []
    for name, part in sorted(parts.items()):
        how = part["made"]
        if "cases" not in how:
            lines.append(f"- {name}: `{how['command']}`, tool {how['tool']}.")
            continue
        share = f" of the plan's {how['of_plan']}, the first in an order that the seed draws"
        share = "" if how["cases"] == how["of_plan"] else share
        lines.append(
            f"- {name}: `{how['command']}`, {how['cases']} cases{share}; {how['set']} set, seed {how['seed']}, answers "
            f"sealed {how['seal_sha256'][:16]}, tool {how['tool']}.{how.get('note', '')}"
        )
    lines += [f"- {name}: not run." for name in ("joint", "loading", "ringing", "measured") if name not in parts]
    return "\n".join(lines)


def made(parts: dict[str, Any]) -> tuple[str, str, dict[str, Any]]:
    """Table, page and figures of what all parts have left (kept.py)."""
    ringing = kept.words_of({name: part for name, part in parts.items() if name == "ringing"}, "cases")
    others_of = {name: part for name, part in parts.items() if name != "ringing"}
    words, beside = kept.words_of(others_of, "cases"), kept.words_of(others_of, "baselines")
    public = parts.get("measured", {}).get("public", {})
    lines, others = figures(words, public), figures(beside, {}) if beside else []
    rung = of_ringing(ringing)
    first = table([*lines, *rung], others)
    error, count, bins = calibration_of(words)
    calibrated = ["| mean confidence | share right | names |", "|---|---|---|"]
    calibrated += [f"| {c:.2f} | {r:.2f} | {n} |" for c, r, n in bins]
    more = ["| | share | |", "|---|---|---|"]
    for name, share in besides(words):
        more.append(
            f"| {name} | {'-' if share.value is None else f'{100 * share.value:.1f} %'} | {share.hits} of {share.of} |"
        )
    page = "\n\n".join([
        "# Foreign worlds", HOW, _runs(parts), first, READING, "## Besides", "\n".join(more), "## Kind by kind",
        by_kind(words), RINGING, by_kind(ringing),
        "## Known failures, rebuilt", evidence_rows(words), "## Gear positions", coverage_rows(words),
        "## Measured sets", measured_text(public), "## Confidence against share right", "\n".join(calibrated),
        "## Words that name a trouble or an outsider", words_text(),
    ]) + "\n"  # fmt: skip
    content = {
        "lines": [*lines, *rung], "baselines": others, "calibration_error": None if math.isnan(error) else error,
        "names": count, "besides": {n: [s.hits, s.of] for n, s in besides(words)},
        "columns": list(kept.COLUMNS), "reading": kept.READING, "parts": parts,
    }  # fmt: skip
    return first, page, content


def by_case(words: Sequence[Word]) -> list[dict[str, Any]]:
    """One entry a case."""
    return [
        {"id": w.truth["id"], "kind": kind(w), "verdict": w.verdict, "hidden": [e["name"] for e in w.truth["effects"]],
         "trouble": w.truth["trouble"], "trouble_s": w.truth.get("trouble_s"), "outside": w.truth["outside"],
         "said": [[c.label, c.confidence, c.in_class] for c in w.claims], "impossible": w.impossible, "told": w.told,
         "found": w.found, "misnamed": w.misnamed, "covered": w.covered, "note": w.note}
        for w in words
    ]  # fmt: skip
