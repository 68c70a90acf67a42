"""A trouble of the instruments in a sentence: what happened, where, and what to do."""

from __future__ import annotations

import numpy as np

from brace.identify.record import Record
from brace.diagnose.loading.troubles.lag import lag_in_words
from brace.diagnose.loading.troubles.kinds import GAIN_STEP, LAG, NOT_NAMED, POSE, RUBS, SLIP, ZERO_STEP, ZEROS

MOST_LISTED = 8  # rows


def shown(record: Record, name: str, columns: np.ndarray, sizes: np.ndarray, sigma: float) -> str:
    """`columns` are channels x rows x sizes, `sigma` that of the first size."""
    if name == LAG:
        return lag_in_words(record, float(sizes[0]), sigma)
    if name == GAIN_STEP:
        return (
            f"the sensor reads {100.0 * sizes[0]:+.2g} % {_since(record, first_row(columns))}, and as believed before; "
            "calibrate the sensor, and look at its amplifier's range"
        )
    if name == ZERO_STEP:
        return (
            f"the sensor's zero moved by {_moves(record, columns, sizes)}; zero the sensor before each run, and say so "
            "in meta.toml"
        )
    if name == ZEROS:
        return (
            f"the force at rest differs from run to run by about {float(np.std(sizes)):.2g} N: the sensor's zero moved, "
            "or the tip was clamped a little elsewhere; zero the sensor before each run, and say so in meta.toml"
        )
    if name == SLIP:
        return (
            f"the tip's clamp or the limb's base slipped by {_slips(record, columns, sizes)}; clamp it tighter, and "
            "load again"
        )
    if name == POSE:
        return (
            f"the posture differs from run to run by about {1e3 * float(np.std(sizes)):.2g} mrad from the commanded "
            "angles; measure the angles of every run (columns theta1_rad, theta2_rad)"
        )
    if name in RUBS:
        joint = "knee" if RUBS[name] == "tibia" else "femur"
        return (
            f"friction of the {joint} joint, which is strained before it slides, or which a joint that rings partly "
            "shakes off; the model has no such law, so that limb.toml leaves the friction out"
        )
    if name in NOT_NAMED:
        return NOT_NAMED[name]
    rows = sorted({int(row) + 1 for row in np.flatnonzero(np.any(columns != 0.0, axis=(0, 2)))})
    more = f" and {len(rows) - MOST_LISTED} more" if len(rows) > MOST_LISTED else ""
    listed = ", ".join(map(str, rows[:MOST_LISTED])) + more
    return f"single readings stand out (row {listed}) and were left out; look at what disturbed them"


def first_row(columns: np.ndarray) -> int:
    """The first row (from 0) that the columns touch."""
    return int(np.argmax(np.any(columns != 0.0, axis=(0, 2))))


def _moves(record: Record, columns: np.ndarray, sizes: np.ndarray) -> str:
    by_row: dict[int, list[str]] = {}
    for place, size in enumerate(sizes):
        own = columns[:, :, [place]]
        channel = record.channels[int(np.argmax(np.any(own != 0.0, axis=(1, 2))))]
        by_row.setdefault(first_row(own), []).append(f"{channel} {size:+.3g} N")
    return "; by ".join(f"{' and '.join(moved)} {_since(record, row)}" for row, moved in sorted(by_row.items()))


def _slips(record: Record, columns: np.ndarray, sizes: np.ndarray) -> str:
    """Each slip has two sizes, along x and along z."""
    return "; by ".join(
        f"{sizes[place]:+.3g} mm along x and {sizes[place + 1]:+.3g} mm along z "
        f"{_since(record, first_row(columns[:, :, [place]]))}"
        for place in range(0, sizes.size, 2)
    )


def _since(record: Record, row: int) -> str:
    data = record.dataset
    return f"from row {row + 1} on (run {int(data['run'][row])}, t = {float(data['t_s'][row]):.6g} s)"
