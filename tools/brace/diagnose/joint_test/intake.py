"""The gate of a joint test: faults that end it, and the model that it starts from."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.ground.errors import BadFileError
from brace.model import LIMB_KEYS, LimbModel, load_limb

MIN_ROWS = 20
_EXAMPLE = Path(__file__).resolve().parents[2] / "data" / "paper-limb.toml"


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
    values = {
        key.name: key.default
        for key in LIMB_KEYS
        if key.name.startswith(f"joint.{joint}.") and key.default is not None
    }
    values[f"joint.{joint}.compliance_rad_per_n_mm"] = float(np.clip(compliance, 1e-12, 1.0))
    return load_limb(_EXAMPLE).with_values(values)
