"""Readings that no sensor in order gives: a force column that stands still, a temperature out of this world."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.check_runs import MAX_LISTED, run_starts, span
from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
TEMPERATURE_DEGC = (-60.0, 150.0)  # beyond it no servo and no sensor works
KELVIN = 273.15
MIN_READINGS = 5  # fewer equal ones may be chance


def faults(columns: Columns) -> list[DataFault]:
    """Every fault found."""
    return [*_stuck(columns), *_temperature(columns)]


def _stuck(columns: Columns) -> Iterator[DataFault]:
    starts = run_starts(columns["run"])
    first = starts[:-1]
    long = np.diff(starts) >= MIN_READINGS
    for axis, (name, moved) in enumerate((("fx_n", "dx_mm"), ("fz_n", "dz_mm"))):
        force = columns[name]
        driven = long & (columns["axis"][first] == axis) & (span(columns[moved], starts) > 0.0)
        still = driven & (span(force, starts) == 0.0)
        if not still.any():
            continue
        if np.ptp(force) == 0.0 or (still == driven).all():
            yield DataFault(
                None,
                name,
                f"it stands at {force[first[still][0]]:g} N while the tip is pushed along its axis: a sensor was off, "
                "or the column was filled in",
            )
            continue
        pose = columns["config"][first]
        for index in np.flatnonzero(still & np.isin(pose, pose[driven & ~still]))[:MAX_LISTED]:
            row = int(first[index])
            yield DataFault(
                row + 1,
                name,
                f"it stands at {force[row]:g} N through run {columns['run'][row]}, and moves in the pose's other runs",
            )


def _temperature(columns: Columns) -> Iterator[DataFault]:
    low, high = TEMPERATURE_DEGC
    degc = columns["temp_degc"]
    beyond = np.flatnonzero((degc < low) | (degc > high))
    in_kelvin = (degc - KELVIN >= low) & (degc - KELVIN <= high)
    if beyond.size == degc.size and in_kelvin.all():
        yield DataFault(None, "temp_degc", f"{degc[0]:g} fits only in kelvin", f"kelvin: subtract {KELVIN}")
        return
    for row in beyond[:MAX_LISTED]:
        why = f"{degc[row]:g} degC: outside {low:g} to {high:g} degC no limb is tested"
        if degc[row] < -KELVIN:
            why = f"{degc[row]:g} degC is below absolute zero"
        kelvin = bool(in_kelvin[row])
        yield DataFault(
            int(row) + 1,
            "temp_degc",
            why + ("; the entry fits only in kelvin" if kelvin else ""),
            float(degc[row] - KELVIN) if kelvin else None,
        )
