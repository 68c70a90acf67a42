"""Troubles of the instruments: what changes the readings, and is of no limb.

Each trouble is a set of columns beside a fitted model's readings, one column for each of its sizes. Where one is far
more likely than every set of effects, the search is done again with its columns taken out of the record
(Record.beside), so that the limb is judged by what the trouble leaves of the record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from brace.dataset import DataFault
from brace.dataset.check_runs import run_starts
from brace.diagnose.diagnosis import Interval
from brace.diagnose.loading.choose import LabelSet
from brace.diagnose.loading.evidence import evidence, freedoms, score
from brace.diagnose.loading.fit import Fit, fit
from brace.diagnose.loading.intervals import Z_90
from brace.diagnose.loading.noise import FORCES
from brace.diagnose.loading.record import Record
from brace.diagnose.loading.rounding import rounds_to_record
from brace.diagnose.loading.screen import Remover
from brace.effects.rivals import INSTRUMENT_TROUBLES, RIVAL_BY_NAME, RivalCause
from brace.native.plant_batch import number_index

MUST_LEAD = 4.6  # nats: 100 to 1 against the best of the catalogue, as every name must be ahead of nothing missing
REFITTED = 4  # kinds of trouble beside sets of effects, the most likely ones
MAY_BE = -3.0  # nats: 1 to 20, from which a trouble is a rival of what was named
FLAT = 1e3  # whitened: a size of which nothing is known before
POSE_SIGMAS_RAD = (7e-4, 1.5e-3, 3e-3, 6e-3)  # what a drive repeats its posture by
ZERO_SIGMAS_N = (0.03, 0.1, 0.3, 1.0)  # what a force sensor's zero wanders by
LEAST_OUT = 25.0  # sigma squared: what a single reading must be off by to be taken for a slip
MOST_OUT = 0.02  # of the readings: more than these are no slips
POSE_STEP_RAD = 1e-4


@dataclass(frozen=True)
class Trouble:
    """`columns` are channels x rows x sizes, in the channels' units, wide enough to take the trouble out of a record;
    `lead` over the best of the catalogue in nats, beside `rest`, whose fit has the trouble taken out; `value` is the
    first size, `sigma` its own; `shown` the sentence for people."""

    name: str
    field: str
    row: int | None
    columns: np.ndarray
    rest: LabelSet
    lead: float
    value: float
    sigma: float
    shown: str

    @property
    def far_ahead(self) -> bool:
        """Whether nothing of the catalogue comes near."""
        return self.lead > MUST_LEAD

    @property
    def cause(self) -> RivalCause:
        """Its words."""
        return RIVAL_BY_NAME[self.name]

    @property
    def sizes(self) -> dict[str, Interval]:
        """Its first size with its 90 % interval; none where the trouble has a size for each run or reading."""
        if self.name not in (LAG, GAIN_STEP, ZERO_STEP):
            return {}
        half = Z_90 * self.sigma
        return {self.cause.ways[0][0].key: Interval(self.value, self.value - half, self.value + half)}

    @property
    def fault(self) -> DataFault:
        """As an entry of data_faults that does not stop the diagnosis."""
        return DataFault(self.row, self.field, self.shown, blocking=False)


@dataclass(frozen=True)
class _Kind:
    """Ways of one trouble (each channels x rows x sizes). `spread`: one sigma of each size, tried one after the other;
    empty where nothing is known of it. `ways` share the trouble's prior."""

    name: str
    ways: Sequence[np.ndarray]
    spread: tuple[float, ...] = ()


def likeliest(record: Record, sets: Sequence[LabelSet]) -> Trouble | None:
    """The trouble that is ahead of every set of effects, or not far behind, or None. `sets` are sorted; one of them has
    no labels."""
    known = {item.labels: item for item in sets}
    best, base = sets[0], known[frozenset()].best.fit
    if rounds_to_record(record, best.best.fit):
        return None
    against = score(best.best.fit, base, record.readings, record.noise_freedom) - float(np.log(best.posterior))
    rests = [frozenset[str](), *(best.labels - {label} for label in sorted(best.labels)), best.labels]
    options = [option for rest in dict.fromkeys(rests) if rest in known for option in _options(record, known[rest])]
    first: dict[tuple[str, frozenset[str]], _Option] = {}
    for option in sorted(options, key=lambda one: -one.score(record, base, one.cost)):
        first.setdefault((option.kind, option.rest.labels), option)
    troubles = [_fitted(record, base, option, against) for option in list(first.values())[:REFITTED]]
    likely = max(troubles, key=lambda one: one.lead, default=None)
    return likely if likely is not None and likely.lead > MAY_BE and likely.name not in OF_POSTURES else None


