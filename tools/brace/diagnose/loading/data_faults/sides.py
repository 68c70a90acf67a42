"""Joint encoders, the base's dial gauges, temperature and the zero of the sensor against the refitted limb."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from brace.dataset import DataFault
from brace.identify.noise import FORCES
from brace.diagnose.loading.data_faults.judge import Judge, misfit
from brace.identify.playing import player_of

SUSPECT = 0.35  # misfit of an encoder beyond what effects of joints make
MENDED = 0.3  # of that misfit, what a repair may leave
UNITS = {"degrees": np.pi / 180.0, "mrad": 1e-3, "arcmin": np.pi / 10800.0, "arcsec": np.pi / 648000.0}
SAME_KIND = (("enc1_rad", "enc2_rad"), ("base_x_mm", "base_z_mm"))
FAHRENHEIT_DEGC = (35.0, 10.0)  # above the reference at least; within this of it once converted
MANY_SIGMAS = 10.0
LEAST_RUNS = 4
LEAST_MOVE = 1e-4  # rad of a joint, mm of the base


def faults(judge: Judge) -> list[DataFault]:
    """Every fault found."""
    return [*_side_readings(judge), *_fahrenheit(judge), *_zero(judge)]


def _side_readings(judge: Judge) -> Iterator[DataFault]:
    channels = [name for pair in SAME_KIND for name in pair if name in judge.channels]
    if not channels:
        return
    data = judge.dataset
    player = player_of(data, channels)
    played = dict(zip(channels, player.play_numbers(judge.as_it_is.numbers[None])[0]))
    for pair in SAME_KIND:
        here = [name for name in pair if name in played]
        # the column moves, and the limb should move it
        known = {
            name: np.ptp(data[name]) > 20.0 * judge.noise[name].floor and np.ptp(played[name]) > LEAST_MOVE
            for name in here
        }
        wrong = {}
        for name in here:
            wrong[name] = misfit(_level(judge, data[name]), _level(judge, played[name])) if known[name] else 0.0
        if len(here) == 2 and all(known.values()) and max(wrong.values()) > SUSPECT:
            crossed = [
                misfit(_level(judge, data[a]), _level(judge, played[b])) for a, b in (here, here[::-1])
            ]
            if max(crossed) < MENDED * max(wrong.values()):
                for name in here:
                    yield DataFault(
                        None,
                        name,
                        f"{here[0]} and {here[1]} are exchanged: each follows what the limb would give the other",
                        f"the columns {here[0]} and {here[1]} exchanged",
                    )
                continue
        for name in here:
            if wrong[name] > SUSPECT:
                yield from _mended(judge, name, played[name], wrong[name])


def _mended(judge: Judge, name: str, played: np.ndarray, before: float) -> Iterator[DataFault]:
    measured, model = _level(judge, judge.dataset[name]), _level(judge, played)
    tried = [(-1.0, "the sign is turned", "the column with its sign turned")]
    if name.endswith("_rad"):
        tried += [(factor, f"the column fits only in {unit}", f"{unit}: multiply by {factor:.6g}")
                  for unit, factor in UNITS.items()]  # fmt: skip
    else:
        tried += [(factor, f"the column fits only in {unit}", f"{unit}: multiply by {factor:g}")
                  for unit, factor in (("um", 1e-3), ("inches", 25.4), ("m", 1e3),
                                       ("thousandths of an inch", 25.4e-3))]  # fmt: skip
    left, words, suggestion = min(
        (misfit(measured * factor, model), words, suggestion) for factor, words, suggestion in tried
    )
    if left < MENDED * before:
        yield DataFault(
            None,
            name,
            f"{words}: the limb's forces call for {np.ptp(model):.3g}, the column moves by {np.ptp(measured):.3g}",
            suggestion,
        )


def _level(judge: Judge, values: np.ndarray) -> np.ndarray:
    """Less the middle of each run: an encoder's zero is its own."""
    starts = judge.starts
    mean = np.add.reduceat(values, starts[:-1]) / np.diff(starts)
    return np.asarray(values - np.repeat(mean, np.diff(starts)))


def _fahrenheit(judge: Judge) -> Iterator[DataFault]:
    """Servos of 70 degC at the start of a test at 22 degC: rather 70 degF."""
    if "temp_degc" not in judge.dataset:
        return
    degc = judge.dataset["temp_degc"]
    reference = judge.believed.number("thermal.reference_degc")
    above, near = FAHRENHEIT_DEGC
    low, high = float(degc.min()), float(degc.max())
    if (
        low > reference + above
        and abs((low - 32.0) / 1.8 - reference) < near
        and (high - 32.0) / 1.8 < reference + 2 * near
    ):
        yield DataFault(
            None,
            "temp_degc",
            f"{low:g} to {high:g}, where the limb is calibrated at {reference:g} degC: the column fits only in "
            "Fahrenheit",
            "Fahrenheit: subtract 32, divide by 1.8",
        )


def _zero(judge: Judge) -> Iterator[DataFault]:
    """Whether meta.toml's word on zeroing fits the first reading of each run."""
    first = judge.starts[:-1]
    if first.size < LEAST_RUNS or judge.dataset.meta.moved_by_motors:
        return
    zeroed = judge.dataset.meta.zeroed_per_run
    values = np.stack([judge.dataset[name][first] for name in FORCES])
    sigma = np.array([judge.noise[name].floor for name in FORCES])
    resolution = judge.dataset.meta.number("sensor.resolution_n")
    if zeroed:
        off = np.sqrt(np.mean(values**2, axis=1))
        if (off > MANY_SIGMAS * (sigma + resolution)).any():
            yield DataFault(
                None,
                "zeroed",
                f"meta.toml says that each run's first reading was taken off, and first readings are {off.max():.3g} N",
                'zeroed = "never"',
            )
        return
    noisy = all("repeats" in judge.noise[name].source or "smoothness" in judge.noise[name].source for name in FORCES)
    if noisy and not values.any() and (sigma > 0.5 * resolution).all() and first.size >= 3 * LEAST_RUNS:
        yield DataFault(
            None,
            "zeroed",
            f"the first reading of each of {first.size} runs is exactly 0 N and all others have noise: they were "
            "zeroed, and meta.toml says never",
            'zeroed = "per_run"',
        )
