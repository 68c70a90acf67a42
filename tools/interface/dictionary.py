"""Reads dictionary.toml into one flat list, groups with * unfolded over coxa, femur, tibia."""

from __future__ import annotations

import itertools
import math
import tomllib
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from interface.units import name_fault, unit_fault

LINKS = ("coxa", "femur", "tibia")
ANGLES = ("theta0", "theta1", "theta2")
AREAS = ("parameters", "measured", "answered", "commands")
_RESERVED_KEYS = ("area", "register", "values", "description")
_GROUP_KEYS = ("table", "persistence", "entry")
_GROUP_MAY_HAVE = ("member", "struct", "says")
_ENTRY_KEYS = ("name", "unit", "description")
_ENTRY_MAY_HAVE = (
    *("register", "table", "field", "type", "range", "open_low", "infinite", "choices", "default", "required", "safe"),
    "ratio",
)
_FORMS = {"range": "range = [least, most]"}  # how to write a key whose name alone does not say it


class DictionaryError(Exception):
    """The dictionary contradicts itself; names the entry."""


@dataclass(frozen=True)
class Entry:
    """One value visible from outside."""

    index: int  # among those of the same persistence, in the struct's order
    register: int  # Modbus; -1 where no controller keeps it
    persistence: str
    key: str  # as in limb.toml
    member: str  # C expression in the struct; empty where no controller keeps it
    type: str  # f32, u32
    unit: str
    low: float
    high: float
    open_low: bool
    infinite: bool
    texts: tuple[str, ...]  # u32 that limb.toml writes as one of these
    numbers: tuple[int, ...]  # u32 that must be one of these
    default: Any  # None: limb.toml must give it
    safe: Any  # what a controller without a valid block uses; a text is given by its index
    ratio: bool
    description: str

    @property
    def field(self) -> str:
        """The C member's own name."""
        return self.member.rpartition(".")[2]

    @property
    def number(self) -> int:
        """What CAN calls it by."""
        return self.register // 2


@dataclass(frozen=True)
class Struct:
    """A C struct of parameters, generated from its entries."""

    member: str  # where it lies in brace_parameters_t, [*] the index
    type: str
    says: str  # one sentence on it
    fields: tuple[Entry, ...]  # of its first instance


@dataclass(frozen=True)
class Dictionary:
    """All entries; `schema` is the canonical list that the hash is of."""

    entries: tuple[Entry, ...]
    structs: tuple[Struct, ...]

    @property
    def parameters(self) -> tuple[Entry, ...]:
        """What is kept in the parameter block, in its order."""
        return tuple(entry for entry in self.entries if entry.persistence == "parameter")

    @property
    def of_the_model(self) -> tuple[Entry, ...]:
        """What limb.toml and the simulated limb have, and no controller."""
        return tuple(entry for entry in self.entries if entry.persistence == "model")

    @property
    def schema(self) -> str:
        """Key, type and unit of each parameter, one a line."""
        return "".join(f"{entry.key} {entry.type} {entry.unit}\n" for entry in self.parameters)

    @property
    def numbers(self) -> str:
        """Key and number of each parameter, one a line: what two ends on a wire must agree on, and a block need not."""
        return "".join(f"{entry.key} {entry.number}\n" for entry in self.parameters)

    @property
    def schema_hash(self) -> int:
        """CRC-32 of the canonical list."""
        return zlib.crc32(self.schema.encode())


def load(path: Path) -> Dictionary:
    """Reads and checks the file."""
    content = tomllib.loads(path.read_text())
    if content.get("format") != 1:
        raise DictionaryError("format must be 1")
    entries: list[Entry] = []
    for group in content["group"]:
        check_keys(group, _GROUP_KEYS, _GROUP_MAY_HAVE, f"group {group.get('table')}")
        for part in range(_parts(group)):
            for raw in group["entry"]:
                alike = [entry for entry in entries if entry.persistence == group["persistence"]]
                entries.append(_entry(group, raw, part, len(alike)))
    kept = [entry for entry in entries if entry.persistence == "parameter"]
    refuse_twice([entry.key for entry in entries])
    refuse_twice([entry.member for entry in kept])
    check_area("parameters", [(entry.register, entry.key) for entry in kept], 0, content)
    groups = [group for group in content["group"] if group["persistence"] == "parameter"]
    return Dictionary(tuple(entries), _structs(groups, kept))