@dataclass(frozen=True)
class _Option:
    """One way of one kind of trouble beside the effects of `rest`. `spread`: one sigma of each size, 0 where nothing is
    known of it; `cost` by the slopes of the fit of `rest`; `price` in nats, for the sizes' spread and the choice."""

    kind: str
    columns: np.ndarray
    spread: float
    rest: LabelSet
    cost: float
    price: float
    sigma: float

    def score(self, record: Record, base: Fit, cost: float) -> float:
        """Log evidence over nothing missing, with this cost."""
        fitted = self.rest.best.fit
        own = freedoms(fitted) + (0 if self.spread else self.columns.shape[2])
        effects = len(fitted.space.variants) + 1
        return evidence(cost, base.cost, own, effects, record.readings, record.noise_freedom) - self.price


def _options(record: Record, rest: LabelSet) -> Iterator[_Option]:
    """Every way of every kind beside a set of effects."""
    fitted = rest.best.fit
    remover = Remover(fitted)
    left = remover.augmented(fitted.residual[None])[0]
    for kind in _kinds(record, fitted, left[: fitted.residual.size]):
        share = float(np.log(len(kind.ways) * max(1, len(kind.spread))))
        for columns in kind.ways:
            bare = remover.columns(_whitened(record, columns))
            power, along = bare.T @ bare, bare.T @ left
            if not np.all(np.diag(power) > 1e-6):
                continue
            for spread in kind.spread or (0.0,):
                inner = power + (np.eye(along.size) / spread**2 if spread else 0.0)
                inverse = np.linalg.pinv(inner, hermitian=True)
                price = share
                if spread:
                    price += 0.5 * float(np.linalg.slogdet(np.eye(along.size) + spread**2 * power)[1])
                elif kind.name == OUTLIERS:  # which readings
                    price += float(along.size * np.log(max(record.readings, 2)))
                sigma = float(np.sqrt(max(inverse[0, 0], 0.0)))
                cost = fitted.cost - float(along @ inverse @ along)
                yield _Option(kind.name, columns, spread, rest, cost, price, sigma)


def _fitted(record: Record, base: Fit, option: _Option, against: float) -> Trouble:
    """The trouble with the limb fitted anew beside it, which may gain more than the slopes of the old fit tell."""
    rest = option.rest.best.fit
    wide = option.columns * (option.spread or _flat(record, option.columns))
    fitted = fit(record.beside(wide), rest.space, rest.x)
    lead = option.score(record, base, min(fitted.cost, option.cost)) - against
    whitened = _whitened(record, option.columns)
    inner = whitened.T @ whitened + (np.eye(whitened.shape[1]) / option.spread**2 if option.spread else 0.0)
    left = record.residuals(fitted.space.models(fitted.x[None]))[0]
    sizes = np.linalg.pinv(inner, hermitian=True) @ (whitened.T @ left)
    return _told(record, option, fitted, wide, sizes, lead)


def _whitened(record: Record, columns: np.ndarray) -> np.ndarray:
    return np.asarray((columns / record.sigma[:, :, None]).reshape(record.measured.size, -1))


LAG, GAIN_STEP, ZERO_STEP, ZEROS, POSE, OUTLIERS = (cause.name for cause in INSTRUMENT_TROUBLES)
# What follows the posture may be of the limb or of an encoder. It is no trouble of the instruments here, and stands
# only against those that would otherwise make up for it.
OF_POSTURES = ("zero_per_posture", "pose_error_per_posture")


def _kinds(record: Record, fitted: Fit, left: np.ndarray) -> Iterator[_Kind]:
    played = (record.measured - fitted.residual.reshape(record.measured.shape) * record.sigma)[: len(FORCES)]
    starts = run_starts(record.dataset["run"])
    yield _Kind(LAG, [_of_forces(record, -_rate(record, played, starts)[:, :, None])])
    later = [np.arange(record.rows) >= start for start in starts[1:-1]]
    if later:
        yield _Kind(GAIN_STEP, [
            _of_forces(record, (played * since * axes)[:, :, None]) for since in later for axes in _AXES_OR_BOTH
        ])  # fmt: skip
        if not record.zeroed:
            since_each = [np.broadcast_to(since, played.shape) for since in later]
            yield _Kind(ZERO_STEP, [
                _of_forces(record, np.stack([since * axis for axis in chosen], axis=2).astype(float))
                for since in since_each for chosen in ((_X,), (_Z,), (_X, _Z))
            ])  # fmt: skip
            runs = _by_run(record, np.ones((1, record.rows)), starts)
            if runs.shape[2] > 2:
                both = np.concatenate([runs * _X[:, :, None], runs * _Z[:, :, None]], axis=2)
                yield _Kind(ZEROS, [_of_forces(record, both)], ZERO_SIGMAS_N)
                yield _Kind(OF_POSTURES[0], [_of_forces(record, _by_posture(record, both, starts))], ZERO_SIGMAS_N)
    if starts.size > 3:
        turned = np.concatenate(
            [_by_run(record, _turned(record, fitted, joint), starts) for joint in ("femur", "tibia")], axis=2
        )
        yield _Kind(POSE, [turned], POSE_SIGMAS_RAD)
        yield _Kind(OF_POSTURES[1], [_by_posture(record, turned, starts)], POSE_SIGMAS_RAD)
    far = np.flatnonzero(left**2 > LEAST_OUT)
    if 0 < far.size <= max(1.0, MOST_OUT * record.readings):
        columns = np.zeros((record.measured.size, far.size))
        columns[far, np.arange(far.size)] = record.sigma.ravel()[far]
        yield _Kind(OUTLIERS, [columns.reshape(*record.measured.shape, far.size)])


