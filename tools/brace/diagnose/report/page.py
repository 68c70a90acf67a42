"""The page of one diagnosis, from the sentence down to the hashes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from brace.dataset import Dataset
from brace.diagnose import plain_words as words
from brace.diagnose.already import only_sizes
from brace.diagnose.beside import beside
from brace.diagnose.diagnosis import Diagnosis, NamedEffect
from brace.diagnose.export import changed
from brace.diagnose.report import html
from brace.diagnose.report.html import text
from brace.diagnose.report.views import View, view
from brace.model import LimbModel

if TYPE_CHECKING:
    from brace.diagnose.provenance import Provenance

MOST_FAULTS, MOST_CANDIDATES = 60, 14
MOST_SURE = 0.999  # of what is told from a number of played tests


def page(
    dataset: Dataset, believed: LimbModel | None, found: Diagnosis, origin: Provenance, processes: int = 1
) -> str:
    """report.html. A second process draws some of the pictures, where `processes` has one."""
    seen = view(dataset, found)
    faulty = found.verdict == "data_fault"

    def gap() -> str:
        return _gap(believed, found, seen)

    with beside(gap, gap, processes if found.gap is not None else 1) as closed:
        where, how_far = _where(believed, found, seen), closed()
    parts = [
        _top(believed, found, origin),
        _faults(found) if faulty else "",
        where,
        _missing(believed, found),
        how_far,
        _unexplained(found),
        _apart(found),
        _next(found),
        "" if faulty else _faults(found),
        _candidates(found),
        html.section("Notes", html.bullets(found.notes)),
        _origin(found, origin),
    ]
    headline = _headline(believed, found)
    return html.document(f"{origin.name}: {headline}", "\n".join(part for part in parts if part))


def _headline(believed: LimbModel | None, found: Diagnosis) -> str:
    if found.verdict == "effect" and only_sizes(believed, found):
        return "What the model has is of another size in the record, and it has a name"
    return words.verdict(found)


def _not_held_out(found: Diagnosis) -> str:
    """Parts of the record may be predicted from its rest all the same."""
    return "no configuration or test could be held out" if found.held_out else "nothing could be held out"


def _before(believed: LimbModel | None) -> str:
    """What the record is compared with first."""
    return "the model as given" if believed is not None else "a spring alone, fitted"


def _top(believed: LimbModel | None, found: Diagnosis, origin: Provenance) -> str:
    limb = f"limb “{believed.name}”" if believed is not None else "no model given: a spring alone"
    tiles = []
    if found.effects and found.verdict in ("effect", "ambiguous"):
        first = found.effects[0]
        tiles.append(html.tile(words.percent(first.confidence), f"sure that it is {words.named(first)}"))
    if found.gap is not None:
        gap, unit = found.gap, words.unit(found.gap.unit)
        held = gap.before.held_out is not None and gap.after.held_out is not None
        ends = (gap.before.held_out, gap.after.held_out) if held else (gap.before.fitted, gap.after.fitted)
        where = "on what took no part" if held else f"on what was fitted; {_not_held_out(found)}"
        if found.verdict in ("effect", "ambiguous", "unknown"):
            arrow = f"{words.number(ends[0] or 0.0)} → {words.number(ends[1] or 0.0)} {unit}"
            tiles.append(html.tile(arrow, f"gap before and after, {where}"))
        else:
            tiles.append(
                html.tile(f"{words.number(ends[0] or 0.0)} {unit}", f"gap of {_before(believed)}, {where}")
            )
        tiles.append(
            html.tile(
                f"{words.number(gap.noise_floor)} {unit}", "noise floor: what the readings’ noise leaves of any model"
            )
        )
    inside = f'<div class="tiles">{"".join(tiles)}</div>' if tiles else ""
    return (
        f'<header style="--accent:var(--{found.verdict})">\n<h1>{text(origin.name)} · {text(limb)}</h1>\n'
        f'<span class="badge">{text(_headline(believed, found))}</span>\n'
        f'<p class="lead">{text(found.sentence)}</p>\n{inside}\n</header>'
    )


def _where(believed: LimbModel | None, found: Diagnosis, seen: View | None) -> str:
    rows = [
        [text(spot.where), f"{words.number(spot.size)} {text(_unit(found))}", text(_chance(spot.p))]
        for spot in found.localised
    ]
    table = html.table(("where", "size (rms)", "by chance"), rows, numeric=(1, 2))
    lead = (
        "Contrasts over the record, each tested by shuffling; 'by chance' is for all of them together."
        if rows
        else "No contrast over load, direction, configuration, order, time or temperature stands out."
    )
    drawn = ""
    if seen is not None and found.gap is not None:
        from brace.diagnose.report import pictures

        whose = (
            _capital(_before(believed))
            if seen.refitted is None
            else "The model refitted within its calibration’s trust"
        )
        shown = f"{whose}. Lines: means of neighbouring readings. Grey band: two noise floors either side."
        drawn = html.picture(pictures.disagreement(seen, found.gap), shown)
    if found.gap is None and not rows:
        return ""
    return html.section("Where they disagreed", html.paragraph(lead), table, drawn)


def _missing(believed: LimbModel | None, found: Diagnosis) -> str:
    if not found.effects:
        return html.section("What was refitted", _base(believed, found))
    rows = []
    for effect in found.effects:
        for index, (key, held) in enumerate(effect.parameters.items()):
            rows.append(
                [
                    _named(effect) if index == 0 else "",
                    html.code(key),
                    text(words.value_with_unit(key, held.value)),
                    text(words.interval(held)),
                    text(
                        words.number(believed.number(key))
                        if believed is not None and _is_number(believed, key)
                        else "–"
                    ),
                ]
            )
        if not effect.parameters:
            rows.append([_named(effect), "", "", "", ""])
    head = ("effect", "key of limb.toml", "value", "90 % interval", "before")
    title = "What it could be"
    if found.verdict == "effect":
        title = "What is of another size" if only_sizes(believed, found) else "What was missing"
    meanings = [
        f"{words.effect(effect.name)[0].upper()}{words.effect(effect.name)[1:]}: "
        f"{words.meaning(effect.name)}."
        for index, effect in enumerate(found.effects)
        if words.meaning(effect.name) and effect.name not in {before.name for before in found.effects[:index]}
    ]
    return html.section(
        title,
        *(html.paragraph(meaning) for meaning in meanings),
        html.table(head, rows, numeric=(2, 3, 4)),
        _base(believed, found),
    )


def _named(effect: NamedEffect) -> str:
    sure = f"{words.percent(effect.confidence)} sure, {words.percent(effect.gap_share)} of what was closed"
    return (
        f"<b>{text(words.named(effect))}</b><br>{html.code(effect.label)}"
        f'<br><span class="small">{text(sure)}</span>'
    )


def _is_number(model: LimbModel | None, key: str) -> bool:
    return model is not None and isinstance(model.values.get(key), (int, float))


def _base(believed: LimbModel | None, found: Diagnosis) -> str:
    """What was refitted besides, within the calibration's trust."""
    if believed is None:
        return ""
    named = {key for effect in found.effects for key in effect.parameters}
    rows = [
        [
            html.code(key),
            text(_shown(believed, key)),
            text(_shown(found.model, key)),
            text(words.key_unit(key)),
        ]
        for key in changed(believed, found.model)
        if key not in named
    ]
    if not rows:
        return ""
    inside = html.table(("key", "before", "after", "unit"), rows, numeric=(1, 2))
    count = f"{len(rows)} value{'s' if len(rows) > 1 else ''}"
    summary = f"<summary>{count} refitted besides, within the calibration’s trust</summary>"
    return f"<details>{summary}{inside}</details>"


