"""Single poses and single runs that contradict the rest of the record: angles that were mistyped or belong to another
pose, runs in another unit or with a turned sign. The other poses say which limb it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from brace.dataset import DataFault, Dataset
from brace.diagnose.loading.data_faults.columns import SAME_SHAPE, UNITS
from brace.identify.noise import FORCES
from brace.diagnose.loading.data_faults.judge import Judge, alike, misfit

MOST_LEFT_OUT = 4  # poses that are left out on trial
LEAST_EXCESS = 1.5
EXCHANGED_NOISE = 0.5  # excess that a record may keep once two poses have changed places
EXCHANGED_LEFT = 0.03
CLEAN = 0.5  # excess of chi squared per reading that calls for no more
LEFT_WITHOUT = 0.4  # of the excess, at most, without a pose that is at fault
MOST_BAD = 0.34  # of the poses: more is no slip
BAD = 25.0  # chi squared per reading of a run or pose that is suspected
BAD_RATIO = 20.0  # times the middle one's
MENDED = 4.0  # chi squared per reading that a repaired run may keep
MENDED_RATIO = 1.5  # times the middle one's
NEAR_NOISE = 2.0
LEAST_HEARD = 3.0  # times noise and resolution together: a run that says less is not judged
LEFT = 0.01  # of chi squared, by a repair that is believed
MOST_RUNS = 0.5  # of a pose's runs that are bad: it is the pose
LEAST_TURN_RAD = 0.05  # an angle that is off by less is the limb's business
SPACINGS_RAD = (0.02, 0.0025, 0.0003)
ANGLES = ("theta1_rad", "theta2_rad")


@dataclass(frozen=True)
class _Bad:
    """A pose or run: rows (indices), chi squared per reading as it is, and what a repair may leave."""

    rows: np.ndarray
    chi2: float
    most: float
    sigma: np.ndarray


def faults(judge: Judge) -> list[DataFault]:
    """A fault for each pose and run that one repair puts right."""
    config = judge.dataset["config"]
    suspects = _suspected_poses(judge)
    if not suspects:
        return _exchanged_poses(judge)
    good = np.flatnonzero(~np.isin(config, suspects))
    few = good[np.isin(good, judge.few)]
    limb = judge.agreement(judge.dataset, few if few.size else good).numbers
    played = judge.play(judge.dataset, limb)
    first = judge.starts[:-1]
    square = np.sum(((judge.measured - played) / judge.sigma) ** 2, axis=0) / 2.0
    by_run = np.add.reduceat(square, first) / np.diff(judge.starts)
    suspected_runs = np.isin(config[first], suspects)
    usual = float(np.median(by_run[~suspected_runs])) if (~suspected_runs).any() else 1.0
    bad_runs = suspected_runs & (by_run > max(BAD, BAD_RATIO * usual))
    found: list[DataFault] = []
    for pose in suspects:
        here = config[first] == pose
        runs = np.flatnonzero(here & bad_runs)
        if not runs.size:
            continue
        if runs.size >= MOST_RUNS * np.count_nonzero(here):
            rows = np.flatnonzero(config == pose)
            of_pose = list(_pose(judge, limb, int(pose), _bad(judge, rows, played, usual), played))
            if of_pose:
                found += of_pose
                continue
        for run in runs:
            rows = np.arange(judge.starts[run], judge.starts[run + 1])
            found += _run(judge, limb, _bad(judge, rows, played, usual), played)
    return found


def _exchanged_poses(judge: Judge) -> list[DataFault]:
    """Two poses that have each other's angles: neither stands out alone."""
    data = judge.dataset
    config = data["config"]
    poses, group = np.unique(config, return_inverse=True)
    before = judge.as_it_is.excess
    if poses.size < 4 or before < LEAST_EXCESS:
        return []
    square = np.sum(((judge.measured - judge.played) / judge.sigma) ** 2, axis=0)
    worst = poses[np.argsort(np.bincount(group, weights=square) / np.bincount(group))[::-1][: MOST_LEFT_OUT + 1]]
    tried = []
    for one, other in combinations([int(pose) for pose in worst], 2):
        rows = {pose: np.flatnonzero(config == pose) for pose in (one, other)}
        columns = {name: data[name].copy() for name in ANGLES}
        for name in ANGLES:
            columns[name][rows[one]], columns[name][rows[other]] = data[name][rows[other][0]], data[name][rows[one][0]]
        mended = data.with_columns(columns)
        left = misfit(judge.measured, judge.play(mended, judge.trust.numbers))
        tried.append((left, one, other, mended))
    tried.sort(key=lambda item: item[0])
    for _, one, other, mended in tried[:2]:
        left = judge.agreement(mended, judge.few).excess
        if left <= max(EXCHANGED_NOISE, EXCHANGED_LEFT * before):
            return [
                DataFault(
                    int(np.argmax(config == one)) + 1,
                    name,
                    f"poses {one} and {other} have each other's angles: the limb misses the record by "
                    f"{np.sqrt(1.0 + before):.3g} times its noise, and by {np.sqrt(1.0 + left):.3g} times once they "
                    "change places",
                    f"poses {one} and {other} exchanged",
                )
                for name in ("config", *ANGLES)
            ]
    return []


