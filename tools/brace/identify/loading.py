"""A loading record as a fit's problem: the whole sequence, played on the plant."""

from __future__ import annotations

import numpy as np

from brace.dataset import Dataset
from brace.dataset.zeroing import zeroed
from brace.errors import BadFileError
from brace.identify.fit import Nuisances, residual_of
from brace.identify.noise import NoiseFloor, along_runs, noise_floor
from brace.model import LimbModel
from brace.identify.playing import player_of
from brace.native.plant_batch import number_index

FORCES = ("fx_n", "fz_n")
OFFSET_KEYS = ("joint.femur.zero_offset_rad", "joint.tibia.zero_offset_rad")
_SIDE_READINGS = ("enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")
MIN_ROWS = 12


class LoadingProblem:
    """Forces, and encoder and gauge readings where there are any, each over its own noise floor. Readings that were not
    taken (NaN) weigh nothing."""

    def __init__(self, dataset: Dataset) -> None:
        if dataset.rows < MIN_ROWS:
            raise BadFileError(
                f"{dataset.rows} rows are not enough to say anything",
                where=str(dataset.csv_path),
                why=f"at least {MIN_ROWS} readings are needed",
                next_step="record more steps",
            )
        self.dataset = dataset
        self.noise: NoiseFloor = noise_floor(dataset)
        present = (name for name in (*FORCES, *_SIDE_READINGS) if name in dataset)
        self._names = [name for name in present if not np.isnan(dataset[name]).all()]
        self._player = player_of(dataset, self._names)
        self._sigma = {
            name: self.noise.sigma_n if name in FORCES else _side_sigma(dataset, name)
            for name in self._names
        }
        _, first = np.unique(dataset["config"], return_index=True)
        self._commanded = np.column_stack([dataset["theta1_rad"][first], dataset["theta2_rad"][first]])

    @property
    def count(self) -> int:
        """Number of readings."""
        return int(sum(np.count_nonzero(~np.isnan(self.dataset[name])) for name in self._names))

    @property
    def readings(self) -> list[str]:
        """Names of the readings that are fitted."""
        return list(self._names)

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x (played - measured) / sigma, reading after reading."""
        readings = self._player.play_numbers(models, settled=True)
        played = zeroed(dict(zip(self._names, np.moveaxis(readings, 1, 0))), self.dataset)
        off = [(played[name] - self.dataset[name]) / self._sigma[name] for name in self._names]
        return np.asarray(np.nan_to_num(np.concatenate(off, axis=1)))

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x configurations x (theta1, theta2), true [rad]."""
        offsets = models[:, [number_index()[key] for key in OFFSET_KEYS]]
        return np.asarray(self._commanded + offsets[:, np.newaxis])

    def force_gap_n(self, model: LimbModel) -> float:
        """rms of what the model leaves of the forces [N]."""
        forces = [name for name in self._names if name in FORCES]
        residual = residual_of(self, model)[: len(forces) * self.dataset.rows] * self.noise.sigma_n
        read = ~np.isnan(np.concatenate([self.dataset[name] for name in forces]))
        return float(np.sqrt(np.mean(residual[read] ** 2)))


def _side_sigma(dataset: Dataset, name: str) -> float:
    """Noise of an encoder or gauge, from repeats or, without any, from its third differences along the runs; never
    below a thousandth of what it moves by."""
    dataset = dataset.select(~np.isnan(dataset[name]))
    keys = np.column_stack([dataset["config"], dataset["axis"], dataset["step"]])
    _, group, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    means = np.bincount(group, weights=dataset[name]) / counts
    if freedom := int(np.sum(counts - 1)):
        spread = float(np.sqrt(np.sum((dataset[name] - means[group]) ** 2) / freedom))
    else:
        spread = along_runs(dataset, dataset[name])
    moves = float(np.std(dataset[name]))
    return max(spread, 1e-3 * moves, 1e-12)
