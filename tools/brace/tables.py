"""Postures of a stiffness table's rows: given, from a printed height, or from one height for all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset
from brace.errors import BadFileError
from brace.model import LimbModel

REACH_SLACK_MM = 1e-6


@dataclass(frozen=True)
class TablePoses:
    """How the rows' postures follow from the table. `fixed` holds true or commanded angles (rows x 2) when the
    table gives them; otherwise r and a height, each row's own or a common one, put the tip in front of the limb.
    """

    r_mm: np.ndarray
    z_mm: np.ndarray | None
    angles_rad: np.ndarray | None
    knee_sign: float = 1.0

    @property
    def needs_height(self) -> bool:
        """Is the direction of the tip unknown?"""
        return self.z_mm is None and self.angles_rad is None

    def height_limits_mm(self) -> tuple[float, float]:
        """The common heights that every row's r can reach."""
        smallest = float(self.r_mm.min())
        return -smallest * (1 - 1e-9), smallest * (1 - 1e-9)

    def true_angles(self, model: LimbModel, tip_height_mm: float = 0.0) -> np.ndarray:
        """rows x (theta1, theta2) [rad], true angles on this model's lengths."""
        if self.angles_rad is not None:
            offsets = [
                model.number("joint.femur.zero_offset_rad"),
                model.number("joint.tibia.zero_offset_rad"),
            ]
            return self.angles_rad + offsets
        femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
        height = self.z_mm if self.z_mm is not None else np.full_like(self.r_mm, tip_height_mm)
        phi = np.arcsin(np.clip(height / self.r_mm, -1.0, 1.0))
        outer = np.clip((femur + tibia) ** 2 - self.r_mm**2, 0.0, None)
        inner = np.clip(self.r_mm**2 - (femur - tibia) ** 2, 0.0, None)
        theta2 = self.knee_sign * 2 * np.arctan2(np.sqrt(outer), np.sqrt(inner))
        theta1 = phi + np.arctan2(tibia * np.sin(theta2), femur + tibia * np.cos(theta2))
        return np.column_stack([theta1, theta2])


def table_poses(dataset: Dataset, model: LimbModel, knee: str = "up") -> TablePoses:
    """Reads the postures out of a table; refuses rows out of the model's reach."""
    if "theta1_rad" in dataset and "theta2_rad" in dataset:
        angles = np.column_stack([dataset["theta1_rad"], dataset["theta2_rad"]])
        return TablePoses(dataset["r_mm"], None, angles)
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    r_mm = dataset["r_mm"]
    out = (r_mm > femur + tibia + REACH_SLACK_MM) | (r_mm < abs(femur - tibia) - REACH_SLACK_MM)
    z_mm = dataset["z_mm"] if "z_mm" in dataset else None
    high = np.abs(z_mm) > r_mm if z_mm is not None else np.zeros_like(out)
    for bad, field, why in (
        (out, "r_mm", f"this limb reaches {abs(femur - tibia):g} to {femur + tibia:g} mm"),
        (high, "z_mm", "a tip can not be higher than it is far away"),
    ):
        if bad.any():
            row = int(np.argmax(bad))
            value = dataset[field][row]
            raise BadFileError(
                f"{field} = {value:g} does not fit",
                why=why,
                where=f"{dataset.csv_path}:{row + 2} (row {row + 1}), {field}",
                next_step="check the row, or the model's lengths",
            )
    return TablePoses(r_mm, z_mm, None, 1.0 if knee == "up" else -1.0)
