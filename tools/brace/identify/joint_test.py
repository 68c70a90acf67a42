"""A joint test as a fit's problem: the imposed deflection played on spring, gap, friction and hardening.

Gears rub in proportion to what they carry (`coulomb_per_load_ratio`). Without that share the fit of a gearbox
takes the widening loop for a softer spring and a narrower gap.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np

from brace.dataset import Dataset
from brace.errors import BadFileError
from brace.identify.fit import Nuisances, columns_of, fit
from brace.effects.catalogue import FRICTION_TURN
from brace.identify.parameters import (
    ANGLE_ZERO,
    TORQUE_OFFSET,
    Parameter,
    ParameterSet,
)
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME
from brace.native.plant_batch import JointBatchPlayer, model_numbers, number_index

MIN_ROWS = 20
BLOCK_ROWS = 3000  # rows that a record is averaged down to: the angle's last digit must not look like motion
START_GAPS = (0.0, 0.25, 0.5)  # of the range of angles
START_FRICTION = (0.02, 0.1)  # of the range of torques
START_HARDENING = (0.0, 4.0)  # cubic share of the torque at half the range of angles, over the linear one


class JointProblem:
    """Torque over its noise, at the deflections of the record; rows at the drive's limit are left out."""

    def __init__(self, dataset: Dataset, block_rows: int = BLOCK_ROWS) -> None:
        if dataset.rows < MIN_ROWS:
            raise BadFileError(
                f"{dataset.rows} rows are not enough to say anything",
                where=str(dataset.csv_path),
                why=f"at least {MIN_ROWS} readings are needed",
                next_step="record more",
            )
        self.dataset = dataset
        self.joint = dataset.meta.joint
        self.columns, self._counts = averaged(dataset, max(1, dataset.rows // block_rows))
        self.noise_n_mm = noise(self.columns["torque_n_mm"])
        self._used = ~saturated(self.columns)
        angle = self.columns["angle_rad"]
        self._centre_rad = float(0.5 * (angle.max() + angle.min()))
        self._start_n_mm = _start_torque(self.columns)
        self._player = JointBatchPlayer(
            {**self.columns, "angle_rad": angle - self._centre_rad}, self.joint, self._start_n_mm
        )

    @property
    def count(self) -> int:
        """Number of averaged readings."""
        return int(np.count_nonzero(self._used))

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x (played - measured) / noise."""
        played = self._played(self._player, models, nuisances)
        return np.asarray(((played - self.columns["torque_n_mm"]) / self.noise_n_mm)[:, self._used])

    def torque_n_mm(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """The model's torque at every row of the record, not averaged."""
        # an encoder's jitter is no motion: the deflection is what is left of it over a block
        angle = smoothed(self.dataset["angle_rad"], self.columns["test"], self._counts) - self._centre_rad
        start_n_mm = np.repeat(self._start_n_mm, self._counts)
        whole = JointBatchPlayer({**self.dataset.columns, "angle_rad": angle}, self.joint, start_n_mm)
        return np.asarray(self._played(whole, model_numbers(model)[np.newaxis], columns_of(nuisances))[0])

    def _played(self, player: JointBatchPlayer, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x rows [N mm]; NaN for a joint that cannot be."""
        none = np.zeros(len(models))
        models = models.copy()
        models[:, number_index()[f"joint.{self.joint}.zero_offset_rad"]] = (
            nuisances.get(ANGLE_ZERO, none - self._centre_rad) + self._centre_rad
        )
        return player.play_numbers(
            models, nuisances.get(FRICTION_TURN, none), nuisances.get(TORQUE_OFFSET, none)
        )

    def angles(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """None: one joint has no tip."""
        return np.empty((len(models), 0, 2))

    def signal_n_mm(self) -> float:
        """Standard deviation of the torque that is fitted."""
        return float(np.std(self.columns["torque_n_mm"][self._used]))

    def parameters(self, model: LimbModel) -> ParameterSet:
        """Spring, gap, friction, hardening, and the record's own; scaled by the record."""
        angle, torque = self.columns["angle_rad"], self.columns["torque_n_mm"]
        angle_span, torque_span = float(np.ptp(angle)) or 1e-6, float(np.ptp(torque)) or 1.0
        at = f"joint.{self.joint}."
        compliance = model.number(at + "compliance_rad_per_n_mm") or angle_span / torque_span
        hardening_scale = torque_span / angle_span**3

        def free(leaf: str, start: float, scale: float) -> Parameter:
            key = KEY_BY_NAME[at + leaf]
            return Parameter(key.name, start, scale, key.low, key.high)

        lowest = free("compliance_rad_per_n_mm", compliance, angle_span / torque_span)
        gap = free("gap_rad", model.number(at + "gap_rad"), 0.1 * angle_span)
        return ParameterSet(
            model.with_values({at + "compliance_rad_per_n_mm": compliance}),
            (
                Parameter(lowest.key, lowest.start, lowest.scale, 1e-3 * lowest.scale, lowest.high),
                Parameter(gap.key, gap.start, gap.scale, gap.low, min(gap.high, angle_span)),
                free("coulomb_n_mm", model.number(at + "coulomb_n_mm"), 0.05 * torque_span),
                free("coulomb_per_load_ratio", model.number(at + "coulomb_per_load_ratio"), 0.1),
                free(
                    "hardening_n_mm_per_rad3", model.number(at + "hardening_n_mm_per_rad3"), hardening_scale
                ),
                *self.record_parameters(model).parameters,
            ),
        )

    def record_parameters(self, model: LimbModel) -> ParameterSet:
        """What no limb.toml holds: the encoder's zero, the torque's zero, the width over which friction
        turns. The encoder starts anywhere, so its zero says nothing of the limb's zero_offset_rad."""
        angle, torque = self.columns["angle_rad"], self.columns["torque_n_mm"]
        angle_span, torque_span = float(np.ptp(angle)) or 1e-6, float(np.ptp(torque)) or 1.0
        zero = -self._centre_rad
        return ParameterSet(
            model,
            (
                Parameter(
                    ANGLE_ZERO, zero, 0.1 * angle_span, zero - 0.5 * angle_span, zero + 0.5 * angle_span
                ),
                Parameter(TORQUE_OFFSET, 0.0, 0.02 * torque_span, -torque_span, torque_span),
                Parameter(
                    FRICTION_TURN,
                    0.02 * angle_span,
                    0.01 * angle_span,
                    1e-4 * angle_span,
                    min(1.0, 0.25 * angle_span),
                ),
            ),
        )

    def aligned(self, model: LimbModel) -> dict[str, float]:
        """The record's own nuisances that fit best with the model's joint as it is."""
        return fit(self, self.record_parameters(model)).nuisances

    def starts(self, parameters: ParameterSet) -> list[np.ndarray]:
        """Springs with less and more gap and friction: the misfit has several valleys."""
        angle_span = float(np.ptp(self.columns["angle_rad"]))
        torque_span = float(np.ptp(self.columns["torque_n_mm"]))
        points = []
        for gap, friction, cubic in product(START_GAPS, START_FRICTION, START_HARDENING):
            point = parameters.array("start")
            reach_rad = 0.5 * angle_span * (1 - gap)
            point[0] = 2 * reach_rad / torque_span * (1 + cubic)
            point[1], point[2], point[3] = gap * angle_span, friction * torque_span, 0.02
            point[4] = cubic / (point[0] * reach_rad**2)
            points.append(point)
        return points


def averaged(dataset: Dataset, block: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Means over `block` rows, never across tests, and how many rows are in each."""
    test = dataset["test"] if "test" in dataset else np.zeros(dataset.rows, np.int32)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(test)) + 1, [test.size]])
    edges = np.concatenate([np.arange(first, last, block) for first, last in zip(starts[:-1], starts[1:])])
    counts = np.diff(np.append(edges, test.size))
    result = {
        name: np.add.reduceat(values.astype(float), edges) / counts
        for name, values in dataset.columns.items()
    }
    result["test"] = test[edges]
    return result, counts


def smoothed(values: np.ndarray, test: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Moving means over as many rows as a block has, never across tests; `test` and `counts` are the
    blocks'."""
    width = int(np.median(counts))
    if width < 2:
        return values
    result = np.empty_like(values, dtype=float)
    edges = np.concatenate([[0], np.cumsum(counts)])
    block_starts = np.concatenate([[0], np.flatnonzero(np.diff(test)) + 1, [test.size]])
    for first, last in zip(edges[block_starts[:-1]], edges[block_starts[1:]]):
        part = values[first:last]
        sums = np.concatenate([[0.0], np.cumsum(part)])
        rows = np.arange(part.size)
        reach = np.minimum(np.minimum(rows, part.size - 1 - rows), width // 2)
        result[first:last] = (sums[rows + reach + 1] - sums[rows - reach]) / (2 * reach + 1)
    return result


def _start_torque(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """One entry a row: the torque that its test starts with, a few readings' mean."""
    test, torque = columns["test"], columns["torque_n_mm"]
    starts = np.concatenate([[0], np.flatnonzero(np.diff(test)) + 1])
    lengths = np.diff(np.append(starts, test.size))
    means = [torque[first : first + min(3, length)].mean() for first, length in zip(starts, lengths)]
    return np.repeat(means, lengths)


def noise(torque_n_mm: np.ndarray) -> float:
    """Scatter from one averaged reading to the next, slow motion taken out by third differences."""
    third = np.diff(torque_n_mm, n=3)
    return max(
        float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0)), 1e-6 * float(np.ptp(torque_n_mm)) or 1e-9
    )


def saturated(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    if "command_n_mm" not in columns:
        return np.zeros(columns["torque_n_mm"].size, dtype=bool)
    torque, command = np.abs(columns["torque_n_mm"]), np.abs(columns["command_n_mm"])
    limit = float(np.quantile(torque, 0.999))
    return np.asarray((0.8 * command > limit) & (torque > 0.8 * limit))
