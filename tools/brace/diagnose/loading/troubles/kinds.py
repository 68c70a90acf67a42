"""What each trouble of the instruments adds to the readings: its columns beside a fitted model's readings."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from math import comb, log

import numpy as np

from brace.dataset.check_runs import run_starts
from brace.diagnose.loading.extensions import LEAST_RANGE_DEGC
from brace.diagnose.loading.fit import Fit
from brace.identify.noise import FORCES
from brace.identify.record import Record
from brace.diagnose.loading.screen import Remover
from brace.diagnose.loading.structure import far_among_alike
from brace.diagnose.loading.troubles.steps import best_rows
from brace.diagnose.loading.troubles.presliding import (
    SHARP,
    STRAINS,
    by_place,
    can_rub,
    friction_n_mm,
    presliding_columns,
    turned_columns,
)
from brace.effects.rivals import INSTRUMENT_TROUBLES, STRAINED_JOINTS
from brace.native.plant_batch import number_index, reference_planar_many

LAG, GAIN_STEP, ZERO_STEP, ZEROS, POSE, SLIP, OUTLIERS = (cause.name for cause in INSTRUMENT_TROUBLES)
# What follows the posture may be of the limb or of an encoder. A tip that is displaced in proportion to time or to the
# temperature is a sign of a rig, a limb or a ground that grows. These are no troubles of the instruments here. They
# stand against those and against effects that would otherwise make up for them: some slips come near a way that grows.
# Nor is what does not begin in the record: a step after its first readings is hardly another thing.
ZERO_BY_POSTURE, ZERO_AT_ONE, POSE_BY_POSTURE, GAIN_BY_POSTURE, GROWTH, ELSEWHERE, GAIN_OF_ONE = (
    "zero_per_posture", "zero_at_one_posture", "pose_error_per_posture", "gain_per_posture", "tip_moves_slowly",
    "tip_stands_elsewhere", "gain_of_one_axis",
)  # fmt: skip
NOT_NAMED = {
    ZERO_BY_POSTURE: "the force at rest differed from posture to posture",
    ZERO_AT_ONE: "the force at rest was another one at one of the postures",
    POSE_BY_POSTURE: "the joints stood at other angles than the record says, at each posture by others",
    GAIN_BY_POSTURE: "the sensor had another gain at each posture",
    GROWTH: "the tip was displaced slowly, with time or with the temperature",
    ELSEWHERE: "the tip stood off its rest where the record says that it stood there",
    GAIN_OF_ONE: "the sensor had another gain along one axis",
}
POSE_SIGMAS_RAD = (7e-4, 1.5e-3, 3e-3, 6e-3)  # what a drive repeats its posture by
ZERO_SIGMAS_N = (0.03, 0.1, 0.3, 1.0)  # what a force sensor's zero wanders by
GAIN_SIGMAS = (0.03, 0.1)  # what a reading's gain may differ by from posture to posture
MOST_STEPS = 3  # of a sensor's zero within one record
MOST_SLIPS = 2
FAR_OUT = 5.0  # sigmas: what a single reading must be off by to be taken for a slip
MOST_OUT = 0.02  # of the readings: more than these are no slips
POSE_STEP_RAD = 1e-4
RUBS = {cause.label: cause.where.removeprefix("joint.") for cause in STRAINED_JOINTS}  # the joint of each kind
RUB_SIGMAS = (0.01, 0.03, 0.1, 0.3, 1.0)  # what an element's stiffness may be, of the joint's own
SHAKEN_SIGMAS = (0.1, 0.3, 1.0)  # the same, of a joint that rings
SHAKEN_OF = (len(STRAINS) + 1, SHARP + 1)  # the elements of its friction, the last ones: all, and those of dry friction
SHAKEN = (0.1, 0.3)  # of friction: by how much what a joint that rings keeps of it differs from place to place


@dataclass(frozen=True)
class Shaken:
    """Friction that a joint which rings partly shakes off: its sizes on the mean, those of some of the elements, the
    last ones, and what turns with each step; and by how many times a size's sigma it differs from place to place."""

    sizes: np.ndarray
    times: float


@dataclass(frozen=True)
class Way:
    """`columns` are channels x rows x sizes; `price` in nats, for the ways of its kind among which it was chosen.
    `total`: what each size counts in the one number that is reported; empty: the first alone. `shaken`: of friction
    that is partly shaken off, how."""

    columns: np.ndarray
    price: float
    total: np.ndarray = field(default_factory=lambda: np.empty(0))
    shaken: Shaken | None = None


@dataclass(frozen=True)
class Kind:
    """Ways of one trouble. `spread`: one sigma of each size, tried one after the other; empty where nothing is known of
    it."""

    name: str
    ways: Sequence[Way]
    spread: tuple[float, ...] = ()


