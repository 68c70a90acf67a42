"""Instruments that were not there all the time: an optional column may be left empty for whole runs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from brace.dataset.columns import Column


def without_blanks(
    rows: list[bytes], present: Sequence[Column], positions: Sequence[int]
) -> tuple[list[bytes], dict[str, np.ndarray]]:
    """The rows with a 0 where an optional column is empty throughout a run, and by column which rows that
    are. Single empty entries, and empty entries of columns that must be there, stay for the checks to
    refuse."""
    if not any(b",," in row or row.rstrip(b" ").endswith(b",") for row in rows):
        return rows, {}
    place = {column.name: position for column, position in zip(present, positions)}
    if "run" not in place:
        return rows, {}
    fields = [row.split(b",") for row in rows]
    _, run = np.unique(np.array([row[place["run"]].strip() for row in fields]), return_inverse=True)
    counts = np.bincount(run)
    found: dict[str, np.ndarray] = {}
    for column in present:
        if column.required:
            continue
        position = place[column.name]
        empty = np.array([not row[position].strip() for row in fields])
        whole = empty & (np.bincount(run, weights=empty) == counts)[run]
        if whole.any() and not whole.all():
            found[column.name] = whole
            for number in np.flatnonzero(whole):
                fields[number][position] = b"0"
    return ([b",".join(row) for row in fields] if found else rows), found
