"""What a run of some parts leaves behind, so that the page holds all parts: one short row a case in foreign.json.

A part that is run again replaces its own rows and leaves those of the others. The page and all figures are made of the
rows alone, so that nobody needs the records again."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from verdicts import Claim, Word

NOTE_LETTERS = 60  # of what a case that crashed says
EMPTY: dict[str, Any] = {"misnamed": None, "impossible": [], "sizes": [], "covered": {}, "note": ""}
COLUMNS = (
    "id", "group", "kind", "hidden", "outside", "trouble", "evidence", "verdict", "said", "told", "found", "more",
)  # fmt: skip
READING = "said: name@where, confidence, itself right, itself or its class right; more: what else there is to say"


def row_of(word: Word) -> list[Any]:
    """A case in the order of COLUMNS."""
    truth = word.truth
    more = {
        "misnamed": word.misnamed,
        "impossible": word.impossible,
        "sizes": [float(f"{size:.2g}") for size in word.sizes],
        "covered": word.covered,
        "note": (word.note.strip().splitlines() or [""])[-1][:NOTE_LETTERS],
    }
    return [
        truth["id"], truth["group"], truth["kind"], " ".join(e["name"] for e in truth["effects"]), truth["outside"],
        truth["trouble"], truth["evidence"], word.verdict,
        [[c.label, round(c.confidence, 4), int(c.right), int(c.in_class)] for c in word.claims],
        word.told, word.found, {key: value for key, value in more.items() if value != EMPTY[key]},
    ]  # fmt: skip


def word_of(part: str, row: Sequence[Any]) -> Word:
    """The case again, as far as the page needs it."""
    one = dict(zip(COLUMNS, row, strict=True))
    more = EMPTY | one["more"]
    truth = {key: one[key] for key in ("id", "group", "kind", "outside", "trouble", "evidence")}
    truth |= {
        "part": part,
        "effects": [{"name": name} for name in one["hidden"].split()],
        "left_out": more["covered"],
    }
    claims = [Claim(label, float(sure), bool(right), bool(near)) for label, sure, right, near in one["said"]]
    return Word(
        truth, one["verdict"], claims, one["told"], one["found"], more["misnamed"], more["impossible"], more["sizes"],
        more["covered"], more["note"],
    )  # fmt: skip


def part_of(words: Sequence[Word], beside: Sequence[Word], made: dict[str, Any]) -> dict[str, Any]:
    """One part's entry of foreign.json."""
    return {"made": made, "cases": [row_of(w) for w in words], "baselines": [row_of(w) for w in beside]}


def words_of(parts: dict[str, Any], column: str) -> list[Word]:
    """The cases of all parts; `column`: cases, or baselines."""
    return [word_of(name, row) for name, part in sorted(parts.items()) for row in part.get(column, [])]


def read(path: Path) -> dict[str, Any]:
    """The parts of earlier runs. Each was judged on its own seed, which the page gives: a part whose diagnosis has not
    changed need not be judged again because another part's has."""
    if not path.exists():
        return {}
    parts: dict[str, Any] = json.loads(path.read_text()).get("parts", {})
    return parts


def text(content: dict[str, Any]) -> str:
    """foreign.json: one case a line, so that a change shows which case changed."""
    parts = content["parts"]
    whole = json.dumps({**content, "parts": {}}, indent=1)
    entries = []
    for name, part in sorted(parts.items()):
        inner = [f'  {json.dumps(key)}: {json.dumps(value)}' for key, value in part.items()
                 if key not in ("cases", "baselines")]  # fmt: skip
        for key in ("cases", "baselines"):
            if key in part:
                rows = ",\n".join(f"   {json.dumps(row, separators=(',', ':'))}" for row in part[key])
                inner.append(f'  "{key}": [\n{rows}\n  ]')
        entries.append(f" {json.dumps(name)}: {{\n" + ",\n".join(inner) + "\n }")
    return whole.replace('"parts": {}', '"parts": {\n' + ",\n".join(entries) + "\n}") + "\n"
