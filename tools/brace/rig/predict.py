"""The dataset's own load sequence, played on a model: one predicted row per row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.dataset.table_poses import table_poses
from brace.dataset.zeroing import zeroed
from brace.ground.errors import UsageError
from brace.model import LimbModel

_MEASURED = (
    "fx_n",
    "fz_n",
    "torque_n_mm",
    "k_xx",
    "k_xz",
    "k_zx",
    "k_zz",
    "lambda_min",
    "lambda_max",
    "unit",
    "enc1_rad",
    "enc2_rad",
    "base_x_mm",
    "base_z_mm",
)
_OPTIONAL_READINGS = ("enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
TABLE_COLUMNS = ("k_xx", "k_xz", "k_zx", "k_zz", "lambda_min", "lambda_max")


@dataclass(frozen=True)
class Prediction:
    """Predicted columns by name, one entry per row; notes are what a reader must know."""

    columns: dict[str, np.ndarray]
    notes: tuple[str, ...] = ()


def require_sound_inputs(dataset: Dataset) -> Sequence[DataFault]:
    """Refuses faults in what is played; returns those in what was measured, which a prediction does not use."""
    measured = [fault for fault in dataset.faults if fault.field in _MEASURED]
    blocking = [fault for fault in dataset.faults if fault.blocking and fault.field not in _MEASURED]
    if blocking:
        raise blocking[0].error(dataset.csv_path, len(blocking) - 1)
    return measured


def predict(
    dataset: Dataset, model: LimbModel, *, knee: str = "up", tip_height_mm: float | None = None
) -> Prediction:
    """Plays the dataset on the model."""
    require_sound_inputs(dataset)
    if dataset.kind == "loading":
        return Prediction(predict_loading(dataset, model))
    if dataset.kind == "joint_test":
        return _predict_joint_test(dataset, model)
    return _predict_table(dataset, model, knee, tip_height_mm)


def predict_loading(dataset: Dataset, model: LimbModel) -> dict[str, np.ndarray]:
    """Forces [N], and encoder and gauge readings where the dataset has them."""
    from brace.identify.playing import player_of
    from brace.identify.turning import settled

    names = ["fx_n", "fz_n", *(name for name in _OPTIONAL_READINGS if name in dataset)]
    return zeroed(player_of(settled(dataset, model), names).play(model, names), dataset)


def _predict_joint_test(dataset: Dataset, model: LimbModel) -> Prediction:
    """The joint's torque at the record's deflections. Where the encoder, the torque sensor and friction stood at the
    start is the record's and in no limb.toml: it is fitted here as `identify` fits it, and said."""
    from brace.identify.joint_test import MIN_ROWS, JointProblem
    from brace.effects.catalogue import FRICTION_TURN
    from brace.identify.parameters import ANGLE_ZERO, TORQUE_OFFSET

    if dataset.rows < MIN_ROWS or any(fault.blocking for fault in dataset.faults):
        from brace.native.plant import JointPlayer

        torque = JointPlayer(dataset, dataset.meta.joint).play(model)
        return Prediction({"torque_n_mm": torque}, ("the angle is taken with the model's zero_offset_rad",))
    problem = JointProblem(dataset)
    own = problem.aligned(model)
    note = (
        f"fitted to this record, not the limb's: zero of the angle {own[ANGLE_ZERO]:+.4g} rad, offset of the torque "
        f"{own[TORQUE_OFFSET]:+.4g} N mm, friction turning over {own[FRICTION_TURN]:.3g} rad; "
        "spring, gap, friction and hardening are the model's"
    )
    return Prediction({"torque_n_mm": problem.torque_n_mm(model, own)}, (note,))


def _predict_table(dataset: Dataset, model: LimbModel, knee: str, tip_height_mm: float | None) -> Prediction:
    from brace.stiffness.at_rest import PostureError, planar_limb

    poses = table_poses(dataset, model, knee)
    notes: tuple[str, ...] = ()
    height = tip_height_mm if tip_height_mm is not None else 0.0
    low, high = poses.height_limits_mm()
    if poses.needs_height and not low <= height <= high:
        raise UsageError(
            f"--tip-height-mm {height:g} is out of reach",
            why=f"the nearest row has r = {high:.4g} mm",
            next_step=f"a height between {low:.4g} and {high:.4g} mm",
        )
    if poses.needs_height and tip_height_mm is None:
        from brace.identify.table import best_tip_height_mm

        height = best_tip_height_mm(dataset, model, poses)
        notes = (
            f"the table gives no direction of the tip: one height of z = {height:.1f} mm for all rows agrees best "
            "with its K; an inference (--tip-height-mm sets it)",
        )
    limb = planar_limb(model)
    angles = poses.true_angles(model, height)
    try:
        k = limb.stiffness(angles[:, 0], angles[:, 1])
    except PostureError as error:
        from brace.ground.errors import BadFileError

        raise BadFileError(
            "the posture of this row is refused",
            why=error.text,
            where=f"{dataset.csv_path}:{error.index + 2} (row {error.index + 1})",
            next_step="check its r_mm, z_mm or angles",
        ) from None
    source = (
        "k_xx_n_per_mm",
        "k_xz_n_per_mm",
        "k_xz_n_per_mm",
        "k_zz_n_per_mm",
        "lambda_min_n_per_mm",
        "lambda_max_n_per_mm",
    )
    return Prediction({name: k[column].astype(float) for name, column in zip(TABLE_COLUMNS, source)}, notes)
