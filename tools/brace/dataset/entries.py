"""Entries of data.csv one by one: which of them cannot be read, and why."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from brace.dataset.columns import MAX_INT, Column
from brace.dataset.faults import DataFault
from brace.ground.slips import slip

MOST_KEPT = 200  # faults; a file with more is another sort of file


QUOTED_COMMA = b"\x1f"  # stands for a comma within quotes while commas separate fields


def entry_text(entry: bytes) -> str:
    """One entry as it stands in the file."""
    return entry.replace(QUOTED_COMMA, b",").strip().decode("utf-8", "replace")


def entry_limit(column: Column) -> float:
    """The largest size that an entry of the column can have at all."""
    return MAX_INT if column.kind == "int" else column.limit


def entry_by_entry(
    rows: Sequence[bytes], columns: Sequence[Column], positions: Sequence[int]
) -> tuple[dict[str, np.ndarray], list[DataFault]]:
    """The columns, with 0 (axis: x) for every entry that cannot be read, and a fault for each of those."""
    found: list[DataFault] = []
    kept: dict[str, np.ndarray] = {}
    fields = [row.split(b",") for row in rows]
    for column, position in zip(columns, positions):
        texts = [row[position].strip() for row in fields]
        if column.kind == "axis":
            kept[column.name] = np.array([text if text in (b"x", b"z") else b"x" for text in texts], dtype="S4")
            neither = [i for i, text in enumerate(texts) if text not in (b"x", b"z")]
            found += _faults(column, texts, dict.fromkeys(neither, "axis is x or z"))
            continue
        values = np.array([_number(text) for text in texts])
        with np.errstate(invalid="ignore"):
            bad = ~np.isfinite(values) | (np.abs(values) > entry_limit(column))
            if column.positive:
                bad |= values <= 0.0
            if column.kind == "int":
                bad |= values != np.rint(values)
        found += _faults(column, texts, {int(i): _why(values[i], column) for i in np.flatnonzero(bad)})
        kept[column.name] = np.where(bad, 1.0 if column.positive else 0.0, values)
    found.sort(key=lambda fault: fault.row or 0)
    return kept, found[:MOST_KEPT]


def _number(text: bytes) -> float:
    try:
        return math.nan if b"_" in text else float(text)
    except ValueError:
        return math.nan


def _why(value: float, column: Column) -> str:
    if not math.isfinite(value):
        unit = f" in {column.unit}" if column.unit else ""
        return f"not a finite number; {column.name} is the {column.meaning}{unit}"
    if abs(value) > entry_limit(column):
        return beyond_limit(column)
    if column.positive and value <= 0.0:
        return f"{column.name}, the {column.meaning}, is positive"
    return f"{column.name}, the {column.meaning}, is a whole number"


def beyond_limit(column: Column) -> str:
    """Why an entry is beyond all entries of its column."""
    return f"no record has such a value; {column.name} is in {column.unit or 'counts'}{column.beyond}"


def _faults(column: Column, texts: Sequence[bytes], bad: Mapping[int, str]) -> list[DataFault]:
    """One for each bad entry (index to reason), or one for the column where none of its entries can be read."""
    if len(bad) < len(texts) or len(texts) == 1:
        return [_fault(index, column, texts[index], why) for index, why in list(bad.items())[:MOST_KEPT]]
    first = _fault(0, column, texts[0], bad[0])
    return [replace(first, row=None, why=f"none of its entries can be read; the first: {first.why}")]


def _fault(index: int, column: Column, text: bytes, why: str) -> DataFault:
    shown = entry_text(text)[:40]
    if not shown:
        return DataFault(index + 1, column.name, "the entry is empty (delete the row, or record it again)")
    reason, meant = slip(shown)
    if meant:
        why = f"{shown!r} is not a number: {reason}"
        return DataFault(index + 1, column.name, why, f"{meant}; so throughout the file")
    way = "write x or z" if column.kind == "axis" else "correct the entry, or delete the row"
    if why.startswith("not a finite number"):
        what = why.partition("; ")[2]
        return DataFault(index + 1, column.name, f"{shown!r} is not a number; {what} ({way})")
    return DataFault(index + 1, column.name, f"{shown!r} is not allowed: {why} ({way})")
