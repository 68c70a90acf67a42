"""A joint test as a fit's problem: the imposed deflection played on spring, gap, friction and hardening.

Gears rub in proportion to what they carry (`coulomb_per_load_ratio`). Without that share the fit of a gearbox
takes the widening loop for a softer spring and a narrower gap.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from brace.dataset import Dataset
from brace.dataset.grid import step_of, unrounded
from brace.effects.catalogue import FADES_SHRINK, FADING_STARTS, FRICTION_TURN, MOST_GAP, USUAL_LOAD_RATIO
from brace.ground.errors import BadFileError
from brace.identify.fit import Fit, Nuisances, columns_of, fit
from brace.identify.gear_positions import POSITION, apart, count
from brace.identify.parameters import (
    ANGLE_ZERO,
    LAG,
    SPREAD,
    TORQUE_OFFSET,
    VISCOUS,
    Parameter,
    ParameterSet,
    angle_zero,
    spread,
)
from brace.identify.swing import swing_over_both_flanks_rad
from brace.model import LimbModel
from brace.model.keys import KEY_BY_NAME
from brace.native.plant_batch import JointBatchPlayer, model_numbers, number_index

MIN_ROWS = 20
BLOCK_ROWS = 1200  # averaged readings: enough for every ramp's shape, few enough to try some hundred models
ASTRAY = 0.1  # of a test's largest command: a drive that is off by more does not follow it
MOST_ASTRAY = 0.1  # of the readings: if more are off, command and torque are not measured at the same place
MOST_TURN = 0.5  # of the range of angles: friction that a small test does not overcome bends over all of it
MOST_SPREAD = 0.7  # log of a ratio: what is twice as soft at one gear position is another joint
START_GAPS = (0.0, 0.25, 0.5, 0.8)  # of the largest gap that the record allows
START_FRICTION = (0.02, 0.1)  # of the range of torques
START_ZEROS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # of the range of angles, from its middle
START_TURNS = (0.02, 0.1)  # of the range of angles
START_HARDENING = (0.0, 4.0)  # cubic share of the torque at half the range of angles, over the linear one


Players = list[tuple[slice | np.ndarray, JointBatchPlayer]]


@dataclass(frozen=True)
class Motion:
    """Of every reading: its speed, a clock that always runs on, and what it showed when the reading's test began."""

    speed_rad_per_s: np.ndarray
    clock_s: np.ndarray
    began_s: np.ndarray


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
        self.dataset = dataset = apart(_as_it_stood(dataset))
        self.position_count = count(dataset)
        self.joint = dataset.meta.joint
        self.columns, self._counts = averaged(dataset, max(1, dataset.rows // block_rows))
        self.noise_n_mm = noise(self.columns["torque_n_mm"])
        self._used = usable(self.columns)
        angle, used = self.columns["angle_rad"], self._used
        torque, test = self.columns["torque_n_mm"], self.columns["test"]
        self.swing_rad = swing_over_both_flanks_rad(angle[used], torque[used], test[used])
        self._centre_rad = float(0.5 * (angle.max() + angle.min()))
        self._start_n_mm = _start_torque(self.columns)
        self._players = self._players_from(self._start_n_mm)
        self._motion = motion(self.columns)

    @property
    def count(self) -> int:
        """Number of averaged readings."""
        return int(np.count_nonzero(self._used))

    def residuals(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x (played - measured) / noise."""
        played = self.torques(models, nuisances)
        return np.asarray(((played - self.columns["torque_n_mm"]) / self.noise_n_mm)[:, self._used])

    def torque_n_mm(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """The model's torque at every row of the record, not averaged."""
        # an encoder's jitter is no motion: the deflection is what is left of it over a block
        angle = smoothed(self.dataset["angle_rad"], self.columns["test"], self._counts) - self._centre_rad
        columns = {
            **self.dataset.columns,
            "angle_rad": angle,
            "test": np.repeat(self.columns["test"], self._counts),
        }
        own = columns_of(nuisances)
        players = self._players_of(columns, np.repeat(self._start_n_mm, self._counts))
        played = self._played(players, model_numbers(model)[np.newaxis], own)
        return np.asarray(as_read(played, own, motion(columns))[0])

    def torques(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """The torque that is read at every averaged reading [N mm], models x readings; NaN for a joint that cannot
        be."""
        return as_read(self._played(self._players, models, nuisances), nuisances, self._motion)

    def _players_from(self, start_n_mm: np.ndarray) -> Players:
        """Play the averaged readings, each test from this torque on."""
        angle = self.columns["angle_rad"] - self._centre_rad
        return self._players_of({**self.columns, "angle_rad": angle}, start_n_mm)

    def _players_of(self, columns: Mapping[str, np.ndarray], start_n_mm: np.ndarray) -> Players:
        """One for each gear position, with its rows."""
        if self.position_count == 1:
            return [(slice(None), JointBatchPlayer(columns, self.joint, start_n_mm))]
        number = np.rint(columns[POSITION])
        found: Players = []
        for position in range(self.position_count):
            rows = np.flatnonzero(number == position)
            part = {name: values[rows] for name, values in columns.items()}
            found.append((rows, JointBatchPlayer(part, self.joint, start_n_mm[rows])))
        return found

    def _played(self, players: Players, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """models x rows [N mm]; NaN for a joint that cannot be."""
        none = np.zeros(len(models))
        index, first, models = number_index(), models, models.copy()
        zero = index[f"joint.{self.joint}.zero_offset_rad"]
        out = np.empty((len(models), sum(player.count for _, player in players)))
        for position, (rows, player) in enumerate(players):
            models[:, zero] = nuisances.get(angle_zero(position), none - self._centre_rad) + self._centre_rad
            for leaf in SPREAD if position else ():
                place = index[f"joint.{self.joint}.{leaf}"]
                models[:, place] = first[:, place] * np.exp(nuisances.get(spread(leaf, position), none))
            out[:, rows] = player.play_numbers(
                models, nuisances.get(FRICTION_TURN, none), nuisances.get(TORQUE_OFFSET, none)
            )
        return out

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
                Parameter(gap.key, gap.start, gap.scale, gap.low, self._largest_gap_rad()),
                free("coulomb_n_mm", model.number(at + "coulomb_n_mm"), 0.05 * torque_span),
                free("coulomb_per_load_ratio", model.number(at + "coulomb_per_load_ratio"), 0.1),
                free(
                    "hardening_n_mm_per_rad3", model.number(at + "hardening_n_mm_per_rad3"), hardening_scale
                ),
                *self.record_parameters(model).parameters,
                *self.spreads(),
            ),
        )

    def record_parameters(self, model: LimbModel) -> ParameterSet:
        """What no limb.toml holds: the encoder's zero, the torque's zero, the width over which friction
        turns. The encoder starts anywhere, so its zero says nothing of the limb's zero_offset_rad."""
        angle, torque = self.columns["angle_rad"], self.columns["torque_n_mm"]
        angle_span, torque_span = float(np.ptp(angle)) or 1e-6, float(np.ptp(torque)) or 1.0
        return ParameterSet(
            model,
            (
                *self.zeros(angle_span),
                Parameter(TORQUE_OFFSET, 0.0, 0.02 * torque_span, -torque_span, torque_span),
                Parameter(
                    FRICTION_TURN,
                    0.02 * angle_span,
                    0.01 * angle_span,
                    1e-4 * angle_span,
                    min(1.0, MOST_TURN * angle_span),
                ),
            ),
        )

    def _largest_gap_rad(self) -> float:
        return min(MOST_GAP * float(np.ptp(self.columns["angle_rad"])), self.swing_rad)

    def settled(self, found: Fit) -> Fit:
        """The fit with a load's share of friction that has the evidence for its size (row.Turn), and with intervals
        that count readings as far as they are independent."""
        key = f"joint.{self.joint}.coulomb_per_load_ratio"
        count = independent(found.residual, self.columns["test"][self._used])
        if found.x[found.parameters.keys.index(key)] > USUAL_LOAD_RATIO:
            prior = USUAL_LOAD_RATIO * np.sqrt(count) / float(np.linalg.norm(found.residual))
            drawn = [replace(one, start=0.0, prior_sigma=prior) if one.key == key else one
                     for one in found.parameters.parameters]  # fmt: skip
            found = fit(self, ParameterSet(found.parameters.base, tuple(drawn)), [found.x])
        return replace(self._fading(found), together=found.residual.size / count)

    def _fading(self, found: Fit) -> Fit:
        """The fit with a friction whose growth with the load fades, where that leaves less by a share."""
        key, ratio = (f"joint.{self.joint}.coulomb_{leaf}" for leaf in ("load_fade_per_n_mm", "per_load_ratio"))
        one = 1.0 / (float(np.ptp(self.columns["torque_n_mm"])) or 1.0)
        law = Parameter(key, found.parameters.base.number(key), one, 0.0, KEY_BY_NAME[key].high)
        starts = []
        for fades, share in FADING_STARTS:
            starts.append(np.append(found.x, fades * one))
            starts[-1][found.parameters.keys.index(ratio)] = share
        freed = ParameterSet(found.parameters.base, (*found.parameters.parameters, law))
        faded = fit(self, freed, [np.append(found.x, law.start), *starts])
        is_better = np.linalg.norm(faded.residual) < (1.0 - FADES_SHRINK) * np.linalg.norm(found.residual)
        return faded if is_better else found

    def zeros(self, angle_span_rad: float) -> tuple[Parameter, ...]:
        """The encoder's zero at every gear position."""
        zero, half = -self._centre_rad, 0.5 * angle_span_rad
        return tuple(
            Parameter(angle_zero(position), zero, 0.2 * half, zero - half, zero + half)
            for position in range(self.position_count)
        )

    def spreads(self) -> tuple[Parameter, ...]:
        """By how much the joint's numbers differ at the other gear positions."""
        return tuple(
            Parameter(spread(leaf, position), 0.0, 0.1, -MOST_SPREAD, MOST_SPREAD)
            for position in range(1, self.position_count)
            for leaf in SPREAD
        )

    def aligned(self, model: LimbModel) -> dict[str, float]:
        """The record's own nuisances that fit best with the model's joint as it is. With a gap the misfit has a valley
        for each way to lay the readings against its sides."""
        parameters = self.record_parameters(model)
        own = np.array([key.startswith(ANGLE_ZERO) for key in parameters.keys])
        span_rad = float(np.ptp(self.columns["angle_rad"]))
        starts = []
        for zero, turn in product(START_ZEROS, START_TURNS):
            point = parameters.array("start") + zero * span_rad * own
            point[parameters.keys.index(FRICTION_TURN)] = turn * span_rad
            starts.append(point)
        return fit(self, parameters, starts).nuisances

    def starts(self, parameters: ParameterSet) -> list[np.ndarray]:
        """Springs with less and more gap and friction: the misfit has several valleys."""
        angle_span = float(np.ptp(self.columns["angle_rad"]))
        torque_span = float(np.ptp(self.columns["torque_n_mm"]))
        points = []
        most = self._largest_gap_rad()
        for gap, friction, cubic in product(START_GAPS, START_FRICTION, START_HARDENING):
            point = parameters.array("start")
            reach_rad = 0.5 * (angle_span - gap * most)
            point[0] = 2 * reach_rad / torque_span * (1 + cubic)
            point[1], point[2], point[3] = gap * most, friction * torque_span, 0.02
            point[4] = cubic / (point[0] * reach_rad**2)
            points.append(point)
        return points


def motion(columns: Mapping[str, np.ndarray]) -> Motion:
    """Speeds and times of readings, never across tests."""
    test, time = columns["test"], columns["t_s"]
    starts = np.concatenate([[True], np.diff(test) != 0])
    step_s = np.where(starts, 0.0, np.diff(time, prepend=time[0]))
    turn = np.where(starts, 0.0, np.diff(columns["angle_rad"], prepend=columns["angle_rad"][0]))
    speed = np.divide(turn, step_s, out=np.zeros_like(turn), where=step_s > 0.0)
    clock = np.cumsum(np.where(starts, 1.0, np.maximum(step_s, 0.0)))
    return Motion(speed, clock, clock[np.maximum.accumulate(np.where(starts, np.arange(test.size), 0))])


def as_read(torque: np.ndarray, nuisances: Nuisances, moved: Motion) -> np.ndarray:
    """Torques (models x readings) with what grows with speed, and as late as they are read."""
    if VISCOUS in nuisances:
        torque = torque + nuisances[VISCOUS][:, np.newaxis] * moved.speed_rad_per_s
    if LAG in nuisances and np.any(nuisances[LAG]):
        clock, began = moved.clock_s, moved.began_s
        late = zip(nuisances[LAG], torque)
        torque = np.stack([np.interp(np.maximum(clock - lag, began), clock, one) for lag, one in late])
    return np.asarray(torque)


def averaged(dataset: Dataset, block: int) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Means over `block` rows, never across tests, and how many rows are in each."""
    test = _tests(dataset)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(test)) + 1, [test.size]])
    edges = np.concatenate([np.arange(first, last, block) for first, last in zip(starts[:-1], starts[1:])])
    counts = np.diff(np.append(edges, test.size))
    result = {
        name: np.add.reduceat(values.astype(float), edges) / counts
        for name, values in dataset.columns.items()
    }
    result["test"] = test[edges]
    return result, counts


def _tests(dataset: Dataset) -> np.ndarray:
    """The number of each row's test. A record that numbers no tests is one test."""
    return dataset["test"] if "test" in dataset else np.zeros(dataset.rows, np.int32)


def _as_it_stood(dataset: Dataset) -> Dataset:
    """The record with its angle as it stood before the encoder rounded it. The record itself where the rounding changes
    the torque by less than its noise."""
    angle, torque = dataset["angle_rad"], dataset["torque_n_mm"]
    step = step_of(angle)
    spring_n_mm_per_rad = float(np.ptp(torque)) / max(float(np.ptp(angle)), 1e-30)
    if spring_n_mm_per_rad * step / np.sqrt(12.0) <= noise(torque):
        return dataset
    return dataset.with_columns({"angle_rad": unrounded(angle, _tests(dataset), step)})


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


def independent(off: np.ndarray, test: np.ndarray) -> float:
    """How many independent readings these are worth, by the autocorrelation of what a model leaves of them."""
    off = off - off.mean()
    lags = min(200, off.size // 4)
    power = float(off @ off) or 1.0
    kept = np.zeros(lags)
    for lag in range(1, lags):
        together = test[lag:] == test[:-lag]
        kept[lag] = float((off[lag:] * off[:-lag])[together].sum()) / power
        if kept[lag] <= 0.05:
            kept[lag] = 0.0
            break
    total = 1.0 + 2.0 * float(kept.sum())
    return max(float(off.size) / total, 4.0)


def usable(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Averaged readings that show the joint: neither at the drive's limit nor where a drive that follows its command
    otherwise does not. There it runs through free travel and meets the far side, and its torque moves the motor."""
    most = saturated(columns)
    if "command_n_mm" not in columns:
        return np.asarray(~most)
    off = np.abs(columns["torque_n_mm"] - columns["command_n_mm"])
    _, number = np.unique(columns["test"], return_inverse=True)
    reach = np.zeros(int(number.max()) + 1)
    np.maximum.at(reach, number, np.abs(columns["command_n_mm"]))
    astray = off > ASTRAY * reach[number]
    follows = np.count_nonzero(astray & ~most) < MOST_ASTRAY * np.count_nonzero(~most)
    return np.asarray(~most & ~astray if follows else ~most)


def saturated(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    if "command_n_mm" not in columns:
        return np.zeros(columns["torque_n_mm"].size, dtype=bool)
    torque, command = np.abs(columns["torque_n_mm"]), np.abs(columns["command_n_mm"])
    limit = float(np.quantile(torque, 0.999))
    return np.asarray((0.8 * command > limit) & (torque > 0.8 * limit))