def _bad(judge: Judge, rows: np.ndarray, played: np.ndarray, usual: float) -> _Bad:
    sigma = judge.sigma[:, rows]
    chi2 = float(np.mean(((judge.measured[:, rows] - played[:, rows]) / sigma) ** 2))
    return _Bad(rows, chi2, min(max(MENDED, MENDED_RATIO * usual), max(LEFT * chi2, NEAR_NOISE)), sigma)


def _suspected_poses(judge: Judge) -> list[int]:
    """Poses without which a limb within the calibration's trust explains the record, or nearly; one after the other,
    those first that it misses most."""
    config = judge.dataset["config"]
    poses, group = np.unique(config, return_inverse=True)
    if poses.size < 4:
        return []
    suspects: list[int] = []
    agreed = judge.as_it_is
    while agreed.excess > CLEAN and len(suspects) < max(1.0, MOST_BAD * poses.size):
        played = judge.play(judge.dataset, agreed.numbers)
        square = np.sum(((judge.measured - played) / judge.sigma) ** 2, axis=0)
        square[np.isin(config, suspects)] = 0.0
        worst = poses[np.argsort(np.bincount(group, weights=square) / np.bincount(group))[::-1][:MOST_LEFT_OUT]]
        tried = []
        for pose in worst:
            rows = judge.few[~np.isin(config[judge.few], [*suspects, pose])]
            tried.append((judge.agreement(judge.dataset, rows), int(pose)))
        best, pose = min(tried, key=lambda item: item[0].excess)
        if best.excess > LEFT_WITHOUT * agreed.excess:
            break
        suspects.append(pose)
        agreed = best
    return suspects


def _chi2(judge: Judge, bad: _Bad, limb: np.ndarray, changes: dict[str, np.ndarray]) -> float:
    """Of the rows with some columns replaced on the limb that the rest says it is."""
    part = _part(judge, bad.rows).with_columns(changes)
    measured = np.stack([part[name] for name in FORCES])
    return float(np.mean(((measured - judge.play(part, limb)) / bad.sigma) ** 2))


def _part(judge: Judge, rows: np.ndarray) -> Dataset:
    mask = np.zeros(judge.dataset.rows, dtype=bool)
    mask[rows] = True
    return judge.dataset.select(mask)


def _other_poses(judge: Judge, rows: np.ndarray) -> Iterator[tuple[int, float, float]]:
    config = judge.dataset["config"]
    for pose in np.unique(config)[:200]:
        if pose == config[rows[0]]:
            continue
        row = int(np.argmax(config == pose))
        yield int(pose), float(judge.dataset["theta1_rad"][row]), float(judge.dataset["theta2_rad"][row])


def _labelled_otherwise(judge: Judge, limb: np.ndarray, bad: _Bad) -> tuple[float, int, float, float]:
    """The other pose whose angles explain the rows best: chi squared, its number and angles."""
    best = (np.inf, 0, 0.0, 0.0)
    for pose, theta1, theta2 in _other_poses(judge, bad.rows):
        turned = {"theta1_rad": np.full(bad.rows.size, theta1), "theta2_rad": np.full(bad.rows.size, theta2)}
        best = min(best, (_chi2(judge, bad, limb, turned), pose, theta1, theta2))
    return best


def _pose(judge: Judge, limb: np.ndarray, pose: int, bad: _Bad, played: np.ndarray) -> Iterator[DataFault]:
    row = int(bad.rows[0])
    chi2, other, theta1, theta2 = _labelled_otherwise(judge, limb, bad)
    if chi2 <= min(bad.most, MENDED):
        for name, value in (("config", float(other)), ("theta1_rad", theta1), ("theta2_rad", theta2)):
            yield DataFault(
                row + 1,
                name,
                f"pose {pose} is measured as pose {other} should be: {_words(bad.chi2, chi2)} with that pose's angles",
                value,
            )
        return
    turned = _angle_off(judge, limb, bad)
    if turned is not None:
        name, value, chi2 = turned
        written = float(judge.dataset[name][row])
        yield DataFault(
            row + 1,
            name,
            f"{written:g} at pose {pose}: the other poses' limb explains its readings at {value:.3f} "
            f"({_words(bad.chi2, chi2)})",
            round(value, 3),
        )
        return
    yield from _run(judge, limb, bad, played)


