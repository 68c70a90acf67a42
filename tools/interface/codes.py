"""Reads what numbers mean from dictionary.toml: [[enum]] and [[bits]]."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.dictionary import DictionaryError

_TABLE_KEYS = {"name", "description", "constant", "type", "header", "prefix", "values"}
_VALUE_KEYS = {"name", "number", "text", "c", "emergency"}
EMERGENCIES = 0x10000  # codes below this
BYTE = 256  # a negative number of an enum stands as this plus it in an unsigned value


@dataclass(frozen=True)
class Code:
    """One meaning of a number, or one bit."""

    number: int  # of a bit: its place, from 0
    name: str
    text: str  # one sentence
    constant: str  # the C constant; "": none
    emergency: int | None  # of a fault: the CANopen code of the emergency that reports it


@dataclass(frozen=True)
class Table:
    """All meanings of a number."""

    name: str
    description: str
    is_bits: bool
    type: str  # the generated C type; "": none
    header: str  # the hand-written C header that has the constants; "": they are generated
    codes: tuple[Code, ...]

    @property
    def names(self) -> dict[int, str]:
        """Number -> name, in a signed field."""
        return {code.number: code.name for code in self.codes}

    @property
    def unsigned_names(self) -> dict[int, str]:
        """Number -> name, in an unsigned value: a negative number stands as 256 plus it."""
        return {code.number % BYTE if code.number < 0 else code.number: code.name for code in self.codes}

    @property
    def schema(self) -> str:
        """What two ends must agree on."""
        kind = "bits" if self.is_bits else "enum"
        return "".join(f"{kind} {self.name} {code.number} {code.name}\n" for code in self.codes)


@dataclass(frozen=True)
class Codes:
    """All tables by their names."""

    tables: tuple[Table, ...]

    def enum(self, name: str, where: str) -> Table:
        """The [[enum]] of that name. DictionaryError, which names `where`, if there is none."""
        return self._find(name, False, where)

    def bits(self, name: str, where: str) -> Table:
        """The [[bits]] of that name. DictionaryError, which names `where`, if there is none."""
        return self._find(name, True, where)

    def _find(self, name: str, is_bits: bool, where: str) -> Table:
        for table in self.tables:
            if table.name == name and table.is_bits == is_bits:
                return table
        kind = "[[bits]]" if is_bits else "[[enum]]"
        raise DictionaryError(f"{where}: no {kind} of dictionary.toml is named {name!r}")

    @property
    def emergencies(self) -> str:
        """Each emergency code in words: "0x7300 SENSOR_FEMUR, SENSOR_TIBIA; 0x6100 TICK_LATE"."""
        names: dict[int, list[str]] = {}
        for table in self.tables:
            for code in table.codes:
                if code.emergency is not None:
                    names.setdefault(code.emergency, []).append(code.name)
        return "; ".join(f"0x{emergency:04x} {', '.join(said)}" for emergency, said in names.items())

    @property
    def schema(self) -> str:
        """What two ends must agree on."""
        return "".join(table.schema for table in self.tables)


def load_codes(path: Path) -> Codes:
    """Reads and checks the tables."""
    content = tomllib.loads(path.read_text())
    tables = [_table(raw, is_bits) for is_bits, kind in ((False, "enum"), (True, "bits")) for raw in content[kind]]
    _refuse_twice((table.name for table in tables), "two tables of codes")
    constants = [code.constant for table in tables for code in table.codes if code.constant and not table.header]
    _refuse_twice(constants, "two C constants")
    return Codes(tuple(tables))


def _table(raw: Mapping[str, Any], is_bits: bool) -> Table:
    name = raw["name"]
    _refuse_unknown(raw, _TABLE_KEYS, name)
    header, generated = raw.get("header", ""), "constant" in raw
    if generated and (header or "prefix" in raw):
        raise DictionaryError(f"{name}: its constants are either generated or those of a header")
    if "type" in raw and (is_bits or not generated):
        raise DictionaryError(f"{name}: only an [[enum]] whose constants are generated has a type")
    codes: list[Code] = []
    for value in raw["values"]:
        where = f"{name}.{value['name']}"
        _refuse_unknown(value, _VALUE_KEYS, where)
        number = value.get("number", codes[-1].number + 1 if codes else 0)
        if is_bits and ("number" in value or number > 31):
            raise DictionaryError(f"{where}: bits are counted from 0 to 31, in their order")
        if not -BYTE // 2 < number < BYTE // 2:
            raise DictionaryError(f"{where}: {number} does not fit into 8 bits")
        emergency = value.get("emergency")
        if emergency is not None and (not isinstance(emergency, int) or not 0 < emergency < EMERGENCIES):
            raise DictionaryError(
                f"{where}: its emergency is no number from 0x0001 to {EMERGENCIES - 1:#x}; 16 bits hold it"
            )
        prefix = raw.get("constant", raw.get("prefix"))
        constant = value.get("c", "" if prefix is None else prefix + value["name"])
        codes.append(Code(number, value["name"], value["text"], constant, emergency))
    _refuse_twice((code.name for code in codes), f"{name}: two values")
    lacking = [code.name for code in codes if code.emergency is None]
    if len(lacking) not in (0, len(codes)):
        raise DictionaryError(f"{name}: {', '.join(lacking)} lacks an emergency; either every value has one, or none")
    _refuse_twice((code.number for code in codes), f"{name}: two values")
    return Table(name, raw["description"], is_bits, raw.get("type", ""), header, tuple(codes))


def _refuse_unknown(table: Mapping[str, Any], known: set[str], where: str) -> None:
    unknown = set(table) - known
    if unknown:
        raise DictionaryError(f"{where}: unknown {', '.join(sorted(unknown))}")


def _refuse_twice(items: Iterable[object], what: str) -> None:
    seen: set[object] = set()
    for item in items:
        if item in seen:
            raise DictionaryError(f"{what} are {item}; give one of them another")
        seen.add(item)
