"""What the straight slopes of force over displacement say about a loading record's labels, before any model: K of
a limb is symmetric, positive definite and as stiff as servos are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from brace.dataset.check_runs import MAX_LISTED, run_starts
from brace.dataset.faults import DataFault
from brace.dataset.unit_slips import FORCE_SLIPS, slip_of

Columns = Mapping[str, np.ndarray]
MAX_CONFIGS = 5000  # beyond it, cross slopes are not compared pose by pose
# A servo's spring (about 6e4 N mm/rad) at levers up to half a metre: a softer or stiffer record is in another unit.
PLAUSIBLE_N_PER_MM = (0.03, 3e3)
USUAL_N_PER_MM = 5.0
SYMMETRIC_WITHIN = 2.0  # what cross-talk and a turned sensor may do to k_xz / k_zx


def faults(columns: Columns) -> list[DataFault]:
    """Exchanged columns, then units, then signs: each would look like the next."""
    runs = _slopes(columns)
    if not runs.first.size:
        return []
    poses = _poses(runs)
    for check in (_exchanged(poses), _units(runs, poses)):
        found = list(check)
        if found:
            return found
    return [*_signs(columns, runs)]


@dataclass(frozen=True)
class _RunSlopes:
    """Straight-line fits of both forces over the driven displacement, one entry (row) per usable run."""

    first: np.ndarray  # row index of the run's first row
    config: np.ndarray
    axis: np.ndarray
    driven: np.ndarray  # slope of the force along the driven axis [N/mm]
    driven_error: np.ndarray
    cross: np.ndarray  # slope of the other force [N/mm]
    cross_error: np.ndarray


@dataclass(frozen=True)
class _PoseSlopes:
    """Poses that were pushed along both axes: K's entries [N/mm], each the mean of its runs, and their errors."""

    k_xx: np.ndarray
    k_xz: np.ndarray  # fx over dz
    k_zx: np.ndarray  # fz over dx
    k_zz: np.ndarray
    k_xz_error: np.ndarray
    k_zx_error: np.ndarray


def _slopes(columns: Columns) -> _RunSlopes:
    starts = run_starts(columns["run"])
    first, count = starts[:-1], np.diff(starts)
    axis = columns["axis"][first]
    along_z = np.repeat(axis, count) == 1

    def centred(values: np.ndarray) -> np.ndarray:
        return values - np.repeat(np.add.reduceat(values, first) / count, count)

    d = centred(np.where(along_z, columns["dz_mm"], columns["dx_mm"]))
    power = np.add.reduceat(d * d, first)
    safe = np.where(power > 0, power, 1.0)
    fits = []
    for force in (
        np.where(along_z, columns["fz_n"], columns["fx_n"]),
        np.where(along_z, columns["fx_n"], columns["fz_n"]),
    ):
        f = centred(force)
        slope = np.add.reduceat(d * f, first) / safe
        square = np.add.reduceat((f - d * np.repeat(slope, count)) ** 2, first)
        fits += [slope, np.sqrt(square / count / safe) + 1e-12]
    usable = (count >= 4) & (power > 0)
    return _RunSlopes(*(values[usable] for values in (first, columns["config"][first], axis, *fits)))


def _poses(runs: _RunSlopes) -> _PoseSlopes:
    configs, group = np.unique(runs.config, return_inverse=True)
    counts = [np.bincount(group, weights=runs.axis == axis, minlength=configs.size) for axis in (0, 1)]
    both = (counts[0] > 0) & (counts[1] > 0)

    def mean(values: np.ndarray, axis: int) -> np.ndarray:
        total = np.bincount(group, weights=np.where(runs.axis == axis, values, 0.0), minlength=configs.size)
        return np.asarray(total[both] / counts[axis][both])

    return _PoseSlopes(
        mean(runs.driven, 0),
        mean(runs.cross, 1),
        mean(runs.cross, 0),
        mean(runs.driven, 1),
        mean(runs.cross_error, 1),
        mean(runs.cross_error, 0),
    )


def _exchanged(poses: _PoseSlopes) -> Iterator[DataFault]:
    """With the force columns exchanged K's rows are: the main entries stand off the diagonal, both positive."""
    if not poses.k_xx.size:
        return
    off_diagonal = poses.k_xz * poses.k_zx
    positive = (poses.k_xz > 0) & (poses.k_zx > 0)
    indefinite = off_diagonal > 1.1 * np.abs(poses.k_xx * poses.k_zz)
    if positive.all() and np.mean(indefinite) > 0.5:
        for name in ("fx_n", "fz_n"):
            yield DataFault(
                None,
                name,
                "the slopes make a K that is not positive definite, and is once fx_n and fz_n (or dx_mm "
                "and dz_mm together with axis) change places",
                "the columns fx_n and fz_n exchanged",
            )


