"""What even a few load-deflection pairs show by themselves: how the force rises along each direction that was pushed,
with its interval, beside what the model says. And what of a diagnosis rests on a single reading."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from brace.diagnose.loading.fit import Fit
from brace.effects.catalogue import CLIPPED_SIGMAS
from brace.identify.information import half_width_90
from brace.identify.noise import FORCES
from brace.identify.record import NOT_MEASURED, Record

SATURATION = "sensor.saturation_n"
FEW = 60  # rows, up to which a record's slopes are reported
LEAST = 3  # readings of one slope


def slopes_in_words(record: Record, believed: np.ndarray) -> Iterator[str]:
    """One sentence for each configuration and axis, of a record of a few readings. `believed` are the model's
    numbers."""
    if record.rows > FEW:
        return
    data = record.dataset
    played = record.player.play_numbers(believed[None])[0]
    for config in np.unique(data["config"]):
        for axis, name in enumerate(("dx_mm", "dz_mm")):
            rows = (data["config"] == config) & (data["axis"] == axis)
            force = FORCES[axis]
            read = rows & (record.sigma[axis] < NOT_MEASURED)
            if np.count_nonzero(read) < LEAST or not np.ptp(data[name][read]):
                continue
            way = data[name][read]
            measured, half = _slope(way, record.measured[axis][read])
            modelled, _ = _slope(way, played[axis][read])
            yield (
                f"at configuration {int(config)} {force} rises by {measured:.3g} N/mm along {'xz'[axis]} "
                f"({measured - half:.3g} to {measured + half:.3g}); the model says {modelled:.3g}"
            )


def rests_on_one(record: Record, fitted: Fit) -> Iterator[str]:
    """A sentence where a saturation clips a single reading."""
    if SATURATION not in fitted.space.keys:
        return
    sigma, read = record.sigma[: len(FORCES)], record.forces_read
    at_level = np.abs(record.measured[: len(FORCES)]) > fitted.value(SATURATION) - CLIPPED_SIGMAS * sigma
    if np.count_nonzero(at_level & read) == 1:
        row = int(np.flatnonzero(np.any(at_level & read, axis=0))[0]) + 1
        yield (
            f"the saturation shows in one reading alone, the largest (row {row}): if something else disturbed it, the "
            "sensor may be sound; load once more to a larger force"
        )


def _slope(way_mm: np.ndarray, force_n: np.ndarray) -> tuple[float, float]:
    """By least squares with a free zero, and the half width of its 90 % interval."""
    off = way_mm - way_mm.mean()
    power = float(off @ off)
    slope = float(off @ force_n) / power
    left = force_n - force_n.mean() - slope * off
    freedom = way_mm.size - 2
    return slope, half_width_90(freedom) * float(np.sqrt(left @ left / freedom / power))
