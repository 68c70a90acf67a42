"""Postures of a stiffness table's rows: given, from a printed height, or from one height for all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset
from brace.ground.errors import BadFileError
from brace.model import LimbModel

REACH_SLACK_MM = 1e-6
REACH_FLOOR_MM = 1.0  # a tip is not better known than this
REACH_SIGMAS = 4.0


# What of a model a posture depends on.
POSTURE_KEYS = (
    "geometry.femur_mm",
    "geometry.tibia_mm",
    "joint.femur.zero_offset_rad",
    "joint.tibia.zero_offset_rad",
)


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
        numbers = np.array([[model.number(key)] for key in POSTURE_KEYS])
        return np.asarray(self.true_angles_many(numbers, np.array([tip_height_mm]))[0])

    def true_angles_many(self, numbers: np.ndarray, tip_height_mm: np.ndarray) -> np.ndarray:
        """The same for many models: models x rows x (theta1, theta2) [rad]. `numbers` has a row for each of
        POSTURE_KEYS, one entry per model, as `tip_height_mm` has."""
        femur, tibia, offset1, offset2 = numbers[:, :, np.newaxis]
        if self.angles_rad is not None:
            return np.stack([self.angles_rad[:, 0] + offset1, self.angles_rad[:, 1] + offset2], axis=2)
        height = self.z_mm if self.z_mm is not None else tip_height_mm[:, np.newaxis]
        phi = np.arcsin(np.clip(height / self.r_mm, -1.0, 1.0))
        outer = np.maximum((femur + tibia) ** 2 - self.r_mm**2, 0.0)
        inner = np.maximum(self.r_mm**2 - (femur - tibia) ** 2, 0.0)
        theta2 = self.knee_sign * 2 * np.arctan2(np.sqrt(outer), np.sqrt(inner))
        theta1 = phi + np.arctan2(tibia * np.sin(theta2), femur + tibia * np.cos(theta2))
        return np.stack([theta1, theta2], axis=2)


def _tip_mm(model: LimbModel, angles_rad: np.ndarray) -> np.ndarray:
    """rows x (x, z) of the tip at true angles."""
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    shank = angles_rad[:, 0] - angles_rad[:, 1]
    x_mm = femur * np.cos(angles_rad[:, 0]) + tibia * np.cos(shank)
    return np.column_stack([x_mm, femur * np.sin(angles_rad[:, 0]) + tibia * np.sin(shank)])


def _refuse_other_reach(dataset: Dataset, model: LimbModel, poses: TablePoses) -> None:
    """Refuses rows whose angles put this model's tip elsewhere than r_mm (and z_mm) say, beyond what print rounding
    and the trust in lengths and angles allow."""
    assert poses.angles_rad is not None
    angles = poses.true_angles(model)
    turned = angles - poses.angles_rad + np.radians(poses.angles_rad)
    rounding_rad = 0.5 * 10.0 ** -dataset.decimals.get("theta2_rad", 0)
    trust_mm = 1.5 * model.number("uncertainty.length_mm")  # two lengths
    trust_rad = model.number("uncertainty.angle_rad")
    shorter_mm = min(model.number("geometry.femur_mm"), model.number("geometry.tibia_mm"))
    # how far the tip goes per radian: r depends on the knee alone, by the shorter length at most
    levers = {"r_mm": np.full_like(poses.r_mm, shorter_mm), "z_mm": 2 * poses.r_mm + shorter_mm}
    for name, lever_mm in levers.items():
        if name not in dataset:
            continue
        printed = dataset[name]
        found, in_degrees = (
            np.hypot(*_tip_mm(model, at).T) if name == "r_mm" else _tip_mm(model, at)[:, 1]
            for at in (angles, turned)
        )
        allowed = (
            REACH_FLOOR_MM
            + 0.5 * 10.0 ** -dataset.decimals.get(name, 0)
            + REACH_SIGMAS * trust_mm
            + (rounding_rad + REACH_SIGMAS * trust_rad) * lever_mm
        )
        apart = np.abs(found - printed) > allowed
        if not apart.any():
            continue
        row = int(np.argmax(apart))
        degrees = bool((np.abs(in_degrees - printed) <= allowed).all())
        raise BadFileError(
            f"{name} = {printed[row]:g} contradicts the row's angles",
            where=f"{dataset.csv_path}:{row + 2} (row {row + 1}), {name}",
            why=f"this limb's tip is at {name} = {found[row]:.4g} with theta1 = {poses.angles_rad[row, 0]:g} and "
            f"theta2 = {poses.angles_rad[row, 1]:g} rad",
            next_step=(
                "the angles fit in degrees: convert both columns to radians (times pi/180)"
                if degrees
                else "check the row, the model's lengths and zero offsets, or drop the angle columns"
            ),
        )


def table_poses(dataset: Dataset, model: LimbModel, knee: str = "up") -> TablePoses:
    """Reads the postures out of a table; refuses rows out of the model's reach."""
    if "theta1_rad" in dataset and "theta2_rad" in dataset:
        angles = np.column_stack([dataset["theta1_rad"], dataset["theta2_rad"]])
        poses = TablePoses(dataset["r_mm"], None, angles)
        _refuse_other_reach(dataset, model, poses)
        return poses
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
