"""A loading record as numbers for fits: readings over their noise, and the plant that plays its sequence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts
from brace.identify.noise import FORCES, ChannelNoise, noise_of
from brace.effects import LoadingSize
from brace.identify.playing import player_of
from brace.model import LimbModel
from brace.native.plant_batch import LoadingBatchPlayer, model_numbers, number_index

NOT_MEASURED = 1e30  # sigma of a reading that was not taken
MOST_KNOWN = 400  # limbs whose residuals are kept
MOST_KEPT_BYTES = 64_000_000  # of them together
SIDE_READINGS = ("enc1_rad", "enc2_rad", "base_x_mm", "base_z_mm")


@dataclass(frozen=True)
class Record:
    """`measured` and `sigma` are channels x rows, in the channels' units; forces come first. Where a channel was not
    read, `measured` is 0 and sigma is NOT_MEASURED. `zeroed` are the places of the channels of which each run's first
    reading was taken off. `beside_model` (channels x rows x sizes, in the channels' units for one sigma of each size)
    is what instruments may add to the readings; it is taken out of residuals as far as it may explain them."""

    dataset: Dataset
    channels: tuple[str, ...]
    noise: dict[str, ChannelNoise]
    measured: np.ndarray
    sigma: np.ndarray
    player: LoadingBatchPlayer
    zeroed: tuple[int, ...] = ()
    beside_model: np.ndarray | None = None

    def __reduce__(self) -> tuple[object, ...]:
        """To another process everything but the player goes, whose memory is the library's: it is made anew."""
        readings = (self.measured, self.sigma, self.zeroed, self.beside_model)
        return _record, (self.dataset, self.channels, self.noise, *readings)

    @property
    def rows(self) -> int:
        return self.dataset.rows

    def residuals(self, models: np.ndarray) -> np.ndarray:
        """(measured - played) / sigma of models (models x numbers): models x readings, channel after channel. A search
        comes back to the same limbs again and again; those that it saw last are not played anew."""
        known, names = self._last_seen, [model.tobytes() for model in models]
        fresh = {name: place for place, name in enumerate(names) if name not in known}
        if fresh:
            known.update(zip(fresh, self._played(models[list(fresh.values())])))
        found = np.empty((len(models), self.measured.size))
        for place, name in enumerate(names):
            known[name] = found[place] = known.pop(name)
        while len(known) > min(MOST_KNOWN, max(1, MOST_KEPT_BYTES // self.measured.nbytes)):
            del known[next(iter(known))]
        return found

    @cached_property
    def _last_seen(self) -> dict[bytes, np.ndarray]:
        """Residuals by the limb's numbers, the last ones seen at the end."""
        return {}

    @cached_property
    def _starts(self) -> np.ndarray:
        return run_starts(self.dataset["run"])

    def _played(self, models: np.ndarray) -> np.ndarray:
        return self.left_by(self.player.play_numbers(models))

    def left_by(self, played: np.ndarray) -> np.ndarray:
        """What played readings (models x channels x rows, overwritten) leave of the record, as `residuals` has it."""
        starts = self._starts
        for channel in self.zeroed[len(FORCES) :]:  # the player takes the forces' own off
            played[:, channel] -= np.repeat(played[:, channel, starts[:-1]], np.diff(starts), axis=1)
        played -= self.measured
        played /= -self.sigma
        for channel in self.zeroed:
            _whiten_zeroing(played[:, channel], starts)
        left = played.reshape(len(played), self.measured.size)
        if self.beside_model is not None:
            basis, share = self._beside
            left -= ((left @ basis) * share) @ basis.T
        return left

    @cached_property
    def _beside(self) -> tuple[np.ndarray, np.ndarray]:
        """Directions of the readings that instruments move (readings x directions, orthonormal), and the share of a
        residual along each that has to go for readings of covariance 1 + columns columns' to be independent again."""
        assert self.beside_model is not None
        basis, lengths, _ = np.linalg.svd(self._scaled(self.beside_model), full_matrices=False)
        return basis, np.asarray(1.0 - 1.0 / np.sqrt(1.0 + lengths**2))

    def whitened(self, columns: np.ndarray) -> np.ndarray:
        """Columns in the channels' units (channels x rows x sizes) as residuals are: readings x sizes, in sigmas, with
        what was taken out of the record taken out of them as well."""
        scaled = self._scaled(columns)
        if self.beside_model is not None:
            basis, share = self._beside
            scaled -= basis @ (share[:, None] * (basis.T @ scaled))
        return scaled

    def _scaled(self, columns: np.ndarray) -> np.ndarray:
        scaled = np.ascontiguousarray(np.moveaxis(columns / self.sigma[:, :, None], 2, 0))
        for channel in self.zeroed:
            _whiten_zeroing(scaled[:, channel], self._starts)
        return scaled.reshape(len(scaled), -1).T

    @property
    def taken_out(self) -> np.ndarray:
        """Directions of the readings that instruments move, readings x directions, orthonormal."""
        return self._beside[0] if self.beside_model is not None else np.empty((self.measured.size, 0))

    def beside(self, columns: np.ndarray) -> Record:
        """The same record with one more trouble taken out, beside those that are out already."""
        all_columns = columns if self.beside_model is None else np.concatenate([self.beside_model, columns], axis=2)
        return replace(self, beside_model=all_columns)

    @cached_property
    def unturned(self) -> Record:
        """The same readings, played on a limb that does not turn: ten times as fast."""
        if self.dataset.small_displacements:
            return self
        return self._played_from(replace(self.dataset, small_displacements=True))

    def moved_by(self, x_mm: float | np.ndarray, z_mm: float | np.ndarray) -> Record:
        """The same readings at displacements that are larger by so much, all alike or row by row."""
        columns = dict(self.dataset.columns)
        columns |= {"dx_mm": columns["dx_mm"] + x_mm, "dz_mm": columns["dz_mm"] + z_mm}
        return self._played_from(replace(self.dataset, columns=columns))

    def _played_from(self, dataset: Dataset) -> Record:
        return replace(self, dataset=dataset, player=_player(dataset, self.channels))

    def select(self, keep: np.ndarray) -> Record:
        """The rows where `keep` is true, with the same noise."""
        return _record(
            self.dataset.select(keep),
            self.channels,
            self.noise,
            self.measured[:, keep],
            self.sigma[:, keep],
            self.zeroed,
            None if self.beside_model is None else self.beside_model[:, keep],
        )

    @property
    def readings(self) -> int:
        """How many readings were taken."""
        return int(np.count_nonzero(self.sigma < NOT_MEASURED))

    @property
    def moved_readings(self) -> int:
        """How many readings were taken while the tip was displaced."""
        moved = (self.dataset["dx_mm"] != 0.0) | (self.dataset["dz_mm"] != 0.0)
        return int(np.count_nonzero((self.sigma < NOT_MEASURED) & moved))

    @property
    def forces_read(self) -> np.ndarray:
        """Which forces were read, 2 x rows."""
        return np.asarray(self.sigma[: len(FORCES)] < NOT_MEASURED)

    @property
    def force_sigma_n(self) -> float:
        """rms of one sigma over the forces that were read [N]."""
        return float(np.sqrt(np.mean(self.sigma[: len(FORCES)][self.forces_read] ** 2)))

    @property
    def noise_freedom(self) -> float:
        """On how many independent readings the noise rests, all channels together."""
        return float(sum(noise.freedom for noise in self.noise.values()))


def rms_force_n(record: Record, numbers: np.ndarray, rows: np.ndarray | None = None) -> float:
    """rms of measured less model over the forces that were read [N]."""
    played = record.player.play_numbers(numbers[None])[0, :2]
    off = np.where(record.forces_read, record.measured[:2] - played, np.nan)
    some = off if rows is None else off[:, rows]
    return float(np.sqrt(np.nanmean(some**2))) if np.isfinite(some).any() else 0.0


def load_record(dataset: Dataset) -> Record:
    """Noise per channel, from the whole record."""
    channels = (*FORCES, *(name for name in SIDE_READINGS if name in dataset and np.nanstd(dataset[name]) > 0.0))
    noise = noise_of(dataset, channels)
    measured = np.stack([np.asarray(dataset[name], float) for name in channels])
    sigma = np.stack([sigma_of(noise[name], values) for name, values in zip(channels, measured)])
    measured = np.nan_to_num(measured, nan=0.0)
    return _record(dataset, channels, noise, measured, sigma, _zeroed(dataset, channels))


def _record(
    dataset: Dataset,
    channels: tuple[str, ...],
    noise: dict[str, ChannelNoise],
    measured: np.ndarray,
    sigma: np.ndarray,
    zeroed: tuple[int, ...] = (),
    beside_model: np.ndarray | None = None,
) -> Record:
    """With a player of its own."""
    return Record(dataset, channels, noise, measured, sigma, _player(dataset, channels), zeroed, beside_model)


def _player(dataset: Dataset, channels: Sequence[str]) -> LoadingBatchPlayer:
    return player_of(dataset, channels, zeroed=dataset.meta.zeroed_per_run)


def _zeroed(dataset: Dataset, channels: Sequence[str]) -> tuple[int, ...]:
    """The forces, and what else begins each run at exactly nothing, when the record says that runs are zeroed."""
    if not dataset.meta.zeroed_per_run:
        return ()
    first = run_starts(dataset["run"])[:-1]
    return tuple(
        place for place, name in enumerate(channels) if name in FORCES or not np.any(dataset[name][first])
    )


def _whiten_zeroing(scaled: np.ndarray, starts: np.ndarray) -> None:
    """Where each run's first reading was taken off, its noise is in all others of the run: covariance I + 11'.
    Multiplied by that covariance's inverse root, readings (models x rows, changed in place) are independent again."""
    lengths = np.diff(starts)
    others = np.maximum(lengths - 1, 1)
    total = np.add.reduceat(scaled, starts[:-1], axis=1) - scaled[:, starts[:-1]]
    share = total * ((1.0 - 1.0 / np.sqrt(1.0 + others)) / others)
    first = scaled[:, starts[:-1]].copy()
    scaled -= np.repeat(share, lengths, axis=1)
    scaled[:, starts[:-1]] = first


def sigma_of(noise: ChannelNoise, values: np.ndarray) -> np.ndarray:
    """One sigma of each reading; a reading that was not taken (NaN) weighs nothing."""
    return np.where(np.isnan(values), NOT_MEASURED, noise.sigma(np.nan_to_num(values)))


def setting_of(record: Record, believed: LimbModel) -> LoadingSize:
    """The sizes that this record reaches, for the catalogue's first tries. A force that was not read counts as none."""
    data = record.dataset
    numbers = model_numbers(believed)
    index = number_index()
    force = np.nan_to_num(np.stack([data["fx_n"], data["fz_n"]]))
    femur_mm, tibia_mm = (believed.number(f"geometry.{link}_mm") for link in ("femur", "tibia"))
    lever = levers(femur_mm, tibia_mm, data["theta1_rad"], data["theta2_rad"])
    torque = {
        joint: float(np.quantile(np.abs(np.sum(lever[joint] * force, axis=0)), 0.99)) for joint in lever
    }
    compliance = {joint: believed.number(f"joint.{joint}.compliance_rad_per_n_mm") for joint in lever}
    starts = run_starts(data["run"])[:-1]
    steps = np.diff(data["t_s"])
    return LoadingSize(
        believed={key: float(numbers[place]) for key, place in index.items()},
        joint_torque_n_mm=torque,
        joint_deflection_rad={joint: max(compliance[joint] * torque[joint], 1e-5) for joint in torque},
        displacement_mm=float(max(np.abs(data["dx_mm"]).max(), np.abs(data["dz_mm"]).max(), 1e-6)),
        force_n=np.sort(np.abs(force).ravel()),
        force_sigma_n=float(np.mean(record.sigma[: len(FORCES)][record.forces_read])),
        run_starts_s=tuple(float(data["t_s"][start]) for start in starts),
        duration_s=float(data["t_s"][-1] - data["t_s"][0]),
        dwell_s=float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 1.0,
        temperature_range_degc=float(np.ptp(data["temp_degc"])) if "temp_degc" in data else 0.0,
        zeroed=data.meta.zeroed_per_run,
        turns=not data.small_displacements,
    )


def levers(
    femur_mm: float, tibia_mm: float, theta1_rad: np.ndarray, theta2_rad: np.ndarray
) -> dict[str, np.ndarray]:
    """Levers of the tip force about the joints, 2 x rows [mm]."""
    tibia_angle = theta1_rad - theta2_rad
    tibia = tibia_mm * np.stack([np.cos(tibia_angle), np.sin(tibia_angle)])
    tip = tibia + femur_mm * np.stack([np.cos(theta1_rad), np.sin(theta1_rad)])
    return {"femur": np.stack([-tip[1], tip[0]]), "tibia": np.stack([-tibia[1], tibia[0]])}
