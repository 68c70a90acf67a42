"""Reads what is measured, answered and commanded from dictionary.toml, and where each stands in the registers."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.codes import Codes, Table
from interface.dictionary import DictionaryError, check_area, check_keys, refuse_twice
from interface.units import UNIT_SUFFIX, unit_fault

MEASURED_REGISTER, ANSWERED_REGISTER, COMMAND_REGISTER = 0, 0x1000, 0x4000  # the first of each
QUESTION = "asked_"  # the names of a question's values begin with it
_KEYS, _MAY_HAVE = ("name", "register", "unit", "description"), ("type", "names", "bit_names", "numeric")


@dataclass(frozen=True)
class Measured:
    """One 32-bit value."""

    index: int  # in its list, which is in the order of the registers
    register: int  # Modbus
    name: str
    type: str  # f32, u32
    unit: str
    codes: Table | None  # what the number or its bits mean
    numeric: bool  # tools give the number, not its name
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


def load_values(path: Path, codes: Codes) -> Values:
    """Reads and checks the lists."""
    content = tomllib.loads(path.read_text())
    raws = [raw for kind in ("measured", "answered", "command") for raw in content[kind]]
    refuse_twice(raw["name"] for raw in raws if "name" in raw)
    return Values(
        _values(content, "measured", "measured", MEASURED_REGISTER, codes),
        _values(content, "answered", "answered", ANSWERED_REGISTER, codes),
        _values(content, "command", "commands", COMMAND_REGISTER, codes),
    )


def _values(content: Mapping[str, Any], kind: str, area: str, first: int, codes: Codes) -> tuple[Measured, ...]:
    for raw in content[kind]:
        check_keys(raw, _KEYS, _MAY_HAVE, f"{kind} {raw.get('name')}")
    raws = sorted(content[kind], key=lambda raw: raw["register"])
    check_area(area, [(raw["register"], raw["name"]) for raw in raws], first, content)
    return tuple(_value(raw, (raw["register"] - first) // 2, codes) for raw in raws)


def _value(raw: Mapping[str, Any], index: int, codes: Codes) -> Measured:
    kind = raw.get("type", "f32")
    if kind not in ("f32", "u32"):
        raise DictionaryError(f"{raw['name']}: type {kind}; there are f32 and u32")
    if fault := unit_fault(raw["unit"]):
        raise DictionaryError(f"{raw['name']}: {fault}")
    return Measured(
        index, raw["register"], raw["name"], kind, raw["unit"], _table(raw, codes), raw.get("numeric", False),
        raw["description"],
    )


def _table(raw: Mapping[str, Any], codes: Codes) -> Table | None:
    if "names" in raw:
        return codes.enum(raw["names"], raw["name"])
    return codes.bits(raw["bit_names"], raw["name"]) if "bit_names" in raw else None
