"""A loading record as a fit's problem: the whole sequence, played on the plant.

Readings, noise and plant are those of `brace diagnose`, so that the same model has the same numbers in both."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.ground.errors import BadFileError
from brace.identify.fit import Nuisances, residual_of
from brace.identify.noise import FORCES
from brace.identify.record import Record, load_record, rms_force_n
from brace.model import LimbModel
from brace.native.plant_batch import model_numbers, number_index

OFFSET_KEYS = ("joint.femur.zero_offset_rad", "joint.tibia.zero_offset_rad")
MIN_ROWS = 4  # fewer are a line through two points


class LoadingProblem:
    """Forces, and encoder and gauge readings where there are any, each over its own noise. Readings that were not
    taken (NaN) weigh nothing. `record`: with a noise that is better known than at the first look."""

    def __init__(self, dataset: Dataset, record: Record | None = None) -> None:
        if dataset.rows < MIN_ROWS:
            raise BadFileError(
                f"{dataset.rows} rows are not enough to say anything",
                where=str(dataset.csv_path),
                why=f"at least {MIN_ROWS} readings are needed",
                next_step="record more steps",
            )
        self.dataset = dataset
        self.record = load_record(dataset) if record is None else record
        _, first = np.unique(dataset["config"], return_index=True)
        self._commanded = np.column_stack([dataset["theta1_rad"][first], dataset["theta2_rad"][first]])

    @property
    def count(self) -> int:
        """Number of readings."""
        return self.record.readings

    @property
    def noise_n(self) -> float:
        """rms of one sigma over the forces [N]."""
        return self.record.force_sigma_n

    @property
    def noise_source(self) -> str:
        """Where the forces' noise is known from."""
        sources = [self.record.noise[name].source for name in FORCES if np.isfinite(self.record.noise[name].floor)]
        return " and ".join(dict.fromkeys(sources))

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x (played - measured) / sigma, reading after reading."""
        return -self.record.residuals(models)

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x configurations x (theta1, theta2), true [rad]."""
        offsets = models[:, [number_index()[key] for key in OFFSET_KEYS]]
        return np.asarray(self._commanded + offsets[:, np.newaxis])

    def force_gap_n(self, model: LimbModel) -> float:
        """rms of what the model leaves of the forces [N]."""
        residual_of(self, model)  # refuses a model that cannot be played
        return rms_force_n(self.record, model_numbers(model))
