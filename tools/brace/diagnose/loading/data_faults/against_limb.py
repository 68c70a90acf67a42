"""A loading record against the limb that is believed: faults that only show once one knows about what should have been
read. Effects of the catalogue are allowed for first: a fault is what one repair of the record removes, down to near the
noise, and no limb within the calibration's trust does."""

from __future__ import annotations

from collections.abc import Sequence

from brace.dataset import DataFault, Dataset
from brace.diagnose.loading.data_faults import columns, readings, runs, sides
from brace.identify.noise import FORCES
from brace.diagnose.loading.data_faults.judge import Judge
from brace.model import LimbModel

CLEAN_EXCESS = 1.0  # of chi squared per reading: below it neither columns nor runs are wrong


def faults(dataset: Dataset, believed: LimbModel) -> list[DataFault]:
    """What is wrong with the record, by the believed limb; empty for a healthy one, whatever effects it holds."""
    judge = Judge(dataset, believed)
    clean = judge.as_it_is.excess < CLEAN_EXCESS
    found = [] if clean else columns.faults(judge)
    found = found or readings.faults(judge)
    if not found and not clean:
        found = runs.faults(judge)
    return found or sides.faults(judge)


def confirmed(dataset: Dataset, believed: LimbModel, slips: Sequence[DataFault]) -> list[DataFault]:
    """Those single slips whose repair brings the reading nearer to what the limb would give; in a burst of glitches
    the neighbours mislead."""
    if not slips:
        return []
    judge = Judge(dataset, believed)
    kept = []
    for fault in slips:
        if fault.row is None or fault.field not in FORCES or not isinstance(fault.suggestion, float):
            continue
        due = judge.played[FORCES.index(fault.field), fault.row - 1]
        if abs(fault.suggestion - due) < 0.5 * abs(dataset[fault.field][fault.row - 1] - due):
            kept.append(fault)
    return readings.lone(judge, kept)