def _parts(group: Mapping[str, Any]) -> int:
    """How many tables of limb.toml a group has."""
    return len(LINKS) if "*" in group.get("member", group["table"]) else 1


def _structs(groups: Sequence[Mapping[str, Any]], entries: Sequence[Entry]) -> tuple[Struct, ...]:
    structs: dict[str, Struct] = {}
    for group in groups:
        member = group["member"]
        first = member.replace("*", "0")
        fields = tuple(entry for entry in entries if entry.member.rpartition(".")[0] == first)
        found = Struct(member, group["struct"], group["says"], fields)
        if structs.setdefault(member, found) != found:
            raise DictionaryError(f"{member}: its groups say different things of one struct")
    refuse_twice([struct.type for struct in structs.values()])
    return tuple(structs.values())


def check_area(area: str, named: Sequence[tuple[int, str]], first: int, content: Mapping[str, Any]) -> None:
    """Every two registers from `first` on hold one value, or are reserved: none twice, and no gap. named: the first
    register of each value, and whose it is."""
    taken = list(named)
    for raw in content.get("reserved", []):
        check_keys(raw, _RESERVED_KEYS, (), "reserved")
        if raw["area"] not in AREAS:
            raise DictionaryError(f"reserved: no area {raw['area']!r}; there are {', '.join(AREAS)}")
        if raw["area"] == area:
            taken += [(raw["register"] + 2 * place, "a reserved place") for place in range(raw["values"])]
    for place, (register, name) in enumerate(sorted(taken)):
        free = first + 2 * place
        whose = sorted(one for at, one in taken if at in (register - 1, register))
        if register < free and len(whose) > 1:
            why = f"register {register} has two values: {' and '.join(whose)}"
            raise DictionaryError(f"{area}: {why}; the first that is free is {_free(taken, first)}")
        if register != free:
            raise DictionaryError(f"{area}: {name} has register {register}; the first that is free is {free}")


def _free(taken: Sequence[tuple[int, str]], first: int) -> int:
    """The first register from `first` on where a value has room."""
    used = {register + part for register, _ in taken for part in (0, 1)}
    return next(register for register in itertools.count(first, 2) if not used & {register, register + 1})


def _entry(group: Mapping[str, Any], raw: Mapping[str, Any], part: int, index: int) -> Entry:
    key = f"{raw.get('table', group['table'])}.{raw.get('name')}".replace("*", LINKS[part])
    is_kept = group["persistence"] == "parameter"
    stands_for_default = "required" if raw.get("required") else "default"
    range_or_choices = "choices" if "choices" in raw else "range"
    check_keys(
        raw,
        (*_ENTRY_KEYS, stands_for_default, range_or_choices, *(["register"] if is_kept else [])),
        _ENTRY_MAY_HAVE,
        key,
    )
    kind = raw.get("type", "f32")
    choices = tuple(raw.get("choices", ()))
    texts = choices if choices and isinstance(choices[0], str) else ()
    numbers = () if texts else choices
    default = None if raw.get("required") else raw["default"]
    safe = raw.get("safe", default)
    if isinstance(safe, list):
        safe = safe[part]
    if texts:
        low, high, safe = 0, len(texts) - 1, texts.index(safe)
    elif numbers:
        low, high = min(numbers), max(numbers)
    else:
        low, high = raw["range"]
    if not is_kept and (group["persistence"] != "model" or {"register", "field", "safe"} & set(raw)):
        why = 'what no controller keeps has persistence "model", and no register, field, safe'
        raise DictionaryError(f"{key}: {why}")
    register = raw["register"] if is_kept else [-1] * _parts(group)
    if (len(register) if isinstance(register, list) else 1) != _parts(group):
        raise DictionaryError(f"{key}: a table with * has a list of {len(LINKS)} registers, another one has one")
    entry = Entry(
        index=index,
        register=register[part] if isinstance(register, list) else register,
        persistence=group["persistence"],
        key=key,
        member=group["member"].replace("*", str(part)) + "." + raw.get("field", raw["name"]) if is_kept else "",
        type=kind,
        unit=raw["unit"],
        low=low,
        high=high,
        open_low=raw.get("open_low", False),
        infinite=raw.get("infinite", False),
        texts=texts,
        numbers=numbers,
        default=default,
        safe=safe,
        ratio=raw.get("ratio", False),
        description=raw["description"].replace("*", LINKS[part]).replace("@", ANGLES[part]),
    )
    _check(entry)
    return entry


