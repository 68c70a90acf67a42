"""Before any physics is blamed: a record that is faulty is a data fault, one that is too small says so."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import fdtrc

from brace.dataset import DataFault, Dataset
from brace.dataset.faults import what_is_wrong
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.loading.data_faults import against_limb
from brace.diagnose.options import Options
from brace.ground.errors import BadFileError
from brace.identify.loading import MIN_ROWS
from brace.identify.noise import FORCES
from brace.model import LimbModel

MOST_LISTED = 200
FOLLOWS_P = 1e-6  # forces that follow the displacement by chance
FEW_FOLLOW_P, FOLLOWED = 0.01, 0.9  # few readings cannot show more, if so much of their square follows


def gate(dataset: Dataset, believed: LimbModel, options: Options) -> Diagnosis | None:
    """The diagnosis that ends here, or None: go on."""
    blocking = [fault for fault in dataset.faults if fault.blocking]
    certain = [fault for fault in blocking if not fault.doubtful]
    if certain or (blocking and dataset.rows < MIN_ROWS):
        return _faulty(dataset, dataset.faults, believed, options)
    if dataset.rows < MIN_ROWS:
        raise BadFileError(
            f"{dataset.rows} rows are not enough to say anything",
            where=str(dataset.csv_path),
            why=f"at least {MIN_ROWS} readings are needed",
            next_step="record more steps",
        )
    force = np.stack([dataset[name] for name in FORCES])
    if np.ptp(dataset["dx_mm"]) == 0.0 and np.ptp(dataset["dz_mm"]) == 0.0:
        return _too_little(believed, options, "the tip was never moved")
    if np.nanmax(force) == np.nanmin(force):
        return _too_little(believed, options, f"every force reads {np.nanmax(force):g} N")
    if not _forces_follow(dataset):
        return _too_little(
            believed, options, "the forces do not follow the displacement; is the tip held, is the sensor alive?"
        )
    if not dataset.reads_both_forces:  # the faults of one axis look like effects: the other would show which
        return None
    found = against_limb.faults(dataset, believed)
    if not found:  # what the record alone looked like: does the limb say so, too?
        found = against_limb.confirmed(dataset, believed, blocking)
    if any(fault.blocking for fault in found):
        return _faulty(dataset, [*found, *(fault for fault in dataset.faults if not fault.blocking)], believed, options)
    return None


def _faulty(dataset: Dataset, faults: Sequence[DataFault], believed: LimbModel, options: Options) -> Diagnosis:
    blocking = [fault for fault in faults if fault.blocking]
    wrong = what_is_wrong(blocking, dataset.csv_path.relative_to(dataset.folder))
    return Diagnosis(
        verdict="data_fault",
        sentence=f"The record is faulty, so nothing is said of the limb: {wrong}.",
        model=believed,
        data_faults=tuple(faults[:MOST_LISTED]),
        seed=options.seed,
    )


def _too_little(believed: LimbModel, options: Options, why: str) -> Diagnosis:
    return Diagnosis(
        verdict="unknown",
        sentence=f"Not enough to say: {why}.",
        model=believed,
        seed=options.seed,
        notes=(why,),
    )


def _forces_follow(dataset: Dataset) -> bool:
    """Whether slopes over the displacement, free in every configuration, explain the forces better than chance."""
    moved = np.column_stack([dataset["dx_mm"], dataset["dz_mm"]]).astype(float)
    explained, left, slopes, free = 0.0, 0.0, 0, 0
    for name in FORCES:
        read = ~np.isnan(dataset[name])
        run_ids, run = np.unique(dataset["run"][read], return_inverse=True)
        centred = np.column_stack([moved[read], dataset[name][read]])  # each run counts from its own mean
        for values in centred.T:
            values -= (np.bincount(run, weights=values) / np.bincount(run))[run]
        free += len(centred) - len(run_ids)
        config = dataset["config"][read]
        for one in np.unique(config):
            rows = config == one
            slope, _, rank, _ = np.linalg.lstsq(centred[rows, :2], centred[rows, 2], rcond=1e-9)
            fit = centred[rows, :2] @ slope
            explained += float(fit @ fit)
            left += float(np.sum((centred[rows, 2] - fit) ** 2))
            slopes += int(rank)
    free -= slopes
    if slopes == 0 or free <= 0 or left <= 0.0:
        return explained > 0.0
    p = float(fdtrc(slopes, free, (explained / slopes) / (left / free)))
    return p < FOLLOWS_P or (p < FEW_FOLLOW_P and explained > FOLLOWED * (explained + left))
