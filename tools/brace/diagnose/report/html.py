"""Pieces of a page: every text that comes from outside is escaped here and nowhere else."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape

from brace.diagnose.report.style import CSS


def text(words: object) -> str:
    """Escaped."""
    return escape(str(words), quote=True)


def paragraph(words: str, kind: str = "") -> str:
    """Plain words."""
    return f'<p class="{kind}">{text(words)}</p>' if kind else f"<p>{text(words)}</p>"


def code(name: object) -> str:
    """A name of the files, which a narrow page may break behind its dots and underscores."""
    return f"<code>{re.sub(r'(?<=[._@])(?=.)', '<wbr>', text(name))}</code>"


def section(title: str, *parts: str) -> str:
    """A titled block; nothing when all parts are empty."""
    inside = "\n".join(part for part in parts if part)
    return f"<section>\n<h2>{text(title)}</h2>\n{inside}\n</section>" if inside else ""


def table(head: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = ()) -> str:
    """Cells are HTML already; columns `numeric` are set right. On a narrow page a row is a block in which every cell
    has its head before it."""

    def cell(index: int, inside: str) -> str:
        label = f' data-head="{text(head[index])}"' if head[index] else ""
        kind = ' class="n"' if index in numeric else ""
        return f"<td{kind}{label}>{inside}</td>" if inside else f"<td{kind}></td>"

    body = "\n".join(f"<tr>{''.join(cell(index, inside) for index, inside in enumerate(row))}</tr>" for row in rows)
    if not body:
        return ""
    top = "".join(
        f'<th class="n">{text(words)}</th>' if index in numeric else f"<th>{text(words)}</th>"
        for index, words in enumerate(head)
    )
    return f'<div class="wide"><table>\n<tr class="head">{top}</tr>\n{body}\n</table></div>'


def bullets(items: Iterable[str]) -> str:
    """A list of plain texts."""
    inside = "".join(f"<li>{text(item)}</li>" for item in items)
    return f"<ul>{inside}</ul>" if inside else ""


def tile(big: str, small: str) -> str:
    """A figure that carries weight."""
    return f'<div class="tile"><b>{text(big)}</b><span>{text(small)}</span></div>'


def answer(question: str, short: str, more: str, width: str = "") -> str:
    """A question that everybody has, with its answer; `width` "wide": a row for itself, "broad": more of its row."""
    kind = f"tile {width}-tile" if width else "tile"
    whole = re.sub(r"-?[\d.]+e-\d+|[\d.]+ %", r'<span class="whole">\g<0></span>', text(more))  # no line ends within
    return f'<div class="{kind}"><i>{text(question)}</i><b>{text(short)}</b><span>{whole}</span></div>'


def bar(share: float, kind: str = "") -> str:
    """A bar of `share` [0, 1] of its column; `kind` "beyond": of a model that nobody believes."""
    return f'<span class="bar {kind}" style="width:{100 * min(max(share, 0.0), 1.0):.1f}px"></span>'


def pictures(svgs: Sequence[str], words: str) -> str:
    """Inline SVGs beside each other where there is room, with what they show."""
    inside = "".join(f'<div class="pic">{one}</div>' for one in svgs)
    return f'<div class="pics of{min(len(svgs), 3) if len(svgs) % 2 else 2}">{inside}</div>\n' + paragraph(words, "small")


def details(summary: str, inside: str) -> str:
    """What is read only by who asks for it."""
    return f"<details><summary>{text(summary)}</summary>{inside}</details>"


def document(title: str, body: str) -> str:
    """The whole page."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="generator" content="brace diagnose">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{text(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n"
        "</html>\n"
    )
