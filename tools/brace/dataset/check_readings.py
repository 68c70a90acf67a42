"""Readings that no sensor in order gives: a force column that stands still, a temperature out of this world, a base
that moves further than the tip."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from brace.dataset.check_runs import MAX_LISTED, run_starts, span
from brace.dataset.faults import DataFault

Columns = Mapping[str, np.ndarray]
TEMPERATURE_DEGC = (-60.0, 150.0)  # beyond it no servo and no sensor works
KELVIN = 273.15
MIN_READINGS = 5  # fewer equal ones may be chance
JUMP_DEGC = 5.0  # to and fro between readings: no limb warms and cools as fast
STEADY_DEGC = 1.0


def faults(columns: Columns) -> list[DataFault]:
    """Every fault found."""
    warmth = [*_temperature(columns), *_temperature_jumps(columns)] if "temp_degc" in columns else []
    return [*_stuck(columns), *warmth, *_gauges(columns)]


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
                doubtful=True,
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


def _temperature_jumps(columns: Columns) -> Iterator[DataFault]:
    """A single reading far from two before and two after it that agree."""
    degc = columns["temp_degc"]
    if degc.size < MIN_READINGS:
        return
    around = np.stack([degc[:-4], degc[1:-3], degc[3:-1], degc[4:]])
    off = np.abs(degc[2:-2] - np.median(around, axis=0))
    for row in np.flatnonzero((off > JUMP_DEGC) & (np.ptp(around, axis=0) < STEADY_DEGC))[:MAX_LISTED] + 2:
        yield DataFault(
            int(row) + 1,
            "temp_degc",
            f"{degc[row]:g} degC between readings of {degc[row - 1]:g} and {degc[row + 1]:g} degC: no limb warms and "
            "cools as fast",
            float(degc[row - 1]),
        )


def _gauges(columns: Columns) -> Iterator[DataFault]:
    """The base gives way less than the tip is moved."""
    furthest = max(float(np.abs(columns[name]).max()) for name in ("dx_mm", "dz_mm"))
    for name in ("base_x_mm", "base_z_mm"):
        if name not in columns or furthest <= 0.0:
            continue
        reach = float(np.ptp(columns[name]))
        if reach > 3.0 * furthest:
            unit, factor = ("um", 1e-3) if reach < 1e3 * furthest else ("", 1.0)
            yield DataFault(
                None,
                name,
                f"it moves by {reach:.3g} where the tip is moved by {furthest:.3g} mm at most"
                + (f"; the column fits only in {unit}" if unit else ""),
                f"{unit}: multiply by {factor:g}" if unit else None,
            )