def _shown(model: LimbModel, key: str) -> str:
    value = model.values[key]
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def _gap(believed: LimbModel | None, found: Diagnosis, seen: View | None) -> str:
    if found.gap is None:
        return ""
    from brace.diagnose.report import pictures

    parts = []
    if seen is not None:
        if seen.kind != "stiffness_table":
            parts.append(
                html.picture(pictures.loops(seen), f"The runs where {_before(believed)} was furthest off.")
            )
        parts.append(
            html.picture(
                pictures.gap(seen, found.gap),
                "Every reading in the record’s order, on the same axes; grey: two noise floors. "
                "What was held out took no part in choosing or fitting.",
            )
        )
    parts.append(
        html.picture(pictures.steps(found.gap, _before(believed)), "The gap after each thing that was added.")
    )
    if found.held_out:
        lead = "The model fitted to the rest of the record predicts the part that was held out:"
        items = [words.held_out(part, found.gap.unit) for part in found.held_out]
        parts.append(html.paragraph(lead) + html.bullets(items))
    if found.gap.after.held_out is None:
        parts.append(
            html.paragraph(f"{_capital(_not_held_out(found))}, so the gap after is one of fitting only.", "small")
        )
    return html.section("The gap before and after", *parts)


def _unexplained(found: Diagnosis) -> str:
    left = found.unexplained
    if left is None:
        return ""
    size = f"{words.number(left.rms)} {_unit(found)}"
    lead = (
        f"{size} (rms) is left, and it has structure: it is not noise alone. It is not exported as physics."
        if left.structured
        else f"{size} (rms) is left, without structure: as far as this record can tell, it is noise."
    )
    return html.section(
        "What stays unexplained", html.paragraph(lead), html.paragraph(_capital(left.description))
    )


