"""A comment in C, wrapped."""

from __future__ import annotations

import textwrap

_COLUMNS = 118


def c_comment(words: str, indent: str = "") -> str:
    """Whole lines, above what they are said of."""
    lines = textwrap.wrap(words, _COLUMNS - len(indent) - len("/*  */"))
    return f"{indent}/* " + f"\n{indent} * ".join(lines) + " */\n"
