"""A table of stiffness matrices as a fit's problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_table import stiffness
from brace.dataset.table_poses import POSTURE_KEYS, TablePoses, table_poses
from brace.ground.errors import BadFileError
from brace.identify.fit import Nuisances
from brace.identify.parameters import TIP_HEIGHT, Parameter, natural_scale
from brace.model import LimbModel
from brace.native.plant import reference_planar
from brace.native.plant_batch import model_numbers, number_index, reference_planar_many

MIN_ROWS = 2


@dataclass(frozen=True)
class Weight:
    """One sigma of an entry of K: absolute + relative part."""

    absolute_n_per_mm: float = 0.3
    relative: float = 0.1


class TableProblem:
    """Entries k_xx, k_xz, k_zz of every row, over the weight."""

    def __init__(self, dataset: Dataset, model: LimbModel, weight: Weight, knee: str = "up") -> None:
        if dataset.rows < MIN_ROWS:
            raise BadFileError(
                f"{dataset.rows} row is not enough to say anything",
                where=str(dataset.csv_path),
                why=f"at least {MIN_ROWS} stiffness matrices are needed",
                next_step="measure more poses",
            )
        self.dataset = dataset
        self.poses: TablePoses = table_poses(dataset, model, knee)
        self.k = stiffness(dataset.columns)
        self.weight = weight
        self.sigma = weight.absolute_n_per_mm + weight.relative * np.abs(self.k)

    @property
    def count(self) -> int:
        """Number of entries of K."""
        return int(self.k.size)

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x (model - measured) / sigma, row by row."""
        k = reference_planar_many(models, self.angles(models, nuisances))[:, :, :3]
        return np.asarray((k - self.k) / self.sigma).reshape(len(models), -1)

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x rows x (theta1, theta2), true [rad]."""
        index = number_index()
        numbers = models[:, [index[key] for key in POSTURE_KEYS]].T
        return self.poses.true_angles_many(numbers, nuisances.get(TIP_HEIGHT, np.zeros(len(models))))

    def predicted(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """rows x (k_xx, k_xz, k_zz) [N/mm]."""
        angles = self.poses.true_angles(model, nuisances.get(TIP_HEIGHT, 0.0))
        return reference_planar(model, angles[:, 0], angles[:, 1])[:, :3]

    def height_parameter(self, start_mm: float | None = None) -> Parameter:
        """The common height of the tip, for a table that gives r alone."""
        low, high = self.poses.height_limits_mm()
        return Parameter(
            TIP_HEIGHT, 0.6 * low if start_mm is None else start_mm, natural_scale(TIP_HEIGHT), low, high
        )


def best_tip_height_mm(dataset: Dataset, model: LimbModel, poses: TablePoses) -> float:
    """The height whose K comes nearest to the table's, limb as it is: a scan, then refined."""
    problem = TableProblem(dataset, model, Weight())
    low, high = poses.height_limits_mm()

    models = np.tile(model_numbers(model), (41, 1))
    for _ in range(6):
        heights = np.linspace(low, high, 41)
        values = [residual @ residual for residual in problem.residuals(models, {TIP_HEIGHT: heights})]
        best = int(np.argmin(values))
        low, high = heights[max(best - 1, 0)], heights[min(best + 1, 40)]
    return float(0.5 * (low + high))
