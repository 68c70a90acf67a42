"""report.html of one diagnosis, from the sentence down to the hashes. What it says stands in `facts`, how it looks in
`html` and `pictures`; here is only the order."""

from __future__ import annotations

from brace.dataset import Dataset
from brace.diagnose.beside import beside
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.provenance import Provenance
from brace.diagnose.report import html
from brace.diagnose.report.facts import Facts, Parameter, facts
from brace.diagnose.report.html import text
from brace.model import LimbModel

SHOWN_CANDIDATES = 5  # the rest is folded
BAND = "Grey band: two noise floors either side."


def page(
    dataset: Dataset, believed: LimbModel | None, found: Diagnosis, origin: Provenance, processes: int = 1
) -> str:
    """report.html. A second process draws some of the pictures, where `processes` has one."""
    said = facts(dataset, believed, found, origin)
    with beside(lambda: _compared(said), lambda: _compared(said), processes if said.view is not None else 1) as drawn:
        above, compared = _disagreement(said), drawn()
    faulty = said.verdict == "data_fault"
    parts = [
        _top(said),
        _faults(said) if faulty else "",
        above,
        _missing(said),
        compared,
        html.section("What stays unexplained", *(html.paragraph(one) for one in said.unexplained)),
        _apart(said),
        _next(said),
        "" if faulty else _faults(said),
        _candidates(said),
        html.section("Notes", html.bullets(said.notes)),
        _origin(said),
    ]
    return html.document(f"{said.record}: {said.headline}", "\n".join(part for part in parts if part))


def _top(said: Facts) -> str:
    widths = ("", "", "broad", "wide")
    answers = "".join(
        html.answer(one.question, one.short, one.more, width) for one, width in zip(said.answers, widths, strict=True)
    )
    names = " · ".join(one for one in (said.record, said.limb) if one)
    return (
        f'<header style="--accent:var(--{said.verdict})">\n<h1>{text(names)}</h1>\n'
        f'<span class="badge">{text(said.headline)}</span>\n<p class="lead">{text(said.sentence)}</p>\n'
        f'{"".join(html.paragraph(one, "caution") for one in said.cautions)}'
        f'<div class="tiles">{answers}</div>\n{html.paragraph(said.misfit, "small") if said.misfit else ""}\n</header>'
    )


def _disagreement(said: Facts) -> str:
    """The believed model first, then what refitting its calibrated numbers leaves of it."""
    if not said.believed_words:
        return ""
    from brace.diagnose.report import pictures

    parts = [html.paragraph(said.believed_words)]
    if said.view is not None:
        shown = f"{said.view.given[:1].upper()}{said.view.given[1:]}. Lines: means of neighbouring readings. {BAND}"
        parts.append(html.pictures(pictures.disagreement(said.view, said.view.before, "believed"), shown))
    parts += [html.paragraph(words) for words in (said.refit_words, said.spots_words) if words]
    rows = [[text(one.where), text(one.size), text(one.share)] for one in said.spots]
    has_shares = any(one.share for one in said.spots)
    head = ("where", "size (rms)", "share of this misfit")[: 3 if has_shares else 2]
    parts.append(html.table(head, [row[: len(head)] for row in rows], numeric=(1, 2)))
    if said.view is not None and said.view.refitted is not None:
        shown = f"The same model with its calibrated numbers refitted and nothing added. {BAND}"
        parts.append(html.pictures(pictures.disagreement(said.view, said.view.refitted, "refitted"), shown))
    return html.section("The model beside the record" if said.verdict == "none" else "Where they disagreed", *parts)


def _missing(said: Facts) -> str:
    head = ("effect", "key of limb.toml", "believed", "found, with the unit of all three", "90 % interval")
    parts = [html.paragraph(one) for one in said.meanings]
    parts.append(html.table(head, [_parameter(one) for one in said.parameters], numeric=(2, 3, 4)))
    if said.k_lines:
        sure = any(one.sure for one in said.k_lines)
        k_head = ["model", *(["probability"] if sure else []), "K xx [N/mm]", "K xz [N/mm]", "K zz [N/mm]"]
        rows = [
            [html.code(one.model) if sure else text(one.model), *([text(one.sure)] if sure else []), *map(text, one.k)]
            for one in said.k_lines
        ]
        parts.append(html.paragraph(said.k_words) + html.table(k_head, rows, numeric=range(1, len(k_head))))
    if said.refitted:
        inside = html.table(
            ("key", "believed", "found", "unit"),
            [[html.code(key), text(before), text(after), text(unit)] for key, before, after, unit in said.refitted],
            numeric=(1, 2),
        )
        parts.append(html.details(said.refitted_words, inside))
    return html.section(said.missing_title, *parts)


