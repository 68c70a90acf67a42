"""docs/effects.md: the catalogue for people, one section a row."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap

from brace.effects.catalogue import EFFECTS
from brace.effects.row import Effect
from brace.model.keys import KEY_BY_NAME

COLUMNS = 120
_HEAD = """# The effects that a diagnosis can name

Written by `.venv/bin/python -m brace.effects > docs/effects.md` from `tools/brace/effects/catalogue.py`; do not edit.
Units and ranges come from the controller's dictionary. How to add one: [adding.md](adding.md).
"""


def page() -> str:
    """The whole page."""
    return _HEAD + "".join("\n" + "\n".join(_section(effect)) + "\n" for effect in EFFECTS)


def _section(effect: Effect) -> Iterator[str]:
    yield f"## {effect.name}"
    yield ""
    yield from wrap(f"{effect.words[0].upper()}{effect.words[1:]}: {effect.meaning}.", COLUMNS)
    yield ""
    yield f"- Law: `{effect.law}`"
    yield f"- It may sit at: {', '.join(f'`{where}`' for where in effect.places)}"
    yield from wrap(f"- What distinguishes it from others: {effect.told_by}.", COLUMNS, subsequent_indent="  ")
    yield f"- Shown by: {', '.join(_records(effect))}"
    for key in effect.keys:
        entry = KEY_BY_NAME[key]
        allowed = ", ".join(entry.choices) if entry.choices else f"{entry.low:g} to {entry.high:g}"
        yield f"- `{key}`: {allowed}{f' {entry.unit}' if entry.unit else ''}"


def _records(effect: Effect) -> Iterator[str]:
    yield "loading records"
    if effect.joint_test is not None:
        yield "joint tests"
    if effect.in_tables:
        yield "tables of K"
