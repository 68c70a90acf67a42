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
    """Cells are HTML already; columns `numeric` are set right."""

    def line(cells: Sequence[str], tag: str) -> str:
        return "".join(
            f'<{tag} class="n">{cell}</{tag}>' if index in numeric else f"<{tag}>{cell}</{tag}>"
            for index, cell in enumerate(cells)
        )

    body = "\n".join(f"<tr>{line(row, 'td')}</tr>" for row in rows)
    if not body:
        return ""
    top = line([text(cell) for cell in head], "th")
    return f'<div class="wide"><table>\n<tr>{top}</tr>\n{body}\n</table></div>'


def bullets(items: Iterable[str]) -> str:
    """A list of plain texts."""
    inside = "".join(f"<li>{text(item)}</li>" for item in items)
    return f"<ul>{inside}</ul>" if inside else ""


def tile(big: str, small: str) -> str:
    """A figure that carries weight."""
    return f'<div class="tile"><b>{text(big)}</b><span>{text(small)}</span></div>'


def bar(share: float) -> str:
    """A bar of `share` [0, 1] of its column."""
    return f'<span class="bar" style="width:{100 * min(max(share, 0.0), 1.0):.1f}px"></span>'


def picture(svg: str, words: str) -> str:
    """Inline SVG with what it shows."""
    return f'<div class="pic">{svg}</div>\n<p class="small">{text(words)}</p>'


def document(title: str, body: str) -> str:
    """The whole page."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="generator" content="brace diagnose">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{text(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n<main>\n{body}\n</main>\n</body>\n"
        "</html>\n"
    )
