"""Before any physics is blamed: a record that is faulty is a data fault, one that is too small says so."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.diagnose.diagnosis import Diagnosis
from brace.diagnose.options import Options
from brace.errors import BadFileError
from brace.identify.loading import MIN_ROWS
from brace.model import LimbModel

MOST_LISTED = 200


def gate(dataset: Dataset, believed: LimbModel, options: Options) -> Diagnosis | None:
    """The diagnosis that ends here, or None: go on."""
    blocking = [fault for fault in dataset.faults if fault.blocking]
    if blocking:
        first = blocking[0].sentence(dataset.csv_path.relative_to(dataset.folder))
        more = f", and {len(blocking) - 1} more" if len(blocking) > 1 else ""
        return Diagnosis(
            verdict="data_fault",
            sentence=f"The record is faulty, so nothing is said of the limb: {first}{more}.",
            model=believed,
            data_faults=tuple(dataset.faults[:MOST_LISTED]),
            seed=options.seed,
        )
    if dataset.rows < MIN_ROWS:
        raise BadFileError(
            f"{dataset.rows} rows are not enough to say anything",
            where=str(dataset.csv_path),
            why=f"at least {MIN_ROWS} readings are needed",
            next_step="record more steps",
        )
    force = np.stack([dataset["fx_n"], dataset["fz_n"]])
    if np.ptp(dataset["dx_mm"]) == 0.0 and np.ptp(dataset["dz_mm"]) == 0.0:
        return _too_little(believed, options, "the tip was never moved")
    if np.ptp(force) == 0.0:
        return _too_little(believed, options, f"every force reads {force.flat[0]:g} N")
    return None


def _too_little(believed: LimbModel, options: Options, why: str) -> Diagnosis:
    return Diagnosis(
        verdict="unknown",
        sentence=f"Not enough to say: {why}.",
        model=believed,
        seed=options.seed,
        notes=(why,),
    )
