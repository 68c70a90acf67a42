"""Entries of data.csv one by one: which of them cannot be read, and why."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from brace.dataset.columns import MAX_INT, Column
from brace.dataset.faults import DataFault

MOST_KEPT = 200  # faults; a file with more is another sort of file


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
            found += [
                _fault(i, column, text, "axis is x or z") for i, text in enumerate(texts) if text not in (b"x", b"z")
            ]
            continue
        values = np.array([_number(text) for text in texts])
        with np.errstate(invalid="ignore"):
            bad = ~np.isfinite(values) | (np.abs(values) > entry_limit(column))
            if column.positive:
                bad |= values <= 0.0
            if column.kind == "int":
                bad |= values != np.rint(values)
        for i in np.flatnonzero(bad)[:MOST_KEPT]:
            found.append(_fault(int(i), column, texts[i], _why(values[i], column)))
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
        return "not a finite number, and a reading that is none says nothing"
    if abs(value) > entry_limit(column):
        return f"no record has such a value; {column.name} is in {column.unit or 'counts'}"
    if column.positive and value <= 0.0:
        return f"{column.name}, the {column.meaning}, is positive"
    return f"{column.name}, the {column.meaning}, is a whole number"


def _fault(index: int, column: Column, text: bytes, why: str) -> DataFault:
    shown = text[:40].decode("utf-8", "replace")
    why = f"{shown!r} cannot be: {why}" if shown else "the entry is empty"
    return DataFault(index + 1, column.name, f"{why} (delete the row, or record it again)")