def _check(entry: Entry) -> None:
    def refuse(why: str) -> DictionaryError:
        return DictionaryError(f"{entry.key}: {why}")

    if entry.type not in ("f32", "u32"):
        raise refuse(f"type {entry.type}")
    # A whole number without a unit may count what its own name says.
    leaf = entry.key.rpartition(".")[2]
    table = entry.key.partition(".")[0]
    if entry.member and entry.field not in (leaf, f"{table}_{leaf}"):
        raise refuse(
            f"in C it is {entry.field}; one thing has one name: {leaf}, or {table}_{leaf} where tables share a struct"
        )
    if fault := unit_fault(entry.unit) or (name_fault(leaf, entry.unit) if entry.type == "f32" or entry.unit else ""):
        raise refuse(fault)
    if entry.type == "f32" and (entry.texts or entry.numbers):
        raise refuse("choices are for u32")
    if entry.low > entry.high:
        raise refuse(f"its range [{entry.low}, {entry.high}] has the greatest first; write the least first")
    if entry.type == "u32" and not all(
        isinstance(bound, int) and 0 <= bound < 1 << 32 for bound in (entry.low, entry.high)
    ):
        raise refuse("the range of a u32 is whole numbers below 2^32")
    if 0 in entry.numbers:
        raise refuse("0 fills up the lists of choices: it cannot be one")
    if entry.open_low and entry.low != 0.0:
        raise refuse("open_low is for a range that starts at 0")
    for what, value in (("default", None if entry.texts else entry.default), ("safe value", entry.safe)):
        if value is None:
            continue
        if not entry.low <= value <= entry.high or (entry.open_low and value == entry.low):
            low, high = entry.low, entry.high
            span = f"above {low}, at most {high}" if entry.open_low else f"{low} to {high}"
            raise refuse(f"its {what}, {value}, lies outside its range, {span}")
        if math.isinf(value) and not entry.infinite:
            raise refuse("inf needs infinite = true")
    if entry.safe is None:
        raise refuse("a required entry needs a safe value")


def check_keys(table: Mapping[str, Any], needed: Sequence[str], may_have: Sequence[str], where: str) -> None:
    """Every key that a table must have is there, and no other than it may have."""
    unknown = set(table) - {*needed, *may_have}
    if unknown:
        raise DictionaryError(
            f"{where}: unknown {', '.join(sorted(unknown))}; "
            f"it has {', '.join(needed)} and may have {', '.join(may_have) or 'nothing else'}"
        )
    lacking = [key for key in needed if key not in table]
    if lacking:
        forms = "".join(f"; write {_FORMS[key]}" for key in lacking if key in _FORMS)
        raise DictionaryError(f"{where}: it lacks {', '.join(lacking)}{forms}")


def refuse_twice(names: Iterable[str]) -> None:
    """No name stands there twice."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise DictionaryError(f"{name} stands there twice; give one of them another name")
        seen.add(name)