def kinds(record: Record, fitted: Fit, remover: Remover, left: np.ndarray) -> Iterator[Kind]:
    """Every trouble that this record can have. `left`: readings and pulls that the fit leaves."""
    played = record.player.play_numbers(fitted.model[None])[0]
    starts = run_starts(record.dataset["run"])
    yield Kind(LAG, [Way(lag_columns(record, fitted), 0.0)])
    forces = played[: len(FORCES), :, None] * _X_Z
    both = forces.sum(axis=2, keepdims=True)  # one size: the columns of both forces are apart
    yield Kind(GAIN_STEP, list(_steps(record, remover, left, [both, *_alone(forces)], most=1)))
    yield Kind(GAIN_OF_ONE, [Way(_of_forces(record, one), log(len(FORCES))) for one in _alone(forces)])
    displaced = _displaced(record, fitted)
    for name, joint in RUBS.items():
        if can_rub(record, fitted, joint):
            yield from _rubs(record, fitted, remover, left, name)
    yield Kind(SLIP, list(_steps(record, remover, left, [displaced], MOST_SLIPS)))
    yield Kind(ELSEWHERE, [Way(_of_forces(record, displaced), 0.0)])
    ramps = list(_ramps(record))
    yield Kind(GROWTH, [Way(_of_forces(record, displaced * ramp[:, None]), log(len(ramps))) for ramp in ramps])
    if not record.zeroed:
        unit = np.broadcast_to(_X_Z, (len(FORCES), record.rows, len(FORCES)))
        yield Kind(ZERO_STEP, list(_steps(record, remover, left, [unit, *_alone(unit)], MOST_STEPS)))
        here = list(_at_one_posture(record))
        yield Kind(ZERO_AT_ONE, [Way(_of_forces(record, unit * at), log(len(here))) for at in here])
        runs = _by_run(record, np.ones((1, record.rows)), starts)
        if runs.shape[2] > 2:
            both = np.concatenate([runs * _X[:, :, None], runs * _Z[:, :, None]], axis=2)
            yield Kind(ZEROS, [Way(_of_forces(record, both), 0.0)], ZERO_SIGMAS_N)
            yield Kind(
                ZERO_BY_POSTURE, [Way(_of_forces(record, _by_posture(record, both, starts)), 0.0)], ZERO_SIGMAS_N
            )
    if starts.size > 3:
        turned = np.concatenate(
            [_by_run(record, _turned(record, fitted, joint), starts) for joint in ("femur", "tibia")], axis=2
        )
        yield Kind(POSE, [Way(turned, 0.0)], POSE_SIGMAS_RAD)
        yield Kind(POSE_BY_POSTURE, [Way(_by_posture(record, turned, starts), 0.0)], POSE_SIGMAS_RAD)
        gains = _by_posture(record, _by_run(record, played[: len(FORCES)], starts), starts)
        yield Kind(GAIN_BY_POSTURE, [Way(_of_forces(record, gains), 0.0)], GAIN_SIGMAS)
    far = np.flatnonzero(far_among_alike(record, fitted) > FAR_OUT)
    if 0 < far.size <= max(1.0, MOST_OUT * record.readings):
        columns = np.zeros((record.measured.size, far.size))
        columns[far, np.arange(far.size)] = record.sigma.ravel()[far]
        which = far.size * log(max(record.readings, 2))
        yield Kind(OUTLIERS, [Way(columns.reshape(*record.measured.shape, far.size), which)])


def rubbing(record: Record, fitted: Fit, joint: str, shaken: Shaken | None = None) -> Way:
    """Friction of a joint that is strained before it slides, or of one that rings."""
    return _rubbed(record, _elements(record, fitted, joint), shaken)


def _elements(record: Record, fitted: Fit, joint: str) -> Way:
    """What a joint's friction is made of: elements that are strained before they slide, then what turns with each
    step."""
    stiffness = _displaced(record, fitted)
    columns = [of(record, fitted, joint, stiffness) for of in (presliding_columns, turned_columns)]
    return Way(np.concatenate(columns, axis=2), 0.0, friction_n_mm(record, fitted, joint))


def _rubbed(record: Record, elements: Way, shaken: Shaken | None) -> Way:
    if shaken is None:
        return Way(elements.columns[:, :, : len(STRAINS)], 0.0, elements.total[: len(STRAINS)])
    columns, total = elements.columns[:, :, -shaken.sizes.size :], elements.total[-shaken.sizes.size :]
    apart = shaken.times * by_place(record, columns @ shaken.sizes)
    share = shaken.times * float(total @ shaken.sizes) / apart.shape[2]
    total = np.concatenate([total, np.full(apart.shape[2], share)])
    return Way(np.concatenate([columns, apart], axis=2), log(len(SHAKEN_OF) * len(SHAKEN)), total, shaken)


def _rubs(record: Record, fitted: Fit, remover: Remover, left: np.ndarray, name: str) -> Iterator[Kind]:
    """Friction of a joint that moves slowly, and of one that rings: of all elements or of those of dry friction alone,
    with what turns with each step, kept by another part at each posture and axis."""
    elements = _elements(record, fitted, RUBS[name])
    yield Kind(name, [_rubbed(record, elements, None)], RUB_SIGMAS)
    whole = remover.columns(record.whitened(elements.columns))
    for count, spread in product(SHAKEN_OF, SHAKEN_SIGMAS):
        bare = whole[:, -count:]
        sizes = np.linalg.solve(bare.T @ bare + np.eye(count) / spread**2, bare.T @ left)
        yield Kind(name, [_rubbed(record, elements, Shaken(sizes, part / spread)) for part in SHAKEN], (spread,))