def _parameter(one: Parameter) -> list[str]:
    named = (
        f'<b>{text(one.effect)}</b><br>{html.code(one.label)}<br><span class="small">{text(one.sure)}</span>'
        if one.effect
        else ""
    )
    key = html.code(one.key) if one.key else ""
    return [named, key, text(one.believed), text(one.found), text(one.interval)]


def _compared(said: Facts) -> str:
    """The misfit of each model, and the believed one beside the one that was found."""
    if not said.steps:
        return ""
    from brace.diagnose.report import pictures

    held = any(one.held_out for one in said.steps)
    has_pull = any(one.pull for one in said.steps)
    rms = f" (rms) [{said.unit}]"
    head = ["model", f"fitted{rms}", *([f"held out{rms}"] if held else [])]
    head += ["from its calibration"] if has_pull else []
    rows = []
    for one in said.steps:
        kind = "beyond" if one.is_beyond else ""
        row = [text(one.model), f"{html.bar(one.fitted_share, kind)} {text(one.fitted)}"]
        row += [f"{html.bar(one.held_out_share, kind)} {text(one.held_out)}"] if held else []
        rows.append(row + ([text(one.pull)] if has_pull else []))
    hatched = " Hatched: a model that its calibration does not allow." if any(one.is_beyond for one in said.steps) else ""
    parts = [
        html.table(head, rows, numeric=[len(head) - 1] if has_pull else []),
        html.paragraph(f"{said.misfit} Each model was fitted without what was held out.{hatched}", "small"),
    ]
    if said.view is not None:
        if said.view.kind != "stiffness_table":
            shown = f"The runs where {said.view.given} was furthest off."
            parts.append(html.pictures(pictures.loops(said.view), shown))
        shown = (
            f"Every reading in the record’s order, on the same axes. {BAND} What was held out took no part in choosing "
            "or fitting."
        )
        parts.append(html.pictures(pictures.misfit(said.view), shown))
    if said.held_out:
        lead = "The model fitted to the rest of the record predicts the part that was held out:"
        parts.append(html.paragraph(lead) + html.bullets(said.held_out))
    if said.not_held_out:
        parts.append(html.paragraph(said.not_held_out, "small"))
    return html.section("The misfit before and after", *parts)


def _apart(said: Facts) -> str:
    parts = [
        '<div class="class"><p>'
        + " <b>or</b> ".join(f"{text(words)} {html.code(label)}" for words, label in members)
        + "</p></div>"
        for members in said.classes
    ]
    if parts:
        parts.insert(0, html.paragraph(said.classes_words))
    if said.could_be:
        parts.append(html.paragraph(said.could_be))
    return html.section("What looks alike" if said.verdict == "effect" else "What cannot be told apart", *parts)


def _next(said: Facts) -> str:
    parts = [html.paragraph(one) for one in said.next_words]
    if said.rig_toml:
        parts.append(
            html.paragraph(
                "As a rig file (one click selects it all); save it as rig.toml, then "
                "brace simulate --model limb.toml --rig rig.toml --out DIR plays it, as the rig does."
            )
        )
        parts.append(f"<pre>{text(said.rig_toml)}</pre>")
    return html.section("What to measure next", *parts)


def _faults(said: Facts) -> str:
    rows = [[text(row), html.code(field), text(why), text(better)] for row, field, why, better in said.faults]
    rest = html.paragraph(f"and {said.more_faults} more, in diagnosis.json") if said.more_faults else ""
    table = html.table(("row", "field", "why", "it should probably be"), rows)
    return html.section("Faults of the record", table, rest)


def _candidates(said: Facts) -> str:
    if not said.candidates:
        return ""
    rows = [
        [
            f"{text(one.words)}<br>{html.code(one.label)}" if one.label else text(one.words),
            text(one.less_likely),
            html.bar(one.gain_share),
            text(one.gain),
        ]
        for one in said.candidates
    ]
    lead = (
        "Each was fitted to the whole sequence; the likeliest first. Gain: twice the log-likelihood won over the "
        "refitted model without it. A larger model is not a better one: how likely it is counts its freedoms, too."
    )
    head = ("candidate", "less likely than the first", "", "gain")
    parts = [html.paragraph(lead), html.table(head, rows[:SHOWN_CANDIDATES], numeric=(1, 3))]
    rest = html.paragraph(f"and {said.more_candidates} more, in diagnosis.json", "small") if said.more_candidates else ""
    if folded := rows[SHOWN_CANDIDATES:]:
        parts.append(html.details(f"{len(folded)} more", html.table(head, folded, numeric=(1, 3)) + rest))
    return html.section("What was tried", *parts)


def _origin(said: Facts) -> str:
    rows = [
        [
            text(what),
            f"<code class='hash'>{text(value)}</code> <span class='small'>{text(words)}</span>" if words else text(value),
        ]
        for what, value, words in said.origin
    ]
    again = "The same data, model, seed and versions give this page again, byte for byte."
    return html.section("Made from", html.table(("", ""), rows), html.paragraph(again, "small"))
