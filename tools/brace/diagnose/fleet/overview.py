"""The fleet's one page and its JSON: the limb that is furthest from its model first."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from brace.diagnose import plain_words as words
from brace.diagnose.digits import number, unit
from brace.diagnose.fleet.job import Outcome
from brace.diagnose.report import html
from brace.diagnose.report.html import text
from brace.diagnose.write import JSON, REPORT, plain


@dataclass(frozen=True)
class Line:
    """One limb. `distance` is its gap before in noise floors: what the ranking goes by."""

    name: str
    data: Mapping[str, Any]

    @property
    def distance(self) -> float:
        """How far the believed model is from the record, in noise floors; infinite where the record is
        faulty."""
        gap = self.data["gap"]
        if gap is None:
            return math.inf
        return float(_end(gap["before"])) / max(float(gap["noise_floor"]), 1e-12)

    @property
    def said(self) -> str:
        """The first effect, or nothing."""
        effects = self.data["effects"]
        return f"{effects[0]['name']}@{effects[0]['where']}" if effects else ""


def ranked(outcomes: Iterable[Outcome]) -> list[Line]:
    """Diagnosed limbs, the worst first; equal ones by name."""
    lines = [Line(outcome.name, outcome.data) for outcome in outcomes if outcome.done]
    return sorted(lines, key=lambda line: (-line.distance, line.name))


def as_json(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """fleet.json."""
    limbs = [
        {
            "name": line.name,
            "title": line.data["title"],
            "verdict": line.data["verdict"],
            "first": line.said or None,
            "gap_in_noise_floors": line.distance,
            "sentence": line.data["sentence"],
            "gap": line.data["gap"],
            "diagnosis": f"{line.name}/{JSON}",
        }
        for line in ranked(outcomes)
    ]
    broken = [{"name": o.name, "error": o.error, "exit_code": o.code} for o in _broken(outcomes)]
    found: dict[str, Any] = plain({"format": 1, "limbs": limbs, "broken": broken})
    return found


def as_lines(outcomes: Sequence[Outcome]) -> list[str]:
    """For the terminal."""
    lines = ranked(outcomes)
    width = max([len(line.name) for line in lines] + [5])
    shown = [
        f"{line.name:{width}}  {line.data['verdict']:10}  {_times(line.distance):>8}  "
        f"{_change(line.data):28}  {line.said}"
        for line in lines
    ]
    head = (
        [f"{'limb':{width}}  {'verdict':10}  {'x noise':>8}  {'misfit before -> after':28}  first"]
        if shown
        else []
    )
    return [line.rstrip() for line in head + shown]


def page(outcomes: Sequence[Outcome]) -> str:
    """fleet.html."""
    lines = ranked(outcomes)
    counts: dict[str, int] = {}
    for line in lines:
        counts[line.data["verdict"]] = counts.get(line.data["verdict"], 0) + 1
    broken = _broken(outcomes)
    tiles = "".join(
        html.tile(str(count), verdict.replace("_", " ")) for verdict, count in sorted(counts.items())
    )
    if broken:
        tiles += html.tile(str(len(broken)), "could not be read or diagnosed")
    worst = max([line.distance for line in lines if math.isfinite(line.distance)], default=1.0)
    rows = [
        [
            f'<span class="dot" style="--accent:var(--{line.data["verdict"]})"></span>'
            f'<a href="{text(_link(line.name))}">{text(line.name)}</a>'
            f'<br><span class="small">{text(line.data["title"])}</span>',
            text(line.data["verdict"].replace("_", " ")),
            html.bar(line.distance / worst if math.isfinite(line.distance) else 1.0),
            text(_times(line.distance)),
            text(_change(line.data)),
            text(words.label(line.said)) if line.said else "",
            text(line.data["sentence"]),
        ]
        for line in lines
    ]
    head = ("limb", "verdict", "", "misfit in noise floors", "misfit before → after", "first", "in words")
    errors = html.table(("dataset", "why"), [[text(o.name), f"<pre>{text(o.error)}</pre>"] for o in broken])
    body = (
        f"<header><h1>Fleet</h1><p class='lead'>{text(_sentence(lines, len(broken)))}</p>"
        f'<div class="tiles">{tiles}</div></header>\n'
        + html.section("Not diagnosed", errors)
        + html.section(
            "Worst first",
            html.paragraph(
                "Ordered by how far the believed model is from the record, in noise "
                "floors of that record.",
                "small",
            ),
            html.table(head, rows, numeric=(3,)),
        )
    )
    return html.document("Fleet", body)


def _sentence(lines: Sequence[Line], broken: int) -> str:
    faulty = sum(line.data["verdict"] == "data_fault" for line in lines)
    off = [line for line in lines if line.data["verdict"] not in ("none", "data_fault")]
    said = f"{len(off)} of {len(lines)} limb{'s' if len(lines) != 1 else ''} differ from their model"
    if len(off) == 1 or len(lines) == 1:
        said = said.replace("differ from their", "differs from its")
    if off:
        said += f"; {off[0].name} most"
    if faulty:
        said += f". {faulty} {'records are' if faulty > 1 else 'record is'} faulty"
    return said + (f". {broken} could not be diagnosed." if broken else ".")


def _broken(outcomes: Sequence[Outcome]) -> list[Outcome]:
    return sorted((o for o in outcomes if not o.done), key=lambda o: o.name)


def _end(pair: Mapping[str, Any]) -> float:
    """On held-out data, where there is some."""
    value = pair["held_out"] if pair["held_out"] is not None else pair["fitted"]
    return math.nan if value is None else float(value)


def _change(data: Mapping[str, Any]) -> str:
    gap = data["gap"]
    if gap is None:
        return ""
    return f"{number(_end(gap['before']))} -> {number(_end(gap['after']))} {unit(gap['unit'])}"


def _times(distance: float) -> str:
    return number(distance) if math.isfinite(distance) else "faulty"


def _link(name: str) -> str:
    from urllib.parse import quote

    return f"{quote(name)}/{REPORT}"