def _steps(
    record: Record, remover: Remover, left: np.ndarray, choices: Sequence[np.ndarray], most: int
) -> Iterator[Way]:
    """One to `most` steps of each choice (forces x rows x sizes) at any readings."""
    for chosen in choices:
        whitened = record.whitened(_of_forces(record, chosen)).reshape(*record.measured.shape, -1)
        rows = best_rows(record, remover, left, whitened, most)
        for count in range(1, len(rows) + 1):
            since = [np.arange(record.rows)[None, :, None] >= row for row in sorted(rows[:count])]
            columns = np.concatenate([chosen * one for one in since], axis=2)
            yield Way(_of_forces(record, columns), log(len(choices) * comb(record.rows - 1, count)))


def _alone(values: np.ndarray) -> list[np.ndarray]:
    """Each size alone."""
    return [values[:, :, [size]] for size in range(values.shape[2])]


def _displaced(record: Record, fitted: Fit) -> np.ndarray:
    """By how much the forces change where the tip stands elsewhere than the record says, forces x rows x (x, z), N/mm:
    K at each row's posture."""
    angles = np.stack([record.dataset["theta1_rad"], record.dataset["theta2_rad"]], axis=1)
    postures, of_row = np.unique(angles, axis=0, return_inverse=True)
    xx, xz, zz = reference_planar_many(fitted.model[None], postures[None])[0, of_row.ravel(), :3].T
    return np.stack([np.stack([xx, xz]), np.stack([xz, zz])], axis=2)


def _at_one_posture(record: Record) -> Iterator[np.ndarray]:
    """1 x rows x 1: where the record is at a posture, for each of them."""
    for config in np.unique(record.dataset["config"]):
        yield (record.dataset["config"] == config)[None, :, None]


def _ramps(record: Record) -> Iterator[np.ndarray]:
    """What grows slowly, each from 0 at the first row by 1 at most: time, and the temperature where it changes."""
    for name, least in (("t_s", 0.0), ("temp_degc", LEAST_RANGE_DEGC)):
        if name in record.dataset:
            since_first = record.dataset[name] - record.dataset[name][0]
            if np.ptp(since_first) > least:
                yield since_first / np.abs(since_first).max()


_X, _Z = np.array([[1.0], [0.0]]), np.array([[0.0], [1.0]])
_X_Z = np.eye(2)[:, None, :]  # forces x 1 x forces


def _of_forces(record: Record, columns: np.ndarray) -> np.ndarray:
    """Columns of the forces (2 x rows x sizes) as columns of all channels, as a record shows them that zeroes each
    run."""
    out = np.zeros((len(record.channels), *columns.shape[1:]))
    out[: len(FORCES)] = columns
    if record.zeroed:
        starts = run_starts(record.dataset["run"])
        out[: len(FORCES)] -= np.repeat(columns[:, starts[:-1]], np.diff(starts), axis=1)
    return out


def lag_columns(record: Record, fitted: Fit) -> np.ndarray:
    """By how much the readings change with each second that the forces are late, channels x rows x 1."""
    played = record.player.play_numbers(fitted.model[None])[0]
    return _of_forces(record, -_rate(record, played[: len(FORCES)], run_starts(record.dataset["run"]))[:, :, None])


def _rate(record: Record, played: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Change of the forces by time since the reading before; none where a run begins."""
    clock = record.dataset["t_s"]
    passed = np.diff(clock, prepend=clock[0])
    rate = np.diff(played, axis=1, prepend=played[:, :1]) / np.where(passed > 0.0, passed, np.inf)
    rate[:, starts[:-1]] = 0.0
    return np.asarray(rate)


def _by_run(record: Record, values: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Values (channels x rows) as one column for each run."""
    out = np.zeros((*values.shape, starts.size - 1))
    for number, (begin, end) in enumerate(zip(starts[:-1], starts[1:])):
        out[:, begin:end, number] = values[:, begin:end]
    return out


def _by_posture(record: Record, by_run: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Columns of runs, one after the other for each of two sizes, summed over the runs of each configuration."""
    of_run = record.dataset["config"][starts[:-1]]
    runs = of_run.size
    summed = [
        by_run[:, :, [size * runs + run for run in np.flatnonzero(of_run == config)]].sum(axis=2)
        for size in range(by_run.shape[2] // runs) for config in np.unique(of_run)
    ]  # fmt: skip
    return np.stack(summed, axis=2)


def _turned(record: Record, fitted: Fit, joint: str) -> np.ndarray:
    """By how much the readings change with the posture of a joint, channels x rows, by rad."""
    place = number_index()[f"joint.{joint}.zero_offset_rad"]
    models = np.stack([fitted.model, fitted.model])
    models[1, place] += POSE_STEP_RAD
    played = record.player.play_numbers(models)
    return np.asarray((played[1] - played[0]) / POSE_STEP_RAD)
