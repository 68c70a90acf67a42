"""Reads what is measured, answered and commanded from dictionary.toml, and where each stands in the registers."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.dictionary import DictionaryError

_KEYS = {"name", "type", "unit", "names", "bit_names", "description"}
UNIT_SUFFIX = {
    "": "", "us": "", "N/mm": "_n_per_mm", "rad": "_rad", "mm": "_mm", "N": "_n", "N mm": "_n_mm", "degC": "_degc"
}


@dataclass(frozen=True)
class Measured:
    """One 32-bit value."""

    index: int  # in its list
    name: str
    type: str  # f32, u32
    unit: str
    names: tuple[str, ...]
    bit_names: tuple[str, ...]
    description: str

    @property
    def member(self) -> str:
        """Name with its unit."""
        return self.name + UNIT_SUFFIX[self.unit]


@dataclass(frozen=True)
class Values:
    """The lists beside the parameters."""

    measured: tuple[Measured, ...]
    answered: tuple[Measured, ...]
    commands: tuple[Measured, ...]

    @property
    def schema(self) -> str:
        """Canonical list of all that two ends must agree on."""
        lists = (("measured", self.measured), ("answered", self.answered), ("command", self.commands))
        return "".join(f"{kind} {v.name} {v.type} {v.unit}\n" for kind, values in lists for v in values)


def load_values(path: Path) -> Values:
    """Reads and checks the lists."""
    content = tomllib.loads(path.read_text())
    values = Values(*(tuple(_values(content[kind])) for kind in ("measured", "answered", "command")))
    names = [value.name for group in (values.measured, values.answered, values.commands) for value in group]
    if len(set(names)) != len(names):
        raise DictionaryError("two values have one name")
    return values


def _values(raws: list[Mapping[str, Any]]) -> list[Measured]:
    values = []
    for index, raw in enumerate(raws):
        if set(raw) - _KEYS:
            raise DictionaryError(f"{raw['name']}: unknown {', '.join(sorted(set(raw) - _KEYS))}")
        kind = raw.get("type", "f32")
        if kind not in ("f32", "u32") or raw["unit"] not in UNIT_SUFFIX:
            raise DictionaryError(f"{raw['name']}: type {kind}, unit {raw['unit']!r}")
        values.append(
            Measured(
                index, raw["name"], kind, raw["unit"], tuple(raw.get("names", ())), tuple(raw.get("bit_names", ())),
                raw["description"],
            )
        )
    return values
