"""A limb as limb.toml describes it: an immutable map from dotted key to value, with the file's lines."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from brace import toml
from brace.ground.errors import BadFileError
from brace.model.doubts import ModelDoubt, doubts
from brace.model.keys import KEY_BY_NAME, LIMB_KEYS, PLANAR_COMPLIANCES

WHAT = "limb model"


@dataclass(frozen=True)
class LimbModel:
    """Values of every key of limb.toml (defaults filled in); numbers are floats, moment_transfer is a ratio."""

    values: Mapping[str, toml.Value]
    given: frozenset[str] = field(default_factory=frozenset)  # keys that the file wrote
    document: toml.Document | None = None

    @property
    def name(self) -> str:
        """The limb's name, or its file's."""
        return str(self.values["name"]) or (self.document.path.stem if self.document else "limb")

    def number(self, key: str) -> float:
        """A numeric value by its dotted key."""
        return float(toml.number(self.values, key))

    def where(self, key: str = "") -> str:
        """`file:line` of a key, for messages."""
        return self.document.where(key) if self.document else "the model"

    def with_values(self, changes: Mapping[str, toml.Value]) -> LimbModel:
        """The same limb with some values replaced. Unknown keys are a programming error."""
        unknown = [key for key in changes if key not in KEY_BY_NAME]
        if unknown:
            raise KeyError(unknown[0])
        return replace(self, values={**self.values, **changes}, given=self.given | set(changes))

    def to_toml(self, header: Iterable[str] = ()) -> str:
        """The file's text: keys that were given or differ from their default, in the format's order; `header`
        lines become comments. Reading it back gives the same values bit for bit."""
        lines = [f"# {line}".rstrip() for line in header]
        table = ""
        for key in LIMB_KEYS:
            value = self.values[key.name]
            if key.name not in self.given and value == key.default:
                continue
            group, _, leaf = key.name.rpartition(".")
            if group != table:
                lines += ["", f"[{group}]"] if lines else [f"[{group}]"]
                table = group
            lines.append(f"{leaf} = {toml_value(key, value)}")
        return "\n".join(lines) + "\n"


def load_limb(path: Path) -> LimbModel:
    """Reads and checks a limb.toml; refuses with file:line, field, reason and suggestion. Warns (ModelDoubt) of values
    that smell of another unit."""
    model = limb_from_document(toml.read(path, WHAT))
    for sentence in doubts(model.values, model.given, model.where):
        warnings.warn(sentence, ModelDoubt, stacklevel=2)
    return model


def limb_from_document(document: toml.Document) -> LimbModel:
    """Checks a parsed limb.toml."""
    values = toml.check(document, LIMB_KEYS, WHAT)
    model = LimbModel(values, frozenset(_given(document.content)), document)
    if not any(model.number(key) > 0.0 for key in PLANAR_COMPLIANCES):
        raise BadFileError(
            "nothing in this limb yields",
            where=document.where("link"),
            why="all compliances of femur, tibia, their joints and the base are zero, so K is " "infinite",
            next_step="give link.femur, link.tibia or the joints a compliance, e.g. "
            "[link.tibia] bending_mm_per_n = 0.25",
        )
    return model


def _given(content: Mapping[str, object], prefix: str = "") -> Iterable[str]:
    for name, value in content.items():
        if isinstance(value, Mapping):
            yield from _given(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}"


def toml_value(key: toml.Key, value: toml.Value) -> str:
    """A value as limb.toml writes it."""
    if key.kind == "ratio" and value in (0.0, 1.0):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = "".join(_escape(character) for character in value)
        return f'"{escaped}"'
    if isinstance(value, list):
        raise TypeError(f"{key.name} is a list, and limb.toml has none")
    return str(int(value)) if key.kind == "integer" else repr(float(value))


def _escape(character: str) -> str:
    if character in '"\\':
        return "\\" + character
    return (
        character
        if character.isprintable()
        else f"\\u{ord(character):04x}" if ord(character) < 0x10000 else f"\\U{ord(character):08x}"
    )
