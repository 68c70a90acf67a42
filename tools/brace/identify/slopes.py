"""K of each configuration straight from the slopes of its runs, by the firmware's estimators."""

from __future__ import annotations

from typing import Any

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts
from brace.native import library

METHODS = {"least_squares": 0, "mean_of_ratios": 1}


def slope_table(dataset: Dataset) -> list[dict[str, Any]]:
    """One entry per configuration: k_xx, k_xz, k_zx, k_zz [N/mm] by least squares through the preload point (the
    better) and by the paper's mean of ratios, averaged over the runs."""
    native = library()
    columns: dict[tuple[int, int], list[dict[str, tuple[float, float]]]] = {}
    starts = run_starts(dataset["run"])
    for first, last in zip(starts[:-1].tolist(), starts[1:].tolist()):
        key = (int(dataset["config"][first]), int(dataset["axis"][first]))
        column = _run_column(native, dataset, first, last)
        if column:
            columns.setdefault(key, []).append(column)
    result = []
    for config in sorted({config for config, _ in columns}):
        entry: dict[str, Any] = {"config": config}
        for method in METHODS:
            for axis, name in enumerate("xz"):
                runs = [run[method] for run in columns.get((config, axis), ())]
                if runs:
                    mean = np.mean(runs, axis=0)
                    entry[f"{method}_k_x{name}_n_per_mm"], entry[f"{method}_k_z{name}_n_per_mm"] = map(
                        float, mean
                    )
        result.append(entry)
    return result


def _run_column(native: Any, dataset: Dataset, first: int, last: int) -> dict[str, tuple[float, float]]:
    """(force x, force z) per displacement along the run's axis [N/mm], by each method."""
    ffi, lib = native.ffi, native.lib
    slope, column = ffi.new("brace_slope_t *"), ffi.new("brace_slope_column_t *")
    d = dataset["dz_mm" if dataset["axis"][first] else "dx_mm"]
    fx, fz = dataset["fx_n"], dataset["fz_n"]
    status = lib.brace_slope_start(slope, d[first], fx[first], fz[first])
    for row in range(first + 1, last):
        status = status or lib.brace_slope_step(slope, d[row], fx[row], fz[row])
    result: dict[str, tuple[float, float]] = {}
    for name, method in METHODS.items():
        if status or lib.brace_slope_column(slope, method, column):
            return {}
        result[name] = (float(column.k_x_n_per_mm), float(column.k_z_n_per_mm))
    return result
