"""How well a record, or a repaired one, agrees with the believed limb once everything that its calibration leaves open
is refitted. What 'fault' and 'healthy' are compared by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from brace.dataset import Dataset
from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.fit import fit
from brace.identify.noise import FORCES, ChannelNoise
from brace.dataset.enough import enough_rows
from brace.identify.record import Record, load_record
from brace.diagnose.loading.space import Space, Trust, space_of, trust_of
from brace.identify.playing import player_of
from brace.identify.turning import settled
from brace.model import LimbModel
from brace.model.assumed_trust import with_assumed_trust
from brace.native.plant_batch import LoadingBatchPlayer

FIT_ROWS = 1500  # a comparison needs no more
NOISE_ROWS = 6000


@dataclass(frozen=True)
class Agreement:
    """`cost` is chi squared with the priors' share over `readings` readings; `numbers` is the refitted limb."""

    cost: float
    readings: int
    numbers: np.ndarray

    @property
    def excess(self) -> float:
        """What the noise does not explain, per reading."""
        return max(self.cost / self.readings - 1.0, 0.0)


class Judge:
    """A record and the limb that it is believed to come from; forces only."""

    def __init__(self, dataset: Dataset, believed: LimbModel) -> None:
        self.dataset = dataset
        self.believed = believed
        known = load_record(dataset.select(enough_rows(dataset, NOISE_ROWS)))
        self.channels: tuple[str, ...] = known.channels
        self.noise: Mapping[str, ChannelNoise] = known.noise
        # both forces, 2 x rows [N], and their noise
        self.measured = np.stack([np.asarray(dataset[name], float) for name in FORCES])
        self.sigma = np.stack([self.noise[name].sigma(dataset[name]) for name in FORCES])
        # before a record is called faulty, what is believed exactly may be wrong
        self.doubted = with_assumed_trust(believed, even_if_exact=True)
        self.trust: Trust = trust_of(self.doubted, turns=not dataset.small_displacements)
        self.space: Space = space_of(self.trust, ())
        self.few = np.flatnonzero(enough_rows(dataset, FIT_ROWS))
        self.starts = run_starts(dataset["run"])

    @cached_property
    def as_it_is(self) -> Agreement:
        """The record without any repair."""
        return self.agreement(self.dataset, self.few)

    @cached_property
    def played(self) -> np.ndarray:
        """What the refitted limb would read, 2 x rows [N]."""
        return self.play(self.dataset, self.as_it_is.numbers)

    def play(self, dataset: Dataset, numbers: np.ndarray) -> np.ndarray:
        """Forces of one limb over a dataset's rows, 2 x rows [N]."""
        return np.asarray(self.player(dataset).play_numbers(numbers[None])[0])

    def player(self, dataset: Dataset) -> LoadingBatchPlayer:
        """For many limbs on one dataset."""
        return player_of(dataset, FORCES, zeroed=dataset.meta.zeroed_per_run)

    def agreement(self, dataset: Dataset, rows: np.ndarray, scale: np.ndarray | None = None) -> Agreement:
        """Of some rows (indices) of a dataset with this one's noise; `scale` (two factors) is what the repair
        multiplied both forces by, and their noise with them."""
        mask = np.zeros(dataset.rows, dtype=bool)
        mask[rows] = True
        part = dataset.select(mask)
        sigma = self.sigma[:, mask] * (1.0 if scale is None else np.abs(scale)[:, None])
        measured = np.stack([np.asarray(part[name], float) for name in FORCES])
        noise = {name: self.noise[name] for name in FORCES}
        record = Record(part, FORCES, noise, measured, sigma, self.player(part))
        found = fit(record, self.space, self.space.mean, final=False)
        if not (dataset.meta.displacements or dataset.small_displacements):
            # a repaired record may show that its limb does not turn, where a faulty one did not
            flat = fit(record.unturned, self.space, self.space.mean, final=False)
            if flat.cost < found.cost and settled(part, self.doubted).small_displacements:
                found = flat
        return Agreement(found.cost, measured.size, found.model)


def misfit(measured: np.ndarray, played: np.ndarray) -> float:
    """0 where they agree, 1 where they have nothing in common."""
    both = float(np.sum(measured**2) + np.sum(played**2))
    return float(np.sqrt(np.sum((measured - played) ** 2) / both)) if both > 0.0 else 0.0


def alike(one: np.ndarray, other: np.ndarray) -> float:
    """Cosine of the angle between them: 1 where they differ by a factor alone."""
    size = float(np.sqrt(np.sum(one**2) * np.sum(other**2)))
    return float(np.sum(one * other)) / size if size > 0.0 else 0.0
