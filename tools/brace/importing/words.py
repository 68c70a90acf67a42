"""The mapping as a person confirms it: a line for each column, then what must be said."""

from __future__ import annotations

from collections.abc import Sequence

from brace.ground.units import UNITS, unit_of
from brace.importing.mapping import ColumnUse, MappingTable
from brace.importing.meaning import OPEN
from brace.importing.part import Part

MEANING = {
    "loading": "a loading test: the tip is displaced, the force is read",
    "joint_test": "a joint test: angle and torque of one joint",
    "stiffness_table": "a table of K by posture",
}


def lines(parts: Sequence[Part], mapping: MappingTable) -> list[str]:
    """How the files were read, every column, every constant, every open question."""
    shown = []
    for path in dict.fromkeys(part.path for part in parts):
        own = [part for part in parts if part.path == path]
        rows = sum(len(part.rows) for part in own)
        tables = f", {len(own)} tables" if len(own) > 1 else ""
        from_line = "" if own[0].log else f" from line {own[0].lines[0]}"
        sheet = f", sheet {own[0].sheet!r}" if own[0].sheet else ""
        shown.append(f"{path.name}: {own[0].how}{sheet}; {rows} rows{from_line}{tables}")
        shown += [f"  {note}" for part in own for note in part.notes]
    shown += [f"read as {MEANING[mapping.kind]} (if it is none: --kind)", ""]
    table = [("column", "is", "unit", "entries", "because")]
    table += [_row(use) for use in mapping.columns]
    table += [
        (f"(of {each.file or 'all files'})", each.target, each.unit, each.value, each.why) for each in mapping.constants
    ]
    widths = [min(34, max(len(row[place]) for row in table)) for place in range(4)]
    for row in table:
        shown.append("  ".join([*(text.ljust(width) for text, width in zip(row, widths)), row[4]]).rstrip())
    if mapping.kind == "loading":
        shown += [
            "",
            "x is outwards, z up; a force is the one on the limb; theta1 counts from +x, theta2 is 0 for a straight "
            "knee",
        ]
    questions = mapping.questions
    if questions:
        shown += ["", f"{len(questions)} open question{'s' if len(questions) > 1 else ''}:"]
        shown += [f"  {text}" for text in questions]
    return shown


def _row(use: ColumnUse) -> tuple[str, str, str, str, str]:
    name = use.name + (f" ({use.file})" if use.file else "")
    if not use.used:
        return name, "ignore", "", use.span, use.why
    unit = UNITS.get(use.unit) or unit_of(use.unit) if use.unit not in ("", OPEN) else None
    written = "?" if use.unit == OPEN else unit.text if unit else ""
    written = ("-" if use.sign == "-1" else "") + written
    return name, " ".join(use.targets), written, use.span, use.why