def _units(runs: _RunSlopes, poses: _PoseSlopes) -> Iterator[DataFault]:
    """One force column in another unit breaks K's symmetry by the unit's factor; both in another unit leave the
    range of limbs."""
    wrong = _asymmetric_column(runs, poses)
    if wrong is not None:
        yield wrong
        return
    low, high = PLAUSIBLE_N_PER_MM
    for axis, name in enumerate(("fx_n", "fz_n")):
        driven = runs.driven[(runs.axis == axis) & np.isfinite(runs.driven)]  # NaN: a force that was not read
        typical = float(np.median(np.abs(driven))) if driven.size else 1.0
        if not low <= typical <= high:
            unit, factor = slip_of(
                typical / USUAL_N_PER_MM, {1e-3: FORCE_SLIPS[1e-3], 1e3: FORCE_SLIPS[1e3]}, 30.0
            )
            yield DataFault(
                None,
                name,
                f"a typical slope of {typical:.3g} N/mm: no limb that servos hold has it"
                + (f"; the column fits only in {unit}" if unit else ""),
                f"{unit}: multiply by {factor:g}" if unit else None,
                doubtful=True,
            )


def _asymmetric_column(runs: _RunSlopes, poses: _PoseSlopes) -> DataFault | None:
    known = (np.abs(poses.k_xz) > 5 * poses.k_xz_error) & (np.abs(poses.k_zx) > 5 * poses.k_zx_error)
    clear = known & (poses.k_xz * poses.k_zx > 0)
    if not clear.any() or clear.sum() < 0.75 * known.sum():  # opposite signs are another fault
        return None
    ratios = np.log(poses.k_xz[clear] / poses.k_zx[clear])
    ratio = float(np.exp(np.median(ratios)))
    agree = np.abs(ratios - np.log(ratio)) < np.log(1.5)
    if 1 / SYMMETRIC_WITHIN < ratio < SYMMETRIC_WITHIN or np.mean(agree) < 0.75:
        return None
    candidates = []
    for axis, (name, off_by) in enumerate((("fx_n", ratio), ("fz_n", 1 / ratio))):
        unit, factor = slip_of(off_by, FORCE_SLIPS, 1.25)
        if unit:
            driven = np.abs(runs.driven[runs.axis == axis])
            mended = float(np.median(driven)) * factor
            candidates.append((abs(np.log(max(mended, 1e-12) / USUAL_N_PER_MM)), name, unit, factor))
    if not candidates:
        return None
    _, name, unit, factor = min(candidates)
    return DataFault(
        None,
        name,
        f"fx over dz is {ratio:.3g} times fz over dx in {np.count_nonzero(clear)} poses, and K is symmetric: the "
        f"column fits only in {unit}",
        f"{unit}: multiply by {factor:g}",
    )


def _signs(columns: Columns, runs: _RunSlopes) -> Iterator[DataFault]:
    """A driven force that falls as the tip is pushed on, or a cross force that no other run of its pose (nor its
    reciprocal) agrees with in sign."""
    number = columns["run"]
    falls = runs.driven < -5 * runs.driven_error
    for axis, name in enumerate(("fx_n", "fz_n")):
        here = runs.axis == axis
        if here.any() and falls[here].all():
            for field in (name, ("dx_mm", "dz_mm")[axis]):
                yield DataFault(
                    None,
                    field,
                    f"{name} falls in every run that pushes along its axis: no limb does, so it or the displacement "
                    "has its sign turned",
                    "the column with its sign turned",
                )
            return
        for first in runs.first[here & falls][:MAX_LISTED]:
            yield DataFault(
                int(first) + 1,
                name,
                f"run {number[first]}: the force falls as the tip is pushed along " "its axis: no limb does",
                "the run with this sign turned",
            )
    configs, group = np.unique(runs.config, return_inverse=True)
    together = np.split(runs.cross[np.argsort(group, kind="stable")], np.cumsum(np.bincount(group))[:-1])
    middle = (
        np.array([np.median(slopes) for slopes in together])[group]
        if configs.size <= MAX_CONFIGS
        else np.zeros(group.size)
    )
    enough = np.bincount(group)[group] >= 3
    turned = (
        enough
        & (runs.cross * middle < 0)
        & (np.abs(runs.cross + middle) < 0.3 * np.abs(middle))
        & (np.abs(runs.cross) > 5 * runs.cross_error)
    )
    for index in np.flatnonzero(turned)[:MAX_LISTED]:
        first, name = int(runs.first[index]), ("fz_n", "fx_n")[runs.axis[index]]
        yield DataFault(
            first + 1,
            name,
            f"run {number[first]}: slope {runs.cross[index]:+.3g} N/mm where the pose's "
            f"other runs have {middle[index]:+.3g}",
            "the run with this sign turned",
            doubtful=True,
        )