_X, _Z = np.array([[1.0], [0.0]]), np.array([[0.0], [1.0]])
_AXES_OR_BOTH = (_X + _Z, _X, _Z)


def _of_forces(record: Record, columns: np.ndarray) -> np.ndarray:
    """Columns of the forces (2 x rows x sizes) as columns of all channels, as a record shows them that zeroes each
    run."""
    out = np.zeros((len(record.channels), *columns.shape[1:]))
    out[: len(FORCES)] = columns
    if record.zeroed:
        starts = run_starts(record.dataset["run"])
        out[: len(FORCES)] -= np.repeat(columns[:, starts[:-1]], np.diff(starts), axis=1)
    return out


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


def _told(
    record: Record, option: _Option, fitted: Fit, wide: np.ndarray, sizes: np.ndarray, lead: float
) -> Trouble:
    """The trouble in words."""
    columns = option.columns
    touched = np.flatnonzero(np.any(columns != 0.0, axis=(0, 2)))
    first = int(touched[0]) if touched.size else 0
    where = [name for place, name in enumerate(record.channels) if np.any(columns[place] != 0.0)]
    row = first + 1 if option.kind in (GAIN_STEP, ZERO_STEP, OUTLIERS) else None
    shown = _shown(record, option.kind, where, first, sizes, option.sigma, columns)
    rest = replace(option.rest, best=replace(option.rest.best, fit=fitted))
    return Trouble(option.kind, ", ".join(where), row, wide, rest, lead, float(sizes[0]), option.sigma, shown)


def _flat(record: Record, columns: np.ndarray) -> np.ndarray:
    """Factors that make each column as long as a size of which nothing is known."""
    length = np.linalg.norm(_whitened(record, columns), axis=0)
    return np.asarray(FLAT / np.where(length > 0.0, length, 1.0))


def _shown(
    record: Record, name: str, where: Sequence[str], first: int, sizes: np.ndarray, sigma: float, columns: np.ndarray
) -> str:
    """What happened, and what to do."""
    data = record.dataset
    since = f"from run {int(data['run'][first])} on (t = {float(data['t_s'][first]):.6g} s)"
    if name == LAG:
        return (
            f"the forces are read {1e3 * sizes[0]:.3g} ms (+-{1e3 * sigma:.1g}) after the displacements; give both "
            "columns one clock, or read after the tip has come to rest"
        )
    if name == GAIN_STEP:
        return (
            f"the sensor reads {100.0 * sizes[0]:+.2g} % {since}, and as believed before; calibrate the sensor, and "
            "look at its amplifier's range"
        )
    if name == ZERO_STEP:
        steps = " and ".join(f"{channel} {size:+.3g} N" for channel, size in zip(where, sizes))
        return f"the sensor's zero moved by {steps} {since}; zero the sensor before each run, and say so in meta.toml"
    if name == ZEROS:
        return (
            f"the sensor's zero differs from run to run by about {float(np.std(sizes)):.2g} N; zero the sensor before "
            "each run, and say so in meta.toml"
        )
    if name == POSE:
        return (
            f"the posture differs from run to run by about {1e3 * float(np.std(sizes)):.2g} mrad from the commanded "
            "angles; measure the angles of every run (columns theta1_rad, theta2_rad)"
        )
    rows = sorted({int(row) + 1 for row in np.flatnonzero(np.any(columns != 0.0, axis=(0, 2)))})
    listed = ", ".join(map(str, rows[:8])) + (f" and {len(rows) - 8} more" if len(rows) > 8 else "")
    return f"single readings stand out (row {listed}) and were left out; look at what disturbed them"
