"""The residuals of a record as the pictures need them: one signed misfit a row, against load, branch, place and
time. Pictures know no diagnosis: all they draw stands here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from brace.dataset import Dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.digits import unit


@dataclass(frozen=True)
class View:
    """One entry a row. `before` and `after` are measured less model along the loaded direction [`unit`], of the model
    as believed and as found; `refitted` is the same with only the calibrated numbers refitted, None where nothing was;
    `imposed` and `measured` are the axes of the test; `branch` is +1 loading, -1 unloading, 0 neither;
    `group` numbers configurations or tests, `run` what is drawn as one loop."""

    kind: str
    before: np.ndarray
    after: np.ndarray
    held_out: np.ndarray
    imposed: np.ndarray
    measured: np.ndarray
    branch: np.ndarray
    group: np.ndarray
    run: np.ndarray
    time_s: np.ndarray
    names: tuple[str, str, str]  # of imposed, measured, group; with units
    unit: str
    noise_floor: float
    rms_before: tuple[float, float | None]  # fitted, held out; over all channels
    rms_after: tuple[float, float | None]
    given: str = ""  # what the model is called that was there before; set by `view`
    refitted: np.ndarray | None = None

    @property
    def believed(self) -> np.ndarray:
        """What the model said before [unit of measured]."""
        predicted: np.ndarray = self.measured - self.before
        return predicted

    @property
    def corrected(self) -> np.ndarray:
        """What it says now."""
        predicted: np.ndarray = self.measured - self.after
        return predicted


def view(dataset: Dataset, found: Diagnosis, given: str) -> View | None:
    """None where the diagnosis has no residuals, or none that can be laid beside the record's rows."""
    residuals = found.residuals
    if residuals is None or found.gap is None or not len(residuals.before):
        return None
    rows = np.asarray(found.details.get("rows", np.arange(dataset.rows)), dtype=int)
    if len(rows) != len(residuals.before) or (len(rows) and (rows.min() < 0 or rows.max() >= dataset.rows)):
        return None
    kinds: Mapping[str, Callable[[Dataset, Diagnosis, np.ndarray], View | None]] = {"loading": _loading, "joint_test": _joint}
    seen = kinds.get(dataset.kind, _table)(dataset, found, rows)
    return None if seen is None else replace(seen, given=given)


def _loading(dataset: Dataset, found: Diagnosis, rows: np.ndarray) -> View | None:
    residuals = found.residuals
    assert residuals is not None
    if not {"fx_n", "fz_n"} <= set(residuals.channels):
        return None
    along = dataset["axis"][rows].astype(int)
    channel = np.array([residuals.channels.index("fx_n"), residuals.channels.index("fz_n")])[along]
    read = np.isfinite(residuals.before[np.arange(len(rows)), channel])
    rows, along, channel, every = rows[read], along[read], channel[read], np.flatnonzero(read)
    refitted = found.details.get("refitted")
    imposed = np.where(along == 1, dataset["dz_mm"][rows], dataset["dx_mm"][rows])
    measured = np.where(along == 1, dataset["fz_n"][rows], dataset["fx_n"][rows])
    run = dataset["run"][rows]
    names = ("displacement along the loaded axis [mm]", "force along it [N]", "configuration")
    return View(
        "loading",
        residuals.before[every, channel],
        residuals.after[every, channel],
        np.asarray(residuals.held_out, dtype=bool)[every],
        imposed,
        measured,
        _branch(np.abs(imposed), run),
        dataset["config"][rows],
        run,
        dataset["t_s"][rows].astype(float),
        names,
        *_scale(found),
        refitted=refitted[every, channel] if refitted is not None and len(refitted) == len(read) else None,
    )


def _joint(dataset: Dataset, found: Diagnosis, rows: np.ndarray) -> View:
    residuals = found.residuals
    assert residuals is not None
    angle, torque = dataset["angle_rad"][rows], dataset["torque_n_mm"][rows]
    test = dataset["test"][rows] if "test" in dataset else np.ones(len(rows), dtype=int)
    names = ("deflection of the joint [rad]", "torque [N mm]", "test")
    return View(
        "joint_test",
        residuals.before[:, 0],
        residuals.after[:, 0],
        np.asarray(residuals.held_out, dtype=bool),
        angle,
        torque,
        _branch(np.abs(torque), test, 25),
        test,
        test,
        dataset["t_s"][rows].astype(float),
        names,
        *_scale(found),
    )


def _table(dataset: Dataset, found: Diagnosis, rows: np.ndarray) -> View | None:
    residuals = found.residuals
    assert residuals is not None
    known = [name for name in residuals.channels if name in dataset]
    if not known:
        return None
    take = [residuals.channels.index(name) for name in known]
    count, r_mm = len(known), dataset["r_mm"][rows].astype(float)
    measured = np.column_stack([dataset[name][rows] for name in known]).ravel()
    held_out = np.asarray(np.any(np.reshape(residuals.held_out, (len(rows), -1)), axis=1))
    zero = np.zeros(len(rows) * count, dtype=int)
    names = ("distance of the tip [mm]", "stiffness [N/mm]", "row")
    return View(
        "stiffness_table",
        residuals.before[:, take].ravel(),
        residuals.after[:, take].ravel(),
        np.repeat(held_out, count),
        np.repeat(r_mm, count),
        measured,
        zero,
        np.repeat(rows + 1, count),
        zero,
        np.full(len(zero), np.nan),
        names,
        *_scale(found),
    )


def _scale(found: Diagnosis) -> tuple[str, float, tuple[float, float | None], tuple[float, float | None]]:
    """Unit, noise floor, and the sizes that the diagnosis counts."""
    gap = found.gap
    assert gap is not None
    before, after = ((pair.fitted, pair.held_out) for pair in (gap.before, gap.after))
    return unit(gap.unit), gap.noise_floor, before, after


def _branch(load: np.ndarray, run: np.ndarray, over: int = 1) -> np.ndarray:
    """+1 where the load grows within its run, -1 where it falls, over `over` rows."""
    change = np.zeros(len(load))
    if len(load) > over:
        change[over:] = load[over:] - load[:-over]
        change[over:][run[over:] != run[:-over]] = 0.0
    scale = 1e-3 * float(np.nanmax(load, initial=0.0))
    return np.where(change > scale, 1, np.where(change < -scale, -1, 0))
