"""What the refitted base shows of the noise of a record without repeats: its floor, once the limb's own shape is out of
the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from brace.identify.noise import (
    REPEATS,
    ROUNDING,
    THIRD_DIFFERENCES_SHARE,
    ChannelNoise,
    robust_sigma,
    rounding_of,
)
from brace.identify.record import NOT_MEASURED, Record

LEAST_DIFFERENCES = 30
REPEATED = (REPEATS, ROUNDING)  # how the source of a noise begins that repeats have shown


def without_repeats(record: Record) -> list[str]:
    """The channels whose noise no repeats have shown."""
    return [name for name, noise in record.noise.items() if not noise.source.startswith(REPEATED)]


def with_noise_after(record: Record, part: Record, left: np.ndarray) -> Record:
    """The record with the noise of those channels taken from the third differences, along the runs, of what the base
    leaves (`left`, whitened, reading after reading) of `part` of it: a smooth disagreement hardly touches them."""
    off = left.reshape(part.measured.shape) * part.sigma
    same = part.dataset["run"][:-3] == part.dataset["run"][3:]
    noise = dict(record.noise)
    poor = without_repeats(record)
    for place, name in enumerate(record.channels):
        taken = part.sigma[place] < NOT_MEASURED
        whole = same & taken[:-3] & taken[1:-2] & taken[2:-1] & taken[3:]
        bends = np.diff(off[place], n=3)[whole] / np.sqrt(20.0)
        if name in poor and bends.size >= LEAST_DIFFERENCES:
            floor = max(robust_sigma(bends), rounding_of(record.dataset, name), 1e-12)
            freedom = bends.size / THIRD_DIFFERENCES_SHARE
            noise[name] = ChannelNoise(floor, 0.0, "smoothness of what the believed limb leaves", freedom)
    return with_noise(record, noise)


def with_noise(record: Record, noise: dict[str, ChannelNoise]) -> Record:
    """The record with another noise of its channels; what was not measured weighs nothing still."""
    fresh = np.stack([noise[name].sigma(values) for name, values in zip(record.channels, record.measured)])
    sigma = np.where(record.sigma < NOT_MEASURED, fresh, NOT_MEASURED)
    return replace(record, noise=noise, sigma=sigma)