def _apart(found: Diagnosis) -> str:
    parts = [
        '<div class="class"><p>'
        + " <b>or</b> ".join(f"{text(words.label(member))} {html.code(member)}" for member in members)
        + "</p></div>"
        for members in found.indistinguishable
    ]
    if parts:
        parts.insert(
            0, html.paragraph("In this record these leave nearly the same trace. How likely each is stands above.")
        )
    if found.members:
        parts.append(_members(found))
    rest = [label for label in found.could_be if label not in {m for c in found.indistinguishable for m in c}]
    if rest:
        parts.append(
            html.paragraph("It could also be: " + "; ".join(words.label(label) for label in rest) + ".")
        )
    return html.section("What cannot be told apart", *parts)


def _members(found: Diagnosis) -> str:
    """What each explanation would mean for K."""
    at = found.members[0].k
    head = ("explanation", "probability", "K xx", "K xz", "K zz [N/mm]")
    rows = [
        [
            html.code(one.label),
            text(words.percent(one.probability)),
            *(text(words.number(k)) for k in (one.k.k_xx_n_per_mm, one.k.k_xz_n_per_mm, one.k.k_zz_n_per_mm)),
        ]
        for one in found.members
    ]
    return html.paragraph(
        f"K without load at theta1 {at.theta1_rad:.3f}, theta2 {at.theta2_rad:.3f} rad, where they differ most:"
    ) + html.table(head, rows, numeric=(1, 2, 3, 4))


def _next(found: Diagnosis) -> str:
    after = found.next_experiment
    if after is None:
        return ""
    parts = [html.paragraph(_capital(after.action))]
    if after.separates:
        labels = [words.label(label) for label in after.separates]
        parts.append(
            html.paragraph(
                f"It would tell apart: {'; '.join(labels)}. It would succeed with a probability of "
                f"{words.percent(min(after.power, MOST_SURE))} and takes about {words.number(after.minutes)} minutes."
            )
        )
    if after.rig_toml:
        parts.append(
            html.paragraph(
                "As a rig file (one click selects it all); save it as rig.toml, then "
                "brace simulate --model limb.toml --rig rig.toml --out DIR plays it, as the rig does."
            )
        )
        parts.append(f"<pre>{text(after.rig_toml)}</pre>")
    return html.section("What to measure next", *parts)


def _faults(found: Diagnosis) -> str:
    rows = [
        [
            text("all" if fault.row is None else fault.row),
            html.code(fault.field),
            text(fault.why),
            text("" if fault.suggestion is None else fault.suggestion),
        ]
        for fault in found.data_faults[:MOST_FAULTS]
    ]
    more = len(found.data_faults) - MOST_FAULTS
    rest = html.paragraph(f"and {more} more, in diagnosis.json") if more > 0 else ""
    return html.section(
        "Faults of the record", html.table(("row", "field", "why", "it should probably be"), rows), rest
    )


def _candidates(found: Diagnosis) -> str:
    if not found.candidates:
        return ""
    best = max(max(tried.gain for tried in found.candidates), 1e-12)
    rows = [
        [
            (
                f"{text(words.label(tried.label))}<br>{html.code(tried.label)}"
                if "@" in tried.label
                else text(tried.label)
            ),
            f"{html.bar(tried.gain / best)}",
            text(words.number(tried.gain)),
            text(words.percent(tried.posterior)),
        ]
        for tried in found.candidates[:MOST_CANDIDATES]
    ]
    lead = (
        "Each was fitted to the whole sequence. Gain: twice the log-likelihood won over the refitted model "
        "without "
        "it. A larger model is not a better one; the share of belief weighs that."
    )
    more = len(found.candidates) - MOST_CANDIDATES
    rest = html.paragraph(f"and {more} more, in diagnosis.json", "small") if more > 0 else ""
    return html.section(
        "What was tried",
        html.paragraph(lead),
        html.table(("candidate", "", "gain", "share of belief"), rows, numeric=(2, 3)),
        rest,
    )


def _origin(found: Diagnosis, origin: Provenance) -> str:
    rows = [
        ["record", text(f"{origin.name}: {origin.kind.replace('_', ' ')}, {origin.rows} rows")],
        [
            "data sha256",
            f"<code class='hash'>{origin.data_sha256}</code> <span class='small'>(meta.toml, then "
            "data.csv)</span>",
        ],
    ]
    if origin.model_sha256:
        rows.append(
            [
                "model sha256",
                f"<code class='hash'>{origin.model_sha256}</code> <span class='small'>(as believed)</span>",
            ]
        )
    rows.append(["seed", str(found.seed)])
    rows.append(["versions", text(", ".join(f"{name} {value}" for name, value in origin.versions.items()))])
    return html.section(
        "Made from",
        html.table(("", ""), rows),
        html.paragraph(
            "The same data, model, seed and versions give this page again, byte for byte.", "small"
        ),
    )


def _capital(words_: str) -> str:
    return words_[:1].upper() + words_[1:]


def _unit(found: Diagnosis) -> str:
    return words.unit(found.gap.unit) if found.gap else ""


def _chance(p: float) -> str:
    return f"p = {p:.1g}" if p >= 1e-4 else "p < 0.0001"