def _angle_off(judge: Judge, limb: np.ndarray, bad: _Bad) -> tuple[str, float, float] | None:
    """One of the two angles at another value: its name, that value, and chi squared."""
    best: tuple[float, str, float] | None = None
    for name in ANGLES:
        written = float(judge.dataset[name][bad.rows[0]])
        turns = np.arange(-np.pi, np.pi, SPACINGS_RAD[0])
        for spacing in SPACINGS_RAD:
            chi2 = _turned(judge, limb, bad, name, turns)
            middle, least = float(turns[int(np.argmin(chi2))]), float(chi2.min())
            turns = middle + np.linspace(-spacing, spacing, 17)
        if abs(middle) > LEAST_TURN_RAD and (best is None or least < best[0]):
            best = (least, name, written + middle)
    if best is None or best[0] > min(bad.most, MENDED):
        return None
    return best[1], best[2], best[0]


def _turned(judge: Judge, limb: np.ndarray, bad: _Bad, name: str, turns: np.ndarray) -> np.ndarray:
    """Chi squared per reading of the rows with one angle turned by each of `turns`, all in one play."""
    part = _part(judge, bad.rows)
    count, times = part.rows, turns.size
    columns = {key: np.tile(values, times) for key, values in part.columns.items()}
    again = np.repeat(np.arange(times), count)
    columns["run"] = (columns["run"] - part["run"].min() + again * (np.ptp(part["run"]) + 1) + 1).astype(np.int32)
    columns["t_s"] = columns["t_s"] + again * (np.ptp(part["t_s"]) + 1.0)
    columns[name] = columns[name] + np.repeat(turns, count)
    played = judge.play(replace(part, columns=columns), limb).reshape(2, times, count)
    left = (judge.measured[:, None, bad.rows] - np.nan_to_num(played, nan=1e6)) / bad.sigma[:, None]
    return np.asarray(np.mean(left**2, axis=(0, 2)))


def _run(judge: Judge, limb: np.ndarray, bad: _Bad, played: np.ndarray) -> list[DataFault]:
    """Signs, units, columns exchanged, another pose's angles."""
    row = int(bad.rows[0])
    number = judge.dataset["run"][row]
    measured, model = judge.measured[:, bad.rows], played[:, bad.rows]

    quiet_n = float(np.sqrt(np.mean(bad.sigma**2))) + judge.dataset.meta.number("sensor.resolution_n")
    if float(np.sqrt(np.mean(measured**2))) < LEAST_HEARD * quiet_n:
        return []

    def left(values: np.ndarray, scale: np.ndarray | float = 1.0) -> float:
        return float(np.mean(((values - model) / (bad.sigma * scale)) ** 2))

    tried: list[tuple[float, tuple[str, ...], str, str | float]] = []
    sides: tuple[tuple[tuple[int, int], tuple[str, ...]], ...] = (
        ((-1, 1), FORCES[:1]),
        ((1, -1), FORCES[1:]),
        ((-1, -1), (*FORCES, _moved(judge, bad.rows))),
    )
    for signs, fields in sides:
        turned = np.array(signs)[:, None] * measured
        tried.append((left(turned), fields, "its sign is turned", "the run with this sign turned"))
    tried.append((left(measured[::-1]), FORCES, "fx_n and fz_n are exchanged in it", "fx_n and fz_n exchanged"))
    for unit, factor in UNITS.values() if alike(measured, model) > SAME_SHAPE else ():
        for fields in (FORCES, FORCES[:1], FORCES[1:]):  # type: tuple[str, ...]
            scale = np.array([[factor if name in fields else 1.0] for name in FORCES])
            words = f"it fits only in {unit}"
            tried.append((left(measured * scale, scale), fields, words, f"{unit}: multiply by {factor:g}"))
    chi2, other, _, _ = _labelled_otherwise(judge, limb, bad)
    chi2 = chi2 if chi2 <= MENDED else np.inf
    tried.append((chi2, ("config", *ANGLES), f"it is measured as a run at pose {other} should be", float(other)))
    tried.sort(key=lambda item: item[0])
    chi2, fields, what, suggestion = tried[0]
    if chi2 > bad.most:
        return []
    return [
        DataFault(row + 1, name, f"run {number}: {what} ({_words(bad.chi2, chi2)})", suggestion) for name in fields
    ]


def _moved(judge: Judge, rows: np.ndarray) -> str:
    return "dz_mm" if judge.dataset["axis"][rows[0]] else "dx_mm"


def _words(before: float, after: float) -> str:
    return f"off by {np.sqrt(before):.3g} times the noise, and by {np.sqrt(after):.3g} times then"
