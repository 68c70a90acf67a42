"""What a diagnosis does to K: the model as believed beside the one that is exported."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.diagnose.diagnosis import StiffnessAt, StiffnessChange
from brace.ground.errors import BadFileError
from brace.model import LimbModel
from brace.native.plant import reference_planar

_WEIGHT = np.sqrt([1.0, 2.0, 1.0])  # of xx, xz, zz: Frobenius, because xz stands twice in K


def postures(dataset: Dataset) -> np.ndarray:
    """The commanded angles of a loading record's configurations, one row each [rad]."""
    _, first = np.unique(dataset["config"], return_index=True)
    return np.column_stack([dataset["theta1_rad"][first], dataset["theta2_rad"][first]])


def k_at(limb: LimbModel, at_rad: np.ndarray) -> np.ndarray:
    """K without load, its play taken up [N/mm], postures x (xx, xz, zz); not a number where the limb has none."""
    angles = [
        at_rad[:, place] + limb.number(f"joint.{joint}.zero_offset_rad")
        for place, joint in enumerate(("femur", "tibia"))
    ]
    try:
        return np.asarray(reference_planar(limb, *angles)[:, :3])
    except BadFileError:
        return np.full((len(at_rad), 3), np.nan)


def apart(k: np.ndarray, of: np.ndarray) -> np.ndarray:
    """By posture, how far a K is from another one, as a share of the other [Frobenius]."""
    return np.asarray(np.linalg.norm((k - of) * _WEIGHT, axis=-1) / np.linalg.norm(of * _WEIGHT, axis=-1))


def stiffness_change(dataset: Dataset, believed: LimbModel, exported: LimbModel) -> StiffnessChange | None:
    """At the record's posture where K changes most; None where the record has no postures, or a limb no K there."""
    if dataset.kind != "loading":
        return None
    at_rad = postures(dataset)
    before, after = k_at(believed, at_rad), k_at(exported, at_rad)
    off = apart(after, before)
    if not np.isfinite(off).all():
        return None
    place = int(np.argmax(off))
    angles = [float(angle) for angle in at_rad[place]]
    return StiffnessChange(
        StiffnessAt(*angles, *map(float, before[place])), StiffnessAt(*angles, *map(float, after[place]))
    )
