"""Instruments that were not there all the time: an optional column may be left empty for whole runs, a force column of
a sensor with one axis throughout, or be left out."""

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
        if whole.any() and (column.one_of or not whole.all()):
            found[column.name] = whole
            for number in np.flatnonzero(whole):
                fields[number][position] = b"0"
    return ([b",".join(row) for row in fields] if found else rows), found


def with_absent(columns: dict[str, np.ndarray], wanted: Sequence[Column]) -> dict[str, np.ndarray]:
    """The columns with those of a sensor with one axis that are not in the file, as readings that were not taken."""
    groups = {column.one_of for column in wanted if column.one_of and column.name in columns}
    rows = len(next(iter(columns.values())))
    absent = [column.name for column in wanted if column.one_of in groups and column.name not in columns]
    return columns | {name: np.full(rows, np.nan) for name in absent}


def nothing_read(columns: dict[str, np.ndarray], wanted: Sequence[Column]) -> tuple[list[str], np.ndarray]:
    """Columns of which every row needs one, and the rows (from 0) that have an entry in none."""
    names = [column.name for column in wanted if column.one_of]
    if not names:
        return [], np.empty(0, int)
    return names, np.flatnonzero(np.isnan(np.stack([columns[name] for name in names])).all(axis=0))
