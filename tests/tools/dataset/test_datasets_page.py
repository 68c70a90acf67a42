"""docs/datasets.md names every column, key and default that the readers know, and no other."""

from __future__ import annotations

import json
import re

import pytest

from brace.dataset.columns import KINDS
from brace.dataset.meta import _KNOWN as META_KEYS
from brace.rig.rig import RIG_KEYS
from command_bench import PROJECT

SECTIONS = dict(
    re.findall(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", (PROJECT / "docs" / "datasets.md").read_text(), re.M | re.S)
)


def rows(text: str) -> list[list[str]]:
    table = [line for line in text.splitlines() if line.startswith("|")][2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def names(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


@pytest.mark.parametrize(
    ("title", "kind"),
    [("a loading record", "loading"), ("a stiffness table", "stiffness_table"), ("a joint test", "joint_test")],
)
def test_columns(title: str, kind: str) -> None:
    said: dict[str, tuple[str, bool]] = {}
    for cell, unit, what in rows(SECTIONS[f"`data.csv` of {title}"]):
        units = unit.split(", ") * (1 if ", " in unit else len(names(cell)))
        said |= {name: (one, "if there" in what) for name, one in zip(names(cell), units, strict=True)}
    assert said == {column.name: (column.unit, not column.required and not column.one_of) for column in KINDS[kind]}


def test_keys_of_meta() -> None:
    text = SECTIONS["`meta.toml`"]
    for key in META_KEYS:
        table, _, leaf = key.name.rpartition(".")
        assert f"{leaf} = " in text and f"[{table}]" in text or not table and leaf in text, key.name
        for choice in key.choices:
            assert f'"{choice}"' in text or choice == "coxa", choice


def test_keys_and_defaults_of_a_rig_file() -> None:
    said: dict[str, str] = {}
    for cell, default, _ in rows(SECTIONS["Rig files"]):
        keys = names(cell)
        defaults = default.split(",") if len(keys) > 1 else [default]
        said |= dict(zip(keys, (text.strip(" `") for text in defaults), strict=True))
    expected = {key.name: key.default for key in RIG_KEYS if key.name not in ("format", "title")}
    assert said.pop("title") == "" and said.keys() == expected.keys()
    for name, given in expected.items():
        if isinstance(given, float):
            assert float(said[name]) == given, name
        else:  # as TOML writes it
            assert said[name] == json.dumps(given), name
