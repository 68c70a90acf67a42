"""What a fit shows of the noise: of a record without repeats its floor, and whether the noise grows with the load."""

from __future__ import annotations

import numpy as np

from brace.dataset.enough import enough_rows
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.space import Trust, space_of
from brace.identify.noise import FORCES, GROWING, REPEATS, ChannelNoise, growth_of, hinted_growth, rounding_of
from brace.identify.noise_after_base import (
    LEAST_DIFFERENCES,
    REPEATED,
    with_noise,
    with_noise_after,
    without_repeats,
)
from brace.identify.record import NOT_MEASURED, Record

QUIETER = 0.7  # of the noise before: a floor below this share is far less


def with_known_noise(record: Record, trust: Trust) -> Record:
    """The record with the noise of channels that have no repeats taken from what the refitted base leaves."""
    if not without_repeats(record):
        return record
    keep = enough_rows(record.dataset)
    part = record if keep.all() else record.select(keep)
    space = space_of(trust, ())
    return with_noise_after(record, part, fit(part, space, space.mean).residual)


def with_less_noise(record: Record, fitted: Fit) -> Record | None:
    """The record with the noise that `fitted` leaves, in the channels whose noise no repeats have shown. None where
    that is not far less than before.

    Their noise came from what the believed limb leaves, which a missing effect or a trouble of the instruments is in.
    The rms of the whole residual counts, not only its scatter from reading to reading, so that the search after this
    finds nothing in what `fitted` leaves."""
    left = fitted.residual.reshape(record.measured.shape) * record.sigma
    taken = record.sigma < NOT_MEASURED
    share = fitted.x.size / max(int(np.count_nonzero(taken)), 1)
    noise = dict(record.noise)
    for place, name in enumerate(record.channels):
        if record.noise[name].source.startswith(REPEATED) or np.count_nonzero(taken[place]) < LEAST_DIFFERENCES:
            continue
        floor = float(np.sqrt(np.mean(left[place][taken[place]] ** 2) / max(1.0 - share, 0.5)))
        if floor < QUIETER * record.noise[name].floor:
            least = max(floor, rounding_of(record.dataset, name), 1e-12)
            noise[name] = ChannelNoise(least, 0.0, "what the best set of effects leaves", record.noise[name].freedom)
    return with_noise(record, noise) if noise != record.noise else None


def with_growth(record: Record, fitted: Fit) -> Record | None:
    """The record with noise that grows with the load where a fit's residuals show that far better than a constant
    one; None where they do not. Of channels with repeats these are asked: a missing effect comes again in each."""
    left = fitted.residual.reshape(record.measured.shape) * record.sigma
    asked, given = [], []
    for place, name in enumerate(record.channels):
        if name not in FORCES or record.noise[name].source.startswith(REPEATED):
            continue  # where noise is as large as the reading, weighing by the reading would bias it
        taken = record.sigma[place] < NOT_MEASURED
        if np.count_nonzero(taken) < LEAST_DIFFERENCES:
            continue
        asked.append(name)
        given.append((left[place][taken], np.abs(record.measured[place][taken])))
    found = {name: growth for name, growth in zip(asked, growth_of(given)) if growth is not None}
    forces = [name for name in record.channels if name in FORCES]
    if all(record.noise[name].source == REPEATS for name in forces):
        found |= hinted_growth(record.dataset, forces)
    if not found:
        return None
    noise = dict(record.noise)
    for name, (floor, growth) in found.items():
        noise[name] = ChannelNoise(floor, growth, noise[name].source + GROWING, noise[name].freedom)
    return with_noise(record, noise)
