"""What to do about faulty rows before fitting: take the one repair that follows, leave the row out, or refuse."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from brace.dataset import Dataset
from brace.dataset.faults import DataFault
from brace.ground.errors import BadFileError


def settle(dataset: Dataset, policy: str) -> tuple[Dataset, list[str]]:
    """The record to fit, and what was done to it. Raises when a blocking fault remains."""
    blocking = [fault for fault in dataset.faults if fault.blocking]
    if not blocking:
        return dataset, []
    if policy == "refuse":
        dataset.require_sound()
    if policy == "drop":
        return _dropped(dataset, blocking)
    unrepairable = [fault for fault in blocking if not _repairable(dataset, fault)]
    if unrepairable:
        raise _hint(unrepairable, dataset)
    changed = {name: values.copy() for name, values in dataset.columns.items()}
    done = []
    for fault in blocking:
        assert fault.row is not None and isinstance(fault.suggestion, float)
        was = changed[fault.field][fault.row - 1]
        changed[fault.field][fault.row - 1] = fault.suggestion
        done.append(f"row {fault.row}, {fault.field}: {was:g} taken as {fault.suggestion:g} ({fault.why})")
    return replace(dataset, columns=changed), done


def _repairable(dataset: Dataset, fault: DataFault) -> bool:
    return (
        fault.repair
        and fault.row is not None
        and fault.field in dataset.columns
        and isinstance(fault.suggestion, float)
    )


def _dropped(dataset: Dataset, blocking: list[DataFault]) -> tuple[Dataset, list[str]]:
    whole = [fault for fault in blocking if fault.row is None]
    if whole:
        raise whole[0].error(dataset.csv_path, len(blocking) - 1)
    keep = np.ones(dataset.rows, dtype=bool)
    keep[[fault.row - 1 for fault in blocking if fault.row is not None]] = False
    if not keep.any():
        raise blocking[0].error(dataset.csv_path, len(blocking) - 1)
    return dataset.select(keep), [
        f"row {fault.row} left out ({fault.field}: {fault.why})" for fault in blocking
    ]


def _hint(faults: list[DataFault], dataset: Dataset) -> BadFileError:
    error = faults[0].error(dataset.csv_path, len(faults) - 1)
    if all(fault.row is not None for fault in faults):
        error.next_step += ", or leave such rows out with --faults drop"
    return error
