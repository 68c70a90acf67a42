"""The readings that judge a joint test: averaged, and weighted by the way they stand for. Some are held out, and those
at the drive's limit are left out."""

from __future__ import annotations

from copy import copy

import numpy as np
from scipy.ndimage import uniform_filter1d

from brace.dataset import Dataset
from brace.dataset.grid import step_of
from brace.diagnose.joint_test.hold_out import alike, held_out
from brace.diagnose.joint_test.shapes import SHAPES, added
from brace.effects import JointTestSize
from brace.effects.catalogue import FRICTION_TURN
from brace.identify.fit import Nuisances, columns_of
from brace.identify.joint_test import JointProblem, as_read, independent, noise, saturated, usable
from brace.identify.gear_positions import POSITION
from brace.identify.swing import ramps
from brace.identify.parameters import angle_zero
from brace.model import LimbModel
from brace.native.plant_batch import model_numbers, number_index

STEPS_A_PERIOD = 4.0  # of the encoder: what repeats faster is its rounding
SPEEDS = 1.5  # by which fast motion must exceed slow motion for viscosity to be distinguished from friction


# A joint that does nothing but rub: its torque is how far friction is turned.
_FRICTION_ALONE = {
    "compliance_rad_per_n_mm": 1.0,
    "gap_rad": 0.0,
    "hardening_n_mm_per_rad3": 0.0,
    "coulomb_n_mm": 1e7,
    "coulomb_per_load_ratio": 0.0,
    "creep.ratio": 0.0,
    "thermal.joint_compliance_per_degc": 0.0,
}


