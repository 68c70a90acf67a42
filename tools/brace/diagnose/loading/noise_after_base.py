"""What a fit tells of the noise: of a record without repeats its floor, once the limb's own shape is out of the way,
and whether the noise grows with the load."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.noise import (
    FORCES,
    GROWING,
    REPEATS,
    ROUNDING,
    THIRD_DIFFERENCES_SHARE,
    ChannelNoise,
    growth_of,
    robust_sigma,
    rounding_of,
)
from brace.dataset.enough import enough_rows
from brace.diagnose.loading.record import NOT_MEASURED, Record
from brace.diagnose.loading.space import Trust, space_of

LEAST_DIFFERENCES = 30


def with_known_noise(record: Record, trust: Trust) -> Record:
    """The record with the noise of channels that have no repeats taken from what the refitted base leaves: its third
    differences along the runs, which any smooth disagreement hardly touches."""
    poor = [name for name, noise in record.noise.items() if not noise.source.startswith((REPEATS, ROUNDING))]
    if not poor:
        return record
    keep = enough_rows(record.dataset)
    part = record if keep.all() else record.select(keep)
    space = space_of(trust, ())
    left = fit(part, space, space.mean).residual.reshape(part.measured.shape) * part.sigma
    same = part.dataset["run"][:-3] == part.dataset["run"][3:]
    noise = dict(record.noise)
    for place, name in enumerate(record.channels):
        taken = part.sigma[place] < NOT_MEASURED
        whole = same & taken[:-3] & taken[1:-2] & taken[2:-1] & taken[3:]
        off = np.diff(left[place], n=3)[whole] / np.sqrt(20.0)
        if name in poor and off.size >= LEAST_DIFFERENCES:
            floor = max(robust_sigma(off), rounding_of(record.dataset, name), 1e-12)
            freedom = off.size / THIRD_DIFFERENCES_SHARE
            noise[name] = ChannelNoise(floor, 0.0, "smoothness of what the believed limb leaves", freedom)
    return _with_noise(record, noise)


def with_growth(record: Record, fitted: Fit) -> Record | None:
    """The record with noise that grows with the load where a fit's residuals show that far better than a constant
    one; None where they do not. Channels whose repeats have spoken stay."""
    left = fitted.residual.reshape(record.measured.shape) * record.sigma
    asked, given = [], []
    for place, name in enumerate(record.channels):
        if name not in FORCES or record.noise[name].source.startswith((REPEATS, ROUNDING)):
            continue  # where noise is as large as the reading, weighing by the reading would bias it
        taken = record.sigma[place] < NOT_MEASURED
        asked.append(name)
        given.append((left[place][taken], np.abs(record.measured[place][taken])))
    found = {name: growth for name, growth in zip(asked, growth_of(given)) if growth is not None}
    if not found:
        return None
    noise = dict(record.noise)
    for name, (floor, growth) in found.items():
        noise[name] = ChannelNoise(floor, growth, noise[name].source + GROWING, noise[name].freedom)
    return _with_noise(record, noise)


def _with_noise(record: Record, noise: dict[str, ChannelNoise]) -> Record:
    fresh = np.stack([noise[name].sigma(values) for name, values in zip(record.channels, record.measured)])
    sigma = np.where(record.sigma < NOT_MEASURED, fresh, NOT_MEASURED)
    return replace(record, noise=noise, sigma=sigma)
