"""limb.toml with the effects in it: the believed file's own text where it can be kept, comments and all."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from brace import toml
from brace.diagnose.diagnosis import Diagnosis
from brace.ground.errors import BadFileError
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME
from brace.model.limb import WHAT, limb_from_document, toml_value
from brace.params import pack

_DIGITS = 9  # more than a controller's 32-bit floats hold
_VALUE = re.compile(r"""^(\s*[^=]+=\s*)("(?:[^"\\]|\\.)*"|'[^']*'|[^#]*?)(\s*)(#.*)?$""")


@dataclass(frozen=True)
class Exported:
    """The file's text, the model that reading it gives, and what a person must know about it."""

    text: str
    model: LimbModel
    notes: tuple[str, ...] = ()


def export(
    diagnosis: Diagnosis, believed: LimbModel | None, believed_text: str, header: Sequence[str]
) -> Exported:
    """The diagnosed model as a file. `believed_text` is the believed model's file ("" when there is none);
    `header` lines become comments on top. What format or firmware would refuse is left out, and said."""
    wanted = diagnosis.model
    if believed is None:
        wanted = wanted.with_values(_rounded({key: wanted.values[key] for key in wanted.given}))
        refusal = _refusal(wanted)
        notes = (f"limb.toml is the model as fitted; {refusal}",) if refusal else ()
        return Exported(wanted.to_toml(header), wanted, notes)
    changes = _rounded(_changes(believed, wanted))
    notes = ()
    refusal = _refusal(believed.with_values(changes)) if changes else ""
    if refusal and not _refusal(believed):
        notes = (f"limb.toml is the believed model, unchanged: with the finding in it {refusal}",)
        changes = {}
    exported = believed.with_values(changes)
    if not changes:
        header = [*header, "nothing was changed"]
    return Exported(_text(believed, exported, changes, believed_text, header), exported, notes)


def changed(believed: LimbModel, model: LimbModel) -> list[str]:
    """Keys whose values differ, in the format's order."""
    return list(_changes(believed, model))


def _changes(believed: LimbModel, model: LimbModel) -> dict[str, Any]:
    return {name: model.values[name] for name in KEY_BY_NAME if model.values[name] != believed.values[name]}


def _rounded(values: Mapping[str, Any]) -> dict[str, Any]:
    """Floats of few enough digits to read; no controller shows a difference from the fit."""
    return {
        name: float(f"{value:.{_DIGITS}g}") if isinstance(value, float) else value
        for name, value in values.items()
    }


def _refusal(model: LimbModel) -> str:
    """Why the format or the firmware would not take a model; empty when they do."""
    try:
        limb_from_document(toml.parse(model.to_toml(), Path("limb.toml"), WHAT))
        pack(model)
    except BadFileError as error:
        return f"{error.what} ({error.why})"
    return ""


def _text(
    believed: LimbModel,
    exported: LimbModel,
    changes: Mapping[str, Any],
    believed_text: str,
    header: Sequence[str],
) -> str:
    """The believed file edited; the whole written anew where that does not read back as the same values."""
    head = "".join(f"# {line}".rstrip() + "\n" for line in header)
    if believed.document is not None and believed_text:
        text = head + _edited(believed, changes, believed_text)
        try:
            if limb_from_document(toml.parse(text, Path("limb.toml"), WHAT)).values == exported.values:
                return text
        except BadFileError:
            pass  # inline tables, dotted keys
    return exported.to_toml(header)


def _edited(believed: LimbModel, changes: Mapping[str, Any], text: str) -> str:
    """Values replaced where they stand, new keys under their table, new tables at the end."""
    assert believed.document is not None
    where = believed.document.lines
    lines = text.splitlines()
    insertions: dict[int, list[str]] = {}
    tables: dict[str, list[str]] = {}
    for name, value in changes.items():
        table, _, leaf = name.rpartition(".")
        shown = _shown(name, value)
        if name in believed.given and name in where:
            lines[where[name] - 1] = _replaced(lines[where[name] - 1], shown)
        elif table in where:
            insertions.setdefault(_last_line(where, table), []).append(f"{leaf} = {shown}")
        else:
            tables.setdefault(table, []).append(f"{leaf} = {shown}")
    for line in sorted(insertions, reverse=True):
        lines[line:line] = insertions[line]
    for table, added in tables.items():
        lines += ["", f"[{table}]", *added]
    return "\n".join(lines) + "\n"


def _last_line(where: Mapping[str, int], table: str) -> int:
    """The last line of a table: of its header or of one of its own keys."""
    own = [line for name, line in where.items() if name.rpartition(".")[0] == table and name in KEY_BY_NAME]
    return max([where[table], *own])


def _replaced(line: str, shown: str) -> str:
    found = _VALUE.match(line)
    if not found:
        return line  # the caller's reading back finds it out
    before, old, gap, comment = found.groups()
    said = comment.removeprefix("#").strip() if comment else ""  # of the old value, so that it stands behind it
    return f"{before}{shown}{gap or '  '}# was {old.strip()}" + (f": {said}" if said else "")


def _shown(name: str, value: Any) -> str:
    """One value as the format writes it."""
    return toml_value(KEY_BY_NAME[name], value)
