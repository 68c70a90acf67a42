"""A loading test that is added to a record: what a person wrote into the record stays, or the test is not begun."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from brace.bus.loading_rows import PRELOADS
from brace.bus.loading_test import COLUMNS
from brace.dataset.columns import LOADING
from brace.ground.errors import UsageError
from brace.ground.files import DATA_LIMIT_BYTES, read_text

TEST_COLUMNS = (*(column.name for column in LOADING[: len(COLUMNS)]), *PRELOADS)
_NEWEST = ("step_mm", "dwell_s")  # of [rig]: the newest test's


def refuse_what_would_go(folder: Path, meta: Mapping[str, object]) -> None:
    """Columns that no loading test has, and entries of meta.toml that cannot be written again."""
    header = read_text(folder / "data.csv", DATA_LIMIT_BYTES, "record").lstrip("\ufeff").split("\n", 1)[0]
    names = [name.strip().strip('"') for name in header.split(",")]
    if lost := [name for name in names if name not in TEST_COLUMNS]:
        raise UsageError(
            f"--add would delete {', '.join(lost)} from the record",
            where=str(folder / "data.csv"),
            why="a loading test has no such column, and a record has each column in all of its runs",
            next_step="--out another folder",
        )
    plain = [*meta.items(), *(item for table in meta.values() if isinstance(table, Mapping) for item in table.items())]
    for name, value in plain:
        top = meta.get(name) is value and isinstance(value, Mapping)
        if not top and not _writable(value):
            raise UsageError(
                f"--add cannot keep {name} in the record's meta.toml",
                where=str(folder / "meta.toml"),
                why="it is a table in a table, or a date",
                next_step="write it as text, or --out another folder",
            )
    rig = meta.get("rig")
    zeroed = meta.get("zeroed", rig.get("zeroed", "per_run") if isinstance(rig, Mapping) else "per_run")
    if zeroed != "per_run":
        raise UsageError(
            f"--add to a record with zeroed = {zeroed!r}",
            where=str(folder / "meta.toml"),
            why="the forces of a loading test count from each run's first reading",
            next_step="--out another folder",
        )


def _writable(value: object) -> bool:
    if isinstance(value, list):
        return all(_writable(item) and not isinstance(item, list) for item in value)
    return isinstance(value, (bool, int, float, str))


def meta_of_both(before: Mapping[str, object], new: Mapping[str, object]) -> dict[str, object]:
    """The record's own entries, what they lack from the new test, and of the plan the new test's."""
    both: dict[str, object] = {**new, **before}
    for name, table in new.items():
        kept = before.get(name)
        if isinstance(table, Mapping) and isinstance(kept, Mapping):
            newest = {key: table[key] for key in _NEWEST if name == "rig" and key in table}
            both[name] = {**table, **kept, **newest}
    return both