class JointRecord(JointProblem):
    """`fitted` and `kept` mark the averaged readings that are fitted and that are held out; `torque` plays a
    model with the shapes of terms.py added."""

    def __init__(self, dataset: Dataset) -> None:
        super().__init__(dataset)
        columns = self.columns
        counts = usable(columns)
        self.position = np.rint(columns.get(POSITION, np.zeros(counts.size))).astype(int)
        kept, self.held_words = held_out(
            columns["angle_rad"], columns["torque_n_mm"], columns["test"], self.position
        )
        if np.count_nonzero(counts & ~kept) < 12:
            kept, self.held_words = np.zeros_like(kept), ""
        self.fitted, self.kept, self.held_rows = counts & ~kept, counts & kept, kept
        self.block_counts = self._counts
        self.ramp = ramps(columns["angle_rad"], columns["test"])
        test = columns["test"]
        self._start = np.concatenate([[True], np.diff(test) != 0])
        time = columns["t_s"]
        self._relaxed = self._players_from(np.zeros(test.size))
        self._since_s = time - time[np.maximum.accumulate(np.where(self._start, np.arange(test.size), 0))]
        temp = columns.get("temp_degc")
        self.size = JointTestSize(
            float(np.ptp(columns["angle_rad"])),
            float(np.ptp(columns["torque_n_mm"])),
            float(self._since_s.max()),
            float(np.ptp(temp)) if temp is not None else 0.0,
            float(np.quantile(np.abs(self._motion.speed_rad_per_s), 0.98)),
            self.swing_rad,
        )
        labels = np.unique(test)
        self.amplitudes = len(alike([float(np.ptp(columns["torque_n_mm"][test == label])) for label in labels]))
        self.minutes = float(sum(np.ptp(self._since_s[test == label]) for label in labels)) / 60.0
        self.raw_noise_n_mm = noise(dataset["torque_n_mm"])
        self.angle_step_rad = step_of(dataset["angle_rad"])
        spring = self.size.torque_n_mm / max(self.size.angle_rad, 1e-30)
        # an angle that is known to a step only leaves the torque uncertain by the spring's share of the step
        self.noise_n_mm = float(np.hypot(self.noise_n_mm, spring * self.angle_step_rad / np.sqrt(12.0)))
        self.root_weight = np.sqrt(self._path())
        self.rests = self._dwells()
        moving = np.abs(self._motion.speed_rad_per_s)[self.fitted]
        moving = moving[moving > 0.05 * max(self.size.speed_rad_per_s, 1e-30)]
        self.speeds_differ = bool(
            moving.size and np.quantile(moving, 0.9) > SPEEDS * max(np.quantile(moving, 0.25), 1e-30)
        )

    def _path(self) -> np.ndarray:
        """How much each reading counts: the way that it stands for in the plane of angle and torque, with a mean of 1.
        A joint that friction holds is read again and again and says nothing new; a joint that slips is read only once
        on its way."""
        away = np.zeros(self.fitted.size)
        for name, span in (("angle_rad", self.size.angle_rad), ("torque_n_mm", self.size.torque_n_mm)):
            smooth = uniform_filter1d(self.columns[name], 3) / span
            away += np.where(self._start, 0.0, np.abs(np.diff(smooth, prepend=smooth[0])))
        away = uniform_filter1d(away, 3)
        weight = np.clip(away / max(float(away[self.fitted].mean()), 1e-30), 0.1, 10.0)
        return np.asarray(weight / weight[self.fitted].mean())

    def _dwells(self) -> bool:
        """Whether time can show: the joint rests under load now and then, or large ramps differ in speed
        threefold."""
        if self.size.length_s <= 0.0:
            return False
        torque, angle, time = (self.columns[name] for name in ("torque_n_mm", "angle_rad", "t_s"))
        resting, rates = 0, []
        for label in np.unique(self.columns["test"]):
            rows = np.flatnonzero((self.columns["test"] == label) & self.fitted)
            width = max(5, rows.size // 20)
            if rows.size < 2 * width:
                continue
            still = np.ones(rows.size - width + 1, dtype=bool)
            for values, noise_size in ((torque[rows], 4.0 * self.noise_n_mm), (angle[rows], 0.0)):
                window = np.lib.stride_tricks.sliding_window_view(values, width)
                still &= np.ptp(window, axis=1) < 0.03 * np.ptp(values) + noise_size
            resting += int(np.count_nonzero(still))
        if resting > 0.03 * np.count_nonzero(self.fitted):
            return True
        for number in np.unique(self.ramp[self.fitted]):
            rows = np.flatnonzero((self.ramp == number) & self.fitted)
            way, took = abs(torque[rows[-1]] - torque[rows[0]]), time[rows[-1]] - time[rows[0]]
            if took > 0.0 and way > 0.5 * self.size.torque_n_mm:
                rates.append(way / took)
        return len(rates) >= 4 and max(rates) > 3.0 * min(rates)

    def torque(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """The model's torque at every averaged reading [N mm], shapes included."""
        return np.asarray(self.torques(model_numbers(model)[np.newaxis], columns_of(nuisances))[0])

    def torques(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """The same for many models (brace.native.plant_batch): models x readings; NaN for a joint that cannot be."""
        played = self._played(self._players, models, nuisances)
        if SHAPES.isdisjoint(nuisances):
            return as_read(played, nuisances, self._motion)
        index = number_index()
        at = f"joint.{self.joint}."
        angle = self.columns["angle_rad"]
        half_gap = 0.5 * models[:, index[at + "gap_rad"], np.newaxis]
        bent = self.deflection_rad(nuisances, len(models))
        bent = np.sign(bent) * np.maximum(np.abs(bent) - half_gap, 0.0)
        stiffness = 1.0 / np.maximum(models[:, index[at + "compliance_rad_per_n_mm"]], 1e-30)

        def shares(turn_rad: np.ndarray) -> np.ndarray:
            alone = models.copy()
            for key, value in _FRICTION_ALONE.items():
                alone[:, index[key if "." in key else at + key]] = value
            return self._played(self._relaxed, alone, {FRICTION_TURN: turn_rad}) / _FRICTION_ALONE["coulomb_n_mm"]

        played = added(played, bent, stiffness, angle - self._centre_rad, self._since_s, shares, nuisances)
        return as_read(played, nuisances, self._motion)

    def deflection_rad(self, nuisances: Nuisances, count: int) -> np.ndarray:
        """`count` models x averaged readings: the angle from the zero of its gear position."""
        if self.position_count == 1:
            zero = nuisances.get(angle_zero(0), np.full(count, -self._centre_rad))
            return np.asarray(self.columns["angle_rad"] + zero[:, np.newaxis])
        bent = np.empty((count, self.fitted.size))
        for one in range(self.position_count):
            rows = self.position == one
            zero = nuisances.get(angle_zero(one), np.full(count, -self._centre_rad))
            bent[:, rows] = self.columns["angle_rad"][rows] + zero[:, np.newaxis]
        return bent

    def offs(self, models: np.ndarray, nuisances: Nuisances) -> np.ndarray:
        """Played less measured [N mm], models x averaged readings."""
        return np.asarray(self.torques(models, nuisances) - self.columns["torque_n_mm"])

    def whole(self) -> JointRecord:
        """The same record with nothing held out."""
        other = copy(self)
        other.fitted, other.kept = self.fitted | self.kept, np.zeros_like(self.kept)
        return other

    def independent(self, off_n_mm: np.ndarray) -> float:
        """How many independent readings the fitted ones are worth, by what a model leaves of all averaged readings."""
        return independent(off_n_mm[self.fitted], self.columns["test"][self.fitted])

    def raw_off(self, model: LimbModel, nuisances: dict[str, float]) -> np.ndarray:
        """Measured less played [N mm], at every row of the record; the model alone, no shapes."""
        return np.asarray(self.dataset["torque_n_mm"] - self.torque_n_mm(model, nuisances))

    def raw_marks(self) -> tuple[np.ndarray, np.ndarray]:
        """`fitted` and `kept` of every row of the record."""
        usable = ~saturated(self.dataset.columns)
        return np.repeat(self.fitted, self._counts) & usable, np.repeat(self.kept, self._counts) & usable

    def strongest_period_rad(self, off_n_mm: np.ndarray) -> float:
        """The period in the angle that residuals follow most: between the spacing of readings and a third of
        the range."""
        x = self.columns["angle_rad"][self.fitted] - self._centre_rad
        y = off_n_mm[self.fitted] - off_n_mm[self.fitted].mean()
        longest = self.size.angle_rad / 3.0
        periods = longest / np.linspace(1.0, 16.0, 91)
        periods = periods[periods > STEPS_A_PERIOD * self.angle_step_rad]
        best, most = longest, -1.0
        for period in periods:
            phase = 2.0 * np.pi * x / period
            power = abs(np.exp(1j * phase) @ y)
            if power > most:
                best, most = float(period), float(power)
        return best
