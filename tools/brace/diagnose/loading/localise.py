"""Where the believed limb and the record disagree, in words: fixed contrasts, and sign flips of the residuals for a p
that holds for all of them together."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.diagnosis import Localised
from brace.diagnose.loading.fit import Fit
from brace.identify.record import Record
from brace.diagnose.loading.screen import Remover
from brace.diagnose.loading.structure import slopes

FLIPS = 999
FAMILY_WISE_P = 0.01
MOST_NAMED = 6
LEAST_SHARE = 0.05  # of the squared misfit: less is a trace that the shape of an effect leaves in many contrasts
NEW = 0.3  # length of a unit contrast beyond those named before; shorter ones say the same in other words
TIME_OWN = 0.1  # of the time's variance that the postures must leave for time to be named
AXES = ("x", "z")


def localise(record: Record, fitted: Fit, seed: int) -> list[Localised]:
    """The contrasts that stand out of the noise, strongest first, each after those before it are taken out: of many
    that are alike, one is named. Sizes are rms over the rows that they speak of, in N."""
    remover = Remover(fitted)
    names, columns, raw = [], [], []
    for name, shape in _contrasts(record, fitted):
        size = float(np.linalg.norm(shape))
        if size <= 0.0:
            continue
        column = remover.columns((shape / size)[:, None])[:, 0]
        length = float(np.linalg.norm(column))
        if length < 0.05:  # what refitting makes up for says nothing
            continue
        names.append(name)
        columns.append(column / length)
        raw.append(shape)
    if not names:
        return []
    basis = np.column_stack(columns)
    left = remover.augmented(fitted.residual[None])[0]
    whole = float(left @ left)
    rng = np.random.default_rng([seed, 0x10CA115E])
    signs = rng.integers(0, 2, size=(FLIPS, left.size), dtype=np.int8).astype(np.float32) * 2 - 1
    found: list[Localised] = []
    while len(found) < MOST_NAMED:
        seen = np.abs(basis.T @ left)
        place = int(np.argmax(seen))
        noise = np.abs(signs @ (basis * left[:, None]).astype(np.float32)).max(axis=1)
        p = (int(np.count_nonzero(noise >= seen[place])) + 1) / (FLIPS + 1)
        share = float(seen[place]) ** 2 / whole
        if p > FAMILY_WISE_P or (found and share < LEAST_SHARE):
            break
        column = basis[:, place].copy()
        rows = raw[place] != 0.0
        amount = float(seen[place]) * float(np.linalg.norm(column[: rows.size][rows]))
        in_newton = amount / np.sqrt(max(int(rows.sum()), 1)) * record.force_sigma_n
        found.append(Localised(names[place], p, float(in_newton), share))
        left = left - column * float(column @ left)
        basis = basis - np.outer(column, column @ basis)
        length = np.linalg.norm(basis, axis=0)
        basis = np.where(length > NEW, basis / np.maximum(length, NEW), 0.0)  # the rest was said already
    return found


def _shows_time(config: np.ndarray, time: np.ndarray) -> bool:
    """Whether some postures were visited again later: else what changes with time may as well change with posture."""
    _, place = np.unique(config, return_inverse=True)
    mean = np.bincount(place, time) / np.bincount(place)
    return bool(np.var(time - mean[place]) > TIME_OWN * np.var(time))


def _contrasts(record: Record, fitted: Fit) -> Iterator[tuple[str, np.ndarray]]:
    """(words, readings) pairs."""
    data, rows = record.dataset, record.rows
    along = np.where(data["axis"] == 1, data["dz_mm"], data["dx_mm"])
    reach = max(float(np.abs(along).max()), 1e-9)
    s = along / reach
    way = np.zeros(rows)
    starts = run_starts(data["run"])
    for begin, end in zip(starts[:-1], starts[1:]):
        way[begin:end] = np.sign(np.diff(along[begin:end], prepend=along[begin]))
    time = (data["t_s"] - data["t_s"][0]) / max(float(np.ptp(data["t_s"])), 1e-9)
    rate = slopes(record, fitted, along)
    clock = "time" if _shows_time(data["config"], time) else "the order of the postures (time and temperature go with it)"

    def moved(shape: np.ndarray) -> np.ndarray:
        return np.asarray((rate * shape[None] / record.sigma).ravel())

    def pushed(channel: int, shape: np.ndarray) -> np.ndarray:
        out = np.zeros((len(record.channels), rows))
        out[channel] = shape / record.sigma[channel]
        return out.ravel()

    turning_back = way * s < 0.0
    near = np.exp(-((s / 0.25) ** 2))
    for axis in (0, 1):
        here = (data["axis"] == axis).astype(float)
        if not here.any():
            continue
        name = AXES[axis]
        yield f"between loading and unloading along {name}, at every load", moved(here * way)
        yield f"between loading and unloading along {name}, near zero force", moved(here * way * near)
        yield f"only when unloading along {name}, near zero force", moved(here * turning_back * np.sign(s) * near)
        yield f"near zero force along {name}, with the sign of the load", moved(here * np.tanh(s / 0.15) * near)
        yield f"along {name}, growing faster than the load", moved(here * s**3)
        yield f"along {name}, alike for both signs of the load", moved(here * np.abs(s))
        yield f"at the largest loads along {name}", moved(here * np.sign(s) * (np.abs(s) > 0.85))
        yield f"along {name}, in proportion to load and {clock}", moved(here * s * (time - 0.5))
        if "temp_degc" in data and clock == "time":
            yield f"along {name}, in proportion to load and temperature", moved(
                here * s * (data["temp_degc"] - np.mean(data["temp_degc"]))
            )
    for channel, axis_name in enumerate(AXES):
        yield f"in f{axis_name}, the same at every reading", pushed(channel, np.ones(rows))
        yield f"in f{axis_name}, growing with {clock}", pushed(channel, time - 0.5)
        largest = np.abs(record.measured[channel]) > 0.9 * np.abs(record.measured[channel]).max()
        yield f"in f{axis_name}, at its largest readings", pushed(
            channel, largest * np.sign(record.measured[channel])
        )
    cross = record.measured - fitted.residual.reshape(record.measured.shape) * record.sigma
    yield "in fx, in proportion to fz", pushed(0, cross[1])
    yield "in fz, in proportion to fx", pushed(1, cross[0])
    for part in (0.25, 0.5, 0.75):
        after = (time >= part).astype(float)
        yield f"in proportion to the load, from {part:.0%} of the record on", moved(s * after)
        yield f"as if the tip had moved, from {part:.0%} of the record on", moved(after)
    configs, first = np.unique(data["config"], return_index=True)
    if configs.size <= 40:
        for config, row in zip(configs, first):
            here = (data["config"] == config).astype(float)
            theta1, theta2 = data["theta1_rad"][row], data["theta2_rad"][row]
            where = f"at configuration {config} (theta1 {theta1:.2f}, theta2 {theta2:.2f} rad)"
            yield f"{where}, in proportion to the load", moved(here * s)
            for channel, axis_name in enumerate(AXES):
                yield f"{where}, in f{axis_name} whatever the load", pushed(channel, here)
                yield f"{where}, in f{axis_name} in proportion to the load", pushed(channel, here * s)
