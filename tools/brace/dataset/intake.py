"""A dataset through the gate: files read, columns typed, faults named before anybody computes with it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from brace.dataset import check_joint_test, check_loading, check_table
from brace.dataset.columns import KINDS
from brace.dataset.csv_table import read_columns
from brace.dataset.faults import DataFault
from brace.dataset.grid import step_of
from brace.dataset.meta import Meta, read_meta

FORCES = ("fx_n", "fz_n")
RESOLUTION = "sensor.resolution_n"
LATE_ORIGIN_S = 1e6  # a clock that shows more has not been started for this record


@dataclass(frozen=True)
class Dataset:
    """`columns` maps a column's name to an array with one entry per row; `faults` is what was found wrong.
    `decimals` (tables only) counts the printed decimals per column. `small_displacements` (loading only): the limb did
    not turn as it was displaced, as in some simulations; brace.identify.playing finds it out."""

    folder: Path
    meta: Meta
    columns: Mapping[str, np.ndarray]
    faults: Sequence[DataFault] = ()
    decimals: Mapping[str, int] = field(default_factory=dict)
    small_displacements: bool = False

    @property
    def kind(self) -> str:
        return self.meta.kind

    @property
    def csv_path(self) -> Path:
        return self.folder / "data.csv"

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.columns.values())))

    @property
    def reads_both_forces(self) -> bool:
        """Whether every row has both forces: not so with a sensor of one axis."""
        return not any(np.isnan(self.columns[name]).any() for name in FORCES)

    def __getitem__(self, column: str) -> np.ndarray:
        return self.columns[column]

    def __contains__(self, column: object) -> bool:
        return column in self.columns

    def select(self, keep: np.ndarray) -> Dataset:
        """The rows where `keep` is true; faults are dropped with their rows' numbers."""
        return replace(self, columns={name: values[keep] for name, values in self.columns.items()}, faults=())

    def with_columns(self, changes: Mapping[str, np.ndarray]) -> Dataset:
        """The same record with some columns replaced."""
        return replace(self, columns={**self.columns, **changes})

    def require_sound(self) -> None:
        """Refuses the record while a blocking fault stands."""
        blocking = [fault for fault in self.faults if fault.blocking]
        if blocking:
            raise blocking[0].error(self.csv_path, len(blocking) - 1)


def load_dataset(folder: Path, *, keep_unreadable: bool = False) -> Dataset:
    """Reads FOLDER/meta.toml and FOLDER/data.csv. What cannot be a record at all is refused; doubts about a
    record that can be read are in `faults`. With `keep_unreadable`, single entries that are no numbers are faults
    too (blocking, and the only ones that are looked for then); such an entry is 0 in `columns`."""
    meta = read_meta(folder)
    unreadable: list[DataFault] | None = [] if keep_unreadable else None
    columns, raw_rows = read_columns(folder / "data.csv", KINDS[meta.kind], unreadable)
    columns = _with_whole_temperature(columns)
    dataset = Dataset(folder, meta, _from_its_first_reading(columns), small_displacements=meta.displacements == "small")
    if unreadable:
        return replace(dataset, faults=unreadable)
    if meta.kind == "loading":
        dataset = replace(dataset, meta=_with_found_resolution(meta, columns))
        return replace(dataset, faults=check_loading.faults(dataset.columns, dataset.meta))
    if meta.kind == "joint_test":
        return replace(dataset, faults=check_joint_test.faults(dataset.columns))
    decimals = check_table.printed_decimals(folder / "data.csv", raw_rows)
    return replace(dataset, faults=check_table.faults(columns, decimals, meta), decimals=decimals)


def _from_its_first_reading(columns: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
    """The time of a calendar's clock counts from the first reading, as that of a clock started for the record does: the
    limb knows nothing of dates, and a number of ten digits leaves no room for the time between readings."""
    if "t_s" not in columns or not columns["t_s"].size or abs(columns["t_s"][0]) < LATE_ORIGIN_S:
        return columns
    return {**columns, "t_s": columns["t_s"] - columns["t_s"][0]}


def _with_whole_temperature(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Without a temperature that is blank in some runs: softening follows it from the first reading to the last."""
    if "temp_degc" not in columns or not np.isnan(columns["temp_degc"]).any():
        return columns
    return {name: values for name, values in columns.items() if name != "temp_degc"}


def _with_found_resolution(meta: Meta, columns: Mapping[str, np.ndarray]) -> Meta:
    """A sensor rounds to the steps that its readings stand on, where meta.toml says finer ones or none."""
    found = max(step_of(columns[name]) for name in FORCES)
    if found <= meta.number(RESOLUTION):
        return meta
    return replace(meta, values={**meta.values, RESOLUTION: found})
