"""The gate of a joint test: faults that end it, and the model that it starts from."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.errors import BadFileError
from brace.model import LimbModel, load_limb

MIN_ROWS = 20
_EXAMPLE = Path(__file__).resolve().parents[2] / "data" / "paper-limb.toml"
_DRIVE = ("gap_rad", "coulomb_n_mm", "coulomb_per_load_ratio", "hardening_n_mm_per_rad3", "zero_offset_rad")


def require_enough(dataset: Dataset) -> None:
    """Refuses a record too short for any statement."""
    if dataset.rows < MIN_ROWS:
        raise BadFileError(
            f"{dataset.rows} rows are not enough to say anything",
            where=str(dataset.csv_path),
            why=f"at least {MIN_ROWS} readings are needed",
            next_step="record more",
        )


def blocking_faults(dataset: Dataset) -> list[DataFault]:
    """Faults that leave nothing to be said about the joint, those of the whole record too."""
    found = [fault for fault in dataset.faults if fault.blocking]
    for name in ("angle_rad", "torque_n_mm"):
        if np.ptp(dataset[name]) == 0.0 and not any(fault.field == name for fault in found):
            found.append(DataFault(None, name, "the column never changes"))
    return found


def spring_alone(dataset: Dataset) -> LimbModel:
    """The start when no model is given: the example limb with nothing but a spring at the joint, as stiff as
    a straight line through the record says."""
    joint = dataset.meta.joint
    compliance = float(np.ptp(dataset["angle_rad"]) / max(float(np.ptp(dataset["torque_n_mm"])), 1e-9))
    values = {f"joint.{joint}.{leaf}": 0.0 for leaf in _DRIVE}
    values[f"joint.{joint}.compliance_rad_per_n_mm"] = float(np.clip(compliance, 1e-12, 1.0))
    return load_limb(_EXAMPLE).with_values(values)
